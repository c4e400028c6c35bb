"""The relay locus: instants of stick and reversal of any linear body of known frequency response."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import Any, ClassVar

import numpy as np

from frictionlab.compile.call import KernelCall
from frictionlab.laws.base import FrictionLaw
from frictionlab.methods.base import (
    NOT_UNIQUE,
    PROVED,
    Answers,
    Ledger,
    Method,
    beyond_balance,
    beyond_linear,
    beyond_springs,
)
from frictionlab.methods.relay_locus import curve
from frictionlab.methods.relay_locus.locus import MOST_INSTANTS
from frictionlab.methods.relay_locus.orbit import BesideFriction, make_locus_orbits
from frictionlab.methods.relay_locus.response import FreeWaves, response_of
from frictionlab.methods.relay_locus.rest_rule import rest_rules
from frictionlab.methods.relay_locus.search import FINE
from frictionlab.methods.words import ModelWord
from frictionlab.motion.orbit.record import Orbits
from frictionlab.scene.parts import BY_TABLE, REMEMBERING
from frictionlab.scene.receptance import LinearBody, TabulatedBody, linear_body
from frictionlab.scene.scene import Scene
from frictionlab.scene.scenes import belt_speeds_of
from frictionlab.scene.signals import Signal, Wave
from frictionlab.theory.linear import answered, corners_of, friction_free_slip
from frictionlab.values.quantities import EPSILON, Floats

TAKEN = (*REMEMBERING, BY_TABLE)
"""Keys of a body that leave it linear."""
REST_DEGREES = (8, 11, 14, 17, 20, 24, 28)
"""Of friction in a rest."""
RESPONSE_TERMS = (12, 16, 20, 24, 28, 32, 40, 48)
"""Of the response over a rest."""
LONGEST_REST, LONGEST_GRADED = 28.0, 6.0
"""Radians of the quickest free motion in a part of a rest; and where it is graded."""
GRADING = 4
"""Of rests where memory has powers that are no whole numbers: makes t^(2 - q) smooth enough at every order q."""
UNSOLVED = "no motion found that is checked: slip of one sign between its instants, friction within its limit at rest"
HALF_FAILED = "no error known: every other row of the table gives no motion"
HOLDS = "the belt is at rest and friction can hold the mass: it stays where it starts, with a mean friction between "


class RelayLocus(Method):
    """Steady states of Coulomb friction on any linear body, known by its frequency response: memory included.

    Between its reversals and rests friction is constant, so that the motion is a sum of the body's responses to
    steps, again in every period: all harmonics, summed in closed form. The instants at which the slip velocity is
    zero, and friction in rests as polynomials, follow by Newton's method from a neighbour's or from a motion in
    steps; slip and friction are then checked between them. Its error is that of the sums and of the polynomials.

    Sources: Tsypkin (1984) for relays; Den Hartog (1931); Bagley & Torvik (1983) of fractional elements.

    >>> import frictionlab as fl
    >>> scene = fl.Scene(damping_ratio=0.1, normal_load=10, belt_speed=5, drive=fl.Drive(unbalance=10, frequency=1))
    >>> scene = scene.with_(body=fl.Body(fractional=fl.Fractional(coefficient=0.2, order=0.5)))
    >>> state = fl.steady_state(scene, fl.Coulomb(mu=0.4), method="relay_locus")
    >>> round(state.mean_friction, 10), state.error < 1e-12
    (0.0847252865, True)
    """

    name: ClassVar[str] = "relay_locus"
    resolves_events: ClassVar[bool] = True

    def refusal(self, scene: Scene, law: FrictionLaw) -> str | None:
        """Anything but Coulomb friction on a driven line, on a body that is linear and dissipates, shaken by
        sines."""
        if law.memory_kind != "none" or not law.constant_sliding_friction() or not law.monotone():
            return beyond_springs(scene) or "relay_locus solves Coulomb friction alone, without mu_static"
        if reason := beyond_linear(self.name, scene, TAKEN):
            return reason
        if reason := beyond_balance(self.name, scene):
            return reason
        signals = scene.signals()
        if signals.normal_load != Signal():
            return "relay_locus needs a normal load that does not change"
        if signals.belt[0].pieces or corners_of(signals.load[0], signals.period)[:, 1].any():
            return "relay_locus needs waveforms of sines: sine or {harmonics: [...]}; a load may be a triangle, too"
        return None

    def solve(self, scenes: Sequence[Scene], law: FrictionLaw, tolerance: float) -> Answers:
        """Answer scenes that differ in belt speed alone."""
        coefficient, body = law.sliding_friction(1.0), linear_body(scenes[0])
        found = LocusCurve(scenes, coefficient, tolerance, body)
        if isinstance(body, TabulatedBody):
            found.add_misfit(LocusCurve(scenes, coefficient, tolerance, body.halved()))
        return found.told()


class LocusCurve(Ledger):
    """The scenes of one curve on their way to answers."""

    def __init__(
        self, scenes: Sequence[Scene], coefficient: float, tolerance: float, body: LinearBody
    ) -> None:
        scene = scenes[0]
        assert scene.normal_load is not None
        self.scenes, self.coefficient, self.tolerance = scenes, coefficient, tolerance
        self.normal_load, self.limit = scene.normal_load, coefficient * scene.normal_load
        self.belt_speeds = belt_speeds_of(scenes)
        self.load, self.belt = scene.signals().load[0], scene.signals().belt[0]
        self.span = scene.signals().period
        self.body = body
        n = len(scenes)
        super().__init__(n)
        self.status, self.error_kind, self.unique = ["ok"] * n, ["estimated"] * n, [PROVED] * n
        self.model = [f"{ModelWord.LOCUS}; {ModelWord.PASSIVE}"] * n
        self.rows = np.full((n, curve.COLUMNS), np.nan)
        self.found = np.zeros((n, MOST_INSTANTS, 3 + REST_DEGREES[-1]))

        self.response = response_of(self.body, 2.0 * math.pi / self.span)
        self.free = friction_free_slip(self.body, self.load, self.belt, self.span)
        self.extremes = self.free.extremes(self.span)
        bends = np.ascontiguousarray(self.free.corners[:, [0, 2]])
        self.forcing = FreeWaves(waves_of(self.free.waves), bends, self.free.steady)
        self.longest = (LONGEST_REST if body.smooth else LONGEST_GRADED) / body.fastest
        terms = terms_of_response(min(self.longest, self.span) * body.fastest)
        self.rules = rest_rules(REST_DEGREES, terms, 1 if body.smooth else GRADING)
        reversing = self._without_reversal()
        reversing = self._without_motion(reversing)
        if len(reversing):
            self._solve(reversing)

    def add_misfit(self, other: LocusCurve) -> None:
        """Count as error how far friction in time is from that of another curve, of a body known less well."""
        moved = np.abs(self.found[:, :, 0] - other.found[:, :, 0])
        alike = np.all(self.found[:, :, 1] == other.found[:, :, 1], axis=1)
        alike &= self.rows[:, curve.COUNT] == other.rows[:, curve.COUNT]
        jumps = 2.0 * self.coefficient * moved.sum(axis=1) / self.span
        apart = np.abs(self.mean - other.mean)
        slips = (self.rows[:, curve.COUNT] == 0.0) & (other.rows[:, curve.COUNT] == 0.0)
        self.error += np.where(slips, 0.0, apart + np.where(alike, jumps, 3.0 * apart))
        for i in np.flatnonzero(np.isfinite(self.mean) & ~np.isfinite(self.error)).tolist():
            self.fail(i, HALF_FAILED)
        self._tell_large_errors("the table is too coarse for less")

    def _tell_large_errors(self, why: str) -> None:
        for i in np.flatnonzero(self.error > self.tolerance).tolist():
            if self.status[i] == "ok":
                self.reason[i] = f"error {self.error[i]:.1e} above the tolerance: {why}"

    def told(self) -> Answers:
        """What was found."""
        self.period = np.where(np.isfinite(self.mean), float(self.scenes[0].periods), np.nan)
        return self.answers(
            orbit=lambda i: self._orbits([i]).one(0),
            orbits=lambda: self._orbits(range(len(self.scenes))),
        )

    def _without_reversal(self) -> Any:
        """Settle belts that no slip overtakes; the places of the others."""
        low, high = self.extremes
        forward, backward = self.belt_speeds >= max(high, 0.0), self.belt_speeds <= min(low, 0.0)
        alone = (forward | backward) & (self.belt_speeds != 0.0)
        self.mean[alone] = self.coefficient * np.sign(self.belt_speeds[alone])
        self.error[alone] = 4.0 * EPSILON * self.coefficient
        self.rows[alone, curve.COUNT] = 0.0
        for i in np.flatnonzero(alone).tolist():
            self.model[i], self.error_kind[i] = str(ModelWord.NO_REVERSAL), "guaranteed"
        return np.flatnonzero(~alone)

    def _without_motion(self, places: Any) -> Any:
        """Settle a belt at rest that holds the mass; the places of the others."""
        low, high = self.load.extremes(self.span)
        low, high = (high - self.limit) / self.normal_load, (low + self.limit) / self.normal_load
        still = self.belt.waves == () and low <= high
        held = [i for i in places.tolist() if still and self.belt_speeds[i] == 0.0]
        for i in held:
            periods = float(self.scenes[i].periods)
            self.leave_open(i, f"{HOLDS}{low:.6g} and {high:.6g}", low, high, periods)
            self.model[i], self.unique[i] = str(ModelWord.ANY_START), NOT_UNIQUE
        return np.setdiff1d(places, held)

    def _solve(self, places: Any) -> None:
        """From the fastest belt of a direction to the slowest, each from its neighbour."""
        speeds = self.belt_speeds[places]
        order = places[np.lexsort((-np.abs(speeds), speeds < 0.0))]
        low, high = self.extremes
        loads = self.span * float(np.abs(self.free.corners[:, 2]).sum())
        given = curve.CurveScales(max(high, -low), self.longest, self.response.error, loads, high, low)
        speeds = np.ascontiguousarray(self.belt_speeds)
        _, seconds = KernelCall(curve.follow_curve).timed(
            self.response, self.rules, self.forcing, self.limit, given, (speeds, order), self.rows, self.found
        )
        self.seconds[:] = seconds / len(self.scenes)
        fine = self.rows[places, curve.VERDICT] == FINE
        good, per_mean = places[fine], self.span * self.normal_load
        self.mean[good] = -self.rows[good, curve.IMPULSE] / per_mean
        self.error[good] = self.rows[good, curve.ERROR] / per_mean
        for i in places[~fine].tolist():
            self.fail(i, UNSOLVED)
        self._tell_large_errors("only rounding errors remain")

    def _orbits(self, places: Sequence[int]) -> Orbits:
        """Of the scenes at these places; without panels where there is none."""
        chosen, ends = list(places), np.zeros(len(places), np.int64)
        counts = np.where(np.isfinite(self.mean[chosen]), self.rows[chosen, curve.COUNT], -1.0).astype(
            np.int64
        )
        degrees = np.nan_to_num(self.rows[chosen, curve.DEGREE]).astype(np.int64)
        position = Signal(tuple(answered(self.body, each, 0) for each in self.load.waves))
        path = Signal(
            tuple(Wave(each.frequency, each.phasor / (1j * each.frequency)) for each in self.belt.waves)
        )
        around = BesideFriction(waves_of(position), waves_of(self.belt), waves_of(path), self.body.smooth)
        track = KernelCall(make_locus_orbits)(
            self.response,
            self.rules,
            self.forcing,
            around,
            np.array([self.limit, self.normal_load]),
            self.belt_speeds[chosen],
            (counts, degrees, self.found[chosen]),
            ends,
        )
        last = int(ends[-1]) if len(ends) else 0
        tau, x, v, friction, stick = (each[:last] for each in track[:5])
        return Orbits(tau, x, v, friction, stick, ends)


def terms_of_response(radians: float) -> int:
    """That a sine through so many radians asks for; the most where that is more."""
    turn = 0.5 * radians
    enough = 8.0 + 5.0 * math.sqrt(turn) + 1.5 * turn
    return next((each for each in RESPONSE_TERMS if each >= enough), RESPONSE_TERMS[-1])


def waves_of(signal: Signal) -> Floats:
    """Frequency, sine and cosine parts of each of its waves."""
    rows = [(each.frequency, each.phasor.real, each.phasor.imag) for each in signal.waves]
    return np.array(rows, dtype=np.float64).reshape(-1, 3)
