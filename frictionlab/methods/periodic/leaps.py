"""Lead a motion over many periods at once if it changes slowly from one period to the next.

Near a state s the map of a period takes s + d to s + G + M d, with M its derivative. H repetitions of this
affine map lead from s to s + (1 + M + ... + M^(H-1)) G, whatever the multipliers. True maps at the end of
such a leap and on the way measure its error, which chooses H. With H = 1 the leap is the motion itself. The
number of maps depends on how often the motion bends, not on how many periods it takes.

Licence, measured on a body under a plate that vibrates at 26 kHz (LuGre, multipliers within 4e-4 of one):
starts end after 77 to 89 maps; 7,000 maps period by period leave 8 of 9 starts open
(tests/methods/shooting/test_leaps.py).
"""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Protocol

import numpy as np

from frictionlab.methods.periodic.attraction import KnownOrbit
from frictionlab.values.quantities import Floats

FEW_MAPS, MOST_MAPS, PAYS = 2000, 5000, 5
"""Numbers of true maps after which no further leap is tried: MOST_MAPS if each has led over PAYS periods."""
MOST_LEAP_STEPS = 5_000_000
"""Number of steps in all maps after which no further leap is tried."""
SHARE, FLOOR = 0.02, 1e-9
"""Largest error of a leap: SHARE of the distance that it leads, plus FLOOR of the size of the state."""
ON_THE_WAY = (0.11, 0.3, 0.62, 0.83)
"""Fractions of a leap at which true maps are made: its end alone does not show every change on the way."""
MOST_ON_A_SPIRAL = 16
"""Largest number of states on the way to an orbit at which a true map is compared with the affine map.

The affine map is that of the orbit's monodromy matrix."""
OBEYED = 0.1
"""Largest error of the affine map there, over the change by a map."""


FARTHEST_LEAP = 3.0
"""Largest distance of a leap, over the largest size of the motion so far: farther out maps cost millions of steps."""
LONGEST = 1_000_000_000
"""Largest number of maps of one leap."""
CLOSED_FROM = 0.05
"""Step of Newton's method, over the size of a state, from which an orbit is closed beside a motion."""


class Section(Protocol):
    """Map of a motion from one section to the next: a period of the drive, or a passage of a level."""

    @property
    def noise(self) -> float:
        """Error of a map."""

    def size(self, state: Floats) -> float:
        """Return the size of what moves in a state."""

    def price(self, state: Floats) -> float:
        """Return the number of steps that the map of a state takes; 0 if that does not matter."""

    def mapped(self, states: Floats) -> Floats:
        """Return the images of states [count, size]; NaN where there is none."""

    def derivative(self, state: Floats) -> Floats:
        """Return the derivative of the map at a state."""


