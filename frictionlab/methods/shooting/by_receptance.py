"""The steady states of a body known by its receptance alone, from the fastest belt to the slowest.

Whether motions leave a periodic one of a bristle on a body known by its receptance: Nyquist's criterion.

A small change u(t) exp(i nu t) of the slip velocity, u with the period of the motion, changes the deflection by zeta,
zeta' + i nu zeta = r_v u + r_z zeta, and friction by F_v u + F_z zeta, with derivatives of the law along the motion:
harmonic by harmonic a matrix Phi(nu). With the mobility Y = p H of the body at p = i (nu + k Omega) it goes on by
itself where det(1 + N Y Phi) = 0, and p goes once through all of them while nu passes Omega. Along that way the
determinant turns round zero, backwards, as often as changes grow.

Source: of harmonic transfer functions Wereley & Hall, Proceedings of the 29th IEEE CDC (1990), 3650-3655.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from frictionlab.laws.base import FrictionLaw
from frictionlab.laws.memory import BristleLaw, bristle_on_the_line
from frictionlab.methods.base import NOT_UNIQUE, PROVED, Answers, Status, beyond_balance
from frictionlab.methods.periodic.period_map import MAP_KINDS, map_kind
from frictionlab.methods.shooting.pseudo_force import ROUGH_MEAN, BalancedMotion, Balancing, MassUnderForce
from frictionlab.methods.under_way import each_told
from frictionlab.methods.words import ModelWord
from frictionlab.motion.orbit.memory import Contact, deflections
from frictionlab.motion.orbit.record import Orbit
from frictionlab.scene.parts import BY_TABLE
from frictionlab.scene.receptance import ComplexValues, LinearBody, TabulatedBody, linear_body
from frictionlab.scene.scene import Scene
from frictionlab.scene.scenes import belt_speeds_of
from frictionlab.scene.signals import Signal
from frictionlab.values.quantities import Floats

SMALL_OFFSET = 1e-6
"""Offset of difference quotients, of the largest slip and of the presliding length."""
FIRST_TURNS, SHARPEST_TURN, TURN_HALVINGS = 33, 0.7, 10
"""Frequencies looked at first, and the turn [rad] from one to the next from which on more are between them."""
AT_ONCE = 8
"""Frequencies, for memory."""
AT_ONCE_IN_PRODUCTS = 60_000
"""Products of numbers: for so few OpenBLAS takes one thread."""

_Along = NDArray[np.float64]


def growing_changes(
    law: BristleLaw, body: LinearBody, normal_load: float, orbit: Orbit, slip: Floats, most: int
) -> float:
    """How many changes grow, nearly a whole number; NaN where friction does not tell the deflection.

    slip: at the nodes of the orbit. most: harmonics -most ... most are coupled.
    """
    tau = orbit.tau.ravel()
    period = float(tau[-1] - tau[0])
    omega = 2.0 * np.pi / period
    along = _derivatives(law, slip, orbit.friction.real)
    if not np.isfinite(along).all():
        return float("nan")
    orders = np.arange(-most, most + 1)
    waves = np.exp(1j * omega * np.outer(tau, orders))

    def turn(nu: Floats) -> ComplexValues:
        """The determinant over its size."""
        friction = _friction_of_changes(tau, along, waves, nu)
        frequency = nu[:, None] + omega * orders
        reply = body.receptance(np.abs(frequency).ravel()).reshape(frequency.shape)
        mobility = 1j * frequency * np.where(frequency < 0.0, reply.conj(), reply)
        matrix = np.eye(len(orders)) + normal_load * mobility[:, :, None] * friction
        return np.asarray(np.linalg.slogdet(matrix)[0])

    return -_turned(turn, 0.5 * omega) / np.pi


def _turned(turn: Callable[[Floats], ComplexValues], end: float) -> float:
    """The angle through which it turns from 0 to the end."""
    nu = np.linspace(0.0, end, FIRST_TURNS)
    found = turn(nu)
    for _ in range(TURN_HALVINGS):
        wide = np.flatnonzero(np.abs(np.angle(found[1:] / found[:-1])) > SHARPEST_TURN)
        if not len(wide):
            break
        between = 0.5 * (nu[wide] + nu[wide + 1])
        nu, found = np.concatenate([nu, between]), np.concatenate([found, turn(between)])
        order = np.argsort(nu)
        nu, found = nu[order], found[order]
    return float(np.angle(found[1:] / found[:-1]).sum())


def _derivatives(law: BristleLaw, slip: Floats, friction: Floats) -> _Along:
    """Of the rate of the deflection by slip and by it, and of friction by both [4, nodes], along an orbit."""
    moved, rubbed = slip.astype(np.complex128), friction.astype(np.complex128)
    contact = Contact(moved, rubbed, np.ones(slip.shape), True, False)
    z = deflections(law, contact).real
    by_slip, by_depth = SMALL_OFFSET * float(np.abs(slip).max()), SMALL_OFFSET * law.presliding()
    found = np.empty((4, slip.size))
    for i, (v, depth) in enumerate(zip(slip.ravel().tolist(), z.ravel().tolist(), strict=True)):
        # a quotient does not reach over the reversal of slip
        h = min(by_slip, 0.5 * abs(v)) or by_slip
        ahead, behind = bristle_on_the_line(law, v + h, depth), bristle_on_the_line(law, v - h, depth)
        up, down = (bristle_on_the_line(law, v, depth + each) for each in (by_depth, -by_depth))
        found[0, i], found[2, i] = ((a - b) / (2.0 * h) for a, b in zip(ahead, behind, strict=True))
        found[1, i], found[3, i] = ((a - b) / (2.0 * by_depth) for a, b in zip(up, down, strict=True))
    return found


def _friction_of_changes(tau: Floats, along: _Along, waves: ComplexValues, nu: Floats) -> Any:
    """Phi [nu, harmonics of friction, harmonics of slip]: exponential steps between nodes, twice linear in time."""
    rate_v, rate_z, friction_v, friction_z = along
    step = np.diff(tau)
    weights = np.zeros(len(tau))
    weights[:-1] += 0.5 * step
    weights[1:] += 0.5 * step
    to_harmonics = (weights[:, None] * waves.conj()).T / (tau[-1] - tau[0])
    pushed = rate_v[:, None] * waves
    pushed = 0.5 * (pushed[1:] + pushed[:-1])
    decay = 0.5 * (rate_z[1:] + rate_z[:-1])
    direct = _product(to_harmonics * friction_v, waves)
    found = []
    for some in np.array_split(nu, 1 + len(nu) // AT_ONCE):
        exponent = step * (decay - 1j * some[:, None])
        kept = np.exp(exponent)
        near = np.abs(exponent) < SMALL_OFFSET
        gained = step * np.where(near, 1.0, np.expm1(exponent) / np.where(near, 1.0, exponent))
        change = np.zeros((len(some), len(tau), waves.shape[1]), np.complex128)
        for m in range(len(step)):
            change[:, m + 1] = kept[:, m, None] * change[:, m] + gained[:, m, None] * pushed[m]
        left = np.cumprod(np.hstack([np.ones((len(some), 1)), kept]), axis=1)
        change += left[:, :, None] * (change[:, -1] / (1.0 - left[:, -1:]))[:, None]
        found.append(direct + _product(to_harmonics * friction_z, change))
    return np.concatenate(found)


def _product(left: ComplexValues, right: ComplexValues) -> Any:
    """Of matrices, in parts so small that threads, which busy machines wait for, are not set off for them."""
    many = max(1, AT_ONCE_IN_PRODUCTS // (left.shape[0] * right.shape[-1]))
    parts = range(0, left.shape[1], many)
    return sum(left[:, k : k + many] @ right[..., k : k + many, :] for k in parts)


FEWEST_BALANCED, MOST_BALANCED = 16, 512
"""Harmonics of the force on the mass."""
BY_CHANCE = 0.02
"""Of the change of friction over a period: it stands in where the means of two motions agree by chance."""
OTHER_MEAN = 1e-4
"""By how much means of rough motions differ that are not of one."""
SEVERAL_BALANCE = "{}: motions of means from {:.6g} to {:.6g} balance"
UNIQUE = {"ok": PROVED, "not_unique": NOT_UNIQUE}
UNBALANCED = "no motion found whose harmonics obey the receptance"
HALF_UNBALANCED = "no error known: every other row of the table gives no motion"
FALLS = (
    "on a body by its receptance shooting needs one bristle under a constant normal load where friction falls with "
    "speed: of other motions that balance nothing tells whether they are stable"
)
UNSTABLE = "the motion of one period that balances is unstable, and no other is followed"
UNTOLD = "nothing tells whether the motion that balances is stable, as friction falls with speed"
ATTRACTS = "it attracts (Nyquist's criterion); whether other starts lead elsewhere is not known"
FEWEST_COUPLED, MOST_COUPLED, NEARLY_WHOLE = 16, 64, 0.1
"""Harmonics of changes of a motion; they are enough where so many changes grow, but for this."""
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
    return FALLS if law.steepest_fall() > 0.0 and not _stability_is_told(scene, law) else None


def _stability_is_told(scene: Scene, law: FrictionLaw) -> bool:
    return isinstance(law, BristleLaw) and scene.signals().normal_load == Signal()


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
        self.rough = None if self.mass.contracts else MassUnderForce(self.scene, law, body, ROUGH_MEAN)
        self.fewest = max(FEWEST_BALANCED, math.ceil(body.fastest / self.mass.frequency))
        n = len(scenes)
        self.motions: list[BalancedMotion | None] = [None] * n
        self.status: list[Status] = ["ok"] * n
        self.reason = [""] * n
        self.mean, self.error, self.low, self.high, self.seconds = np.full((5, n), np.nan)
        known: BalancedMotion | None = None
        for i in each_told(np.lexsort((-np.abs(self.belt_speeds), self.belt_speeds < 0.0)).tolist()):
            if known is not None and self.belt_speeds[i] * known.belt_speed < 0.0:
                known = None
            known = self._solve(i, known) or known

    def _solve(self, i: int, known: BalancedMotion | None) -> BalancedMotion | None:
        """The motion of one scene, from a neighbour's."""
        speed = float(self.belt_speeds[i])
        before = self._spent()
        found = self._refined(speed, known) or (self._refined(speed, None) if known is not None else None)
        if found is None:
            self.status[i], self.reason[i] = "failed", UNBALANCED
        else:
            fine, cut = found
            self.motions[i], self.mean[i] = fine, fine.motion.mean
            error = fine.motion.error + 2.0 * (fine.left + cut)
            self.error[i] = error + self._misfit(i, fine)
            if self.status[i] == "ok":
                self._compare_far_starts(i, fine)
            if self.error[i] > self.tolerance:
                why = "the table is too coarse for less" if self.halved else "more harmonics are not balanced"
                self._say(i, f"error {self.error[i]:.1e} above the tolerance: {why}")
        self.seconds[i] = self._spent() - before
        return found[0] if found else None

    def _spent(self) -> float:
        return sum(each.seconds for each in (self.mass, self.halved, self.rough) if each is not None)

    def _refined(self, speed: float, known: BalancedMotion | None) -> tuple[BalancedMotion, float] | None:
        """The motion with as many harmonics as the tolerance asks for, and what it is from that with half as many."""
        count = self.fewest if known is None else max(self.fewest, known.harmonics // 2)
        search = Balancing(self.mass, speed, count)
        found = search.found(known or search.without_friction()) or search.found(search.without_slip())
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
        self._leave(i, "failed", HALF_UNBALANCED)
        return math.nan

    def _compare_far_starts(self, i: int, fine: BalancedMotion) -> None:
        """Leave the mean open where the search ends elsewhere from the motion without friction, or without slip."""
        if self.rough is None:
            return
        search = Balancing(self.rough, fine.belt_speed, self.fewest)
        found = [search.found(each) for each in (fine, search.without_friction(), search.without_slip())]
        means = [each.motion.mean for each in found if each is not None]
        if means and max(means) - min(means) > OTHER_MEAN:
            self.low[i], self.high[i] = min(means), max(means)
            falls = self.law.steepest_fall() > 0.0
            why = "friction falls with speed" if falls else "the deflection lags behind the slip"
            self._leave(i, "not_unique", SEVERAL_BALANCE.format(why, self.low[i], self.high[i]))
        else:
            self._judge_stability(i, found[0])

    def _judge_stability(self, i: int, rough: BalancedMotion | None) -> None:
        """Leave a motion that others leave; say of friction that falls what is known."""
        law, falls, growing = self.law, self.law.steepest_fall() > 0.0, math.nan
        if rough is not None and isinstance(law, BristleLaw) and _stability_is_told(self.scene, law):
            orbit, belt = rough.motion.orbit, self.mass.signals.belt[0]
            slip = orbit.v.real - rough.belt_speed - belt(orbit.tau)
            most = max(FEWEST_COUPLED, math.ceil(1.2 * self.mass.body.fastest / self.mass.frequency))
            while math.isnan(growing) and most <= MOST_COUPLED:
                found = growing_changes(law, self.mass.body, self.mass.normal_load, orbit, slip, most)
                growing, most = found if abs(found - np.round(found)) < NEARLY_WHOLE else math.nan, 2 * most
        if growing > 0.5:
            self._leave(i, "failed", UNSTABLE)
        elif falls:
            told = not math.isnan(growing)
            self._leave(i, "failed", UNTOLD) if not told else self._say(i, ATTRACTS)

    def _leave(self, i: int, status: Status, reason: str) -> None:
        self.status[i], self.reason[i], self.motions[i] = status, reason, None
        self.mean[i] = self.error[i] = math.nan

    def _say(self, i: int, reason: str) -> None:
        self.reason[i] = f"{self.reason[i]}; {reason}" if self.reason[i] else reason

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
            model=[model if status != "failed" else "" for status in self.status],
            error_kind=["estimated" if each else "" for each in ok],
            mean=self.mean,
            error=self.error,
            period=np.where(ok, float(self.scene.periods), np.nan),
            mean_low=self.low,
            mean_high=self.high,
            window=np.where(np.isnan(self.low), np.nan, float(self.scene.periods)),
            unique=[UNIQUE.get(status, "") if proved or status != "ok" else "" for status in self.status],
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
