"""The nearest curve of another model: itself, the two norms, what is varied, bad questions."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from profiles import deep

import frictionlab as fl

SCENE = fl.Scene(damping_ratio=0.1, normal_load=10, belt_speed=5, drive=fl.Drive(unbalance=10, frequency=1))
SLIP = fl.Scene(belt_speed=1, slip=fl.Slip(velocity_amplitude=50, frequency=1))
SPEEDS = np.linspace(2.0, 58.0, 15)
SOFT: Any = (
    SLIP,
    fl.Dahl(mu=0.4, presliding_length=1.0),
    {"presliding_length": {"from": 0.1, "to": 1e3, "spacing": "log"}},
)


@deep("seconds of search")
def test_a_model_among_itself_is_at_no_distance() -> None:
    law = fl.Dahl(mu=0.4, presliding_length=20.0)
    found = fl.equivalent((SLIP, law), SOFT, belt_speed=SPEEDS, starts=2)
    assert found.values["presliding_length"] == pytest.approx(20.0, rel=1e-5)
    assert found.distance <= found.distance_error + 1e-8


def test_a_slip_half_as_wide_again_is_found() -> None:
    """Coulomb curves under a prescribed slip differ by their unit of belt speed."""
    wider = fl.Scene(belt_speed=1, slip=fl.Slip(velocity_amplitude=75, frequency=1))
    free = {"scene.slip.velocity_amplitude": (20, 200)}
    found = fl.equivalent((wider, fl.Coulomb(mu=0.4)), (SLIP, fl.Coulomb(mu=0.4), free), SPEEDS, starts=2)

    assert found.values["scene.slip.velocity_amplitude"] == pytest.approx(75, rel=1e-6)
    assert found.distance < 1e-7


@pytest.mark.parametrize(("norm", "mu", "distance"), [("largest", 0.2, 0.2), ("rms", 0.3, 0.4 * 0.1875**0.5)])
def test_to_a_step_the_norms_are_nearest_with_other_numbers(norm: Any, mu: float, distance: float) -> None:
    """Slip to and fro at one speed: no mean below it, mu above; beside slip that never turns round, always mu.

    One of four belt speeds is below: the largest distance is least half way up, the root mean square at the average.
    """
    square = fl.Scene(belt_speed=1, slip=fl.Slip(velocity_amplitude=50, frequency=1, waveform="square"))
    hardly = fl.Scene(belt_speed=1, slip=fl.Slip(velocity_amplitude=1, frequency=1))
    among = hardly, fl.Coulomb(mu=0.3), {"mu": (0.1, 1.0)}
    found = fl.equivalent((square, fl.Coulomb(mu=0.4)), among, [20, 60, 70, 80], norm, starts=2)

    assert found.values["mu"] == pytest.approx(mu, abs=1e-6)
    assert found.distance == pytest.approx(distance, abs=1e-7)
    assert found.rms == pytest.approx(np.sqrt(np.mean((found.curves["among"] - found.curves["of"]) ** 2)))


def test_the_stated_error_covers_what_a_fine_solve_finds() -> None:
    """A Dahl body among LuGre bodies: both curves are integrated, neither is exact."""
    lugre = fl.LuGre(mu_kinetic=0.35, presliding_length=1, damping=0.05)
    laws = fl.Dahl(mu=0.4, presliding_length=2.0), lugre
    found = fl.equivalent((SCENE, laws[0]), (SCENE, lugre, {"mu_kinetic": (0.2, 0.6)}), SPEEDS[::2], starts=1)
    nearest = lugre.model_copy(update=found.values)
    fine = [
        fl.curve(SCENE, law, SPEEDS[::2], tolerance=1e-11, columns=["mean_friction"], progress=False)[
            "mean_friction"
        ]
        for law in (laws[0], nearest)
    ]
    distance = np.abs(fine[0] - fine[1]).max()

    assert abs(distance - found.distance) <= found.distance_error < 1e-7


def test_numbers_are_found_anew_over_an_input() -> None:
    other = SCENE, fl.Coulomb(mu=0.4), {"mu": (0.1, 1.0)}
    over = {"drive.frequency": [1.0, 1.5]}
    found = fl.equivalent((SCENE, fl.Coulomb(mu=0.6)), other, belt_speed=SPEEDS, over=over, starts=1)
    assert found.table["mu"].to_list() == pytest.approx([0.6, 0.6], abs=1e-6)
    assert found.table["drive.frequency"].to_list() == [1.0, 1.5]
    assert len(found.plot().axes) == 2


def test_where_a_body_has_two_motions_the_reason_stands_in_its_row() -> None:
    """A stiff Dahl contact keeps reversing above V_lin when it started so, beside steady sliding."""
    scene = fl.Scene(
        damping_ratio=0.1, normal_load=20, belt_speed=1, drive=fl.Drive(amplitude=10, frequency=4)
    )
    law, speeds = fl.Dahl(mu=0.4, presliding_length=0.0666), [1.0, 40 / abs(complex(15, 0.8))]
    among = scene, fl.Coulomb(mu=0.4), {"mu": (0.1, 1.0)}
    found = fl.equivalent((scene, law), among, speeds, over={"drive.frequency": [4, 1]}, starts=1)

    assert "not_unique" in found.table["reason"][0]
    assert found.table["distance"].isna().tolist() == [True, False]
    assert found.distance == found.table["distance"][1]
    assert found.plot().axes[0].get_title(loc="left").endswith(": 1")
    with pytest.raises(ValueError, match="not_unique"):
        fl.equivalent((scene, law), among, speeds, starts=1)


def test_bad_questions_are_told() -> None:
    with pytest.raises(ValueError, match="norm must be 'largest' or 'rms', got 'mean'"):
        fl.equivalent((SCENE, fl.Coulomb(mu=0.4)), SOFT, norm="mean")  # type: ignore[arg-type]
    with pytest.raises(ValueError, match="over must name one input"):
        fl.equivalent(
            (SCENE, fl.Coulomb(mu=0.4)), SOFT, over={"drive.frequency": [1], "damping_ratio": [0.1]}
        )
