"""Shooting on bristles in the plane: references of unrelated codes, corners, planar forms."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pandas as pd
import pytest
from answered import with_columns
from profiles import deep
from resonance import bristles_of

import frictionlab as fl
from frictionlab.methods.shooting.method import Shooting

REFERENCE = Path(__file__).parents[2] / "reference"
MORE = pd.read_csv(REFERENCE / "bristle_more.csv")
pytestmark = deep("planar kernels take long to compile")


def scenes(belt_speeds: np.ndarray, omega_r: float, across: float = 10.0) -> list[fl.Scene]:
    transverse = fl.Transverse(natural_frequency=omega_r, damping_ratio=0.1, load=fl.Load(unbalance=across))
    drive = fl.Drive(unbalance=10.0, frequency=4.0)
    return [
        fl.Scene(damping_ratio=0.1, normal_load=1.0, belt_speed=speed, drive=drive, transverse=transverse)
        for speed in belt_speeds
    ]


@pytest.mark.parametrize("kind", ["dahl", "lugre", "dupont"])
def test_planar_bristles_are_true_to_the_reference(kind: str) -> None:
    rows = MORE[(MORE["omega_r"] != "none") & (MORE["kind"] == kind)].fillna(1.0)
    assert len(rows) >= 6
    for (omega_r, _length), curve in rows.groupby(["omega_r", "presliding_length"]):
        curve = curve.sort_values("belt_speed")
        answers = with_columns(
            Shooting(), scenes(curve["belt_speed"], float(omega_r)), bristles_of(curve.iloc[0]), 1e-6
        )
        assert set(answers.status) == {"ok"}
        error = answers.columns["error"]
        assert (error <= 1e-6).all()
        miss = np.abs(answers.columns["mean_friction"] - curve["mean_friction"])
        assert (miss <= error + curve["accuracy"]).all()


def test_an_orbit_is_found_where_the_steps_of_a_map_jump_by_as_much_as_is_asked() -> None:
    """Bristles that begin to break away twice a period: two tolerances closed nothing, and those between them did.

    The mean is that of scipy's LSODA on the interpreted law at rtol 1e-12, give or take 3e-10.
    """
    across = fl.Transverse(
        natural_frequency=1.6488055973299363,
        damping_ratio=0.05603843509478128,
        load=fl.Load(amplitude=7.3925836394616615),
    )
    scene = fl.Scene(
        damping_ratio=0.31398282805326316,
        normal_load=1.5608333069584945,
        belt_speed=1.218650369925577,
        drive=fl.Drive(amplitude=40.7426499128653, phase=160.67156911920316, frequency=0.6440665334178808),
        transverse=across,
    )
    law = fl.ElastoPlastic(
        mu_kinetic=0.305324651762114,
        breakaway_ratio=0.3204256771436784,
        presliding_length=205.49119705685237,
        damping=2.3255240619590335e-06,
    )
    for tolerance in (1e-6, 1e-8):
        answers = with_columns(Shooting(), [scene], law, tolerance)
        assert answers.status == ["ok"]
        assert answers.columns["error"][0] <= tolerance
        assert abs(answers.columns["mean_friction"][0] - 0.13038352) <= answers.columns["error"][0] + 3e-10


def test_planar_jenkins_friction_moves_on_its_circle_and_tends_to_coulombs() -> None:
    gaps = []
    for length in (1.0, 1e-2, 1e-4):
        (answers,) = (
            with_columns(Shooting(), scenes([15.0], 0.5), fl.Jenkins(mu=0.4, presliding_length=length), 1e-7),
        )
        assert answers.status == ["ok"]
        orbit = answers.orbit(0)
        assert orbit is not None
        assert np.abs(orbit.friction).max() <= 0.4 * (1 + 1e-6)
        coulomb = with_columns(Shooting(), scenes([15.0], 0.5), fl.Coulomb(mu=0.4), 1e-8).columns[
            "mean_friction"
        ][0]
        gaps.append(abs(answers.columns["mean_friction"][0] - coulomb))
    assert gaps[0] > 5e-3
    assert gaps[0] > 20 * gaps[1] > 400 * gaps[2] or gaps[2] < 1e-6


def test_without_a_load_across_the_belt_planar_bristles_are_those_of_the_line() -> None:
    law = fl.Dahl(mu=0.4, presliding_length=0.1)
    planar = with_columns(Shooting(), scenes([15.0], 0.5, across=0.0), law, 1e-8)
    line = [
        fl.Scene(
            damping_ratio=0.1,
            normal_load=1.0,
            belt_speed=15.0,
            drive=fl.Drive(unbalance=10.0, frequency=4.0),
        )
    ]
    alone = with_columns(Shooting(), line, law, 1e-8)
    assert planar.columns["mean_friction"][0] == alone.columns["mean_friction"][0]
    assert "x2 decays" in planar.model[0]


def test_the_two_planar_forms_are_two_laws() -> None:
    means = {}
    for form in ("vectorial", "per-axis"):
        law = fl.Dahl(mu=0.4, presliding_length=3.0, planar=form)
        answers = with_columns(Shooting(), scenes([15.0], 0.5), law, 1e-6)
        assert answers.status == ["ok"]
        means[form] = float(answers.columns["mean_friction"][0])
    coulomb = with_columns(Shooting(), scenes([15.0], 0.5), fl.Coulomb(mu=0.4), 1e-8).columns[
        "mean_friction"
    ][0]
    assert abs(means["per-axis"] - means["vectorial"]) > 1e-3
    assert abs(means["vectorial"] - coulomb) > 1e-3
