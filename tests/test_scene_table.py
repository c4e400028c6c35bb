"""The page on scenes says which method takes which scene with which law; what it says is taken is solved."""

from __future__ import annotations

import itertools

import pytest
import scene_table
from profiles import deep
from scene_table import LAWS, METHODS, PAGE, SCENES, law_of, refusal

import frictionlab as fl
from frictionlab.study import registry


def test_the_tables_are_those_of_the_methods() -> None:
    assert PAGE.read_text(encoding="utf-8") == scene_table.written(), "run: python tests/scene_table.py"


def test_every_method_has_its_column() -> None:
    # relay_locus is for bodies that remember, which the table has none of; certified takes what exact takes
    assert set(METHODS) == set(registry.method_names()) - {"certified", "relay_locus"}


ANSWERS = "ok", "not_unique"


def is_answered(law: str, state: fl.SteadyState) -> bool:
    """Whether there is an answer; of a law that is too stiff at rest, whether the reason says that."""
    too_stiff = law == "rate-and-state" and " rest" in state.reason
    return state.status in ANSWERS or too_stiff


@deep("most kernels there are")
@pytest.mark.parametrize("scene", SCENES)
def test_what_is_said_to_be_taken_is_solved_and_methods_agree(scene: str) -> None:
    for law in LAWS:
        taken = [method for method in METHODS if refusal(method, scene, law) is None]
        given = fl.Scene(**SCENES[scene]), law_of(law)
        states = {method: fl.steady_state(*given, method, tolerance=1e-6) for method in taken}

        assert {(law, name): each for name, each in states.items() if not is_answered(law, each)} == {}
        found = [each for each in states.values() if each.status == "ok"]
        for one, other in itertools.combinations(found, 2):
            assert abs(one.mean_friction - other.mean_friction) <= one.error + other.error, (law, one, other)
