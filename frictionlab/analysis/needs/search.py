"""Things taken away from a model one at a time, then two and all of those that may go, and the smallest one left."""

from __future__ import annotations

import itertools
from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass
from typing import NamedTuple

from frictionlab.analysis.needs.answers import Change, Curves, change_of_curve
from frictionlab.analysis.needs.motion import (
    CannotGo,
    LesserModel,
    Taken,
    cut_to,
    friction_free_of,
    orders,
    slipping,
)
from frictionlab.analysis.needs.parts import (
    on_a_line,
    rigid,
    sines,
    steady_normal_load,
    undamped_bristles,
    without_fall,
    without_load_across,
    without_term,
    without_viscosity,
)
from frictionlab.scene.parts import BENDING, REMEMBERING
from frictionlab.study import registry
from frictionlab.values.notes import WrongValues


class Thing(NamedTuple):
    """A part of a model. group: of those of one group one alone is taken away, a later one takes more away.

    weight: by which sets of things are ranked: a heavier one outweighs all lighter ones together.
    """

    name: str
    group: str
    weight: int
    away: Taken


def things(rests: bool) -> tuple[Thing, ...]:
    """In the order in which several are taken away; of a group the later ones take more away.

    rests: whether the full motion rests at some belt speed.
    """
    cuts = [
        Thing(f"harmonics above {n}", "motion", 20 + 10 * rank, cut_to(n))
        for rank, n in enumerate(reversed(orders()))
    ]
    return (
        Thing("waveform", "waveform", 1, sines),
        Thing("load variation", "normal load", 1, steady_normal_load),
        Thing("load across the belt", "across", 1, without_load_across),
        Thing("transverse motion", "across", 2000, on_a_line),
        *(Thing(name.replace("_", " "), name, 1, without_term(name)) for name in BENDING),
        *(Thing(f"{name} of the body", name, 400, without_term(name)) for name in REMEMBERING),
        Thing("bristle damping", "bristles", 1, undamped_bristles),
        Thing("contact compliance", "bristles", 400, rigid),
        Thing("fall of friction with speed", "fall", 1, without_fall),
        Thing("viscosity", "viscosity", 1, without_viscosity),
        *([Thing("stick", "motion", 10, slipping)] if rests else []),
        *cuts,
        Thing("friction's effect on the motion", "motion", 200, friction_free_of),
    )


Chosen = tuple[Thing, ...]


@dataclass(frozen=True)
class Without:
    """A model without some things, None where they cannot go, and what that changes."""

    gone: Chosen
    model: LesserModel | None
    change: Change

    @property
    def names(self) -> tuple[str, ...]:
        """Return what is gone."""
        return tuple(thing.name for thing in self.gone)

    @property
    def may_go(self) -> bool:
        """Check whether the change is within the tolerance, its error included."""
        return self.change.verdict == "not needed"

    @property
    def asks_for_others(self) -> bool:
        """Check whether a thing that cannot go alone may go once others have: some ways to find motions ask."""
        return self.model is None and self.gone[0].group == "motion"


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
        """Return the model that takes most away within the tolerance; None where nothing may go.

        Things that no method can take away alone are tried with others. Sets that hold a pair whose change is above
        the tolerance are left out.
        """
        against = [set(pair.gone) for pair in pairs if pair.change.verdict == "needed"]
        options = [each.gone[0] for each in singles if each.may_go or each.asks_for_others]
        for chosen in sorted(
            _sets(options), key=lambda each: sum(thing.weight for thing in each), reverse=True
        ):
            found = None if any(pair <= set(chosen) for pair in against) else self._one(chosen)
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
        if chosen in self._known:
            return self._known[chosen]
        found, model = None, self._model(chosen)
        if isinstance(model, str):
            found = Without(chosen, None, Change(model))
        elif model is not None:
            tables, given = (self._curves.of(self.full), self._curves.of(model)), self._curves.given
            found = Without(chosen, model, change_of_curve(*tables, given, self._within, self._laws))
        self._known[chosen] = found
        return found

    def _model(self, chosen: Chosen) -> LesserModel | str | None:
        """Return the model without these things; why they cannot go; None where it has one of them not."""
        found: LesserModel | None = self.full
        try:
            for thing in chosen:
                found = found and thing.away(found)
        except (CannotGo, WrongValues) as problem:
            return str(problem)
        return found


def each_reason_once(singles: Sequence[Without]) -> list[Without]:
    """Without those that cannot go for the reason for which a later one of their group cannot."""
    last = {(each.gone[0].group, each.change.reason): each for each in singles}
    return [each for each in singles if each.model is not None or each in last.values()]


def _most(singles: Sequence[Without]) -> Chosen:
    """Return, of each group of those that may go, the one that takes most away, in the order of the things."""
    return tuple({each.gone[0].group: each.gone[0] for each in singles if each.may_go}.values())


def _sets(options: Sequence[Thing]) -> Iterator[Chosen]:
    """Every set of them but the empty one, of each group at most one."""
    groups: dict[str, list[Thing | None]] = {}
    for thing in options:
        groups.setdefault(thing.group, [None]).append(thing)
    chosen = (tuple(filter(None, picked)) for picked in itertools.product(*groups.values()))
    return filter(None, chosen)
