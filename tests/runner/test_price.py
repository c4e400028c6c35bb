"""A price told beforehand, and the time left while a run goes on, against what it takes, by methods that wait."""

from __future__ import annotations

import time
from collections.abc import Sequence
from typing import Any, ClassVar

import pytest
from fake_methods import Another, Fake, register

import frictionlab as fl
from frictionlab.compile.call import KernelCall, NotKept
from frictionlab.methods.base import Answers
from frictionlab.methods.under_way import each_told
from frictionlab.runner.chunks import task_of
from frictionlab.runner.price import Price, prices, solving_seconds
from frictionlab.study import parse_study


class Slow(Fake):
    """Takes longest at low belt speeds, and tells how far it is."""

    name: ClassVar[str] = "slow"
    pauses: ClassVar[tuple[float, float]] = 0.06, 0.01

    def solve(self, scenes: Sequence[fl.Scene], law: fl.FrictionLaw, tolerance: float) -> Answers:
        for scene in each_told(scenes):
            time.sleep(self.pauses[scene.belt_speed > 4.0])
        return super().solve(scenes, law, tolerance)


class Unknown(Another):
    """Needs kernels that are not kept."""

    name: ClassVar[str] = "unknown"

    def solve(self, *_: Any) -> Answers:
        raise NotKept(frozenset({"frictionlab_answer_curve_12ab"}))


STUDY: dict[str, Any] = {
    "schema": 1,
    "scene": {"damping_ratio": 0.1, "normal_load": 10, "belt_speed": 5}
    | {"drive": {"unbalance": 10, "frequency": 1}},
    "laws": [{"kind": "coulomb", "mu": 0.4}],
    "methods": ["fake", "slow"],
    "sweep": {"scene.belt_speed": {"start": 1, "stop": 10, "num": 30}},
}


@pytest.fixture(autouse=True)
def known(monkeypatch: pytest.MonkeyPatch) -> None:
    register(monkeypatch, fake=Fake, slow=Slow, unknown=Unknown)


def priced(**changes: Any) -> list[Price]:
    study = parse_study(STUDY | changes)
    return list(prices(list(study.curves()), task_of(study)).values())


def test_a_few_points_of_every_kind_tell_what_all_will_take() -> None:
    priced()  # imports are paid for once
    quick, slow = priced()
    start = time.perf_counter()
    fl.run(STUDY)
    took = time.perf_counter() - start

    assert 2 < slow.measured < 30
    assert quick.seconds < 0.1 * slow.seconds
    assert took / 2.0 < solving_seconds([quick, slow]) < 2.0 * took


def test_what_would_have_to_be_compiled_is_told_and_not_compiled(monkeypatch: pytest.MonkeyPatch) -> None:
    (price,) = priced(methods=["unknown"])

    assert (price.measured, price.to_compile) == (0, {"frictionlab_answer_curve_12ab"})
    assert price.record()["seconds"] is None

    monkeypatch.setattr(KernelCall, "_prepare", lambda *_: pytest.fail("compiled"))
    monkeypatch.setattr(KernelCall, "not_kept", lambda *_: frozenset({"frictionlab_anything_12ab"}))
    monkeypatch.setattr("frictionlab.compile.call._ready", set())
    monkeypatch.setattr("frictionlab.compile.call.PYTHON_IN_A_TRIAL", 0.0)
    (price,) = priced(methods=["auto"], laws=[{"kind": "lugre", "mu_kinetic": 0.4, "stiffness": 40}])
    assert (price.measured, price.to_compile) == (0, {"frictionlab_anything_12ab"})


def test_the_time_left_is_within_a_factor_of_three_from_a_tenth_on(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("frictionlab.runner.forecast.LEARNS_AFTER", 0.0)
    told: list[tuple[float, float]] = []
    study = STUDY | {"laws": [{"kind": "coulomb", "mu": mu, "label": str(mu)} for mu in (0.2, 0.3, 0.4)]}
    start = time.perf_counter()
    fl.run(study, progress=lambda _done, _of, left: told.append((time.perf_counter() - start, left)))
    took = told[-1][0]

    for since, left in told:
        if 0.1 * took < since < 0.8 * took:
            assert (took - since) / 3.0 < left < 3.0 * (took - since), (since, took)
