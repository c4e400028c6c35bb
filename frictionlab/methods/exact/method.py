"""Method ``exact``: closed-form motion between events under Coulomb friction, closed by Newton's method."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import Any, ClassVar

import numpy as np
from numpy.typing import NDArray

from frictionlab.compile.call import KernelCall
from frictionlab.laws.base import FrictionLaw
from frictionlab.methods.base import NOT_UNIQUE, PROVED, Answers, Ledger, Method, Multipliers, beyond_linear
from frictionlab.methods.exact import continuation as curve
from frictionlab.methods.exact.continuation import make_orbits
from frictionlab.methods.exact.forcing import FASTEST, HIGHEST, LOWEST, forcing_of
from frictionlab.methods.prescribed.method import solve_prescribed
from frictionlab.methods.shooting.method import suggest_shooting
from frictionlab.methods.words import ModelWord
from frictionlab.motion.orbit.record import Orbits
from frictionlab.scene.scene import Scene
from frictionlab.scene.scenes import belt_speeds_of
from frictionlab.scene.signals import Signal
from frictionlab.values.quantities import Floats

SALTATION = 1e-8
"""Error of multipliers carried through events, absolute or of those above one: rounding, much more than is seen."""
FARTHEST = np.finfo(np.float64).max
REACHED = "reached from scene.initial after {} periods; other starts reach other states"
NO_DAMPING = (
    "without damping and without slip reversal the free oscillation does not decay: the friction is mu at every "
    "instant of every motion, but the motion depends on the start; give scene.initial"
)
UNBOUNDED = (
    "amplitude grows without bound: undamped resonance with friction mu*normal_load below pi/4 of the force"
)
NO_CERTIFY = "is gone: use method certified, which the package frictionlab-certified brings"


def _refusal_of_legs(scene: Scene, law: Any) -> str | None:
    """Return why a prescribed slip has no two legs along which the deflection is known; None if it has."""
    if scene.constant_contact:
        return ModelWord.STIFF_CONTACT.sentence
    if not law.exact_path():
        return ModelWord.NO_PATH.sentence
    if not scene.load_along_belt_only:
        return ModelWord.TWO_WAYS.sentence
    return None


def _refusal_of_flow(scene: Scene, law: FrictionLaw) -> str | None:
    """Return why the motion between events is not known in closed form; None if it is."""
    if law.memory_kind != "none":
        return ModelWord.MEMORY.sentence
    if not law.constant_sliding_friction():
        return ModelWord.SPEED.sentence
    if scene.degrees_of_freedom > 0 and not law.monotone():
        return ModelWord.STATIC.sentence
    if scene.undriven:
        return ModelWord.UNDRIVEN.sentence
    if scene.degrees_of_freedom == 2 and not scene.load_along_belt_only:
        loaded = scene.signals().load[1] != Signal()
        return (ModelWord.LOAD_ACROSS if loaded else ModelWord.BELT_ACROSS).sentence
    return None


class Exact(Method):
    """Steady states of Coulomb friction along one line, to rounding: events in closed form, no steps.

    Between events the motion is that of a linear oscillator under loads and friction known in time, or rest
    on the belt: sines, and parabolas between corners of loads, belt velocity and normal load. Each event is
    found by steps that cannot pass it. The period is closed by Newton's method with derivatives carried
    through the events (saltation); if that fails, by iteration of the period map itself, which never expands.

    References
    ----------
    Sources: Den Hartog (1931); of saltation Leine & Nijmeijer (2004); of the map Leine & van de Wouw (2008).

    Examples
    --------
    >>> import frictionlab as fl
    >>> scene = fl.Scene(damping_ratio=0.1, normal_load=10, belt_speed=5, drive=fl.Drive(unbalance=10, frequency=1))
    >>> state = fl.steady_state(scene, fl.Coulomb(mu=0.4), method="exact")
    >>> round(state.mean_friction, 10), state.error < 1e-13
    (0.0505839238, True)
    """

    name: ClassVar[str] = "exact"
    resolves_events: ClassVar[bool] = True
    gone_keys: ClassVar[dict[str, str]] = {"certify": NO_CERTIFY}

    def refusal(self, scene: Scene, law: FrictionLaw) -> str | None:
        """Anything but Coulomb friction, the same at rest, on a driven line or a prescribed slip."""
        prescribed = scene.degrees_of_freedom == 0 and law.memory_kind == "bristle"
        reason = (_refusal_of_legs if prescribed else _refusal_of_flow)(scene, law)
        reason = beyond_linear(self.name, scene) or reason
        return suggest_shooting(reason, scene, law) if reason else None

    def refusals(self, scenes: Sequence[Scene], law: FrictionLaw) -> list[str | None]:
        """Return the refusals: what is accepted depends on no belt speed, the reason of a refusal may."""
        if self.refusal(scenes[0], law) is None:
            return [None] * len(scenes)
        return super().refusals(scenes, law)

    def solve(self, scenes: Sequence[Scene], law: FrictionLaw, tolerance: float) -> Answers:
        """Answer scenes that differ in belt speed alone."""
        if scenes[0].degrees_of_freedom == 0:
            return solve_prescribed(scenes, law, tolerance)
        return _Curve(scenes, law.sliding_friction(1.0), tolerance).solved()


class _Curve(Ledger):
    """Scenes of one curve on their way to answers.

    odd: whether one sine is all: turned round, a scene is itself half a period later on a belt that moves the other
    way, and is solved on the one that moves ahead. sides: -1 where that is its mirror image.
    """

    def __init__(self, scenes: Sequence[Scene], coefficient: float, tolerance: float) -> None:
        self.scenes, self.coefficient, self.tolerance = scenes, coefficient, tolerance
        self.mass, self.odd = scenes[0].mass(), scenes[0].is_harmonic
        self.forcing = forcing_of(self.mass, coefficient)
        self.belt_speeds = belt_speeds_of(scenes)
        self.sides = np.where(self.odd & (self.belt_speeds < 0.0), -1.0, 1.0)
        n = len(scenes)
        super().__init__(n)
        self.status, self.error_kind, self.unique = ["ok"] * n, ["estimated"] * n, [PROVED] * n
        self.model = [str(ModelWord.EVENTS)] * n
        self.rows = np.full((n, curve.COLUMNS), np.nan)

    def solved(self) -> Answers:
        """Solve and judge."""
        undamped, jumps = self.mass.damping == 0.0, self.forcing.belt_jumps()
        rests = (self.belt_speeds == 0.0) & (not jumps)
        unbounded = undamped and self.forcing.unbounded()
        special = np.flatnonzero(rests | undamped).tolist()
        settled = [i for i in special if self._has_no_single_answer(i, bool(rests[i]), unbounded)]
        open_points = np.delete(np.arange(len(self.scenes)), settled)
        self._solve(open_points)
        if self.odd:  # on a belt at rest the orbit is its own mirror image half a period later
            self.rows[open_points[self.belt_speeds[open_points] == 0.0], curve.MEAN] = 0.0
        self._judge(open_points)
        if self.scenes[0].degrees_of_freedom == 2:
            self.model = [f"{text}; {ModelWord.X2_DECAYS}" if text else text for text in self.model]
        proof = ModelWord.DAMPED if self.mass.damping > 0.0 else ModelWord.NEIGHBOURS
        proved = {text: f"{text}; {proof}" for text in set(self.model)}
        self.model = [
            proved[text] if unique == PROVED else text
            for text, unique in zip(self.model, self.unique, strict=True)
        ]
        self.mean, self.error = self.sides * self.rows[:, curve.MEAN], self.rows[:, curve.ERROR]
        self.period = np.where(np.isfinite(self.mean), float(self.scenes[0].periods), np.nan)
        return self.answers(
            floquet=self._floquet,
            multipliers=self._multipliers,
            orbit=lambda i: self._orbits([i]).one(0),
            orbits=lambda: self._orbits(range(len(self.scenes))),
        )

    def _has_no_single_answer(self, i: int, rests: bool, unbounded: bool) -> bool:
        """Settle the cases where the steady state depends on the start, or does not exist.

        rests: whether the belt is at rest. unbounded: whether an undamped load in resonance outdoes friction.
        """
        forcing, speed = self.forcing, float(self.belt_speeds[i])
        # At rest the force of friction is the position less the load, whose mean the spring balances.
        mean = self.scenes[i].signals().load[0].mean
        low, high = forcing.table[[HIGHEST, LOWEST]] - mean + np.array([-1.0, 1.0]) * forcing.friction
        if rests and low <= high:
            bounds = float(low / forcing.normal_load), float(high / forcing.normal_load)
            self._depends_on_start(i, bounds, _permanent_stick(*bounds))
        elif self.mass.damping == 0.0 and abs(speed) >= forcing.table[FASTEST]:
            self._depends_on_start(i, self._mean_without_reversal(i), NO_DAMPING)
        elif unbounded:
            self.fail(i, UNBOUNDED)
        else:
            return False
        return True

    def _mean_without_reversal(self, i: int) -> tuple[float, float]:
        return (math.copysign(self.coefficient, self.belt_speeds[i]),) * 2

    def _depends_on_start(self, i: int, bounds: tuple[float, float], reason: str) -> None:
        """Enter a state that is not unique, unless the scene says where it starts.

        bounds: lowest and highest mean over all starts.
        """
        if self.scenes[i].initial is None or not self._settles(i):
            self.leave_open(i, reason, *bounds, float(self.scenes[i].periods))
            self.model[i] = str(ModelWord.ANY_START)
            self.rows[i, curve.LEGS] = 0.0
        self.unique[i] = NOT_UNIQUE

    def _settles(self, i: int) -> bool:
        """Simulate from scene.initial until nothing changes."""
        row = np.full(curve.COLUMNS, np.nan)
        speed = self.sides[i] * self.belt_speeds[i] + 0.0
        periods = KernelCall(curve.iterate_until_fixed)(self.forcing, speed, self._start(i), row)
        if periods < 0:
            return False
        # The adjoint of a map that leaves some direction as it was does not exist: only rounding is left to say.
        row[curve.ERROR] = (periods + 8.0) * 16.0 * row[curve.ROUNDING] / self.mass.normal_load
        self.rows[i] = row
        self.reason[i] = REACHED.format(periods)
        return True

    def _start(self, i: int) -> Floats:
        """Return canonical position, slip velocity and time of scene.initial."""
        initial, side, (path, vibration) = self.scenes[i].initial, self.sides[i], self.forcing.belt_at_start()
        assert initial is not None
        w = side * (initial.velocity - self.belt_speeds[i] - vibration)
        return np.array([side * (initial.x - path), w, self._shift(side)])

    def _shift(self, side: float) -> float:
        """Return the canonical time of tau = 0.

        It is the phase of a sine, half a period later for a belt that moves the other way.
        """
        if not self.odd:
            return 0.0
        force = side * self.mass.force
        return math.atan2(force.imag, force.real) % (2.0 * math.pi) / self.mass.frequency

    def _solve(self, places: np.ndarray) -> None:
        """Solve each belt speed once: both directions share one solution where one sine is all."""
        speeds, back = np.unique(self.sides[places] * self.belt_speeds[places] + 0.0, return_inverse=True)
        rows = np.full((len(speeds), curve.COLUMNS), np.nan)
        _, seconds = KernelCall(curve.continue_in_speed).timed(self.forcing, speeds, rows)
        self.seconds[:] = seconds / len(self.scenes)
        self.rows[places] = rows[back]

    def _judge(self, places: NDArray[np.int64]) -> None:
        """Say of each of these how it was found, and of those that are not as good as asked, why."""
        linear = self.rows[places, curve.FOUND] == 1.0
        if self.mass.damping == 0.0:
            for i in places[linear].tolist():
                self.rows[i] = np.nan
                self._depends_on_start(i, self._mean_without_reversal(i), NO_DAMPING)
            places, linear = places[~linear], linear[~linear]
        rows = self.rows[places]
        for i in places[linear].tolist():
            self.model[i], self.error_kind[i] = str(ModelWord.NO_REVERSAL), "guaranteed"
        closed = rows[:, curve.RESIDUAL] <= 1e3 * rows[:, curve.ROUNDING]
        good = closed & (rows[:, curve.ERROR] <= min(self.tolerance, FARTHEST)) & (self.mass.damping > 0.0)
        for i in places[~linear & ~good].tolist():
            self._judge_one(i)

    def _judge_one(self, i: int) -> None:
        row = self.rows[i]
        if not row[curve.RESIDUAL] <= 1e3 * row[curve.ROUNDING]:
            undamped = "; a load in undamped resonance may let it grow without bound" * (
                self.mass.damping == 0.0
            )
            self._lose(
                i, f"no fixed point of the return map found: residual {row[curve.RESIDUAL]:.1e}{undamped}"
            )
        elif self.mass.damping == 0.0 and not row[curve.FLOQUET] < 1.0 - 1e-9:
            self._lose(
                i,
                f"without damping the orbit is not attractive: largest multiplier {row[curve.FLOQUET]:.9f}",
            )
        elif not row[curve.ERROR] < math.inf:
            self._lose(i, "the motion over one period is smaller than the rounding error of its position")
        elif row[curve.ERROR] > self.tolerance:
            self.reason[i] = f"error {row[curve.ERROR]:.1e} above the tolerance: only rounding errors remain"

    def _lose(self, i: int, reason: str) -> None:
        self.fail(i, reason)
        self.rows[i] = np.nan

    def _floquet(self) -> Floats:
        """Return the largest multiplier of each scene; in the plane that of x2 counts, too, and is not known."""
        if self.scenes[0].degrees_of_freedom == 1:
            return self.rows[:, curve.FLOQUET]
        # x2 obeys x2'' + (2 b2 wr + f/|w|) x2' + wr^2 x2 = 0 along the orbit: no closed form, and not computed.
        return np.full(len(self.scenes), np.nan)

    def _multipliers(self) -> Multipliers:
        known = self._floquet()
        return Multipliers(known, SALTATION * np.maximum(known, 1.0), [""] * len(known))

    def _orbits(self, places: Sequence[int]) -> Orbits:
        """Return the orbits of the scenes at these places; one that does not exist has no panels."""
        rows, ends = self.rows[list(places)], np.zeros(len(places), np.int64)
        speeds, legs = self.belt_speeds[list(places)], np.nan_to_num(rows[:, curve.LEGS])
        sides = self.sides[list(places)]
        shifts = np.where(sides < 0.0, self._shift(-1.0), self._shift(1.0))
        states = np.column_stack([rows[:, curve.STATE_X], rows[:, curve.STATE_W], legs, shifts, sides])
        track = KernelCall(make_orbits)(self.forcing, speeds, states, ends)
        filled = slice(ends[-1])  # the rest of a track has never been written
        parts = track.x[filled], track.v[filled], track.friction[filled], track.stick[filled]
        return Orbits(track.tau[filled], *parts, ends)


def _permanent_stick(low: float, high: float) -> str:
    within = f"within {high:.6g} of zero" if math.isclose(low, -high) else f"between {low:.6g} and {high:.6g}"
    return (
        "the belt is at rest and the load never exceeds friction: the mass stays where it starts, "
        f"with any mean friction {within}; give scene.initial"
    )
