"""The plain program that shows a newcomer how a mean is found has the mean of the package."""

from __future__ import annotations

import runpy
from pathlib import Path

import frictionlab as fl

PROGRAM = Path(__file__).parents[1] / "docs" / "how_a_mean_is_found.py"


def test_the_plain_program_and_the_package_find_one_mean() -> None:
    plain = runpy.run_path(str(PROGRAM))
    drive = fl.Drive(amplitude=plain["P"], frequency=plain["OMEGA"])
    scene = fl.Scene(
        damping_ratio=plain["ZETA"], normal_load=plain["N"], belt_speed=plain["V_B"], drive=drive
    )

    found = fl.steady_state(scene, fl.Coulomb(mu=plain["MU"]))

    assert abs(plain["mean"] - found.mean_friction) <= plain["error"] + found.error
    assert plain["error"] < 1e-9
