"""Steady states of generalised Maxwell-slip friction, event by event, with nothing of the package.

Between events every element sticks or slips and the motion is smooth: scipy's DOP853 follows it, and every event
begins a new integration. Periods are repeated until one changes neither the state nor what sticks. One source serves
the line (real numbers) and the plane (complex ones).
"""

from __future__ import annotations

import math
from dataclasses import dataclass, field
from typing import Any

import numpy as np
from scipy.integrate import solve_ivp


@dataclass(frozen=True)
class Elements:
    """The law: parts alpha of the sliding friction and stiffness of each element, and the numbers of s."""

    alpha: Any
    stiffness: Any
    mu_kinetic: float
    mu_static: float
    stribeck_speed: float
    stribeck_exponent: float
    attraction: float
    viscosity: float

    @classmethod
    def of(cls, law: dict[str, Any]) -> Elements:
        """Of a law as a study gives it."""
        share = np.array(law["share"])
        return cls(
            share / share.sum(),
            np.array(law["stiffness"]),
            law["mu_kinetic"],
            law.get("mu_static", law["mu_kinetic"]),
            law.get("stribeck_speed", 1.0),
            law.get("stribeck_exponent", 2.0),
            law["attraction"],
            law.get("viscosity", 0.0),
        )

    def sliding(self, w: Any) -> float:
        """s at slip velocity w."""
        drop = self.mu_static - self.mu_kinetic
        return self.mu_kinetic + drop * math.exp(-((abs(w) / self.stribeck_speed) ** self.stribeck_exponent))

    def rates(self, w: Any, z: Any, slips: Any) -> Any:
        """Of the deflections."""
        speed = abs(w)
        if speed == 0.0:
            return np.where(slips, 0.0 * z, w)
        slipping = self.attraction * (self.alpha / self.stiffness * (w / speed) - z / self.sliding(w))
        return np.where(slips, slipping, w)

    def breakaway(self, w: Any) -> Any:
        """Of every element."""
        return self.alpha * self.sliding(w) / self.stiffness


@dataclass(frozen=True)
class Mechanics:
    """The scene: a driven body, or a prescribed slip; numbers along x1, and x2 where there is motion across."""

    scene: dict[str, Any]

    @property
    def driven(self) -> bool:
        """Whether a body moves."""
        return "drive" in self.scene

    @property
    def planar(self) -> bool:
        """Whether there is motion across the belt."""
        return "transverse" in self.scene or "transverse_slip" in self.scene

    @property
    def frequency(self) -> float:
        """Of the drive or of the slip."""
        return float(self.scene["drive" if self.driven else "slip"]["frequency"])

    def swing(self, t: float) -> Any:
        """The load of a body, the velocity of a prescribed slip."""
        if self.driven:
            along, across = self.scene["drive"], self.scene.get("transverse", {}).get("load")
        else:
            along, across = self.scene["slip"], self.scene.get("transverse_slip")
        first = self._size(along) * math.sin(self.frequency * t + math.radians(along.get("phase", 0.0)))
        if not self.planar:
            return first
        second = self._size(across) * math.sin(self.frequency * t + math.radians(across.get("phase", 0.0)))
        return complex(first, second)

    def _size(self, swing: dict[str, float]) -> float:
        if "unbalance" in swing:
            return swing["unbalance"] * self.frequency**2
        return swing["velocity_amplitude"] if "velocity_amplitude" in swing else swing["amplitude"]

    def restoring(self, x: Any, v: Any) -> Any:
        """Springs and dashpots."""
        along = x.real + 2.0 * self.scene["damping_ratio"] * v.real
        if not self.planar:
            return along
        across = self.scene["transverse"]
        own = across["natural_frequency"]
        return complex(along, own**2 * x.imag + 2.0 * across["damping_ratio"] * own * v.imag)


@dataclass
class Steady:
    """The mean friction of a steady state, that by the mean position, and the events of a period."""

    mean: float
    mean_by_position: float
    periods: int
    reversals: int
    breakaways: int
    state: Any = field(repr=False)
    slips: Any = field(repr=False)


