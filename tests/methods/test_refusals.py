"""Refusals of methods and their reasons; one that names another method is right about that."""

from __future__ import annotations

import itertools
import re
from typing import Any

import pytest
import scene_table
from generalised_maxwell_slip import GeneralisedMaxwellSlip
from memory_laws import elements
from rate_and_state import RateAndState
from scene_table import LINE, PLANE

from frictionlab import (
    Coulomb,
    Dahl,
    ElastoPlastic,
    Exact,
    FrictionLaw,
    HarmonicBalance,
    Jenkins,
    LuGre,
    March,
    Mdsm,
    Method,
    Scene,
    Shooting,
)
from frictionlab.study import registry

SCENES = scene_table.SCENES | {
    "pushed across": LINE | {"transverse": PLANE["transverse"], "initial": {"x2": 1.0}},
    "undamped resonance": LINE | {"damping_ratio": 0.0, "drive": {"unbalance": 10, "frequency": 1}},
}
LAWS = {name: scene_table.law_of(name) for name in scene_table.LAWS} | {
    "coulomb, more at rest": Coulomb(mu=0.4, mu_static=0.6),
    "dahl without a vector form": Dahl(mu=0.4, presliding_length=0.1, exponent=2.0),
    "dahl per axis": Dahl(mu=0.4, presliding_length=0.1, exponent=2.0, planar="per-axis"),
    "elasto-plastic per axis": ElastoPlastic(mu_kinetic=0.4, presliding_length=0.1, planar="per-axis"),
}


@pytest.mark.parametrize("name", registry.method_names())
def test_what_a_refusal_says_to_use_does_not_refuse(name: str) -> None:
    methods = {each: registry.method_class(each)() for each in registry.method_names()}
    for (told, keys), law in itertools.product(SCENES.items(), LAWS.values()):
        scene = Scene(**keys)
        reason = methods[name].refusal(scene, law) or ""
        for other in set(re.findall(r"\buse (\w+)", reason)) & set(methods):
            assert methods[other].refusal(scene, law) is None, f"{told}: {reason}"


LOADED = PLANE | {"transverse": PLANE["transverse"] | {"load": {"amplitude": 1.0}}}
SLIP = {"belt_speed": 0.3, "slip": {"velocity_amplitude": 1.0, "frequency": 1.0}}
ASKEW = {"belt_speed": 0.3, "slip": SLIP["slip"] | {"direction": 30.0, "waveform": "square"}}
SHAKEN = {"belt_vibration": {"velocity_amplitude": 1.0, "direction": 90.0}}
CONSTANT = {"normal_load_variation": {"amplitude": 0.3, "contact": "constant"}}
BENT = {"body": {"curvature": 0.01, "cubic_stiffness": 1.0}}
AT_REST = {"belt_speed": 0.0, "initial": {"x": 0.1, "velocity": 0.0}}
BESIDE = {
    "transverse": {"natural_frequency": 1.0, "damping_ratio": 0.1},
    "damping_ratio": 0.02,
    "belt_speed": 1.0,
}
DRIVEN = LINE | {"drive": {"amplitude": 1.0, "frequency": 2.0}}
COULOMB, STATIC, DAHL = Coulomb(mu=0.4), Coulomb(mu=0.4, mu_static=0.6), Dahl(mu=0.4, presliding_length=0.1)
SQUARE = Dahl(mu=0.4, stiffness=1.0, exponent=2.0)
BY_AXIS = SQUARE.model_copy(update={"planar": "per-axis"})
DUPONT, JENKINS = ElastoPlastic(mu_kinetic=0.4, presliding_length=0.1), Jenkins(mu=0.4, stiffness=1.0)
FEEDING = LuGre(mu_kinetic=0.3, mu_static=0.5, stribeck_speed=0.2, presliding_length=0.01, damping=50.0)
AGEING = RateAndState(mu=0.4, a=0.03, b=0.05, slip_length=0.01)
ELEMENTS, STIFF = (elements(stiffness=(k,), reach=(0.4 / k,)) for k in (4.0, 1e6))
STICKING = GeneralisedMaxwellSlip(
    share=[2, 1], stiffness=[1, 3], mu_kinetic=0.25, mu_static=0.4, stribeck_speed=5.0, attraction=2.0
)


