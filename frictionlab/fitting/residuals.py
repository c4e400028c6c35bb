"""What a model says at the points of measurements, and how far that is from what was measured."""

from __future__ import annotations

import math
from collections.abc import Iterable
from dataclasses import dataclass, field
from typing import Any

import numpy as np

from frictionlab.faults import CannotCompile
from frictionlab.fitting.along_path import friction_along
from frictionlab.fitting.free import Model
from frictionlab.fitting.measured import Measurements
from frictionlab.quantities import Floats
from frictionlab.runner.steady_state import steady_states
from frictionlab.scene.scenes import Scenes

FIT_TOLERANCE = 1e-9
"""Asked of mean friction: far below what measurements tell, and below what difference quotients see."""
SLOPE_STEP = 1e-5
"""Share of a range by which a number is changed for a derivative."""
UNANSWERED_AS = 10.0
"""A point without a number counts as so many spreads of what was measured."""


@dataclass(eq=False)
class Residuals:
    """Of a model against measurements; counts how often the model was asked. error: that of its numbers, largest."""

    model: Model
    measured: Measurements
    evaluations: int = 0
    error: float = 0.0
    unanswered: int = 0
    _known: dict[bytes, Floats] = field(default_factory=dict, repr=False)

    def __post_init__(self) -> None:
        values = self.measured.values
        self.spread = float(np.std(values)) or float(np.abs(values).max()) or 1.0
        self.weights = np.ones(len(values)) if self.measured.sigma is None else 1.0 / self.measured.sigma

    def said(self, shares: Floats) -> Floats:
        """What the model says, row by row; NaN where it has no number."""
        key = np.asarray(shares, dtype=float).tobytes()
        if key not in self._known:
            if len(self._known) > 200:
                self._known.clear()
            self.evaluations += 1
            try:
                law, scene = self.model.at(shares)
                found = self._path(law) if self.measured.is_path else self._curve(law, scene)
            except CannotCompile:
                raise
            except (ValueError, ArithmeticError):  # numbers that make no law
                found = np.full(len(self.measured.values), math.nan)
            self._known[key] = found
        return self._known[key]

    def raw(self, shares: Floats) -> Floats:
        """Said less measured; ``UNANSWERED_AS`` spreads where nothing is said."""
        apart = self.said(shares) - self.measured.values
        self.unanswered = int(np.isnan(apart).sum())
        return np.where(np.isnan(apart), UNANSWERED_AS * self.spread, apart)

    def __call__(self, shares: Floats) -> Floats:
        """The same over the stated standard errors, where there are some."""
        return self.raw(shares) * self.weights

    def slopes(self, shares: Floats, numbers: Iterable[int] | None = None) -> Floats:
        """d(residual)/d(share), a column for each of these numbers, all where left out: differences inwards."""
        here, columns = self(shares), []
        for k in range(len(shares)) if numbers is None else numbers:
            there = np.array(shares, dtype=float)
            there[k] += SLOPE_STEP if there[k] < 0.5 else -SLOPE_STEP
            columns.append((self(there) - here) / (there[k] - shares[k]))
        return np.column_stack(columns)

    def _path(self, law: Any) -> Floats:
        table, found = self.measured.table, np.empty(len(self.measured.values))
        times, slips = (table[name].to_numpy(dtype=float) for name in ("time", "slip"))
        for piece in self.measured.pieces:
            found[piece] = friction_along(
                law, times[piece], slips[piece], float(self.measured.values[piece][0])
            )
        return found

    def _curve(self, law: Any, scene: Any) -> Floats:
        measured, found = self.measured, np.full(len(self.measured.values), math.nan)
        given = measured.table[measured.along].to_numpy(dtype=float)
        for changed, places in measured.groups:
            different, back = np.unique(given[places], return_inverse=True)
            here = Scenes(scene.with_(**changed) if changed else scene, different)
            numbers = steady_states(here, law, FIT_TOLERANCE, ["mean_friction"]).numbers
            found[places] = numbers["mean_friction"][back]
            self.error = max(self.error, float(np.nan_to_num(numbers["error"]).max()))
        return found
