"""Memory of a law along a recorded orbit, from the recorded slip and friction.

Friction linear in the deflection of a bristle is solved for the deflection, sample by sample.

Any other memory is integrated along the recorded slip, panel by panel, until it repeats. This is collocation
(Hairer, Nørsett & Wanner, 1993, II.7): at every node but the first of a panel the derivative of the memory
equals the rate of the law. The memory is accepted if its friction is the recorded one.
"""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from frictionlab.compile.interpret import interpreted
from frictionlab.laws.base import FrictionLaw
from frictionlab.laws.memory import BristleLaw, MemoryLaw, bristle_in_the_plane, bristle_on_the_line
from frictionlab.motion.contact import resistance_at_share
from frictionlab.motion.orbit.recorder import DERIVATIVE, NODES
from frictionlab.values.quantities import Floats

_SAME = 1e-6
"""Largest difference between friction of a memory and recorded friction, relative to the largest recorded."""
_STEEP = 1e-3
"""Smallest slope of friction over deflection, relative to that at rest, that gives the deflection."""
_CLOSED = 1e-9
"""Largest change over a period, relative to the memory, at which the memory repeats."""
_SETTLED = 1e-11
"""Largest last step of Newton's method, relative to the memory."""
_MOST_PERIODS, _MOST_STEPS = 4, 12

Numbers = NDArray[np.complex128]


class Contact(NamedTuple):
    """Slip velocity, friction over the mean normal load, normal load over its mean: arrays of equal shape.

    line: True if all motion is along the belt. keeps_stiffness: True if the contact keeps its stiffness while
    the load changes.
    """

    slip: Numbers
    friction: Numbers
    share: Floats
    line: bool
    keeps_stiffness: bool

    def at(self, place: Any) -> tuple[Any, Any, float]:
        """Return slip, friction and share of the load at a place, as laws take them."""
        w, c = complex(self.slip[place]), complex(self.friction[place])
        return (w.real, c.real, float(self.share[place])) if self.line else (w, c, float(self.share[place]))


def deflections(law: BristleLaw, contact: Contact) -> Numbers:
    """Return the deflection of a bristle from its friction; NaN if friction does not give it."""
    resistance: Any = bristle_on_the_line if contact.line else bristle_in_the_plane
    found = np.full(contact.slip.shape, np.nan + 0j)
    for place in np.ndindex(contact.slip.shape):
        w, c, n = contact.at(place)
        z = _deflection(resistance, law, w, c / n)
        found[place] = z * n if contact.keeps_stiffness else z
    return found


def _deflection(resistance: Any, law: BristleLaw, w: Any, c: Any) -> Any:
    """Return z whose friction at slip w is c, if friction is linear in z; else NaN."""
    none = 0.0 * w
    by_axis = isinstance(w, complex) and law.planar_form() == "per-axis"
    one = none + (1.0 + 1.0j if by_axis else 1.0)
    begin = resistance(law, w, none)[1]
    slope, at_rest = resistance(law, w, one)[1] - begin, law.friction(0.0, 1.0, 0.0)
    if min(abs(slope.real), abs(slope.imag) if by_axis else abs(slope)) < _STEEP * abs(at_rest):
        return np.nan
    along, across = (c - begin).real, (c - begin).imag
    z = complex(along / slope.real, across / slope.imag) if by_axis else (c - begin) / slope
    meets = abs(resistance(law, w, z)[1] - c) <= _SAME * (abs(c) + abs(begin))
    return z if meets else np.nan


def followed(law: FrictionLaw, tau: Floats, contact: Contact) -> Numbers | None:
    """Return periodic memories along an orbit [panels, nodes, count].

    Return None if the memory is not found, does not repeat, or has other friction than was recorded.
    """
    path, start = _Path(law, contact), _in_sliding(law, contact)
    for _ in range(_MOST_PERIODS):
        found = _one_period(path, tau, start)
        if found is None:
            return None
        if np.abs(found[-1, -1] - found[0, 0]).max() <= _CLOSED * np.abs(found).max():
            return found if path.meets(found) else None
        start = found[-1, -1]
    return None


