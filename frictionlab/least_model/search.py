"""One thing taken away at a time, then two and all of those that may go, and the smallest model that is left."""

from __future__ import annotations

import itertools
from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass

from frictionlab import registry
from frictionlab.least_model.answers import Curves
from frictionlab.least_model.change import Change, change_of_curve, refused_change
from frictionlab.least_model.lesser import CannotGo, LesserModel
from frictionlab.least_model.things import Thing, things, without_these
from frictionlab.mistakes.notes import WrongValues

Chosen = tuple[Thing, ...]


@dataclass(frozen=True)
class Without:
    """A model without some things, None where they cannot go, and what that changes."""

    gone: Chosen
    model: LesserModel | None
    change: Change

    @property
    def names(self) -> tuple[str, ...]:
        """What is gone."""
        return tuple(thing.name for thing in self.gone)

    @property
    def may_go(self) -> bool:
        """Whether the change is within the tolerance, its error included."""
        return self.change.verdict == "not needed"


class LeastSearch:
    """Models smaller than a full one, compared with it; each set of things is looked at once.

    within: the tolerance on the mean.
    """

    def __init__(self, full: LesserModel, curves: Curves, within: float, laws: registry.Laws) -> None:
        self.full, self._curves, self._within, self._laws = full, curves, within, laws
        self._rests = bool((curves.of(full)["stick_fraction"] > 0.0).any())
        self._known: dict[Chosen, Without | None] = {}

    def singles(self) -> list[Without]:
        """Every thing that the full model has, taken away alone."""
        return self._all((thing,) for thing in things(self._rests))

    def pairs(self, singles: Sequence[Without]) -> list[Without]:
        """Two at a time of those that may go, of each group what takes most away."""
        return self._all(itertools.combinations(_most(singles), 2))

    def whole(self, singles: Sequence[Without]) -> list[Without]:
        """All that may go at once."""
        return self._all([_most(singles)] if len(_most(singles)) > 2 else [])

    def smallest(self, singles: Sequence[Without], pairs: Sequence[Without]) -> Without | None:
        """The model that takes most away within the tolerance; None where nothing may go.

        Things that no method can take away alone are tried with others. Sets that hold a pair whose change is above
        the tolerance are left out.
        """
        against = [set(pair.gone) for pair in pairs if pair.change.verdict == "needed"]
        options = [each.gone[0] for each in singles if each.may_go or _with_others(each)]
        for chosen in sorted(_sets(options), key=_taken_away, reverse=True):
            if any(pair <= set(chosen) for pair in against):
                continue
            found = self._one(chosen)
            if found is not None and found.may_go:
                return found
        return None

    def _all(self, sets: Iterable[Chosen]) -> list[Without]:
        """Each of these sets, those to be solved solved together."""
        chosen = list(sets)
        models = [self._model(each) for each in chosen]
        self._curves.solve([each for each in models if isinstance(each, LesserModel)])
        return [found for each in chosen if (found := self._one(each)) is not None]

    def _one(self, chosen: Chosen) -> Without | None:
        if chosen not in self._known:
            self._known[chosen] = self._compared(chosen)
        return self._known[chosen]

    def _compared(self, chosen: Chosen) -> Without | None:
        model = self._model(chosen)
        if model is None:
            return None
        if isinstance(model, str):
            return Without(chosen, None, refused_change(model))
        tables = self._curves.of(self.full), self._curves.of(model)
        return Without(chosen, model, change_of_curve(*tables, self._curves.given, self._within, self._laws))

    def _model(self, chosen: Chosen) -> LesserModel | str | None:
        """The model without these things; why they cannot go; None where it has one of them not."""
        try:
            return without_these(self.full, chosen)
        except (CannotGo, WrongValues) as problem:
            return str(problem)


def each_reason_once(singles: Sequence[Without]) -> list[Without]:
    """Without those that cannot go for the reason for which a later one of their group cannot."""
    last = {_why_not(each): each for each in singles}
    return [each for each in singles if each.model is not None or last[_why_not(each)] is each]


def _why_not(single: Without) -> tuple[str, str]:
    return single.gone[0].group, single.change.reason


def _most(singles: Sequence[Without]) -> Chosen:
    """Of those that may go the one of each group that takes most away, in the order of the things."""
    last = {each.gone[0].group: each.gone[0] for each in singles if each.may_go}
    return tuple(last.values())


def _with_others(single: Without) -> bool:
    """Whether a thing that cannot go alone may go once others are gone: a way to find the motion asks for those."""
    return single.model is None and single.gone[0].group == "motion"


def _sets(options: Sequence[Thing]) -> Iterator[Chosen]:
    """Every set of them but the empty one, of each group at most one."""
    groups: dict[str, list[Thing | None]] = {}
    for thing in options:
        groups.setdefault(thing.group, [None]).append(thing)
    for picked in itertools.product(*groups.values()):
        chosen = tuple(thing for thing in picked if thing is not None)
        if chosen:
            yield chosen


def _taken_away(chosen: Chosen) -> int:
    return sum(thing.weight for thing in chosen)
