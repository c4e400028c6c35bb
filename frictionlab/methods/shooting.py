"""Shooting: the period map of adaptive eighth-order steps, stick included, closed by quasi-Newton steps."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import ClassVar

import numpy as np

from frictionlab.kernel import compiled, timed
from frictionlab.laws.base import FrictionLaw, SlidingLaw
from frictionlab.methods.base import Answers, Floats, Method, Orbit, Status
from frictionlab.methods.curve import MOST_PERIODS, Curve, answer_curve, settle
from frictionlab.orbit import READ
from frictionlab.scene import Body, Scene, in_the_plane, on_the_line


class Shooting(Method):
    """Shooting on the period map of any constant sliding law, on the line and in the plane.

    Accepts sliding laws of constant friction (Coulomb) on scenes of one and two degrees of freedom. Integrates
    the deviation from the friction-free response by DOP853 (Hairer, Norsett & Wanner, 1993) with the instants
    of stick and release resolved, and closes the orbit by Broyden's method (1965) with Newton and Picard steps
    where it stalls. The error comes from a last map sixteen times finer: what it leaves open, carried to the
    mean by the contraction of monotone friction.
    """

    name: ClassVar[str] = "shooting"

    def refusal(self, scene: Scene, law: FrictionLaw) -> str | None:
        """Why not: prescribed slip, friction that varies with speed or remembers, no damping across the belt."""
        if scene.degrees_of_freedom == 0:
            return "shooting closes an orbit of the mass, and a prescribed slip leaves it none; use exact"
        if not (isinstance(law, SlidingLaw) and law.constant_sliding_friction() and law.monotone()):
            return "shooting needs a sliding law of constant friction (Coulomb)"
        return None

    def cost(self, scene: Scene, law: FrictionLaw, tolerance: float) -> float:
        """About 0.3 ms in the plane and 0.1 ms on the line at 1e-9; steps grow as tolerance^(-1/8)."""
        return (1e-4 if scene.load_along_belt_only else 3e-4) * (1e-9 / tolerance) ** 0.125

    def solve(self, scenes: Sequence[Scene], law: FrictionLaw, tolerance: float) -> Answers:
        """Answer a curve by continuation in belt speed."""
        found = Found.empty(len(scenes))
        resting = [i for i, scene in enumerate(scenes) if stays_at_rest(scene, law)]
        moving = [i for i in range(len(scenes)) if i not in resting]
        if moving:
            found.take(moving, scenes[0], *_answered([scenes[i] for i in moving], law, None, tolerance))
        for i in resting:
            settled = _settled(scenes[i], law) if scenes[i].initial is not None else None
            if settled is None:
                found.leave_open(i, resting_range(scenes[i], law))
            elif settled[1] < 0:
                found.reason[i] = (
                    f"started from scene.initial the mass still creeps after {MOST_PERIODS} periods"
                )
            else:
                found.take([i], scenes[i], *_answered([scenes[i]], law, settled[0], tolerance))
                found.columns["error"][i] += 1e-11 * settled[1]  # of the steps on the way there
                found.reason[i] = "the state reached from scene.initial; other starts come to rest elsewhere"
        found.judge(tolerance)
        return Answers(
            found.status,
            found.reason,
            [_model(scenes[0])] * len(scenes),
            ["estimated" if status == "ok" else "" for status in found.status],
            found.columns,
            lambda i: _orbit(scenes[i], law, found.states[i], tolerance),
        )


@dataclass(frozen=True)
class Found:
    """What has been found so far of a curve's answers."""

    status: list[Status]
    reason: list[str]
    states: list[Floats | None]
    columns: dict[str, Floats]

    @classmethod
    def empty(cls, n: int) -> Found:
        """Nothing found yet for n scenes."""
        names = [name for name in READ if not name.startswith("mean_position")]
        names += ["error", "mean_low", "mean_high", "window", "period", "floquet", "seconds"]
        return cls(["failed"] * n, [""] * n, [None] * n, {name: np.full(n, np.nan) for name in names})

    def take(self, where: list[int], scene: Scene, curve: Curve, seconds: float) -> None:
        """Take in the closed orbits of the scenes at these places."""
        self.columns["seconds"][where] = seconds / len(where)
        multipliers = np.abs(np.linalg.eigvals(curve.matrices)).max(axis=1)
        for row, i in enumerate(where):
            maps, error = curve.results[row, 3], curve.results[row, 2]
            if maps < 0.0:
                self.reason[i] = f"no steady state found in {-maps:.0f} period maps (error {error:.1e})"
            elif _undamped(scene) and multipliers[row] > 1.0 - 1e-6 and not _at_rest(curve, row):
                self.reason[i] = (
                    "without damping a free oscillation remains, and the state depends on the start"
                )
                self._range(i, curve.results[row, 0], curve.results[row, 0])
            else:
                self._put(i, curve, row)
                self.columns["floquet"][i] = (
                    multipliers[row] if curve.states.shape[1] == _size(scene) else np.nan
                )

    def leave_open(self, i: int, highest: float) -> None:
        """A mass that can rest for ever on a belt at rest: where it rests depends on where it starts."""
        self._range(i, -highest, highest)
        self.reason[i] = (
            "the belt is at rest and friction can hold the loads for ever: the mass stays wherever it stops; "
            "give scene.initial to choose a start"
        )

    def _range(self, i: int, low: float, high: float) -> None:
        self.status[i] = "not_unique"
        self.columns["mean_low"][i], self.columns["mean_high"][i] = low, high
        self.columns["window"][i] = 1.0

    def _put(self, i: int, curve: Curve, row: int) -> None:
        for name, value in zip(READ, curve.columns[row], strict=True):
            if name in self.columns:
                self.columns[name][i] = value
        mean, across, error = curve.results[row, :3]
        self.columns["mean_friction"][i], self.columns["mean_friction_transverse"][i] = mean, across
        self.columns["error"][i], self.columns["period"][i] = error, 1.0
        self.status[i], self.states[i] = "ok", curve.states[row]

    def judge(self, tolerance: float) -> None:
        """Say where the error is above the tolerance."""
        for i, error in enumerate(self.columns["error"]):
            if self.status[i] == "ok" and not error <= tolerance:
                said = f"the error is above the tolerance {tolerance:.1e}"
                self.reason[i] = f"{self.reason[i]}; {said}" if self.reason[i] else said


