"""Scene at many belt speeds: a method solves it at all of them at once."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from functools import cached_property
from typing import overload

import numpy as np
from numpy.typing import NDArray

from frictionlab.scene.scene import Scene
from frictionlab.scene.units import Units, measured
from frictionlab.values.quantities import Floats


class Scenes(Sequence[Scene]):
    """Scene along an array of belt speeds; the scene at one of them is made when it is asked for.

    given: the belt speeds in the units in which the scene was given [scene velocity; m/s for a scene in SI
    units].

    >>> from frictionlab import Drive
    >>> scene = Scene(damping_ratio=0.1, normal_load=1, belt_speed=0, drive=Drive(amplitude=1, frequency=2))
    >>> Scenes(scene, np.array([1.0, 2.0]))[1].belt_speed
    2.0
    """

    def __init__(self, scene: Scene, given: Floats) -> None:
        self.scene, self.given = scene, given

    @classmethod
    def of(cls, scenes: Sequence[Scene]) -> Scenes:
        """Make it of these scenes, at least one, which differ in belt speed alone."""
        if isinstance(scenes, Scenes):
            return scenes
        si = [scene.dimensional.belt_speed_m_per_s for scene in scenes if scene.dimensional is not None]
        return cls(scenes[0], np.array(si or [scene.belt_speed for scene in scenes], dtype=np.float64))

    @property
    def belt_speeds(self) -> Floats:
        """Array of belt speeds [scene velocity]."""
        si = self.scene.dimensional
        return self.given if si is None else self.given / si.scales.velocity

    def measured(self, units: Units) -> Scenes:
        """Return the scenes, nondimensional, in other units."""
        nondimensional = self.scene.model_copy(update={"dimensional": None})
        return Scenes(measured(nondimensional, units), self.belt_speeds / units.velocity)

    def __len__(self) -> int:
        return len(self.given)

    @overload
    def __getitem__(self, place: int) -> Scene: ...

    @overload
    def __getitem__(self, place: slice) -> Scenes: ...

    def __getitem__(self, place: int | slice) -> Scene | Scenes:
        if isinstance(place, slice):
            return Scenes(self.scene, self.given[place])
        return self._first if place == 0 else self.scene.at(float(self.given[place]))

    @cached_property
    def _first(self) -> Scene:
        """First scene, for callers that need what all scenes have in common."""
        return self.scene.at(float(self.given[0]))

    def __iter__(self) -> Iterator[Scene]:
        return (self.scene.at(float(speed)) for speed in self.given)

    def taken(self, places: Sequence[int] | NDArray[np.int64]) -> Scenes:
        """Return the scenes at these places."""
        return Scenes(self.scene, self.given[np.asarray(places, dtype=np.int64)])


def belt_speeds_of(scenes: Sequence[Scene]) -> Floats:
    """Return the belt speed of each scene [scene velocity]."""
    return (
        scenes.belt_speeds if isinstance(scenes, Scenes) else np.array([scene.belt_speed for scene in scenes])
    )