def _in_sliding(law: FrictionLaw, contact: Contact) -> Numbers:
    """Return memories of steady sliding at the fastest slip of the orbit; zero if nothing slips.

    For a bristle this is the presliding length, along the slip.
    """
    w = contact.at(np.unravel_index(np.abs(contact.slip).argmax(), contact.slip.shape))[0]
    if w == 0.0:
        return np.zeros(law.count(), np.complex128)
    if isinstance(law, MemoryLaw):
        return np.array([law.steady(w, k) for k in range(law.count())], np.complex128)
    return np.array([law.presliding() * w / abs(w)], np.complex128)


class _Path(NamedTuple):
    """Law along a recorded contact."""

    law: FrictionLaw
    contact: Contact

    def resistance(self, place: Any, memory: Numbers) -> tuple[list[Any], Any]:
        """Return the rates of all memories at a place, and the friction force over the mean normal load."""
        law, (w, _, n) = self.law, self.contact.at(place)
        scalars = self.contact.line or law.memory_kind == "scalars"
        held: list[Any] = [float(each.real) if scalars else complex(each) for each in memory]
        if self.contact.keeps_stiffness:
            rate, friction = interpreted(resistance_at_share)(law, w, held[0], n)
            return [rate], n * friction
        if isinstance(law, BristleLaw):
            rate, friction = (bristle_on_the_line if self.contact.line else bristle_in_the_plane)(
                law, w, held[0]
            )
            return [rate], n * friction
        assert isinstance(law, MemoryLaw)
        rates = [law.rate(w, held, k) for k in range(law.count())]
        return rates, n * law.friction(w, held, rates)

    def meets(self, found: Numbers) -> bool:
        """Check whether friction at these memories is the recorded one."""
        most = np.nanmax(np.abs(self.contact.friction))
        return all(
            abs(self.resistance(place, found[place])[1] - self.contact.at(place)[1]) <= _SAME * most
            for place in np.ndindex(self.contact.slip.shape)
        )


def _one_period(path: _Path, tau: Floats, start: Numbers) -> Numbers | None:
    count = len(start)
    found = np.empty((*tau.shape, count), np.complex128)
    for panel in range(len(tau)):
        half = 0.5 * (tau[panel, -1] - tau[panel, 0])
        held = _one_panel(path, panel, half, start)
        if held is None:
            return None
        found[panel], start = held, held[-1]
    return found


def _one_panel(path: _Path, panel: int, half: float, start: Numbers) -> Numbers | None:
    """Solve for the memory of a panel by Newton's method on the rates at all nodes but the first.

    At the first node the memory is known. Return None if the method fails.
    """
    width = 1 if path.contact.line else 2
    nodes, size = NODES.size - 1, len(start) * width

    def unfolded(memory: Numbers) -> Floats:
        return memory.view(np.float64).reshape(*memory.shape, 2)[..., :width].reshape(len(memory), size)

    def folded(numbers: Floats) -> Numbers:
        parts = numbers.reshape(len(numbers), len(start), width)
        return np.asarray(parts[..., 0] + 1j * (parts[..., 1] if width == 2 else 0.0))

    def rates(numbers: Floats) -> Floats:
        memory = folded(numbers)
        rates_at_nodes = [path.resistance((panel, k + 1), memory[k])[0] for k in range(nodes)]
        return unfolded(np.array(rates_at_nodes, np.complex128))

    begin = unfolded(start[None])[0]
    numbers = np.repeat(begin[None], nodes, axis=0)
    linear = np.kron(DERIVATIVE[1:, 1:], np.eye(size))
    for _ in range(_MOST_STEPS):
        here = rates(numbers)
        residual = DERIVATIVE[1:, 1:] @ numbers + DERIVATIVE[1:, :1] * begin - half * here
        shift = 1e-7 * (1e-3 * np.abs(numbers).max() + np.abs(numbers).max(axis=0) + 1e-30)
        jacobian = linear.copy().reshape(nodes, size, nodes, size)
        for column in range(size):
            moved = numbers.copy()
            moved[:, column] += shift[column]
            change = (rates(moved) - here) / shift[column]
            for k in range(nodes):
                jacobian[k, :, k, column] -= half * change[k]
        step = np.linalg.solve(jacobian.reshape(nodes * size, -1), residual.ravel()).reshape(nodes, size)
        numbers = numbers - step
        if not np.isfinite(numbers).all():
            return None
        if np.abs(step).max() <= _SETTLED * np.abs(numbers).max():
            return np.vstack((start[None], folded(numbers)))
    return None