@dataclass
class Leaper:
    """Motion that is led on by leaps.

    state: state reached so far. periods: maps passed so far. maps: true maps made so far, including those for
    derivatives. price: steps that a map takes, measured anew where the motion has grown tenfold.
    """

    section: Section
    state: Floats
    periods: int = 0
    maps: int = 0
    price: float = 0.0

    def __post_init__(self) -> None:
        self._length = 2 * self.fewest
        self._size, self._priced = 0.0, 0.0

    def lead(
        self, known: Callable[[], Sequence[KnownOrbit]], close_beside: Callable[[Floats], object]
    ) -> KnownOrbit | None:
        """Lead the motion on to the known orbit where it ends; None where leaps no longer pay.

        known: orbits known so far, to which ``close_beside`` may add the one beside a state.
        """
        set_out, tried, self._length = self.state, math.inf, 2 * self.fewest
        while (newton := self.leap()) is not None:
            size, left = self.section.size(self.state), float(np.linalg.norm(newton))
            if left < CLOSED_FROM * size and left < 0.3 * tried:
                tried = left
                close_beside(self.state)
            for orbit in known():
                away, before = (float(np.linalg.norm(at - orbit.state)) for at in (self.state, set_out))
                near = orbit.gap > 0.0 and away <= max(0.1 * before, 1e-3 * size)
                if near and self.ends_on(orbit):
                    return orbit
        return None

    @property
    def fewest(self) -> int:
        """Number of periods of the shortest leap: it costs no more than as many true maps."""
        return self.state.size + 3

    @property
    def _most(self) -> float:
        most = MOST_MAPS if self.periods > PAYS * self.maps else FEW_MAPS
        return min(most, MOST_LEAP_STEPS / max(self.price, 1.0))

    def leap(self) -> Floats | None:
        """Lead the motion on by one leap.

        Return Newton's step from the state before the leap; None if a leap no longer pays.
        """
        base = self._mapped(self.state[None])[0] - self.state
        matrix = self._derivative()
        self._size = max(self._size, self.section.size(self.state))  # a motion from rest has none at first
        if self._size > 10.0 * self._priced:
            self.price, self._priced = self.section.price(self.state), self._size
        length = self._within_growth(matrix)
        while length >= self.fewest and np.isfinite(matrix).all() and self.maps < self._most:
            power, total = power_sum(matrix, length)
            moved = total @ base
            if not np.linalg.norm(moved) <= FARTHEST_LEAP * self._size:
                length //= 2
                continue
            parts = [power_sum(matrix, max(1, int(share * length))) for share in ON_THE_WAY]
            error, defect = self._missed([(power, total), *parts], base)
            allowed = SHARE * float(np.linalg.norm(moved)) + FLOOR * self._size
            ratio = error / allowed if math.isfinite(error) else math.inf
            if ratio <= 1.0:
                self.state = self.state + moved + defect / 3.0  # one order more
                self.periods += length
                self._length = int(min(LONGEST, length * min(8.0, 0.9 * max(ratio, 1e-6) ** (-1 / 3))))
                return _newton(matrix, base)
            length = int(length * max(0.1, 0.8 * ratio ** (-1 / 3))) if math.isfinite(ratio) else length // 10
        return None

    def ends_on(self, orbit: KnownOrbit) -> bool:
        """Check that the motion goes to an orbit: true maps along the way must agree with its affine map."""
        away = self.state - orbit.state
        # distances below the error of the orbit itself, measured by a fine map, cannot be told apart
        off = float(np.linalg.norm(self._mapped(orbit.state[None])[0] - orbit.state))
        noise = 2.0 * off + self.section.noise
        steps = _spread(orbit.monodromy)
        powers = [np.linalg.matrix_power(orbit.monodromy, step) for step in steps]
        places = np.array([orbit.state + power @ away for power in powers])
        ends = self._mapped(places)
        before, after = places - orbit.state, ends - orbit.state
        predicted = before @ orbit.monodromy.T
        changed = np.linalg.norm(predicted - before, axis=1)
        missed = np.linalg.norm(predicted - after, axis=1)
        return bool((missed <= OBEYED * changed + noise).all())

    def _missed(self, sums: list[tuple[Floats, Floats]], base: Floats) -> tuple[float, Floats]:
        """Return the error of a leap, and its defect at the end, from true maps at its end and on the way.

        sums: ``power_sum`` of the whole leap, then of its parts.
        """
        places = np.array([self.state + total @ base for _, total in sums])
        expected = np.array([power @ base for power, _ in sums])
        defects = (self._mapped(places) - places - expected) @ sums[0][1].T
        return float(np.linalg.norm(defects, axis=1).max()) / 3.0, defects[0]

    def _within_growth(self, matrix: Floats) -> int:
        """Return the length of the next leap, in which a growing deviation grows a thousandfold at most."""
        if not np.isfinite(matrix).all():
            return 0
        radius = float(np.abs(np.linalg.eigvals(matrix)).max())
        return (
            min(self._length, int(math.log(1e3) / math.log(radius))) if radius > 1.0 + 1e-12 else self._length
        )

    def _mapped(self, states: Floats) -> Floats:
        self.maps += len(states)
        return self.section.mapped(states)

    def _derivative(self) -> Floats:
        self.maps += 2 * self.state.size
        return self.section.derivative(self.state)


def power_sum(matrix: Floats, length: int) -> tuple[Floats, Floats]:
    """Return M^H and 1 + M + ... + M^(H-1) by repeated squaring."""
    power, total = np.eye(len(matrix)), np.zeros_like(matrix)
    for bit in bin(length)[2:]:
        total, power = total + power @ total, power @ power
        if bit == "1":
            total, power = total + power, power @ matrix
    return power, total


def _newton(matrix: Floats, base: Floats) -> Floats:
    """Return the shortest step to the fixed point of an affine map; infinity if it has none."""
    moves = np.eye(len(base)) - matrix
    step = np.asarray(np.linalg.lstsq(moves, base, rcond=1e-7)[0])
    missed = np.linalg.norm(moves @ step - base) > 0.1 * np.linalg.norm(base)
    return np.full_like(step, math.inf) if missed else step


def _spread(matrix: Floats) -> list[int]:
    """Return numbers of periods at which the way to an orbit is checked.

    After the last of them a hundredth of the distance is left.
    """
    modulus = np.abs(np.linalg.eigvals(matrix))
    slowest = float(modulus[modulus < 1.0 - 1e-9].max(initial=1e-3))
    last = max(1, int(math.log(0.01) / math.log(max(slowest, 1e-3))))
    if last <= MOST_ON_A_SPIRAL:
        return list(range(last + 1))
    half = MOST_ON_A_SPIRAL // 2
    return sorted({*range(half), *np.geomspace(half, last, half).astype(int).tolist()})
