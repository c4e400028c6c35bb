"""The axes of a study's grid: along each, one swept value changes or several advance together."""

from __future__ import annotations

import itertools
import math
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass

from frictionlab.columns import BELT_SPEEDS
from frictionlab.scene.waveforms import Form

GridValue = float | str | Form
"""What a sweep runs over: numbers, words or waveforms."""
LINKED = "linked"
"""The key of a sweep under which lists advance together."""
FRICTION = "friction"
"""The path of a sweep that sets mu or mu_kinetic of every law."""
STATIC = "mu_static"
SCENE = "scene."


@dataclass(frozen=True)
class Axis:
    """Values by path, as many of each, that advance together."""

    values: dict[str, tuple[GridValue, ...]]

    def __len__(self) -> int:
        return len(next(iter(self.values.values())))

    def of(self, owner: str) -> dict[str, tuple[GridValue, ...]]:
        """Of what belongs to ``scene.`` or ``laws.<label>.``, the values by what comes after that."""
        inside = {path: values for path, values in self.values.items() if owner_of(path) == owner}
        return {path.removeprefix(owner): values for path, values in inside.items()}

    @property
    def is_of_scene(self) -> bool:
        """Whether it varies the scene, be it together with laws."""
        return any(path.startswith(SCENE) for path in self.values)

    @property
    def is_of_speed(self) -> bool:
        """Whether belt speed alone varies along it."""
        return len(self.values) == 1 and not self.values.keys().isdisjoint(BELT_SPEEDS)

    def thinned(self) -> Axis:
        """Every second place, and the last."""
        return Axis({path: (*values[:-1:2], values[-1]) for path, values in self.values.items()})


def axes_of(sweep: Mapping[str, tuple[GridValue, ...]], links: Sequence[tuple[str, ...]]) -> tuple[Axis, ...]:
    """The axes of sweeps, in their order. links: the paths that advance together, which follow one another."""
    linked = {path: entry for entry in links for path in entry}
    entries = dict.fromkeys(linked.get(path, (path,)) for path in sweep)
    return tuple(Axis({path: sweep[path] for path in entry}) for entry in entries)


def places(axes: Sequence[Axis]) -> Iterator[tuple[int, ...]]:
    """Every combination of places along axes; the last runs fastest."""
    return itertools.product(*(range(len(axis)) for axis in axes))


def point_at(axes: Sequence[Mapping[str, tuple[GridValue, ...]]], at: Sequence[int]) -> dict[str, GridValue]:
    """The value of everything at these places along axes."""
    return {
        name: values[place] for axis, place in zip(axes, at, strict=True) for name, values in axis.items()
    }


def grid_points(axes: Sequence[Axis]) -> int:
    """How many points a grid of axes has."""
    return math.prod(map(len, axes))


def owner_of(path: str) -> str:
    """The part that a sweep varies: ``scene.`` or ``laws.<label>.`` (a label may contain points); '' for friction."""
    return SCENE if path.startswith(SCENE) else f"{path.rpartition('.')[0]}." if "." in path else ""
