"""The numbers of a scene and of a law by dotted path, and both with one of them changed."""

from __future__ import annotations

import re
from typing import Any, NamedTuple

from frictionlab.laws.base import FrictionLaw
from frictionlab.mistakes.notes import did_you_mean
from frictionlab.quantities import given_values
from frictionlab.scene.scene import Scene

_RATIO = "frequency_ratio"
"""A ratio of periods: no motion beside it has the same period."""


class Pair(NamedTuple):
    """A scene and a law as they were given."""

    scene: Scene
    law: FrictionLaw

    def numbers(self) -> dict[str, float]:
        """``scene.<path>`` and ``law.<name>`` of every number that may be changed a little."""
        told = {f"scene.{path}": value for path, value in self.scene.given_values().items()}
        left_out = {name: value for name, value in self.law if name not in self.law.model_fields_set}
        told |= {f"law.{name}": value for name, value in _cells(given_values(self.law) | left_out)}
        return {
            path: float(value)
            for path, value in told.items()
            if isinstance(value, float) and not path.endswith(_RATIO) and ".initial." not in path
        }

    def later(self, degrees: float) -> Pair:
        """The same loads seen from an instant at which the angle of the drive is so much larger."""
        told = self.scene.given_values()
        phases = {path: float(told[path]) for path in told if path.endswith(".phase")}
        turned = {
            path: phase + degrees * float(told.get(path.removesuffix("phase") + _RATIO, 1.0))
            for path, phase in phases.items()
        }
        return self._replace(scene=self.scene.with_(**turned)) if degrees else self

    def with_(self, path: str, value: float) -> Pair:
        """Both with this number in place of theirs. Raises ValueError where it makes no scene or law."""
        owner, _, name = path.partition(".")
        if owner == "scene":
            return self._replace(scene=self.scene.with_(**{name: value}))
        changed: Any = value
        if place := re.fullmatch(r"(.+)\[(\d+)\]", name):
            name, several = place[1], list(getattr(self.law, place[1]))
            several[int(place[2])] = value
            changed = tuple(several)
        return self._replace(law=type(self.law)(**(given_values(self.law) | {name: changed})))


def asked_for(numbers: dict[str, float], paths: Any) -> list[str]:
    """The paths asked for, all where none are. Raises ValueError, TypeError."""
    if paths is None:
        return list(numbers)
    if isinstance(paths, str) or not all(isinstance(path, str) for path in paths):
        raise TypeError(f"parameters must be a list such as ['law.mu', 'scene.damping_ratio'], got {paths!r}")
    for path in paths:
        if path not in numbers:
            hint = did_you_mean(path, [*numbers])
            raise ValueError(
                f"parameters: no number '{path}' of this scene or law{f'; {hint}' if hint else ''}"
            )
    return list(dict.fromkeys(paths))


def _cells(values: dict[str, Any]) -> list[tuple[str, Any]]:
    """Values by name, several numbers as ``name[0]``, ``name[1]``."""
    cells: list[tuple[str, Any]] = []
    for name, value in values.items():
        if isinstance(value, tuple):
            cells += [(f"{name}[{k}]", each) for k, each in enumerate(value)]
        else:
            cells.append((name, value))
    return cells
