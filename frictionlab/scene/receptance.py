"""Linear bodies by their frequency response: x1 over force.

With p = i omega, a body of mass m, spring and dashpot that remembers has H(p) = 1/D(p), dynamic stiffness

    D(p) = m p^2 + damping p + stiffness + k (p time)^q / (1 + (p time)^q) + c p^r.

The fourth term is a fractional Zener element in parallel, D^q y = D^q x - y/time^q with the force k y; of
order 1 it is the standard linear solid. The fifth term is the Kelvin-Voigt element of order r (Weyl: the
derivative of a periodic motion that has gone on for ever). Powers are principal: D is analytic off the
negative real axis. Orders are in (0, 1], so that neither element gives back more work than it took.

Sources: Bagley & Torvik (1983); of the fractional Zener element Rossikhin & Shitikova (2010).

A body's receptance may also be a table, measured or computed by others: it is read, checked and interpolated
here.
"""

from __future__ import annotations

import csv
import hashlib
from dataclasses import dataclass
from functools import cached_property, lru_cache
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from frictionlab.values.quantities import Floats

NEARLY_FREE = 0.3
"""Relative difference from the free mass below which a response counts as that of the free mass.

It is that of one mode at twice its frequency."""
COLUMNS_OF_TABLE = "frequency", "real", "imaginary"
UNITS_OF_TABLE = "_rad_per_s", "_m_per_N", "_m_per_N"
"""Units in which the names of the columns may end if the file is in SI units."""


@dataclass(frozen=True)
class TabulatedBody:
    """Body by x1 over force at these circular frequencies; above the last one it is that of a free mass.

    Between frequencies x1 over force is the cubic through the nearest four values, of the receptance or of
    its inverse without the mass: the receptance is smooth at antiresonances, its inverse at resonances. The
    cubic that changes less if the farthest of the four values is left out is used.
    """

    frequency: tuple[float, ...]
    values: tuple[complex, ...]
    mass: float
    damping: float = 0.0
    smooth: bool = True

    @property
    def known_to(self) -> float:
        """Last frequency of the table."""
        return self.frequency[-1]

    @property
    def detail(self) -> float:
        """Last frequency of the table."""
        return self.frequency[-1]

    @cached_property
    def fastest(self) -> float:
        """Last frequency at which the response is not yet nearly that of the free mass."""
        omega, values = np.array(self.frequency), np.array(self.values)
        far = np.abs(1.0 + self.mass * omega**2 * values) > NEARLY_FREE
        return float(omega[np.flatnonzero(far)[-1]])

    @cached_property
    def digest(self) -> str:
        """Digest of frequencies and values."""
        return hashlib.sha256(repr((self.frequency, self.values)).encode()).hexdigest()[:16]

    @cached_property
    def dissipates(self) -> bool:
        """True if the body dissipates at every frequency of the table but 0."""
        return all(value.imag < 0.0 for value in self.values[1:])

    def receptance(self, omega: Floats) -> ComplexValues:
        """Compute x1 over force at these circular frequencies: interpolated, or beyond the table."""
        at = np.asarray(omega, dtype=np.float64)
        found = np.empty(at.shape, dtype=np.complex128)
        above = at > self.known_to
        found[above] = self.beyond(1j * at[above])
        found[~above] = self._between(at[~above])
        return found

    def beyond(self, p: ComplexValues) -> ComplexValues:
        """Compute x1 over force of the free mass."""
        return 1.0 / (self.mass * np.asarray(p) ** 2)

    def scaled(self, frequency_unit: float, receptance_unit: float) -> TabulatedBody:
        """Return the body with frequency and receptance multiplied by these.

        Its mass is in the new units already.
        """
        values = tuple(receptance_unit * value for value in self.values)
        return TabulatedBody(tuple(frequency_unit * omega for omega in self.frequency), values, self.mass)

    def halved(self) -> TabulatedBody:
        """Return the body with every other row of the table, the last one kept."""
        last = () if len(self.frequency) % 2 else (-1,)
        rows = [*range(0, len(self.frequency), 2), *last]
        return TabulatedBody(
            tuple(self.frequency[k] for k in rows), tuple(self.values[k] for k in rows), self.mass
        )

    def _between(self, at: Floats) -> ComplexValues:
        nodes, values = np.array(self.frequency), np.array(self.values)
        direct = _cubic(nodes, values, at)
        inertia = self.mass if np.isfinite(self.mass) else 0.0
        inverse = _cubic(nodes, 1.0 / values + inertia * nodes**2, at)
        other = 1.0 / (inverse[0] - inertia * at**2)
        return np.where(np.abs(other) ** 2 * inverse[1] < direct[1], other, direct[0])


