"""What a method finds, with the columns that a table would show of it."""

from __future__ import annotations

from collections.abc import Mapping
from functools import cached_property

import numpy as np

from frictionlab.methods.exact.method import Exact
from frictionlab.methods.shooting.method import Shooting
from frictionlab.motion.orbit.recorder import WEIGHTS
from frictionlab.runner.solve import FROM_METHODS, number_columns
from frictionlab.scene.scene import Scene


def with_columns(method, scenes, law, tolerance):
    """The answers of a method, which refuses none of these scenes, or this one, with ``columns``."""
    scenes = [scenes] if isinstance(scenes, Scene) else scenes
    assert [method.refusal(one, law) for one in scenes] == [None] * len(scenes)
    return Answered(method.solve(scenes, law, tolerance), scenes)


def beside_full_answers(method, scenes, law):
    """How far above the full means a model's are, which is within its errors, and its answers."""
    full = Exact() if not any(Exact().refusals(scenes, law)) else Shooting()
    found, true = with_columns(method, scenes, law, 1e-8), full.solve(scenes, law, 1e-9)
    apart = found.mean.real - true.mean.real
    assert found.status == true.status == ["ok"] * len(scenes)
    assert np.all(np.abs(apart) <= found.error + true.error)
    return apart, found


def moves_as_its_velocity(orbit):
    """Whether positions of an orbit change by the integral of its velocity."""
    half = 0.5 * np.ptp(orbit.tau, axis=1)
    return np.allclose(orbit.x[:, -1] - orbit.x[:, 0], half * (orbit.v @ WEIGHTS), rtol=1e-7, atol=1e-9)


class Answered:
    """Answers and their columns: all of them once one is asked for that must be read from an orbit."""

    def __init__(self, answers, scenes):
        self.answers, self.columns = answers, Columns(answers, scenes)

    def __getattr__(self, name):
        return getattr(self.answers, name)


class Columns(Mapping):
    """The columns by name."""

    own = (
        "mean_friction",
        "mean_friction_transverse",
        "error",
        "period",
        "mean_low",
        "mean_high",
        "window",
        "seconds",
    )

    def __init__(self, answers, scenes):
        self._given = answers, scenes

    @cached_property
    def _few(self):
        return number_columns(*self._given, self.own)

    @cached_property
    def _all(self):
        return number_columns(*self._given, FROM_METHODS)

    def __getitem__(self, name):
        return self._few[name] if name in self.own else self._all[name]

    def __iter__(self):
        return iter(FROM_METHODS)

    def __len__(self):
        return len(FROM_METHODS)
