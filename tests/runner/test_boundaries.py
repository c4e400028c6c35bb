"""Lines over two swept numbers on which a measure of the curves has a level."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path
from typing import Any

import fig_4b
import numpy as np
import pytest
from fig_4b import LAW
from profiles import deep
from scipy.integrate import simpson
from scipy.optimize import brentq

import frictionlab as fl
from frictionlab.charts.maps import map_of_curves
from frictionlab.runner.api import write_derived
from frictionlab.runner.boundaries import measures_of
from frictionlab.runner.workforce import threads
from frictionlab.study.registry import INSTALLED_LAWS
from frictionlab.theory import friction_free_velocity
from frictionlab.values.notes import StudyError

SPEEDS = {"start": 2, "stop": 60, "num": 30}
SCENE = fig_4b.SCENE.with_(drive=fl.Drive(amplitude=10, frequency=1))
FREQUENCY, LOAD, SPEED = "scene.drive.frequency", "scene.normal_load", "scene.belt_speed"
SWEEP: dict[str, Any] = {FREQUENCY: [0.9, 1.0, 1.1], LOAD: [5.0, 10.0, 15.0], SPEED: SPEEDS}


def study(**told: Any) -> fl.Study:
    return fl.Study.of(SCENE, LAW, **{"sweep": SWEEP, "boundaries": {"shape_area": 0}, **told})


def measured(
    what: str, tolerance: float, scene: fl.Scene = SCENE, law: fl.FrictionLaw = LAW
) -> tuple[float, float]:
    """Return a measure of a curve and its error."""
    curves = [*fl.Study.of(scene, law, sweep={SPEED: SPEEDS}).curves()]
    with threads(1) as force:
        (found,), (error,) = measures_of(curves, what, tolerance, force, INSTALLED_LAWS)
    return float(found), float(error)


def area(load: float, frequency: float) -> float:
    """The area over the chord by many belt speeds and Simpson's rule in the angle arcsin(v / V_lin)."""
    scene = SCENE.with_(normal_load=load, **{"drive.frequency": frequency})
    angle = np.linspace(0.0, np.pi / 2, 401)
    end = friction_free_velocity(scene)
    found = fl.curve(scene, LAW, end * np.sin(angle[1:]))["mean_friction"]
    rise = np.concatenate([[0.0], found]) / found.iloc[-1]
    return float(2.0 * simpson((rise - np.sin(angle)) * np.cos(angle), x=angle))


@deep("seconds of roots")
def test_random_places_are_where_bisections_of_curves_solved_densely_are() -> None:
    found = fl.run(study()).boundaries

    assert set(found["piece"]) == {1}
    frequencies = found[FREQUENCY]
    assert (frequencies.min(), frequencies.max()) == (0.9, 1.1)
    for told in found.sample(3, random_state=1).to_dict("records"):
        root = brentq(area, 5.0, 15.0, args=(told[FREQUENCY],), xtol=1e-6)
        assert abs(told[LOAD] - root) <= told["scene.normal_load_error"] < 2e-3


def test_a_place_is_the_root_of_the_measure_to_a_millionth() -> None:
    one = study()
    told = fl.run(one).boundaries.iloc[2]

    def area_at(load: float) -> float:
        scene = SCENE.with_(normal_load=load, **{"drive.frequency": told[FREQUENCY]})
        return measured("shape_area", one.tolerance, scene)[0]

    assert told[LOAD] == pytest.approx(brentq(area_at, 5.0, 15.0, xtol=1e-9), abs=1e-6)


@deep("seconds of roots")
def test_the_end_of_reversal_of_a_law_that_falls_is_found_sharply() -> None:
    stribeck = fl.Stribeck(mu_kinetic=0.3, mu_static=0.4, stribeck_speed=20)
    end, error = measured("reversal_end", 1e-8, law=stribeck)

    def shortfall(speed: float) -> float:
        orbit = fl.steady_state(SCENE.with_(belt_speed=speed), stribeck).orbit(4000)
        return float(speed - orbit["v1"].max()) - 1e-3  # of rest and of samples beside the peak

    assert abs(end - brentq(shortfall, 0.5 * end, 1.5 * end, xtol=1e-6)) < 2e-3
    assert 0.0 < error < 4e-5 * end


@deep("seconds of roots")
def test_lines_over_linked_numbers_and_over_friction_are_those_of_the_number_they_stand_for() -> None:
    at = {FREQUENCY: SWEEP[FREQUENCY], SPEED: SPEEDS}
    both = {LOAD: [20.0, 10.0, 4.0], "friction": [0.1, 0.4, 1.5]}
    forces = []
    for sweep in (SWEEP, at | {"friction": [0.2, 0.4, 0.6]}, at | {"linked": [both]}):
        rows = fl.run(study(sweep=sweep)).boundaries
        at_grid = np.isin(rows[FREQUENCY].round(9), SWEEP[FREQUENCY])
        forces.append(np.sort((rows["law.mu"] * rows[LOAD])[at_grid]))

    assert len(forces[0]) == 3
    for each in forces[1:]:
        np.testing.assert_allclose(each, forces[0], rtol=1e-6)


