"""Linear bodies by their frequency response: x1 over force.

With p = i omega, a body of mass m, spring and dashpot that remembers has H(p) = 1/D(p), dynamic stiffness

    D(p) = m p^2 + damping p + stiffness + k (p time)^q / (1 + (p time)^q) + c p^r.

The fourth term is a fractional Zener element in parallel, D^q y = D^q x - y/time^q with the force k y, of order 1 the
standard linear solid; the fifth the Kelvin-Voigt element of order r (Weyl: the derivative of a periodic motion that
has gone on for ever). Powers are principal: D is analytic off the negative real axis. Orders are in (0, 1], so that
neither gives back more than it took.

Sources: Bagley & Torvik (1983); of the fractional Zener element Rossikhin & Shitikova (2010).
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, Protocol

import numpy as np
from numpy.typing import NDArray

from frictionlab.quantities import Floats

ComplexValues = NDArray[Any]


class LinearBody(Protocol):
    """A body of which a force moves x1 linearly.

    mass, damping: of its response to high frequencies, 1/(mass p^2 + damping p + ...). known_to: frequency above
    which ``beyond`` is the response, analytic in p where Re(p/i) is at least that. fastest: frequency above which it
    does not swing by itself. detail: frequency up to which its response in time has details. smooth: whether its
    answer to a jump of force is analytic just after the jump. dissipates: at every frequency."""

    @property
    def mass(self) -> float: ...

    @property
    def damping(self) -> float: ...

    @property
    def known_to(self) -> float: ...

    @property
    def fastest(self) -> float: ...

    @property
    def smooth(self) -> bool: ...

    @property
    def dissipates(self) -> bool: ...

    @property
    def detail(self) -> float: ...

    def __hash__(self) -> int: ...

    def receptance(self, omega: Floats) -> ComplexValues:
        """x1 over force at these circular frequencies >= 0."""
        ...

    def beyond(self, p: ComplexValues) -> ComplexValues:
        """The same as a function of p = i omega, beyond ``known_to``."""
        ...


@dataclass(frozen=True)
class RememberingBody:
    """Mass 1, spring, dashpot, and beside them a relaxing and a fractional element."""

    damping: float
    stiffness: float = 1.0
    relaxation: Any = None
    fractional: Any = None
    mass: float = 1.0

    @property
    def known_to(self) -> float:
        """Twice as far as any pole is from zero: there D is as large as its mass alone."""
        springs = self.stiffness + (2.0 * self.relaxation.stiffness if self.relaxation else 0.0)
        bound = 1.0
        for _ in range(200):
            new = self.damping + springs / bound
            if self.fractional:
                new += self.fractional.coefficient * bound ** (self.fractional.order - 1.0)
            bound = 0.5 * (bound + new)
        return 2.0 * bound

    @property
    def fastest(self) -> float:
        """That of all springs together, hardened by the fractional element."""
        return self.known_to / 2.0

    @property
    def detail(self) -> float:
        """The same."""
        return self.fastest

    @property
    def smooth(self) -> bool:
        """Not where a power that is no whole number remembers."""
        return all(part is None or part.order == 1.0 for part in (self.relaxation, self.fractional))

    @property
    def dissipates(self) -> bool:
        """At every frequency."""
        return self.damping > 0.0 or self.relaxation is not None or self.fractional is not None

    def dynamic_stiffness(self, p: ComplexValues) -> ComplexValues:
        """D(p)."""
        return (self.mass * p + self.damping) * p + self.stiffness + self.memory(p)

    def memory(self, p: ComplexValues) -> ComplexValues:
        """Force over x1 of what remembers."""
        total = np.zeros_like(p)
        if self.relaxation:
            power = (p * self.relaxation.time) ** self.relaxation.order
            total = total + self.relaxation.stiffness * power / (1.0 + power)
        if self.fractional:
            total = total + self.fractional.coefficient * p**self.fractional.order
        return total

    def receptance(self, omega: Floats) -> ComplexValues:
        """1/D(i omega)."""
        return 1.0 / self.dynamic_stiffness(1j * np.asarray(omega, dtype=np.float64))

    def beyond(self, p: ComplexValues) -> ComplexValues:
        """1/D(p)."""
        return 1.0 / self.dynamic_stiffness(p)


def linear_body(scene: Any) -> LinearBody:
    """That of a scene along x1."""
    body = scene.body
    if body is not None and body.receptance is not None:
        measured: LinearBody = body.receptance.body()
        return measured
    remembers = {} if body is None else {"relaxation": body.relaxation, "fractional": body.fractional}
    return RememberingBody(2.0 * scene.damping_ratio, **remembers)
