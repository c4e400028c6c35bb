"""A mass on the line under Coulomb friction by an unrelated event-driven integration (scipy, DOP853).

Written for tests alone, from the equation of motion and the words on waveforms alone: it shares no formula and no
code with the methods it checks. Modes are slip of either sign and stick; integration stops at every corner.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import Any, NamedTuple

from scipy.integrate import solve_ivp

CORNERS = {"square": (0.0, math.pi), "triangle": (0.5 * math.pi, 1.5 * math.pi), "sawtooth": (math.pi,)}


class Wave(NamedTuple):
    """size*waveform(frequency*tau + phase); terms (order, amplitude, phase) of a sum of harmonics."""

    shape: str
    size: float
    frequency: float
    phase: float
    terms: tuple[Any, ...] = ()

    def near(self, middle: float) -> Callable[[float], tuple[float, float]]:
        """Value and rate as functions of time, as they go on from the piece around ``middle``."""
        size, w, phase = self.size, self.frequency, self.phase
        if self.shape == "sine":
            return lambda t: (size * math.sin(w * t + phase), size * w * math.cos(w * t + phase))
        if self.shape == "harmonics":
            return lambda t: _harmonics(self, w * t + phase)
        theta = (w * middle + phase) % (2.0 * math.pi)
        if self.shape == "square":
            value, slope = (1.0 if theta < math.pi else -1.0), 0.0
        elif self.shape == "triangle":
            value = 2.0 / math.pi * math.asin(math.sin(theta))
            slope = 2.0 / math.pi * (1.0 if math.cos(theta) > 0.0 else -1.0)
        else:
            value, slope = ((theta + math.pi) % (2.0 * math.pi)) / math.pi - 1.0, 1.0 / math.pi
        return lambda t: (size * (value + slope * w * (t - middle)), size * slope * w)

    def corners(self, end: float) -> list[float]:
        """Between 0 and ``end``."""
        every = CORNERS.get(self.shape, ()) if self.size else ()
        turns = range(-2, math.ceil(end * self.frequency / (2.0 * math.pi)) + 2)
        found = [(each + 2.0 * math.pi * k - self.phase) / self.frequency for each in every for k in turns]
        return [tau for tau in found if 1e-12 * end < tau < (1.0 - 1e-12) * end]


def _harmonics(wave: Wave, theta: float) -> tuple[float, float]:
    value = rate = 0.0
    for order, amplitude, phase in wave.terms:
        angle = order * theta + math.radians(phase)
        value += wave.size * amplitude * math.sin(angle)
        rate += wave.size * amplitude * order * wave.frequency * math.cos(angle)
    return value, rate


class Followed(NamedTuple):
    """Mean friction over the last common period, how far that was from closing, and the state at its end."""

    mean: float
    closing: float
    x: float
    v: float


def waves_of(scene: Any) -> tuple[Wave, Wave, Wave]:
    """Load, belt vibration and share that the normal load varies by."""
    omega, drive = scene.frequency, scene.drive
    size = 0.0
    if drive is not None:
        size = drive.amplitude if drive.amplitude is not None else drive.unbalance * omega**2
    load = _wave(drive, size, omega)
    belt, press = scene.belt_vibration, scene.normal_load_variation
    along = 0.0 if belt is None else belt.velocity_amplitude * math.cos(math.radians(belt.direction))
    return load, _wave(belt, along, omega), _wave(press, press.amplitude if press else 0.0, omega)


def _wave(part: Any, size: float, omega: float) -> Wave:
    if part is None:
        return Wave("sine", 0.0, omega, 0.0)
    form, ratio = part.waveform, getattr(part, "frequency_ratio", None) or 1.0
    shape, terms = ("sine", ()) if form is None else (form.shape, form.terms)
    return Wave(shape, size, omega * ratio, math.radians(part.phase), terms)


class Motion:
    """Follows one scene; fineness: least steps per period of the quickest wave and of the free oscillation."""

    def __init__(self, scene: Any, mu: float, fineness: int = 100) -> None:
        self.b, self.n0, self.vb, self.mu = scene.damping_ratio, scene.normal_load, scene.belt_speed, mu
        self.waves = waves_of(scene)
        self.end = 2.0 * math.pi / scene.frequency * scene.periods
        inside = sorted({tau for wave in self.waves for tau in wave.corners(self.end)})
        self.edges = [
            0.0,
            *(t for k, t in enumerate(inside) if not k or t - inside[k - 1] > 1e-12 * self.end),
        ]
        self.edges.append(self.end)
        quickest = (
            max(
                wave.frequency * max([1, *(term[0] for term in wave.terms)])
                for wave in self.waves
                if wave.size
            )
            if any(wave.size for wave in self.waves)
            else 1.0
        )
        self.step = 2.0 * math.pi / max(quickest, 1.0, 2.0 * self.b) / fineness

    def period(self, x: float, v: float) -> tuple[float, float, float]:
        """State after a common period from tau = 0 and the impulse of friction; v: of the mass."""
        impulse = 0.0
        for start, stop in zip(self.edges[:-1], self.edges[1:], strict=True):
            self.load, self.belt, self.press = (wave.near(0.5 * (start + stop)) for wave in self.waves)
            x, v, gained = self._piece(start, stop, x, v)
            impulse += gained
        return x, v, impulse

    def _net(self, t: float, x: float) -> tuple[float, float]:
        """Force that holds the mass on the belt, and the limit of friction."""
        (vibration, jolt), load = self.belt(t), self.load(t)[0]
        held = load - 2.0 * self.b * (self.vb + vibration) - x - jolt
        return held, self.mu * self.n0 * (1.0 + self.press(t)[0])

    def _piece(self, start: float, stop: float, x: float, v: float) -> tuple[float, float, float]:
        t, impulse = start, 0.0
        w = v - self.vb - self.belt(t)[0]
        resting = abs(w) < 1e-11 * (abs(v) + abs(self.vb) + abs(self.belt(t)[0]) + 1e-3)
        mode = self._after_rest(t, x) if resting else (1 if w > 0.0 else -1)
        for _ in range(100_000):
            if t >= stop:
                break
            solved = solve_ivp(
                self._rates(mode),
                (t, stop),
                [x, self.vb + self.belt(t)[0] if mode == 0 else v, 0.0],
                method="DOP853",
                rtol=1e-12,
                atol=1e-13 * (abs(x) + abs(v) + 1.0),
                max_step=self.step,
                events=self._events(mode),
            )
            x, v, gained = (float(part[-1]) for part in solved.y)
            t, impulse = float(solved.t[-1]), impulse + gained
            if solved.status == 1:
                v = self.vb + self.belt(t)[0]
                mode = self._after_rest(t, x) if mode else (1 if self._net(t, x)[0] > 0.0 else -1)
        if mode == 0:
            v = self.vb + self.belt(stop)[0]
        return x, v, impulse

    def _after_rest(self, t: float, x: float) -> int:
        held, limit = self._net(t, x)
        return 0 if abs(held) <= limit else (1 if held > 0.0 else -1)

    def _rates(self, mode: int) -> Any:
        def stuck(t: float, y: Any) -> list[float]:
            vibration, jolt = self.belt(t)
            return [self.vb + vibration, jolt, self._net(t, y[0])[0]]

        def slipping(t: float, y: Any) -> list[float]:
            friction = mode * self.mu * self.n0 * (1.0 + self.press(t)[0])
            return [y[1], self.load(t)[0] - 2.0 * self.b * y[1] - y[0] - friction, friction]

        return slipping if mode else stuck

    def _events(self, mode: int) -> list[Any]:
        def slip(t: float, y: Any) -> float:
            return mode * (y[1] - self.vb - self.belt(t)[0])

        def above(t: float, y: Any) -> float:
            held, limit = self._net(t, y[0])
            return limit - held

        def below(t: float, y: Any) -> float:
            held, limit = self._net(t, y[0])
            return limit + held

        events: list[Any] = [slip] if mode else [above, below]
        for each in events:
            each.terminal, each.direction = True, -1.0
        return events


def follow(scene: Any, mu: float, start: tuple[float, float], periods: int, fineness: int = 100) -> Followed:
    """So many common periods from start = (x, v) at tau = 0."""
    motion = Motion(scene, mu, fineness)
    x, v = start
    for _ in range(periods):
        before = x, v
        x, v, impulse = motion.period(x, v)
    closing = math.hypot(x - before[0], v - before[1])
    return Followed(-impulse / (motion.n0 * motion.end), closing, x, v)
