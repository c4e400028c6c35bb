"""The motion without rest: against exact means, Den Hartog's, and where it is not the mass's."""

from __future__ import annotations

import math
from pathlib import Path

import numpy as np
import pytest
from resonance import reference_curve

from frictionlab.analysis.needs.motion import WithoutRest
from frictionlab.laws.coulomb import Coulomb
from frictionlab.methods.exact.method import Exact
from frictionlab.methods.reduced.reversals import DrivenLine, exact_response, reversals
from frictionlab.scene.scene import Drive, Scene
from frictionlab.theory import friction_free_velocity

LAW = Coulomb(mu=0.4)


def scene(belt_speed, frequency, normal_load, damping=0.1, **load):
    """Paper, Figs. 2 to 4, but for the changes."""
    drive = Drive(frequency=frequency, **(load or {"unbalance": 10.0}))
    return Scene(damping_ratio=damping, normal_load=normal_load, belt_speed=belt_speed, drive=drive)


FILES = sorted((Path(__file__).parents[1] / "reference").glob("sdof_fig*.csv"))


@pytest.mark.parametrize("file", FILES, ids=lambda file: file.stem)
def test_where_the_mass_never_rests_the_motion_without_rest_has_the_exact_mean(file: Path) -> None:
    known = reference_curve(file.name)
    frequency, load = (float(number) for number in file.stem.split("_Om")[1].split("_g"))
    slips = (known["stick_fraction"] == 0.0) & (known["v_b"] > 0.0)
    scenes = [scene(v, frequency, load) for v in known["v_b"][slips]]

    found = WithoutRest().model_means(scenes, LAW)

    np.testing.assert_allclose(found / 0.4, known["mu_bar_exact"][slips] / 0.4, rtol=0, atol=2e-11)


@pytest.mark.parametrize(
    ("damping", "frequency", "friction", "load", "peak"),
    [
        (0.1, 1.0, 4.0, 10.0, 24.50073798),
        (0.02, 2.0, 0.25, 1.0, 0.30605922),
        (0.05, 0.8, 0.3, 1.0, 2.34687197),
    ],
)
def test_with_the_belt_at_rest_it_is_den_hartogs(damping, frequency, friction, load, peak) -> None:
    one = scene(0.0, frequency, friction / LAW.mu, damping, amplitude=load)
    free, response = friction_free_velocity(one), exact_response(one.mass())
    found = reversals(DrivenLine(response, friction, free), np.array([0.5 * math.pi]))
    nodes, weights = np.polynomial.legendre.leggauss(40)
    since = 0.5 * math.pi * (1.0 + nodes)
    # the switch at the begin of forward slip and, half a period before, that at the end of the last
    begun, ended = response(since), response(math.pi + since)
    rub = 0.5 * (begun.both + begun.apart) - 0.5 * (ended.both + ended.apart)
    velocity = free * np.sin(found.middle[0] - 0.5 * math.pi + since) - 2 * friction * rub

    assert found.belt_speed[0] == pytest.approx(0.0, abs=1e-12)
    half = math.pi / frequency
    assert 0.25 * half * (weights @ velocity) == pytest.approx(peak, rel=1e-7)  # from -peak to peak: twice


def test_a_slow_drive_makes_the_free_oscillation_reverse_the_slip_once_more_which_it_leaves_out() -> None:
    still = scene(0.0, 0.5, 0.1 / LAW.mu, 0.05, amplitude=1.0)
    one = still.at(0.7 * friction_free_velocity(still))
    known = Exact().solve([one], LAW, 1e-9).mean[0].real

    assert abs(WithoutRest().model_means([one], LAW)[0] - known) > 0.004


@pytest.mark.parametrize("damping", [0.999999, 1.000001])
def test_critical_damping_is_no_exception(damping: float) -> None:
    at_one, near = (
        WithoutRest().model_means([scene(v, 1.5, 5.0, each) for v in (1.0, 4.0)], LAW)
        for each in (1.0, damping)
    )

    np.testing.assert_allclose(near, at_one, atol=1e-5)
