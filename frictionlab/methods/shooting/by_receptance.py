"""The steady states of a body known by its receptance alone, from the fastest belt to the slowest."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from frictionlab.laws.base import FrictionLaw
from frictionlab.methods.base import PROVED, Answers, Status, beyond_balance
from frictionlab.methods.periodic.map_kinds import MAP_KINDS, map_kind
from frictionlab.methods.shooting.pseudo_force import BalancedMotion, Balancing, MassUnderForce
from frictionlab.methods.under_way import each_told
from frictionlab.methods.words import ModelWord
from frictionlab.orbit.record import Orbit
from frictionlab.scene.parts import BY_TABLE
from frictionlab.scene.receptance import LinearBody, linear_body
from frictionlab.scene.receptance_table import TabulatedBody
from frictionlab.scene.scene import Scene
from frictionlab.scene.scenes import belt_speeds_of

FEWEST_BALANCED, MOST_BALANCED = 16, 512
"""Harmonics of the force on the mass."""
BY_CHANCE = 0.02
"""Of the change of friction over a period: it stands in where the means of two motions agree by chance."""
UNBALANCED = "no motion found whose harmonics obey the receptance"
HALF_UNBALANCED = "no error known: every other row of the table gives no motion"
FALLS = (
    "on a body by its receptance shooting needs friction that does not fall with speed: of a motion that balances "
    "nothing else tells whether it is stable"
)
RESTS = (
    "on a belt at rest the mean may depend on the start, and on a body by its receptance no motion is followed from "
    "one: give a belt speed"
)


QUICK = (
    "the body swings by itself up to harmonic {:.0f} of what repeats, and on a body by its receptance shooting "
    "balances {} at most"
)


def by_receptance(scene: Scene, _law: FrictionLaw) -> bool:
    """Whether that is all that is known of the body."""
    return BY_TABLE in scene.body_terms


def receptance_refusal(scene: Scene, law: FrictionLaw) -> str | None:
    """Why no motion of such a body is sought, or trusted."""
    if reason := beyond_balance("shooting", scene):
        return reason
    if (
        harmonics := linear_body(scene).fastest * scene.signals().period / (2.0 * math.pi)
    ) > MOST_BALANCED // 2:
        return QUICK.format(harmonics, MOST_BALANCED // 2)
    if scene.belt_speed == 0.0:
        return RESTS
    return FALLS if law.steepest_fall() > 0.0 else None


def solve_by_receptance(scenes: Sequence[Scene], law: FrictionLaw, tolerance: float) -> Answers:
    """Answer scenes that differ in belt speed alone."""
    return BalancedCurve(scenes, law, tolerance, linear_body(scenes[0])).answers()


class BalancedCurve:
    """The scenes of one curve on their way to answers."""

    def __init__(self, scenes: Sequence[Scene], law: FrictionLaw, tolerance: float, body: LinearBody) -> None:
        self.scene, self.law, self.tolerance = scenes[0], law, tolerance
        self.belt_speeds = belt_speeds_of(scenes)
        self.mass = MassUnderForce(self.scene, law, body, tolerance)
        self.halved: MassUnderForce | None = None
        if isinstance(body, TabulatedBody):
            self.halved = MassUnderForce(self.scene, law, body.halved(), tolerance)
        self.fewest = max(FEWEST_BALANCED, math.ceil(body.fastest / self.mass.frequency))
        n = len(scenes)
        self.motions: list[BalancedMotion | None] = [None] * n
        self.status: list[Status] = ["ok"] * n
        self.reason = [""] * n
        self.mean, self.error, self.seconds = np.full((3, n), np.nan)
        known: BalancedMotion | None = None
        for i in each_told(np.lexsort((-np.abs(self.belt_speeds), self.belt_speeds < 0.0)).tolist()):
            if known is not None and self.belt_speeds[i] * known.belt_speed < 0.0:
                known = None
            known = self._solve(i, known) or known

    def _solve(self, i: int, known: BalancedMotion | None) -> BalancedMotion | None:
        """The motion of one scene, from a neighbour's."""
        speed = float(self.belt_speeds[i])
        before = self.mass.seconds + (self.halved.seconds if self.halved else 0.0)
        found = self._refined(speed, known) or (self._refined(speed, None) if known is not None else None)
        if found is None:
            self.status[i], self.reason[i] = "failed", UNBALANCED
        else:
            fine, cut = found
            self.motions[i], self.mean[i] = fine, fine.motion.mean
            self.error[i] = fine.motion.error + 2.0 * (fine.left + cut) + self._misfit(i, fine)
            if self.error[i] > self.tolerance:
                why = "the table is too coarse for less" if self.halved else "more harmonics are not balanced"
                self.reason[i] = f"error {self.error[i]:.1e} above the tolerance: {why}"
        self.seconds[i] = self.mass.seconds + (self.halved.seconds if self.halved else 0.0) - before
        return self.motions[i]

    def _refined(self, speed: float, known: BalancedMotion | None) -> tuple[BalancedMotion, float] | None:
        """The motion with as many harmonics as the tolerance asks for, and what it is from that with half as many."""
        count = self.fewest if known is None else max(self.fewest, known.harmonics // 2)
        found = Balancing(self.mass, speed, count).found(known)
        while found is not None:
            finer = Balancing(self.mass, speed, 2 * count).found(found)
            if finer is None:
                return None
            cut, count = _apart(found, finer), 2 * count
            if 3.0 * cut <= self.tolerance or 2 * count > MOST_BALANCED:
                return finer, cut
            found = finer
        return None

    def _misfit(self, i: int, fine: BalancedMotion) -> float:
        """How far the mean is from that of every other row of the table; NaN where that has none."""
        if self.halved is None:
            return 0.0
        other = Balancing(self.halved, fine.belt_speed, fine.harmonics).found(fine)
        if other is not None:
            return _apart(fine, other)
        self.status[i], self.reason[i], self.mean[i], self.motions[i] = (
            "failed",
            HALF_UNBALANCED,
            np.nan,
            None,
        )
        return math.nan

    def answers(self) -> Answers:
        """What was found."""
        ok = np.array([status == "ok" for status in self.status])
        kind = map_kind(self.law, False) if not self.scene.constant_contact else self.law.memory_kind
        words = [ModelWord.SHOOTING_LINE, MAP_KINDS[kind].said, ModelWord.PSEUDO_FORCE]
        proved = self.mass.contracts
        words += [ModelWord.PASSIVE] if proved else []
        model = "; ".join(filter(None, words))
        return Answers(
            status=self.status,
            reason=self.reason,
            model=[model if each else "" for each in ok],
            error_kind=["estimated" if each else "" for each in ok],
            mean=self.mean,
            error=self.error,
            period=np.where(ok, float(self.scene.periods), np.nan),
            unique=[PROVED if proved and each else "" for each in ok],
            seconds=self.seconds,
            orbit=self._orbit,
        )

    def _orbit(self, i: int) -> Orbit | None:
        """As it was recorded, about where the body's own spring holds it."""
        found = self.motions[i]
        if found is None:
            return None
        held = float(self.mass.body.receptance(np.zeros(1))[0].real) - 1.0 / self.mass.spring
        orbit = found.motion.orbit
        return replace(orbit, x=orbit.x + self.mass.normal_load * self.mean[i] * held)


def _apart(one: BalancedMotion, other: BalancedMotion) -> float:
    """How far two mean frictions are apart; or a share of how far their lower harmonics are, where that is more."""
    n = min(one.harmonics, other.harmonics)
    changed = np.linalg.norm(one.motion.friction[:n] - other.motion.friction[:n]) / math.sqrt(2.0)
    return max(abs(one.motion.mean - other.motion.mean), BY_CHANCE * float(changed))