def _cubic(nodes: Floats, values: ComplexValues, at: Floats) -> tuple[ComplexValues, Floats]:
    """Compute the polynomial through the nearest four nodes, or all if they are fewer, and its change.

    The change is the distance to the polynomial through all of these nodes but the farthest.
    """
    count = min(4, len(nodes))
    first = np.clip(np.searchsorted(nodes, at) - 2, 0, len(nodes) - count)
    x, y = (numbers[first[:, None] + np.arange(count)] for numbers in (nodes, values))
    whole = _lagrange(x, y, at)
    farthest = np.abs(x - at[:, None]).argmax(axis=1)
    kept = np.arange(count) != farthest[:, None]
    less = _lagrange(x[kept].reshape(-1, count - 1), y[kept].reshape(-1, count - 1), at)
    return whole, np.abs(whole - less)


def _lagrange(x: Floats, y: ComplexValues, at: Floats) -> ComplexValues:
    """Compute the polynomials through x and y, by rows, at these places."""
    total = np.zeros(len(at), dtype=np.complex128)
    for j in range(x.shape[1]):
        share = np.ones(len(at))
        for k in range(x.shape[1]):
            if k != j:
                share = share * (at - x[:, k]) / (x[:, j] - x[:, k])
        total = total + share * y[:, j]
    return total


def read_receptance(file: str, free_mass: float | None, in_si: bool = False) -> TabulatedBody:
    """Return the body of a file; with ``in_si`` the names of columns may end in units.

    Raises ValueError with a sentence that begins with the file and the line.
    """
    path = Path(file)
    try:
        stamp = path.stat().st_mtime_ns
    except OSError as problem:
        raise ValueError(f"there is no file {file}") from problem
    frequency, values = _read(file, in_si, stamp)
    return TabulatedBody(frequency, values, np.inf if free_mass is None else free_mass)


@lru_cache(maxsize=16)
def _read(file: str, in_si: bool, _stamp: int) -> tuple[tuple[float, ...], tuple[complex, ...]]:
    rows = list(csv.reader(Path(file).read_text(encoding="utf-8-sig").splitlines()))
    head = [name.strip() for name in rows[0]] if rows else []
    if in_si:
        plain = {f"{name}{unit}": name for name, unit in zip(COLUMNS_OF_TABLE, UNITS_OF_TABLE, strict=True)}
        head = [plain.get(name, name) for name in head]
    if missing := [name for name in COLUMNS_OF_TABLE if name not in head]:
        raise ValueError(
            f"{file}:1: no column {' and '.join(missing)}; it needs frequency, real and imaginary"
        )
    places = [head.index(name) for name in COLUMNS_OF_TABLE]
    frequency: list[float] = []
    values: list[complex] = []
    for line, row in enumerate(rows[1:], 2):
        if not any(cell.strip() for cell in row):
            continue
        try:
            omega, real, imaginary = (float(row[place]) for place in places)
        except (ValueError, IndexError) as problem:
            raise ValueError(f"{file}:{line}: needs three numbers, got {','.join(row)!r}") from problem
        if wrong := _wrong_row(frequency, omega, complex(real, imaginary)):
            raise ValueError(f"{file}:{line}: {wrong}")
        frequency.append(omega)
        values.append(complex(real, imaginary))
    if len(frequency) < 2:
        raise ValueError(f"{file}: needs at least two rows")
    return tuple(frequency), tuple(values)


