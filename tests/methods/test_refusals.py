"""A method that refuses and names another one is right about that."""

from __future__ import annotations

import re
from typing import Any

import pytest

from frictionlab import (
    Coulomb,
    Dahl,
    Drive,
    ElastoPlastic,
    Initial,
    Jenkins,
    Load,
    LuGre,
    Scene,
    Slip,
    Stribeck,
    Transverse,
    TransverseSlip,
    registry,
)

BODY: dict[str, Any] = {"damping_ratio": 0.1, "normal_load": 10.0, "belt_speed": 0.5}
DRIVE, ACROSS = Drive(unbalance=10, frequency=1), Transverse(natural_frequency=0.5, damping_ratio=0.1)
SLIP = {"belt_speed": 0.5, "slip": Slip(velocity_amplitude=1, frequency=1)}
SCENES = {
    "driven": Scene(**BODY, drive=DRIVE),
    "undriven": Scene(**BODY),
    "undriven plane": Scene(**BODY, transverse=ACROSS),
    "pushed across": Scene(**BODY, transverse=ACROSS, initial=Initial(x2=1.0)),
    "plane": Scene(
        **BODY,
        drive=DRIVE,
        transverse=Transverse(natural_frequency=0.5, damping_ratio=0.1, load=Load(unbalance=10)),
    ),
    "undamped resonance": Scene(**(BODY | {"damping_ratio": 0.0}), drive=DRIVE),
    "slip": Scene(**SLIP),
    "slip in the plane": Scene(**SLIP, transverse_slip=TransverseSlip(velocity_amplitude=1, phase=40)),
}
LAWS = {
    "coulomb": Coulomb(mu=0.4),
    "coulomb, more at rest": Coulomb(mu=0.4, mu_static=0.6),
    "stribeck": Stribeck(mu_kinetic=0.3, mu_static=0.5),
    "dahl": Dahl(mu=0.4, presliding_length=0.1),
    "dahl without a vector form": Dahl(mu=0.4, presliding_length=0.1, exponent=2.0),
    "dahl per axis": Dahl(mu=0.4, presliding_length=0.1, exponent=2.0, planar="per-axis"),
    "lugre": LuGre(mu_kinetic=0.3, mu_static=0.5, presliding_length=0.1),
    "elasto-plastic": ElastoPlastic(mu_kinetic=0.4, presliding_length=0.1, planar="rotated"),
    "jenkins": Jenkins(mu=0.4, presliding_length=0.1),
}


@pytest.mark.parametrize("law", LAWS)
@pytest.mark.parametrize("scene", SCENES)
@pytest.mark.parametrize("name", registry.method_names())
def test_what_a_refusal_says_to_use_does_not_refuse(name: str, scene: str, law: str) -> None:
    reason = registry.method_class(name)().refusal(SCENES[scene], LAWS[law]) or ""
    for other in re.findall(r"\buse (\w+)", reason):
        if other in registry.method_names():
            assert registry.method_class(other)().refusal(SCENES[scene], LAWS[law]) is None, reason
