"""Numbers that a fit may change: of a law and of its scene, each within its range, on an even or a log scale."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any

from frictionlab.analysis.quotients import with_numbers
from frictionlab.laws.base import FrictionLaw
from frictionlab.runner.table import cells
from frictionlab.scene.dimensional import unit_of
from frictionlab.scene.scene import Scene
from frictionlab.study.keys import StudyKeys, range_in_numbers
from frictionlab.study.study import kind_of
from frictionlab.study.written import units_of_law
from frictionlab.values.notes import closest
from frictionlab.values.quantities import Floats
from frictionlab.values.validation import checked_value

LOG_ABOVE = 100.0
"""Ratio of the ends of a positive range above which it is searched by its logarithm."""


@dataclass(frozen=True)
class FreeNumber:
    """One: its name, its range, whether it is searched by its logarithm."""

    name: str
    low: float
    high: float
    by_log: bool

    def value(self, share: float) -> float:
        """At this share of the range."""
        if self.by_log:
            return float(math.exp((1.0 - share) * math.log(self.low) + share * math.log(self.high)))
        return float(self.low + share * (self.high - self.low))

    def share(self, value: float) -> float:
        """Return the share of the range at which a value is."""
        if self.by_log:
            return math.log(value / self.low) / math.log(self.high / self.low)
        return (value - self.low) / (self.high - self.low)

    def slope(self, value: float) -> float:
        """d(value)/d(share)."""
        return value * math.log(self.high / self.low) if self.by_log else self.high - self.low


@dataclass(frozen=True)
class Model:
    """A law and a scene (None for a path of slip) with some free numbers."""

    law: FrictionLaw
    scene: Scene | None
    free: tuple[FreeNumber, ...]

    def unit(self, name: str) -> str:
        """Return the unit of a free number in SI; '' where it has none or the scene is nondimensional."""
        if self.scene is None or self.scene.dimensional is None:
            return ""
        key = name.rpartition(".")[2].partition("[")[0]
        return unit_of(key) or "" if name.startswith("scene.") else units_of_law(type(self.law)).get(key, "")

    @property
    def label(self) -> str:
        """Return what tables call the law."""
        return self.law.label or type(self.law).__name__

    @property
    def words(self) -> str:
        """Return what sentences and figures call it."""
        own = self.law.label not in ("", kind_of(self.law))
        return self.label if own else type(self.law).in_words or self.label

    def values(self, shares: Floats) -> dict[str, float]:
        """Return the free numbers at these shares of their ranges."""
        return {each.name: each.value(float(share)) for each, share in zip(self.free, shares, strict=True)}

    def at(self, shares: Floats) -> tuple[FrictionLaw, Scene | None]:
        """Return the law and the scene at these shares. Raises ValueError where they are none."""
        values = self.values(shares)
        of_scene = {name.removeprefix("scene."): x for name, x in values.items() if name.startswith("scene.")}
        of_law = {name: x for name, x in values.items() if not name.startswith("scene.")}
        scene = self.scene.with_(**of_scene) if self.scene and of_scene else self.scene
        return with_numbers(self.law, of_law), scene


def free_numbers(
    given: Mapping[str, Any], laws: Sequence[FrictionLaw], scene: Scene | None
) -> dict[int, tuple[FreeNumber, ...]]:
    """Return the free numbers of each law, by its place. Raises ValueError for a name that nothing has."""
    if not isinstance(given, Mapping) or not given:
        raise ValueError(f"free must be a mapping such as {{'mu': (0.1, 1.0)}}, got {given!r}")
    of_scene = {} if scene is None else _numbers_of(scene.given_values(), "scene.")
    known = [_numbers_of(dict(law), "") for law in laws]
    for name in given:
        if name not in of_scene and not any(name in law for law in known):
            every = [*of_scene, *(each for law in known for each in law)]
            hint = closest(name, every)
            raise ValueError(
                f"free: no number '{name}' of the laws or the scene{f'; did you mean {hint!r}?' if hint else ''}"
            )
    in_si = scene is not None and scene.dimensional is not None
    ranges = {name: _range(name, value, [type(law) for law in laws], in_si) for name, value in given.items()}
    return {
        place: tuple(each for name, each in ranges.items() if name in of_scene or name in law)
        for place, law in enumerate(known)
    }


def _numbers_of(values: Mapping[str, Any], before: str) -> dict[str, Any]:
    """Return numbers, and what may be one, by name."""
    kinds = float | int | None
    return {
        f"{before}{name}": value
        for name, value in cells(values).items()
        if isinstance(value, kinds) and not isinstance(value, bool)
    }


def _range(name: str, given: Any, laws: Sequence[type[FrictionLaw]], in_si: bool) -> FreeNumber:
    """Raises ValueError with the first mistake in a range."""
    read, what, _ = checked_value(StudyKeys, "free", {name: given})
    found, what = (None, what) if what is not None else range_in_numbers(name, read[name], laws, in_si)
    if found is None:
        raise ValueError(f"free.{name}: {what}")
    low, high, spacing = float(found.low), float(found.high), found.spacing
    far = low > 0.0 and high / low >= LOG_ABOVE
    return FreeNumber(name, low, high, spacing == "log" or (spacing is None and far))
