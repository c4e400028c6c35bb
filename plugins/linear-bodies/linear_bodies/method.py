"""Method ``relay_locus``: instants of stick and reversal of any linear body of known frequency response."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import Any, ClassVar

import numpy as np

import frictionlab as fl
from frictionlab.theory import Floats
from frictionlab.tools import KernelCall, LinearBody, Orbits, friction_free_slip, linear_body
from linear_bodies import curve
from linear_bodies.locus import MOST_INSTANTS
from linear_bodies.orbit import BesideFriction, make_locus_orbits
from linear_bodies.response import EPSILON, FreeWaves, response_of
from linear_bodies.rest_rule import rest_rules
from linear_bodies.search import FINE

TAKEN = ("relaxation", "fractional", "receptance")
"""Keys of a body that leave it linear."""
REST_DEGREES = (8, 11, 14, 17, 20, 24, 28)
"""Degrees of friction in a rest."""
RESPONSE_TERMS = (12, 16, 20, 24, 28, 32, 40, 48)
"""Terms of the response over a rest."""
LONGEST_REST, LONGEST_GRADED = 28.0, 6.0
"""Radians of the quickest free motion in a part of a rest; and where it is graded."""
GRADING = 4
"""Grading of rests where memory has powers that are no whole numbers: t^(2 - q) is smooth enough at every order q."""
UNSOLVED = "no motion found that is checked: slip of one sign between its instants, friction within its limit at rest"
HALF_FAILED = "no error known: every other row of the table gives no motion"
COULOMB_ALONE = (
    "relay_locus solves Coulomb friction alone, without mu_static: use law coulomb, or a body of springs and "
    "dashpots"
)
LINE_ALONE = (
    "relay_locus takes a body by its response along one line, with a mass: leave transverse and slip out"
)
UNDRIVEN = (
    "relay_locus needs a drive, whose period is that of the motion: give one, or method shooting and a body of "
    "springs and dashpots"
)
UNDAMPED = "relay_locus needs a body that dissipates at every frequency: give damping_ratio or memory"
STEADY_LOAD = "relay_locus needs a normal load that does not change"
SMOOTH = "relay_locus needs waveforms of sines: sine or {harmonics: [...]}; a load may be a triangle, too"
LOCUS, ONE_WAY, ANY_START = "relay locus; unique: passive", "no reversal", "any start"
"""Words of the column ``model``."""
HOLDS = "the belt is at rest and friction can hold the mass: it stays where it starts, with a mean friction between "


class RelayLocus(fl.Method):
    """Steady states of Coulomb friction on any linear body, known by its frequency response: memory included.

    Between its reversals and rests friction is constant, so that the motion is a sum of the body's responses to
    steps, again in every period: all harmonics, summed in closed form. The instants at which the slip velocity is
    zero, and friction in rests as polynomials, follow by Newton's method from a neighbour's or from a motion in
    steps; slip and friction are then checked between them. Its error is that of the sums and of the polynomials.

    References
    ----------
    Sources: Tsypkin (1984) for relays; Den Hartog (1931); Bagley & Torvik (1983) of fractional elements.

    Examples
    --------
    >>> import frictionlab as fl
    >>> scene = fl.Scene(damping_ratio=0.1, normal_load=10, belt_speed=5, drive=fl.Drive(unbalance=10, frequency=1))
    >>> scene = scene.with_(body=fl.Body(fractional=fl.Fractional(coefficient=0.2, order=0.5)))
    >>> state = fl.steady_state(scene, fl.Coulomb(mu=0.4), method="relay_locus")
    >>> round(state.mean_friction, 10), state.error < 1e-12
    (0.0847252865, True)
    """

    bibtex: ClassVar[str] = """
    @book{tsypkin1984, author = {Tsypkin, Ya. Z.}, title = {Relay Control Systems}, publisher = {Cambridge University
      Press}, year = {1984}}
    """

    name: ClassVar[str] = "relay_locus"
    resolves_events: ClassVar[bool] = True

    def refusal(self, scene: fl.Scene, law: fl.FrictionLaw) -> str | None:
        """Return why not: it takes Coulomb friction on a driven line, a linear body that dissipates, and sines."""
        if law.memory_kind != "none" or not law.constant_sliding_friction() or not law.monotone():
            return COULOMB_ALONE
        if others := [f"body.{term}" for term in scene.body_terms if term not in TAKEN]:
            return f"relay_locus does not take {' and '.join(others)}"
        if scene.degrees_of_freedom != 1:
            return LINE_ALONE
        if scene.undriven:
            return UNDRIVEN
        return _refusal_of_body(linear_body(scene)) or _refusal_of_waveforms(scene)

    def solve(self, scenes: Sequence[fl.Scene], law: fl.FrictionLaw, tolerance: float) -> fl.Answers:
        """Answer scenes that differ in belt speed alone."""
        coefficient = law.sliding_friction(1.0)
        body: Any = linear_body(scenes[0])
        found = LocusCurve(scenes, coefficient, tolerance, body)
        if scenes[0].body is not None and scenes[0].body.receptance is not None:
            found.add_misfit(LocusCurve(scenes, coefficient, tolerance, body.halved()))
        return found.told()


def _refusal_of_body(body: LinearBody) -> str | None:
    """Return why the response of a body is not enough."""
    if not body.dissipates:
        return UNDAMPED
    if not math.isfinite(body.mass):
        return (
            f"friction has frequencies above the last one of the table, {body.known_to:g}: "
            "give body.receptance.free_mass"
        )
    return None


def _refusal_of_waveforms(scene: fl.Scene) -> str | None:
    """Return why what shakes a scene is not taken: a normal load that changes, jumps, corners of the belt."""
    signals = scene.signals()
    load, belt, normal = signals.load[0], signals.belt[0], signals.normal_load
    if normal.waves or normal.pieces:
        return STEADY_LOAD
    free = friction_free_slip(linear_body(scene), load, belt, signals.period)
    return SMOOTH if belt.pieces or free.corners[:, 1].any() else None


class LocusCurve(fl.Ledger):
    """Scenes of one curve on their way to answers."""

    def __init__(
        self, scenes: Sequence[fl.Scene], coefficient: float, tolerance: float, body: LinearBody
    ) -> None:
        scene = scenes[0]
        assert scene.normal_load is not None
        self.scenes, self.coefficient, self.tolerance = scenes, coefficient, tolerance
        self.normal_load, self.limit = scene.normal_load, coefficient * scene.normal_load
        self.belt_speeds = np.array([each.belt_speed for each in scenes])
        self.load, self.belt = scene.signals().load[0], scene.signals().belt[0]
        self.span = scene.signals().period
        self.body = body
        n = len(scenes)
        super().__init__(n)
        self.status, self.error_kind, self.unique = ["ok"] * n, ["estimated"] * n, ["proved"] * n
        self.model = [LOCUS] * n
        self.rows = np.full((n, curve.COLUMNS), np.nan)
        self.found = np.zeros((n, MOST_INSTANTS, 3 + REST_DEGREES[-1]))

        self.response = response_of(self.body, 2.0 * math.pi / self.span)
        self.free = friction_free_slip(self.body, self.load, self.belt, self.span)
        self.extremes = self.free.extremes(self.span)
        bends = np.ascontiguousarray(self.free.corners[:, [0, 2]])
        self.forcing = FreeWaves(waves_of(self.free.waves.waves), bends, self.free.steady)
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

    def told(self) -> fl.Answers:
        """Return what was found."""
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
            self.model[i], self.error_kind[i] = ONE_WAY, "guaranteed"
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
            self.model[i], self.unique[i] = ANY_START, "no"
        return np.setdiff1d(places, held)

    def _solve(self, places: Any) -> None:
        """Solve from the fastest belt of a direction to the slowest, each from its neighbour."""
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
        """Return the orbits of the scenes at these places; without panels where there is none."""
        chosen, ends = list(places), np.zeros(len(places), np.int64)
        counts = np.where(np.isfinite(self.mean[chosen]), self.rows[chosen, curve.COUNT], -1.0).astype(
            np.int64
        )
        degrees = np.nan_to_num(self.rows[chosen, curve.DEGREE]).astype(np.int64)
        responses = [self.body.receptance(np.array([each.frequency]))[0] for each in self.load.waves]
        paths = [1.0 / (1j * each.frequency) for each in self.belt.waves]
        around = BesideFriction(
            waves_of(self.load.waves, responses),
            waves_of(self.belt.waves),
            waves_of(self.belt.waves, paths),
            self.body.smooth,
        )
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
    """Return how many terms a sine through so many radians asks for; the most where that is more."""
    turn = 0.5 * radians
    enough = 8.0 + 5.0 * math.sqrt(turn) + 1.5 * turn
    return next((each for each in RESPONSE_TERMS if each >= enough), RESPONSE_TERMS[-1])


def waves_of(waves: Sequence[Any], factors: Sequence[complex] = ()) -> Floats:
    """Return frequency, sine and cosine parts of each wave, times its factor where there are some."""
    given = zip(waves, factors or [1.0] * len(waves), strict=True)
    phasors = [(each.frequency, complex(factor * each.phasor)) for each, factor in given]
    rows = [(frequency, phasor.real, phasor.imag) for frequency, phasor in phasors]
    return np.array(rows, dtype=np.float64).reshape(-1, 3)