def _wrong_row(before: list[float], omega: float, value: complex) -> str:
    """Return the mistake in a row that follows those of these frequencies, or ''."""
    if not (np.isfinite(omega) and np.isfinite(value)):
        return "needs finite numbers"
    if not before and omega != 0.0:
        return f"begins at frequency {omega:g}: frequency 0 is required, x1 under a constant force"
    if before and omega == before[-1]:
        return f"frequency {omega:g} is repeated"
    if before and omega < before[-1]:
        return f"frequency {omega:g} after {before[-1]:g}: frequencies must rise"
    if not before and not (value.imag == 0.0 and value.real > 0.0):
        return "at frequency 0 the receptance is real and above 0"
    if value.imag > 0.0:
        return f"not passive at frequency {omega:g}: the imaginary part of x1 over force must not be above 0"
    return "" if value != 0.0 else f"the receptance is 0 at frequency {omega:g}"


ComplexValues = NDArray[Any]


@dataclass(frozen=True)
class RememberingBody:
    """Body of mass 1, spring, dashpot, and beside them a relaxing and a fractional element."""

    damping: float
    stiffness: float = 1.0
    relaxation: Any = None
    fractional: Any = None
    mass: float = 1.0

    @property
    def known_to(self) -> float:
        """Frequency twice as far as any pole is from zero: there D is as large as its mass alone."""
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
        """Frequency of all springs together, hardened by the fractional element."""
        return self.known_to / 2.0

    @property
    def detail(self) -> float:
        """Frequency up to which the response in time has details: ``fastest``."""
        return self.fastest

    @property
    def smooth(self) -> bool:
        """True unless an element has an order that is no whole number."""
        return all(part is None or part.order == 1.0 for part in (self.relaxation, self.fractional))

    @property
    def dissipates(self) -> bool:
        """True if the body dissipates at every frequency."""
        return self.damping > 0.0 or self.relaxation is not None or self.fractional is not None

    def dynamic_stiffness(self, p: ComplexValues) -> ComplexValues:
        """Compute D(p)."""
        return (self.mass * p + self.damping) * p + self.stiffness + self.memory(p)

    def memory(self, p: ComplexValues) -> ComplexValues:
        """Compute force over x1 of the elements that remember."""
        total = np.zeros_like(p)
        if self.relaxation:
            power = (p * self.relaxation.time) ** self.relaxation.order
            total = total + self.relaxation.stiffness * power / (1.0 + power)
        if self.fractional:
            total = total + self.fractional.coefficient * p**self.fractional.order
        return total

    def receptance(self, omega: Floats) -> ComplexValues:
        """Compute 1/D(i omega)."""
        return 1.0 / self.dynamic_stiffness(1j * np.asarray(omega, dtype=np.float64))

    def beyond(self, p: ComplexValues) -> ComplexValues:
        """Compute 1/D(p)."""
        return 1.0 / self.dynamic_stiffness(p)


LinearBody = TabulatedBody | RememberingBody
"""Body whose x1 depends linearly on the force.

mass, damping: those of its response to high frequencies, 1/(mass p^2 + damping p + ...). known_to: frequency above
which ``beyond`` is the response, analytic in p where Re(p/i) is at least that. fastest: frequency above which the
body does not swing by itself. detail: frequency up to which its response in time has details. smooth: true if its
response to a jump of force is analytic just after the jump. dissipates: true if it dissipates at every frequency.
"""


def linear_body(scene: Any) -> LinearBody:
    """Return the linear body of a scene along x1."""
    body = scene.body
    if body is not None and body.receptance is not None:
        measured: TabulatedBody = body.receptance.body()
        return measured
    remembers = {} if body is None else {"relaxation": body.relaxation, "fractional": body.fractional}
    return RememberingBody(2.0 * scene.damping_ratio, **remembers)
