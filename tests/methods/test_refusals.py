"""A method that refuses and names another one is right about that."""

from __future__ import annotations

import itertools
import re

import pytest
import scene_table
from scene_table import LINE, PLANE

from frictionlab import Coulomb, Dahl, ElastoPlastic, Scene
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
