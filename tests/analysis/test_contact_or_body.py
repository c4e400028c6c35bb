"""What docs/equivalence.md says of elastic contacts under a prescribed slip and of bodies that friction brakes."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from equivalence_figures import (
    COULOMB,
    LOAD,
    MU,
    SHARES,
    body,
    means,
    nearest,
    other_body,
    planar_body,
    slip_of,
    v_lin,
)
from profiles import deep

import frictionlab as fl
from frictionlab.analysis.fit.equivalent import Norm

COUNT = 60


def curve_of(scene: fl.Scene) -> np.ndarray:
    return means(scene, COULOMB, SHARES * v_lin(scene))


def nearest_found(scene: fl.Scene, norm: Norm, wide: bool = False) -> fl.Equivalent:
    """By ``fl.equivalent``; wide: the amplitude of the slip is free, too."""
    slip, stroke = slip_of(scene)
    free: dict[str, Any] = {
        "presliding_length": {"from": 1e-4 * stroke, "to": 1e2 * stroke, "spacing": "log"}
    }
    if wide:
        free["scene.slip.velocity_amplitude"] = (0.5 * v_lin(scene), 3 * v_lin(scene))
    among = slip, fl.Dahl(mu=MU, presliding_length=stroke), free
    return fl.equivalent((scene, COULOMB), among, SHARES * v_lin(scene), norm, starts=2)


@deep("seconds of search")
@pytest.mark.parametrize("norm", ["largest", "rms"])
@pytest.mark.parametrize(("frequency", "ratio"), [(1, 0.4), (0.5, 0.4), (1, 1.2)])
def test_no_stiffness_at_all_comes_nearer_than_the_search(frequency: float, ratio: float, norm: str) -> None:
    """The bounds hold for any presliding length, as curves rise with it; the search ends at a hundred strokes."""
    bounds = nearest(curve_of(body(frequency, ratio)), norm, COUNT)
    found = nearest_found(body(frequency, ratio), norm)

    assert bounds.at_least <= found.distance / MU <= bounds.distance + 1e-4


@deep("seconds of search")
def test_they_are_alike_above_resonance_and_never_the_same() -> None:
    for frequency, ratio, below in ((1.5, 0.6, 0.05), (4, 0.6, 0.05), (4, 0.05, 0.006), (1, 0.6, 0.076)):
        scene = body(frequency, ratio)
        assert nearest(curve_of(scene), "largest", COUNT).at_least > 0.003
        assert nearest_found(scene, "largest").distance / MU < below


@deep("seconds of search")
def test_the_stiffness_of_the_contact_is_that_of_the_body() -> None:
    """Above resonance the presliding length over the stroke depends on friction over load alone."""
    for ratio, softness in ((0.2, 0.075), (0.3, 0.2), (0.4, 0.39), (0.5, 0.67)):
        for frequency in (1.5, 4):
            scene = body(frequency, ratio)
            found = nearest_found(scene, "rms").values["presliding_length"] / slip_of(scene)[1]
            assert found == pytest.approx(softness, rel=0.05)


@deep("seconds of search")
@pytest.mark.parametrize(("frequency", "stiffness"), [(1, 0.12), (1.5, 1.3), (2, 3.1), (4, 15)])
def test_the_nearest_contact_stiffness_in_shares_of_the_spring(frequency: float, stiffness: float) -> None:
    length = nearest_found(body(frequency, 0.4), "rms").values["presliding_length"]

    assert 0.4 * LOAD / length == pytest.approx(stiffness, rel=0.05)


@deep("seconds of search")
def test_a_second_frequency_decides() -> None:
    length = nearest_found(body(1.5, 0.4), "rms").values["presliding_length"]
    scene = body(3, 0.4)
    slip = slip_of(scene)[0]

    apart = curve_of(scene) - means(slip, fl.Dahl(mu=MU, presliding_length=length), SHARES * v_lin(scene))

    assert np.abs(apart).max() == pytest.approx(0.21, abs=5e-3)


@deep("seconds of search")
@pytest.mark.parametrize(
    ("frequency", "ratio", "low"), [(0.5, 0.2, 0.2), (0.5, 0.8, 0.14), (1, 1, 0.29), (4, 1, 0.2)]
)
def test_where_no_stiffness_does(frequency: float, ratio: float, low: float) -> None:
    assert low < nearest(curve_of(body(frequency, ratio)), "largest", COUNT).at_least


@deep("seconds of search")
def test_a_load_across_cannot_be_imitated_unless_slip_is_wider() -> None:
    scene = planar_body()
    bounds = nearest(curve_of(scene), "largest", COUNT)
    wide = nearest_found(scene, "largest", wide=True)

    assert (bounds.softness, bounds.at_least) == (0, pytest.approx(0.2996, abs=1e-3))
    assert wide.distance / MU == pytest.approx(0.041, abs=1e-3)
    assert wide.values["scene.slip.velocity_amplitude"] / v_lin(scene) == pytest.approx(1.84, abs=0.01)


@deep("seconds of search")
def test_another_coulomb_body_is_like_a_dahl_body_up_to_resonance() -> None:
    assert other_body(1, 0.35, 0.1, "largest").distance / MU < 0.01
    assert 0.05 < other_body(2, 0.35, 0.1, "largest").distance / MU < 0.12


@deep("seconds of search")
@pytest.mark.parametrize(
    ("frequency", "per_load", "apart", "left"), [(1, 0.0119, 0.178, 0.0377), (1.5, 0.422, 0.040, 0.0190)]
)
def test_bodies_of_unbalance_and_normal_load_ten(
    frequency: float, per_load: float, apart: float, left: float
) -> None:
    """Contact stiffness per load, root mean squares from rigid and nearest slip: those of an unrelated scan."""
    scene = body(frequency, 0.4 / frequency**2)  # in a unit of length that is larger by frequency^2
    found = nearest_found(scene, "rms")
    rigid = curve_of(scene) - 2 / np.pi * np.arcsin(SHARES)

    assert MU / (found.values["presliding_length"] * frequency**2) == pytest.approx(per_load, rel=5e-3)
    assert np.sqrt(np.mean(rigid**2)) == pytest.approx(apart, abs=1e-3)
    assert found.distance / MU == pytest.approx(left, abs=3e-4)
