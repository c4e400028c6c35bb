"""Methods for tests of what stands around methods: quick or slow, refusing, failing and breaking as told."""

from __future__ import annotations

import math
import time
from collections.abc import Callable, Sequence
from pathlib import Path
from typing import Any, ClassVar

import numpy as np
import pytest
from fig_4b import over_speeds

from frictionlab.laws.base import FrictionLaw
from frictionlab.methods.base import Answers, Method
from frictionlab.motion.orbit.record import Orbit
from frictionlab.runner import store
from frictionlab.scene.scene import Scene
from frictionlab.study import registry
from frictionlab.study.registry import BrokenPlugin
from frictionlab.values.quantities import NonNegative

Trouble = Callable[[dict[float, Callable[[], object]]], None]


def breaks_down() -> None:
    """As arithmetic does."""
    raise ZeroDivisionError("float division by zero")


def is_wrong() -> None:
    """As a program does."""
    raise TypeError("no such operand")


def is_broken() -> None:
    """As a plugin does."""
    raise BrokenPlugin("law 'x' does not compile")


class Fake(Method):
    """Mean friction mu tanh(belt speed), with trouble at the belt speeds named in ``troubles``."""

    name: ClassVar[str] = "fake"
    refused_at: ClassVar[frozenset[float]] = frozenset({13.0})
    nothing_at: ClassVar[frozenset[float]] = frozenset({17.0})
    troubles: ClassVar[dict[float, Callable[[], None]]] = {}

    pause: NonNegative = 0.0
    touch: str = ""
    """A file to make when the first chunk is begun."""

    def refusal(self, scene: Scene, law: FrictionLaw) -> str | None:
        return "thirteen, of all numbers" if scene.belt_speed in self.refused_at else None

    def solve(self, scenes: Sequence[Scene], law: FrictionLaw, tolerance: float) -> Answers:
        if self.touch:
            Path(self.touch).touch()
        time.sleep(self.pause)
        speeds = [scene.belt_speed for scene in scenes]
        assert sorted(set(speeds)) == speeds
        for speed in speeds:
            self.troubles.get(speed, lambda: None)()
        mean = np.array([law.sliding_friction(abs(v)) * math.tanh(v) / 3.0 for v in speeds])
        mean[[speed in self.nothing_at for speed in speeds]] = np.nan
        n = len(scenes)
        return Answers(
            status=["ok"] * n,
            reason=[""] * n,
            model=["fake"] * n,
            error_kind=["estimated"] * n,
            mean=mean,
            error=np.full(n, tolerance),
            orbit=lambda i: _orbit(speeds[i]),
        )


class Another(Fake):
    """The same under another name."""

    name: ClassVar[str] = "another"


def register(monkeypatch: pytest.MonkeyPatch, **fakes: type[Method]) -> None:
    """Let studies name these methods, too."""
    known, names = registry.method_class, registry.method_names()
    monkeypatch.setattr(registry, "method_class", lambda name: fakes.get(name) or known(name))
    monkeypatch.setattr(registry, "method_names", lambda: sorted([*names, *fakes]))
    code = registry.method_code
    monkeypatch.setattr(store, "_code_of_method", lambda name: "fake" if name in fakes else code(name))


def faked(belt_speeds: Any, **changes: Any) -> dict[str, Any]:
    """A study of the body of Fig. 4b by the fake, but for the changes."""
    return over_speeds(belt_speeds, **{"methods": ["fake"], **changes})


def _orbit(belt_speed: float) -> Orbit | None:
    """One panel of rest; none at belt speed 0."""
    if belt_speed == 0.0:
        return None
    nodes = np.zeros((1, 10), dtype=complex)
    return Orbit(
        np.linspace(0.0, 2.0 * math.pi, 10)[None, :], nodes, nodes + belt_speed, nodes, np.array([True])
    )
