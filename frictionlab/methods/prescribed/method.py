"""Mean friction under a prescribed slip velocity.

Friction by axis under a prescribed slip in the plane: each axis slips along one line, whatever the other does.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from typing import Any

import numpy as np

from frictionlab.laws.base import FrictionLaw
from frictionlab.methods.base import PROVED, TESTED, Answers, Ledger, Status
from frictionlab.methods.prescribed.bristle import BristlePoint
from frictionlab.methods.prescribed.loop import PrescribedMean
from frictionlab.methods.prescribed.memory import MemoryPoint
from frictionlab.methods.prescribed.varying_slip import VaryingPoint, VaryingSlip
from frictionlab.methods.under_way import each_told
from frictionlab.methods.words import ModelWord
from frictionlab.motion.orbit.record import End, Orbit
from frictionlab.motion.orbit.recorder import NODES, interpolation_weights
from frictionlab.scene.scene import Scene, Slip
from frictionlab.values.quantities import Floats


class AxesPoint:
    """One scene of such a slip, a law by axis, and the answer; solve: answers a scene of slip along the belt."""

    def __init__(self, scene: Scene, solve: Callable[[Scene], Any]) -> None:
        self.along, self.across = (solve(each) for each in _axes(scene))
        self.scene = scene
        first, second = self.along.found, self.across.found
        self.status: Status = self.along.status
        self.reason, self.model = self.along.reason, self.along.model
        self.error_kind, self.seconds = self.along.error_kind, self.along.seconds + self.across.seconds
        known = second.mean.real if self.across.status == "ok" else math.nan
        self.found = PrescribedMean(complex(first.mean.real, known), first.error, first.low, first.high)

    def orbit(self) -> Orbit | None:
        """Prescribed motion and the friction along it; NaN across the belt where the mean there is open."""
        one, other = self.along.orbit(), self.across.orbit()
        if one is None:
            return None
        slip = VaryingSlip.of(self.scene.signals(), self.scene.motion().normal_load)
        if other is None:
            return slip.orbit(one.tau, one.friction.real + complex(0.0, math.nan))
        end = one.tau[-1, -1]
        edges = np.unique(np.concatenate([one.tau[:, 0], other.tau[:, 0]]))
        edges = edges[np.diff(edges, append=end) > 1e-12 * end]
        half = 0.5 * np.diff(edges, append=end)[:, None]
        tau: Floats = edges[:, None] + half * (1.0 + NODES)
        return slip.orbit(tau, _friction_on(one, tau) + 1j * _friction_on(other, tau))


def _axes(scene: Scene) -> tuple[Scene, Scene]:
    """Return the slip along the belt alone, and that across as one along a belt at rest."""
    slip, across = scene.slip, scene.transverse_slip
    still = Slip(velocity_amplitude=0.0, frequency=scene.frequency)
    first, second = slip or still, still
    if across is not None:
        own = across.model_dump(exclude={"frequency"}, exclude_none=True)
        second = Slip(frequency=scene.frequency, **own)
    elif slip is not None and slip.direction is not None:
        turn = math.radians(slip.direction)
        first, second = _directed(slip, math.cos(turn)), _directed(slip, math.sin(turn))
    changes = {"slip": first, "transverse_slip": None}
    return scene.model_copy(update=changes), scene.model_copy(
        update={**changes, "slip": second, "belt_speed": 0.0}
    )


def _directed(slip: Slip, share: float) -> Slip:
    """A share of a slip, along the belt."""
    size, direction = slip.velocity_amplitude * abs(share), 180.0 if share < 0.0 else 0.0
    return slip.model_copy(update={"velocity_amplitude": size, "direction": direction})


def _friction_on(orbit: Orbit, tau: Floats) -> Floats:
    """Its friction along x1 on panels, each inside one of the orbit's."""
    inside = np.searchsorted(orbit.tau[:, 0], 0.5 * (tau[:, 0] + tau[:, -1]), side="right") - 1
    start, end = orbit.tau[inside, :1], orbit.tau[inside, -1:]
    weights = interpolation_weights(((2.0 * tau - start - end) / (end - start)).ravel())
    weights = weights.reshape(*tau.shape, len(NODES))
    return np.asarray((weights * orbit.friction.real[inside, None, :]).sum(axis=2))


Point = VaryingPoint | BristlePoint | AxesPoint | MemoryPoint

POINTS: dict[str, Callable[[Scene, Any, float], Point]] = {
    "none": lambda scene, law, _tolerance: VaryingPoint(scene, law),
    "bristle": lambda scene, law, tolerance: _bristle_point(scene, law, tolerance),
    "deflections": MemoryPoint,
    "scalars": MemoryPoint,
}
"""Solvers of a scene of prescribed slip, by what the law remembers."""


def _bristle_point(scene: Scene, law: Any, tolerance: float) -> Point:
    line = scene.load_along_belt_only
    if not line and law.planar_form() == "per-axis":
        return AxesPoint(scene, lambda axis: _bristle_point(axis, law, tolerance))
    if line and law.exact_path() and scene.is_harmonic:
        return BristlePoint(scene, law)
    # in a contact that keeps its stiffness, deflections change with the normal load, too
    if line and law.exact_path() and not scene.constant_contact:
        slip = VaryingSlip.of(scene.signals(), scene.motion().normal_load)
        if slip.keeps_its_side(scene.belt_speed):
            slides = VaryingPoint(scene, law, slip)
            slides.model = ModelWord.SLIP_ONE_WAY
            return slides
    return MemoryPoint(scene, law, tolerance)


def _point(scene: Scene, law: FrictionLaw, tolerance: float) -> Point:
    return POINTS[law.memory_kind](scene, law, tolerance)


def _told_uniqueness(row: Point) -> str:
    """Tell how it is known that no memory at the start of an ok point leads elsewhere, in its model or reason.

    Of bristles nothing is asked: the deflection that repeats is looked for as if there were one.
    """
    if row.status != "ok" or isinstance(row, BristlePoint | AxesPoint):
        return ""
    if isinstance(row, MemoryPoint):
        row.reason = f"{row.reason}; {row.tested}" if row.reason else row.tested
        return TESTED
    row.model = f"{row.model}; {ModelWord.BY_SLIP}"
    return PROVED


def _ends(row: Point) -> list[End]:
    """Return where starts end whose memory keeps what it began with."""
    return row.ends() if isinstance(row, MemoryPoint) else []


def solve_prescribed(scenes: Sequence[Scene], law: FrictionLaw, tolerance: float) -> Answers:
    """Answer scenes of prescribed slip that differ in belt speed alone."""
    rows, ledger = [_point(scene, law, tolerance) for scene in each_told(scenes)], Ledger(len(scenes))
    for i, row in enumerate(rows):
        found = row.found
        if row.status == "ok":
            unique = _told_uniqueness(row)
            ledger.accept(i, found.mean, found.error, float(scenes[0].periods), row.error_kind)
            ledger.model[i], ledger.reason[i], ledger.unique[i] = row.model, row.reason, unique
            if found.error > tolerance:
                ledger.remark(i, f"error {found.error:.1e} above the tolerance: only rounding errors remain")
        elif row.status == "failed":
            ledger.fail(i, row.reason)
        else:
            ledger.leave_open(i, row.reason, found.low, found.high, 1.0)
            ledger.model[i] = row.model
        ledger.seconds[i] = row.seconds
    return ledger.answers(orbit=lambda i: rows[i].orbit(), ends=lambda i: _ends(rows[i]))