@deep("seconds of roots")
def test_at_resonance_the_area_is_zero_where_friction_is_a_third_of_the_load() -> None:
    # the exact value, .331 of the load, is of many points; those few have an error that covers it
    found = fl.run(study(sweep=SWEEP | {SPEED: {"start": 0.5, "stop": 60, "num": 120}})).boundaries
    at = found[np.isclose(found[FREQUENCY], 1.0)].iloc[0]

    assert at[LOAD] * 0.4 / 10.0 == pytest.approx(0.331, abs=1e-3)


@deep("seconds of roots")
def test_lines_are_kept_in_a_file_read_again_and_drawn(tmp_path: Path) -> None:
    for _ in range(2):
        done = fl.run(study(), tmp_path / "out")
        write_derived(done, "boundaries")
    assert done.computed == 0
    assert len(done.boundaries) == len((tmp_path / "out" / "boundaries.csv").read_text().splitlines()) - 1


@deep("seconds of roots")
def test_a_map_shows_the_lines_in_place_of_contours_of_its_grid() -> None:
    fine = {FREQUENCY: {"start": 0.9, "stop": 1.1, "num": 5}, LOAD: {"start": 5, "stop": 15, "num": 5}}
    done = fl.run(study(sweep=fine | {SPEED: SPEEDS}))
    measures = map_of_curves(done.curves)
    assert measures is not None
    axes = replace(measures, boundaries=done.boundaries).draw().axes

    lines = [line for each in axes for line in each.lines]
    assert len(lines) == 1
    np.testing.assert_allclose(lines[0].get_xdata(), done.boundaries[FREQUENCY])


def test_a_study_says_what_its_lines_are_over() -> None:
    assert study().resolved()["boundaries"] == {"shape_area": 0}
    assert fl.Study.of(SCENE, LAW).resolved().get("boundaries") is None


NEEDS = "needs the belt speed and two numbers swept"


@pytest.mark.parametrize(
    ("told", "said"),
    [
        ({"boundaries": {"area": 0}}, "boundaries.area: unknown key"),
        ({"boundaries": {"shape_area": "zero"}}, "shape_area: must be a number, got the text 'zero'"),
        ({"sweep": {SPEED: SPEEDS}}, NEEDS),
        ({"sweep": {"friction": [0.1, 0.2]} | SWEEP}, NEEDS),
        ({"sweep": SWEEP | {LOAD: [5.0]}}, NEEDS),
    ],
)
def test_what_is_no_boundary_is_said(told: dict[str, Any], said: str) -> None:
    with pytest.raises(StudyError, match=said):
        study(**told)


WEAK = 1e-4
"""Normal load so small that the motion is that without friction."""


@deep("seconds of roots")
@pytest.mark.parametrize("across", [None, (0.01, 0.0), (1.5, 70.0), (300.0, 0.0)])
def test_weak_friction_leaves_the_area_of_the_motion_without_it(across: tuple[float, float] | None) -> None:
    # from omega_r = 0, a mass alone, to infinity, where the body moves along the belt: 1 - 4/pi at every frequency
    frequency, natural, phase = 1.3, *(across or (1e9, 0.0))
    scene = SCENE.with_(normal_load=WEAK, **{"drive.frequency": frequency})
    if across is not None:
        load = fl.Load(amplitude=10, phase=phase)
        scene = scene.with_(transverse=fl.Transverse(natural_frequency=natural, damping_ratio=0.1, load=load))
    along, beside = (
        10j * frequency * np.exp(1j * turned) / (each**2 - frequency**2 + 0.2j * own * frequency)
        for each, own, turned in ((1.0, 1.0, 0.0), (natural, natural, np.radians(phase)))
    )
    turn = np.exp(1j * 2.0 * np.pi * (np.arange(4000) + 0.5) / 4000)
    angle = np.linspace(0.0, np.pi / 2, 401)[1:]
    slip = abs(along) * np.sin(angle)[:, None] - (along * turn).real + 1j * (beside * turn).real
    rise = np.concatenate([[0.0], 0.4 * (slip / abs(slip)).real.mean(axis=1)])
    chord = np.concatenate([[0.0], np.sin(angle)])
    wanted = 2.0 * simpson((rise / rise[-1] - chord) * np.sqrt(1.0 - chord**2), dx=angle[0])

    area_found, error = measured("shape_area", 1e-7, scene)
    assert abs(area_found - wanted) < error + 1e-3
    if natural > 100.0:
        assert area_found == pytest.approx(1.0 - 4.0 / np.pi, abs=2e-3)


@pytest.mark.parametrize("frequency", [0.7, 1.6])
def test_a_weak_soft_contact_has_no_area_where_prescribed_slip_has_none(frequency: float) -> None:
    # at a presliding length of 0.472 amplitudes, as studies/prescribed_shape_measures_dahl.yaml has it
    amplitude = 10.0 / abs(1.0 - frequency**2 + 0.2j * frequency)
    scene = SCENE.with_(normal_load=WEAK, **{"drive.frequency": frequency})
    dahl = fl.Dahl(mu=0.4, presliding_length=0.472 * amplitude)
    found, error = measured("shape_area", 1e-7, scene, dahl)

    assert abs(found) < error + 1e-3
