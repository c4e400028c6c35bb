"""One motion marched to its steady state: from scene numbers to kernel and back, one run per step size or width."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace

import numpy as np

from frictionlab.compile.call import KernelCall
from frictionlab.compile.interpret import interpreted
from frictionlab.laws.base import FrictionLaw
from frictionlab.methods.march.lap import MarchSettings
from frictionlab.methods.march.laps import (
    CLOSED,
    RESTING,
    STALLED,
    TOO_STIFF,
    MarchHistory,
    MarchState,
    march_laps,
)
from frictionlab.methods.march.steppers import (
    STEPPERS,
    Resolution,
    StepperName,
    fastest_slip,
    fewest_steps,
    first_memory,
    lightest_contact,
    memory_stiffness,
    shares_of_load,
    steps_through_rest,
)
from frictionlab.methods.periodic.problem import along_the_belt
from frictionlab.motion.equation import mean_friction, quickest_of, span
from frictionlab.motion.orbit.record import Orbit
from frictionlab.scene.body import Mass, in_the_plane, on_the_line
from frictionlab.scene.scene import Initial, Scene
from frictionlab.values.quantities import Floats

LONGEST_PERIOD = 8
"""Longest period of a response that repeats only after several laps."""


@dataclass(frozen=True)
class MarchResult:
    """Means of a run over one period of the response.

    Low and high are the extremes of the mean over one lap, over the laps it was watched for.
    """

    pace: Resolution
    place: MarchState
    mean: complex
    low: float
    high: float
    laps: int
    period: float  # time
    verdict: int
    rate: float
    steps: int
    stride: int
    drift: float  # gap of the last lap, in the norm of energy
    met: float  # most slip

    @property
    def settled(self) -> bool:
        """Check whether there is a mean to speak of."""
        return self.verdict in (CLOSED, STALLED, RESTING)


class MarchRun:
    """Everything of a scene and a law that does not change from run to run; counts the seconds."""

    def __init__(self, scene: Scene, law: FrictionLaw, stepper: StepperName) -> None:
        self.scene, self.law, self.stepper, self.facts = scene, law, stepper, STEPPERS[stepper]
        self.mass: Mass = scene.mass()
        self.through_rest = steps_through_rest(scene, law, self.facts)
        start = scene.initial
        starts_across = start is not None and (start.x2 != 0.0 or start.velocity2 != 0.0)
        self.straight = straight = along_the_belt(scene, law) and not starts_across
        # a lap is a period of everything that changes in time: so many of the drive
        self.periods = 1.0 if scene.is_harmonic else float(scene.periods)
        planar = in_the_plane(self.mass, self.periods)
        self.body = on_the_line(self.mass, self.periods) if straight else planar
        self.lightest, _ = shares_of_load(scene)
        sine, cosine = self.body.reference_sine, self.body.reference_cosine
        self._free = complex(cosine), complex(scene.frequency * sine)
        self._fresh, self._spring = first_memory(scene, law), memory_stiffness(scene, law)
        self.start = self.place(scene.start if scene.undriven else scene.initial)
        # on a belt at rest the mass stays wherever a run left it
        self.forgets = scene.belt_speed != 0.0
        self.drive_period = 2.0 * math.pi / self.mass.frequency
        self.lap: float = interpreted(span)(self.body)
        self.window = self._relaxing()
        self.seconds = 0.0

    def place(self, start: Initial | None) -> MarchState:
        """A start as a state; None for the friction-free orbit."""
        if start is None:
            return MarchState(*self._free, self._fresh)
        return MarchState(complex(start.x, start.x2), complex(start.velocity, start.velocity2), self._fresh)

    def fewest(self) -> int:
        """Steps per period that the stepper needs not to explode; 1 where any number will do."""
        return fewest_steps(self.scene, self.law, self.facts)

    def run(self, pace: Resolution, place: MarchState | None = None) -> MarchResult:
        """March to the steady state, period doublings included."""
        place = place or self.start
        march = self._marched(pace, self._way(pace), place)
        run = self._read(march, pace, 1)
        stride = _stride(march) if march.progress.verdict == STALLED else 1
        if stride > 1:
            longer = self._marched(pace, self._way(pace)._replace(stride=stride, rate=0.0), run.place)
            other = self._read(longer, pace, stride)
            run = replace(other, steps=run.steps + other.steps) if other.verdict == CLOSED else run
        return run

    def track(self, run: MarchResult, laps: int) -> Orbit:
        """So many laps, from the end of a run that settled."""
        room = 2 * laps * (run.steps // run.laps + 50)
        way = self._way(run.pace)._replace(most=laps, stride=laps + 1, room=room)
        march = self._marched(run.pace, way, run.place)
        track, n = march.track, int(march.track.filled[0])
        tau = track.tau[:n] + _offsets(track.tau[:n])[:, None]
        return Orbit(tau, track.x[:n], track.v[:n], track.friction[:n], track.stick[:n])

    def fastest(self, pace: Resolution) -> float:
        """Return the slip speed that steps of this pace can bear."""
        if not self.facts.limited_by_rates:
            return 1e300
        return fastest_slip(
            self.law, self.facts, self.drive_period / pace.steps / lightest_contact(self.scene)
        )

    def _relaxing(self) -> int:
        """Laps in which a drift towards the steady state dies out by a third, at least fifty and at most 2000."""
        damping = self.mass.damping if self.straight else min(self.mass.damping, self.mass.transverse_damping)
        slow = max(1.0, 2.0 / damping if damping > 0.0 else 1.0, self.mass.damping)
        return int(min(2000.0, max(50.0, slow / self.drive_period)))

    def _marched(self, pace: Resolution, way: MarchSettings, place: MarchState) -> MarchHistory:
        real = self.straight or self.law.memory_kind == "scalars"
        x, v = (place.x.real, place.v.real) if self.straight else (place.x, place.v)
        z = np.array(place.z.real) if real else place.z.astype(complex)
        history: MarchHistory
        numbers = self.body, self.facts.record(pace), way, MarchState(x, v, z)
        history, seconds = KernelCall(march_laps, self.law).timed(*numbers)
        self.seconds += seconds
        return history

    def _way(self, pace: Resolution) -> MarchSettings:
        driven, h = not self.scene.undriven, self.drive_period / pace.steps
        adaptive = self.facts.adaptive
        quickest: float = interpreted(quickest_of)(self.body)
        reach = 2.0 * math.pi / quickest / 12.0 if adaptive else h
        return MarchSettings(
            belt_speed=self.scene.belt_speed,
            driven=driven,
            steps=pace.steps if driven and self.facts.gridded else 1,
            span=self.lap if driven else self.lap * pace.most,
            first=1e-3 * reach if adaptive else h,
            slack=0.5 if driven and not adaptive else 1e-9,
            reach=reach,
            enough=pace.enough,
            most=pace.most,
            stride=1,
            rate=pace.rate,
            work=pace.work,
            window=self.window,
            room=0,
            spring=self._spring,
            fastest=self.fastest(pace),
            refined=0 if adaptive else pace.refined,
            lightest=self.lightest,
        )

    def _read(self, march: MarchHistory, pace: Resolution, stride: int) -> MarchResult:
        laps = len(march.laps.impulse)
        window = min(self.window * stride if march.progress.verdict == STALLED else stride, laps)
        time = float(march.laps.duration[-window:].sum())
        mean = interpreted(mean_friction)(complex(march.laps.impulse[-window:].sum()), time)
        each = interpreted(mean_friction)(march.laps.impulse[-window:].real, march.laps.duration[-window:])
        low, high = float(each.min()), float(each.max())
        drift = self._apart(march, laps, laps - stride)
        stiff = march.trace.reverses and pace.steps < self.through_rest
        return MarchResult(
            pace=pace,
            place=MarchState(complex(march.laps.x[-1]), complex(march.laps.v[-1]), march.laps.z[-1]),
            mean=mean,
            low=low,
            high=high,
            laps=laps,
            period=time / window * stride,
            verdict=TOO_STIFF if stiff else int(march.progress.verdict),
            rate=float(march.rate),
            steps=int(march.progress.steps),
            stride=stride,
            drift=drift,
            met=float(march.trace.met),
        )

    def _apart(self, march: MarchHistory, a: int, b: int) -> float:
        b = max(b, 0)
        dx, dv, dz = (
            march.laps.x[a] - march.laps.x[b],
            march.laps.v[a] - march.laps.v[b],
            march.laps.z[a] - march.laps.z[b],
        )
        with np.errstate(over="ignore", invalid="ignore"):  # of a motion that grows without bound
            across = self.mass.transverse_stiffness * dx.imag**2
            bent = float(np.dot(self._spring, np.abs(dz) ** 2))
            return float(np.sqrt(dx.real**2 + across + abs(dv) ** 2 + bent))


def _stride(march: MarchHistory) -> int:
    """After how many laps a motion that does not close every lap comes nearest to repeating."""
    points = np.stack([march.laps.x.real, march.laps.v.real, march.laps.x.imag, march.laps.v.imag], axis=1)[
        -3 * LONGEST_PERIOD :
    ]
    gaps = [
        float(np.abs(points[n:] - points[:-n]).max(axis=1)[-LONGEST_PERIOD:].mean())
        for n in range(1, LONGEST_PERIOD + 1)
    ]
    best = int(np.argmin(gaps))
    return best + 1 if gaps[best] < 0.1 * gaps[0] else 1


def _offsets(tau: Floats) -> Floats:
    """Return what to add to each panel's time so that laps, each from zero, follow each other."""
    offsets = np.zeros(len(tau))
    for i in np.flatnonzero(tau[1:, 0] < tau[:-1, 0]):
        offsets[i + 1 :] += tau[i, -1]
    return offsets
