"""Record of one period of a steady state in smooth pieces, and of many orbits one after another."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from frictionlab.values.quantities import Floats


@dataclass(frozen=True)
class Orbit:
    """Period of a steady state in smooth pieces, each sampled at the same Gauss-Lobatto nodes.

    Parameters
    ----------
    tau : ndarray
        Time [panels, nodes], which increases.
    x : ndarray
        Position [panels, nodes], x1 + i x2.
    v : ndarray
        Velocity [panels, nodes], in the same way.
    friction : ndarray
        Resisting friction force over the mean normal load [panels, nodes], positive if slip is positive; NaN in a
        component that is unknown.
    stick : ndarray or None
        Marks [panels] of pieces at rest on the belt; None if the method cannot detect rest.
    periods : int, default 1
        Number of periods in the record, by which sums and counts over it are divided. It is more than one if
        steps of a method keep the motion from repeating so soon, or if it never repeats (long mean).

    Examples
    --------
    >>> import frictionlab as fl
    >>> scene = fl.Scene(damping_ratio=0.1, normal_load=10, belt_speed=5, drive=fl.Drive(unbalance=10, frequency=1))
    >>> orbit = fl.Exact().solve([scene], fl.Coulomb(mu=0.4), 1e-8).orbit(0)
    >>> isinstance(orbit, fl.Orbit), orbit.tau.shape == orbit.friction.shape
    (True, True)
    """

    tau: Floats
    x: NDArray[np.complex128]
    v: NDArray[np.complex128]
    friction: NDArray[np.complex128]
    stick: NDArray[np.bool_] | None
    periods: int = 1


class End(NamedTuple):
    """Orbit of one of many states, whose means fill a range, and the bound on the error of its own mean."""

    orbit: Orbit
    error: float


@dataclass(frozen=True)
class Orbits:
    """Orbits stored one after another: each quantity is one array [panels, ...].

    Orbit k has the panels ends[k-1] to ends[k] - 1.
    """

    tau: Floats
    x: NDArray[np.complex128]
    v: NDArray[np.complex128]
    friction: NDArray[np.complex128]
    stick: NDArray[np.bool_]
    ends: NDArray[np.int64]

    def one(self, k: int) -> Orbit | None:
        """Return orbit k; None if it has no panels."""
        panels = slice(self.ends[k - 1] if k else 0, self.ends[k])
        if panels.start == panels.stop:
            return None
        return Orbit(*(part[panels] for part in self._parts))

    def and_those_of(self, other: Orbits) -> Orbits:
        """Return the orbits of both records; each orbit has panels in at most one of them."""
        if not other.ends.any():
            return self
        first, second = np.diff(self.ends, prepend=0), np.diff(other.ends, prepend=0)
        owner = np.repeat(np.arange(len(first)), first), np.repeat(np.arange(len(second)), second)
        order = np.argsort(np.concatenate(owner), kind="stable")
        pairs = zip(self._parts, other._parts, strict=True)
        tau, x, v, friction, stick = (np.concatenate(pair)[order] for pair in pairs)
        return Orbits(tau, x, v, friction, stick, np.cumsum(first + second))

    @property
    def _parts(self) -> tuple[Any, ...]:
        return self.tau, self.x, self.v, self.friction, self.stick