class Contact:
    """A law on a scene; the state is x, v, the integral of x, that of friction, and the deflections."""

    def __init__(self, law: dict[str, Any], scene: dict[str, Any]) -> None:
        self.law, self.mechanics = Elements.of(law), Mechanics(scene)
        self.load, self.belt = scene.get("normal_load", 1.0), scene["belt_speed"]
        self.period = 2.0 * math.pi / self.mechanics.frequency
        self.count = len(law["share"])
        self.kind = complex if self.mechanics.planar else float

    def slip(self, t: float, y: Any) -> Any:
        """Slip velocity."""
        return (y[1] if self.mechanics.driven else self.mechanics.swing(t)) - self.belt

    def rates(self, t: float, y: Any, slips: Any) -> Any:
        """Of the state."""
        w, z = self.slip(t, y), y[4:]
        rub = self.law.stiffness @ z + self.law.viscosity * w
        if self.mechanics.driven:
            a = self.mechanics.swing(t) - self.mechanics.restoring(y[0], y[1]) - self.load * rub
            return np.concatenate(([y[1], a, y[0], rub], self.law.rates(w, z, slips)))
        return np.concatenate(([0.0, 0.0, 0.0, rub], self.law.rates(w, z, slips)))

    def events(self, slips: Any, side: float) -> list[Any]:
        """What ends a piece: reversal (on the line) or unloading of what slips, and breakaway of what sticks."""
        found = []
        if not self.mechanics.planar:
            found.append(_event(lambda t, y, _slips: self.slip(t, y), -side, -1))
        for k in range(self.count):
            if not slips[k]:
                found.append(_event(lambda t, y, _slips, k=k: self._loaded(t, y, k, side), 1.0, k))
            elif self.mechanics.planar:
                found.append(_event(lambda t, y, _slips, k=k: self._along(t, y, k), -1.0, k))
        return found

    def _along(self, t: float, y: Any, k: int) -> float:
        return float((y[4 + k] * self.slip(t, y).conjugate()).real)

    def _loaded(self, t: float, y: Any, k: int, side: float) -> float:
        """Positive where a sticking element is loaded beyond its breakaway."""
        w = self.slip(t, y)
        if not self.mechanics.planar:
            return float(side * y[4 + k] - self.law.breakaway(w)[k])
        return float(min(abs(y[4 + k]) - self.law.breakaway(w)[k], self._along(t, y, k)))

    def over(self, y: Any, slips: Any, rtol: float, steps: int) -> tuple[Any, Any, int, int]:
        """The state, what slips, reversals and breakaways after a period of at least so many steps."""
        y, slips, t, reversals, breakaways = y.copy(), slips.copy(), 0.0, 0, 0
        y[2] = y[3] = 0.0
        w = self.slip(0.0, y)
        side = math.copysign(1.0, w.real)
        for _ in range(100_000):
            for k in range(self.count):
                slips[k] = slips[k] or self._loaded(t, y, k, side) > 0.0
            events = self.events(slips, side)
            done = solve_ivp(
                self.rates,
                (t, self.period),
                y,
                "DOP853",
                events=events,
                args=(slips,),
                rtol=rtol,
                atol=0.01 * rtol,
                max_step=self.period / steps,
            )
            t, y = done.t[-1], done.y[:, -1]
            if done.status == 0:
                return y, slips, reversals, breakaways
            assert done.status == 1, done.message
            which = next(event.element for event, at in zip(events, done.t_events, strict=True) if len(at))
            if which < 0:
                side, slips = -side, np.zeros(self.count, bool)
                reversals += 1
            else:
                breakaways += not slips[which]
                slips[which] = not slips[which]
        raise AssertionError("events without end")

    def steady(self, rtol: float, steps: int, start: Steady | None = None) -> Steady:
        """The periodic state, from rest or from another."""
        y = np.zeros(4 + self.count, self.kind) if start is None else start.state
        slips = np.zeros(self.count, bool) if start is None else start.slips
        for periods in range(1, 2000):
            after, later, reversals, breakaways = self.over(y, slips, rtol, steps)
            change = abs(np.delete(after - y, (2, 3))).max()
            same = bool((later == slips).all())
            y, slips = after, later
            if same and change < max(10.0 * rtol, 1e-12) * max(1.0, abs(y[0]), abs(y[1])):
                mean, position = -y[3].real / self.period, y[2].real / self.period / self.load
                return Steady(mean, position, periods, reversals, breakaways, y, slips)
        raise AssertionError(f"no periodic state: the last period changed the state by {change:g}")


def _event(function: Any, direction: float, element: int) -> Any:
    function.terminal, function.direction, function.element = True, direction, element
    return function
