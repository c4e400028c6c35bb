"""Observed orders: fits of sequences that are known, linear test problems, and a stepper with a wrong weight."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import pytest
from bench_lists import texts
from profiles import deep

from frictionlab.bench.order_solvers import MOTIONS, ORDER_SOLVERS
from frictionlab.bench.orders import OrdersSection, agrees, fit_order, theory_of
from frictionlab.bench.page import write_table
from frictionlab.bench.result import SectionResult
from frictionlab.methods.march.run import MarchRun
from frictionlab.methods.march.steppers import Resolution

SIZES = 0.5 ** np.arange(8)


def orders(motions: str, solvers: str, samples: int = 8) -> SectionResult:
    """Of these motions and solvers."""
    named = {"motions": motions.split(), "steppers": solvers.split()}
    section = OrdersSection.model_validate({**named, "samples": samples})
    return section.measure(lambda line: None)


@pytest.mark.parametrize("order", [0.5, 1.0, 4.0])
def test_a_power_is_fitted_above_the_error_of_the_reference(order: float) -> None:
    errors = 1e-3 * SIZES**order + 1e-9

    fit = fit_order(SIZES, errors, known=1e-9)

    assert fit.asymptotic
    assert fit.order == pytest.approx(order, abs=0.05)
    assert errors[fit.last] > 1e-8


def test_errors_that_fall_ever_faster_have_no_asymptotic_range() -> None:
    fit = fit_order(SIZES, np.exp(-1.0 / SIZES), known=1e-60)

    assert not fit.asymptotic
    assert fit.spread > 1.0


@deep("seconds of steps")
def test_smooth_motion_shows_the_order_of_the_stepper() -> None:
    table = orders("smooth", "moreau_0.5").table

    assert table["asymptotic"].tolist() == ["yes"]
    assert agrees(table).all()
    assert table["order"][0] == pytest.approx(2.0, abs=0.1)


@deep("seconds of steps")
def test_a_reversal_inside_a_step_costs_the_order() -> None:
    smooth, reversing = orders("smooth crossing", "rk4", samples=6).table["order"]

    assert smooth == pytest.approx(4.0, abs=0.1)
    assert reversing == pytest.approx(1.0, abs=0.3)


@deep("seconds of steps")
def test_a_stepper_with_a_wrong_weight_shows_a_wrong_order(monkeypatch: pytest.MonkeyPatch) -> None:
    def midway(self: MarchRun, pace: Resolution, *given: Any) -> Any:
        return run(self, Resolution(**{**vars(pace), "theta": 1.0}), *given)

    run = MarchRun.run
    monkeypatch.setattr(MarchRun, "run", midway)
    table = orders("smooth", "moreau_0.5").table

    assert table["asymptotic"].tolist() == ["yes"]
    assert not agrees(table).any()
    assert table["order"][0] == pytest.approx(1.0, abs=0.1)


def test_every_solver_has_a_theory_on_every_motion_it_can_follow() -> None:
    for motion in MOTIONS.values():
        for solver in ORDER_SOLVERS.values():
            if solver.takes(motion):
                assert theory_of(solver.name, motion.name)[1]


@deep("seconds of steps")
def test_the_table_says_what_was_fitted_and_why_theory_expects_it(tmp_path: Path) -> None:
    result = orders("smooth", "moreau_1 smoothed")
    (name,) = write_table(result, tmp_path)
    by_steps, by_width = texts(tmp_path / name).to_dict("records")

    assert list(by_steps) == [
        *("solver", "motion", "law", "setting", "settings_from", "settings_to", "order", "spread", "theory"),
        *("reason", "asymptotic", "error_from", "error_to", "reference"),
    ]
    assert float(by_steps["order"]) == pytest.approx(1.0, abs=0.1)
    assert (by_steps["theory"], by_steps["asymptotic"], by_steps["reference"]) == ("1.0", "yes", "shooting")
    assert float(by_steps["error_to"]) < float(by_steps["error_from"])
    assert by_width["theory"] == ""
    assert "faster than any power" in by_width["reason"]
    assert "moreau_1" in result.summary


@deep("minutes")
@pytest.mark.parametrize("motion", MOTIONS)
def test_orders_are_within_a_tenth_of_theory_wherever_they_are_asymptotic(motion: str) -> None:
    # fewer grids leave orders .06 apart by which grids they are
    table = orders(motion, " ".join(ORDER_SOLVERS), samples=64).table

    known = table[table["asymptotic"] == "yes"]
    assert not known.empty
    assert known.loc[~agrees(known), ["solver", "order"]].to_numpy().tolist() == []
