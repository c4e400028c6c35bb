"""The search for the smallest model, on curves made up: what each part is worth is given, not solved for."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
import pandas as pd
import pytest

import frictionlab as fl
from frictionlab.analysis.needs.motion import LesserModel
from frictionlab.analysis.needs.needs import sentence_of, smallest_in_words
from frictionlab.analysis.needs.search import LeastSearch, each_reason_once
from frictionlab.study import registry

SPEEDS = np.array([1.0, 2.0])
WITHIN = 4e-3
SCENE = fl.Scene(
    damping_ratio=0.1,
    normal_load=1,
    belt_speed=1,
    drive=fl.Drive(amplitude=3, frequency=2),
    transverse=fl.Transverse(natural_frequency=3, damping_ratio=0.1, load=fl.Load(amplitude=1)),
)
FULL = LesserModel(SCENE, fl.LuGre(mu_kinetic=0.3, mu_static=0.4, stiffness=40))
WHOLE = ("transverse motion", "contact compliance", "fall of friction with speed")


class MadeUp:
    """Curves whose means are sums of what the parts that a model lacks are worth; error: of every mean."""

    given = SPEEDS

    def __init__(self, error: float = 0.0, **worth: float) -> None:
        self.worth, self.error, self.asked = worth, error, list[LesserModel]()

    def solve(self, models: Sequence[LesserModel]) -> None:
        """Nothing to solve."""

    def of(self, model: LesserModel) -> pd.DataFrame:
        self.asked.append(model)
        lacking = {
            "line": not model.scene.planar,
            "load": model.scene.transverse is not None and model.scene.transverse.load is None,
            "rigid": model.law.memory_kind == "none",
            "flat": model.law.constant_sliding_friction(),
            "free": model.scene.degrees_of_freedom == 0 or getattr(model.way, "name", "") == "mdsm",
            "one": getattr(model.way, "name", "") == "harmonic_balance",
            "only": getattr(model.way, "harmonics", 0) == 1,
        }
        mean = 0.2 + sum(self.worth.get(part, 0.0) for part, is_gone in lacking.items() if is_gone)
        numbers = {"mean_friction": mean, "error": self.error, "normalized_friction": mean / 0.3}
        words = {"law": "0", "status": "ok", "reason": ""}
        columns = {"scene.belt_speed": SPEEDS, **words, **numbers, "stick_fraction": 0.0}
        return pd.DataFrame(columns)


def search(**worth: float) -> LeastSearch:
    return LeastSearch(FULL, MadeUp(**worth), WITHIN, registry.INSTALLED_LAWS)  # type: ignore[arg-type]  # a stand-in


def names(found: Sequence[object]) -> list[str]:
    return [" + ".join(each.names) for each in found]  # type: ignore[attr-defined]


def test_what_is_worth_nothing_goes_altogether() -> None:
    looked = search()
    singles = looked.singles()
    pairs = looked.pairs(singles)
    smallest = looked.smallest(singles, pairs)

    assert len(pairs) == 6  # of four groups
    assert names(looked.whole(singles)) == [smallest and " + ".join(smallest.names)]
    assert smallest is not None
    assert set(smallest.names) == {*WHOLE, "friction's effect on the motion"}
    assert smallest.model is not None
    assert smallest.model.law == fl.Coulomb(mu=0.3)
    assert smallest.model.method.name == "mdsm"  # type: ignore[union-attr]


def test_a_degree_of_freedom_weighs_more_than_all_the_rest() -> None:
    looked = search(line=3e-3, rigid=3e-3, flat=3e-3, free=3e-3, one=3e-3)
    singles = looked.singles()
    smallest = looked.smallest(singles, looked.pairs(singles))

    assert all(single.may_go for single in singles if single.model is not None)
    assert smallest is not None
    assert smallest.names == ("transverse motion",)


def test_a_set_above_the_tolerance_is_given_up_for_the_next() -> None:
    looked = search(line=1e-3, rigid=2e-3, flat=0.5e-3, free=1.2e-3, one=1.0)
    singles = looked.singles()
    smallest = looked.smallest(singles, looked.pairs(singles))

    assert smallest is not None
    assert set(smallest.names) == set(WHOLE)
    assert smallest.change.mean.value == pytest.approx(3.5e-3)


def test_what_cannot_go_alone_goes_with_others() -> None:
    looked = search(free=1.0, one=1e-4)
    singles = looked.singles()
    alone = {each.names[0]: each for each in singles}
    smallest = looked.smallest(singles, looked.pairs(singles))

    assert alone["friction's effect on the motion"].change.verdict == "needed"
    assert alone["harmonics above 1"].change.verdict == "refused"
    said = sentence_of(alone["harmonics above 1"])
    assert said.startswith("harmonics above 1 cannot be taken away: in the plane")
    assert smallest is not None
    assert "harmonics above 1" in smallest.names


def test_of_cuts_that_no_method_makes_alone_the_strongest_within_the_tolerance_goes() -> None:
    looked = search(free=1.0, only=1.0)
    singles = looked.singles()
    smallest = looked.smallest(singles, looked.pairs(singles))

    assert len([each for each in singles if each.model is None]) == 4
    assert names(each_reason_once(singles))[-2:] == ["harmonics above 1", "friction's effect on the motion"]
    assert len(each_reason_once(singles)) == len(singles) - 3
    assert smallest is not None
    assert "harmonics above 3" in smallest.names


@pytest.mark.parametrize(
    ("change", "error", "verdict"),
    [(5e-3, 1e-4, "needed"), (3e-3, 1e-4, "not needed"), (4e-3, 1e-4, "undecided"), (0.0, 3e-3, "undecided")],
)
def test_a_verdict_counts_the_errors_of_both(change: float, error: float, verdict: str) -> None:
    looked = search(line=change, error=error)
    found = next(each for each in looked.singles() if each.names == ("transverse motion",))

    assert found.change.mean == (pytest.approx(change), pytest.approx(2.0 * error))
    assert found.change.verdict == verdict


def test_nothing_may_go() -> None:
    looked = search(line=1.0, load=1.0, rigid=1.0, flat=1.0, free=1.0, one=1.0)
    singles = looked.singles()

    assert looked.pairs(singles) == []
    assert looked.whole(singles) == []
    assert looked.smallest(singles, []) is None
    assert smallest_in_words(None, FULL, WITHIN).startswith("the smallest model within 0.004 is the full one")