class Remembers(FrictionLaw):
    """Friction of no kind that a method knows."""

    def sliding_friction(self, speed: float) -> float:
        return 0.4 / (1.0 + speed)


@pytest.mark.parametrize(
    ("method", "keys", "law", "said"),
    [
        (Exact(), LOADED, COULOMB, "has a transverse load.*use shooting"),
        (Exact(), PLANE | SHAKEN, COULOMB, "belt that vibrates across.*use shooting"),
        (Exact(), SLIP | CONSTANT, DAHL, "keep the stiffness"),
        (Exact(), SLIP | CONSTANT, COULOMB, ""),
        (Exact(), ASKEW, DAHL, "across the belt.*use shooting"),
        (Exact(), SLIP, SQUARE, ""),
        (Exact(), SLIP, DUPONT, "use shooting"),
        *((method, DRIVEN | BENT, COULOMB, "not take body.cubic_stiffness") for method in (Exact(), Mdsm())),
        (HarmonicBalance(), DRIVEN | BENT, COULOMB, "not take body.cubic_stiffness and body.curvature"),
        (Shooting(), DRIVEN, Remembers(), "a SlidingLaw, a BristleLaw or a MemoryLaw"),
        *(
            (Shooting(), keys, SQUARE, "vector form.*exponent 1|exponent 1.*vector form")
            for keys in (ASKEW, LOADED)
        ),
        *((Shooting(), keys, BY_AXIS, "") for keys in (ASKEW, LOADED)),
        *((Shooting(), keys, SQUARE, "") for keys in (SLIP, LINE)),
        (Shooting(), LINE | AT_REST, AGEING, "creeps"),
        (Shooting(), LINE | AT_REST | {"belt_speed": 0.1}, AGEING, ""),
        (Shooting(), LINE | BESIDE, FEEDING, "across"),
        (Shooting(), LINE | BESIDE | {"initial": {"x2": 1.0}}, COULOMB, "initial.x2"),
        (March(), DRIVEN, STATIC, ""),
        *((March(stepper=each), DRIVEN, STATIC, "use stepper moreau") for each in ("rk4", "smoothed")),
        (March(stepper="moreau"), DRIVEN, FEEDING, "not support friction with memory; use rk4 or sdirk2"),
        (March(theta=1), DRIVEN, FEEDING, "theta is a key of stepper moreau"),
        (March(stepper="rk4"), DRIVEN, Dahl(mu=0.4, stiffness=1.0, exponent=0.5), "needs a bound"),
        (March(stepper="sdirk2"), DRIVEN, JENKINS, "continuous rates"),
        (March(stepper="sdirk2"), DRIVEN, COULOMB, "needs a bristle law; use moreau, rk4 or smoothed"),
        (March(), LOADED, SQUARE, "exponent 1"),
        *((March(), keys, law, "") for keys, law in ((LOADED, BY_AXIS), (DRIVEN, SQUARE))),
        (March(), DRIVEN | CONSTANT, ELEMENTS, "give per_load"),
        (March(), DRIVEN | CONSTANT, DAHL, ""),
        (March(), SLIP, ELEMENTS, "march steps a mass, and this slip is prescribed; use shooting"),
        (March(), LINE | {"initial": {"x": 1.0}}, ELEMENTS, "use shooting"),
        (March(stepper="moreau"), DRIVEN, ELEMENTS, "use rk4"),
        (March(theta=1), DRIVEN, ELEMENTS, "leave it out"),
        (March(), DRIVEN, STIFF, "steps per period"),
        (March(), DRIVEN, STICKING, "no stick or slip of single elements; shooting does"),
    ],
)
def test_what_a_method_cannot_do_is_refused_with_the_reason(
    method: Method, keys: dict[str, Any], law: FrictionLaw, said: str
) -> None:
    reason = method.refusal(Scene(**keys), law) or ""

    assert re.search(said, reason) if said else reason == ""
