"""A prescribed slip that comes to rest for an instant, without turning back: panels towards it stay few."""

from __future__ import annotations

import pytest

from frictionlab.laws.coulomb import Coulomb
from frictionlab.methods.prescribed.varying_slip import VaryingPoint, VaryingSlip
from frictionlab.scene.scene import Scene

LOAD = {"amplitude": 0.6, "phase": 20.0}


@pytest.mark.parametrize("frequency", [1.0, 0.3, 7.0])
def test_a_slip_that_touches_rest_takes_few_panels(frequency: float) -> None:
    slip = {"velocity_amplitude": 1.0, "frequency": frequency}
    scene = Scene(belt_speed=1.0, slip=slip, normal_load_variation=LOAD)
    found = VaryingSlip.of(scene.signals(), 1.0)

    edges, k = found.panels(1.0)

    assert len(k) == len(edges) - 1 < 2000
    point = VaryingPoint(scene, Coulomb(mu=1.0))
    assert abs(point.found.mean - 1.0) <= point.found.error < 1e-5