def stays_at_rest(scene: Scene, law: FrictionLaw) -> bool:
    """Whether friction can hold the loads for ever on a belt at rest."""
    return scene.belt_speed == 0.0 and resting_range(scene, law) >= 0.0


def resting_range(scene: Scene, law: FrictionLaw) -> float:
    """The largest mean friction coefficient of a mass at rest on a belt at rest; negative where none can rest.

    The spring holds k, friction the rest of the load: |load - k| <= limit all the time, a convex set of k,
    symmetric about zero; the mean is k1/normal_load.
    """
    mass = scene.mass()
    limit = mass.normal_load * law.sliding_friction(0.0)
    angle = np.linspace(0.0, np.pi, 721)  # the other half of the ellipse of loads mirrors this one
    turn = np.exp(1j * angle)
    load = (mass.force * turn).imag + 1j * (mass.transverse_force * turn).imag
    load = np.concatenate([load, -load])
    low, high, best = -limit, limit, -np.inf
    for _ in range(6):
        across = np.linspace(low, high, 201)
        room = limit**2 - (load.imag[:, None] - across) ** 2
        half = np.sqrt(np.maximum(room, 0.0))
        upper, lower = (load.real[:, None] + half).min(axis=0), (load.real[:, None] - half).max(axis=0)
        reach = np.where((room >= 0.0).all(axis=0) & (lower <= upper), upper, -np.inf)
        at = int(reach.argmax())
        best = max(best, float(reach[at]))
        width = (high - low) / 50.0
        low, high = across[at] - width, across[at] + width
    return best / mass.normal_load


def _body(scene: Scene) -> tuple[Body, complex]:
    """The body, on the line where nothing pushes across the belt, and a number of the kind of its positions."""
    if scene.load_along_belt_only:
        return on_the_line(scene.mass()), 0.0
    return in_the_plane(scene.mass()), 0j


def _size(scene: Scene) -> int:
    """Of a state that has every degree of freedom: along the line, multipliers across the belt are left out."""
    return 2 * scene.degrees_of_freedom


def _undamped(scene: Scene) -> bool:
    mass = scene.mass()
    return mass.damping == 0.0 or (scene.transverse is not None and mass.transverse_damping == 0.0)


def _at_rest(curve: Curve, row: int) -> bool:
    return bool(curve.results[row, 4] > 1.0 - 1e-9)


def _answered(
    scenes: Sequence[Scene], law: FrictionLaw, state: Floats | None, tolerance: float
) -> tuple[Curve, float]:
    """The curve through these scenes, from a known state at the first where there is one; and kernel time [s]."""
    body, like = _body(scenes[0])
    belt_speeds = np.array([scene.belt_speed for scene in scenes])
    guess = np.empty((0, 0)) if state is None else state[None, :]
    return timed(compiled(answer_curve, law), body, scenes[0].mass(), belt_speeds, guess, tolerance, like)


def _settled(scene: Scene, law: FrictionLaw) -> tuple[Floats, int]:
    """The state reached from scene.initial on a belt at rest, and in how many periods; -1 for never."""
    body, like = _body(scene)
    start = scene.initial
    assert start is not None
    x, v = complex(start.x, start.x2), complex(start.velocity, start.velocity2)
    x, v = (x, v) if isinstance(like, complex) else (x.real, v.real)
    return compiled(settle, law)(body, x, v, 1e-13 * scene.mass().normal_load)


def _model(scene: Scene) -> str:
    if scene.degrees_of_freedom == 2 and scene.load_along_belt_only:
        return "shooting, one degree of freedom: with no load across the belt x2 dies out"
    return f"shooting, {'two degrees' if scene.degrees_of_freedom == 2 else 'one degree'} of freedom"


def _orbit(scene: Scene, law: FrictionLaw, state: Floats | None, tolerance: float) -> Orbit | None:
    if state is None:
        return None
    track = _answered([scene], law, state, tolerance)[0].last
    return Orbit(track.tau, track.x, track.v, track.friction, track.stick)
