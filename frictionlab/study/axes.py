"""Axes of a study's grid: along each, one swept value changes or several advance together.

A range of a sweep: its ends, how many values and how they are spaced; the values are built on demand.
"""

from __future__ import annotations

import itertools
import math
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from fractions import Fraction
from typing import Annotated, Any, Literal, Self

from pydantic import Field, model_validator

from frictionlab.laws.base import Finite, Positive, Record
from frictionlab.scene.waveforms import Form
from frictionlab.values.columns import BELT_SPEEDS
from frictionlab.values.notes import number_text

LARGEST_RANGE = 1_000_000


class _Ends(Record):
    """A range.

    start: first value
    stop: last value
    """

    start: Finite
    stop: Finite

    @classmethod
    def called(cls) -> str:
        """Return what messages in Python call it."""
        return "belt_speed"

    @property
    def ends(self) -> tuple[float, float]:
        """Both."""
        return self.start, self.stop

    @model_validator(mode="after")
    def _check_ends(self) -> Self:
        start, stop = map(number_text, (self.start, self.stop))
        if self.stop <= self.start:
            raise ValueError(f"stop: must be > start = {start}, got {stop}")
        if self.start <= 0.0 and getattr(self, "spacing", "") == "log":
            raise ValueError(f"start: must be > 0 for log spacing, got {start}")
        return self


class SweepRange(_Ends):
    """Values from start to stop (> start), evenly spaced or evenly in the logarithm.

    num: number of values, both ends included
    spacing: equal differences (linear) or equal ratios (log)
    """

    num: Annotated[int, Field(strict=True, ge=2, le=LARGEST_RANGE)]
    spacing: Literal["linear", "log"] = "linear"

    def values(self) -> tuple[float, ...]:
        """Every value, in rising order."""
        return self._logarithmic() if self.spacing == "log" else self._linear()

    def resolved(self) -> dict[str, Any]:
        """Return the entry of a study file; linear spacing is left out."""
        return self.model_dump(exclude_defaults=True)

    def _linear(self) -> tuple[float, ...]:
        """Evenly spaced and correctly rounded: {0.1, 1, 10} holds 0.3, not 0.30000000000000004."""
        first, last = Fraction(repr(self.start)), Fraction(repr(self.stop))
        shared = math.lcm(first.denominator, last.denominator)
        low, high = int(first * shared), int(last * shared)
        steps = self.num - 1
        return tuple((low * (steps - k) + high * k) / (shared * steps) for k in range(self.num))

    def _logarithmic(self) -> tuple[float, ...]:
        """Both ends exact."""
        low, high = math.log(self.start), math.log(self.stop)
        inner = (math.exp(low + (high - low) * k / (self.num - 1)) for k in range(1, self.num - 1))
        return (self.start, *inner, self.stop)


ENDS = "start", "stop"
"""Keys of its ends."""
WITHIN = "within"
"""Key of a range out of which belt speeds are chosen as a run goes."""
FINEST_WITHIN = 10.0
"""Tolerances within which straight lines may be asked to be: a point's own error is as large as that."""
MOST_CHOSEN = 100_000
"""Points of a table whose belt speeds are chosen as a run goes."""
FIRST_SPEEDS = 17
"""Belt speeds, evenly spaced, from which others are chosen."""
CLOSEST_SPEEDS = 2.0**-20
"""Share of a range within which no belt speed is chosen beside another: there a jump of friction is left."""


class SpeedRange(_Ends):
    """Belt speeds from start to stop (> start), to be chosen as a run goes.

    within: belt speeds are chosen until straight lines between points are within this of mean_friction
    """

    within: Positive

    def _even(self, num: int) -> tuple[float, ...]:
        return SweepRange.model_construct(start=self.start, stop=self.stop, num=num).values()

    def first(self) -> tuple[float, ...]:
        """Return the belt speeds to begin with."""
        return self._even(FIRST_SPEEDS)

    def about(self) -> tuple[float, ...]:
        """About as many as will be chosen, evenly spaced: mostly where the curve bends at V_lin."""
        return self._even(FIRST_SPEEDS + math.ceil(0.6 / math.sqrt(self.within)))

    def resolved(self) -> dict[str, Any]:
        """Return the entry of a study file."""
        return self.model_dump()


GridValue = float | str | Form
"""Value of a sweep: a number, a word or a waveform."""
LINKED = "linked"
"""Key of a sweep under which lists advance together."""
FRICTION = "friction"
"""Path of a sweep that sets mu or mu_kinetic of every law."""
STATIC = "mu_static"
SCENE = "scene."


@dataclass(frozen=True)
class Axis:
    """Values by path, as many of each, that advance together."""

    values: dict[str, tuple[GridValue, ...]]

    def __len__(self) -> int:
        return len(next(iter(self.values.values())))

    def of(self, owner: str) -> dict[str, tuple[GridValue, ...]]:
        """Return the values of what belongs to ``scene.`` or ``laws.<label>.``, by what comes after that."""
        inside = {path: values for path, values in self.values.items() if owner_of(path) == owner}
        return {path.removeprefix(owner): values for path, values in inside.items()}

    @property
    def is_of_scene(self) -> bool:
        """Check whether it varies the scene, be it together with laws."""
        return any(path.startswith(SCENE) for path in self.values)

    @property
    def is_of_speed(self) -> bool:
        """Check whether belt speed alone varies along it."""
        return len(self.values) == 1 and not self.values.keys().isdisjoint(BELT_SPEEDS)

    def thinned(self) -> Axis:
        """Every second place, and the last."""
        return Axis({path: (*values[:-1:2], values[-1]) for path, values in self.values.items()})


def axes_of(sweep: Mapping[str, tuple[GridValue, ...]], links: Sequence[tuple[str, ...]]) -> tuple[Axis, ...]:
    """Return the axes of sweeps, in their order. links: the paths that advance together, which follow one another."""
    linked = {path: entry for entry in links for path in entry}
    entries = dict.fromkeys(linked.get(path, (path,)) for path in sweep)
    return tuple(Axis({path: sweep[path] for path in entry}) for entry in entries)


def places(axes: Sequence[Axis]) -> Iterator[tuple[int, ...]]:
    """Every combination of places along axes; the last runs fastest."""
    return itertools.product(*(range(len(axis)) for axis in axes))


def point_at(axes: Sequence[Mapping[str, tuple[GridValue, ...]]], at: Sequence[int]) -> dict[str, GridValue]:
    """Return the value of everything at these places along axes."""
    return {
        name: values[place] for axis, place in zip(axes, at, strict=True) for name, values in axis.items()
    }


def grid_points(axes: Sequence[Axis]) -> int:
    """Return how many points a grid of axes has."""
    return math.prod(map(len, axes))


def owner_of(path: str) -> str:
    """Part that a sweep varies: ``scene.`` or ``laws.<label>.`` (a label may contain points); '' for friction."""
    return SCENE if path.startswith(SCENE) else f"{path.rpartition('.')[0]}." if "." in path else ""
