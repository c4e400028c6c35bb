"""Whether motions leave a periodic one of a bristle on a body known by its receptance: Nyquist's criterion.

A small change u(t) exp(i nu t) of the slip velocity, u with the period of the motion, changes the deflection by zeta,
zeta' + i nu zeta = r_v u + r_z zeta, and friction by F_v u + F_z zeta, with derivatives of the law along the motion:
harmonic by harmonic a matrix Phi(nu). With the mobility Y = p H of the body at p = i (nu + k Omega) it goes on by
itself where det(1 + N Y Phi) = 0, and p goes once through all of them while nu passes Omega. Along that way the
determinant turns round zero, backwards, as often as changes grow.

Source: of harmonic transfer functions Wereley & Hall, Proceedings of the 29th IEEE CDC (1990), 3650-3655.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np
from numpy.typing import NDArray

from frictionlab.laws.memory import BristleLaw, bristle_on_the_line
from frictionlab.orbit.memory import Contact, deflections
from frictionlab.orbit.record import Orbit
from frictionlab.quantities import Floats
from frictionlab.scene.receptance import ComplexValues, LinearBody

SMALL_OFFSET = 1e-6
"""Offset of difference quotients, of the largest slip and of the presliding length."""
FIRST_TURNS, SHARPEST_TURN, TURN_HALVINGS = 33, 0.7, 10
"""Frequencies looked at first, and the turn [rad] from one to the next from which on more are between them."""
AT_ONCE = 8
"""Frequencies, for memory."""
AT_ONCE_IN_PRODUCTS = 60_000
"""Products of numbers: for so few OpenBLAS takes one thread."""

_Along = NDArray[np.float64]


def growing_changes(
    law: BristleLaw, body: LinearBody, normal_load: float, orbit: Orbit, slip: Floats, most: int
) -> float:
    """How many changes grow, nearly a whole number; NaN where friction does not tell the deflection.

    slip: at the nodes of the orbit. most: harmonics -most ... most are coupled.
    """
    tau = orbit.tau.ravel()
    period = float(tau[-1] - tau[0])
    omega = 2.0 * np.pi / period
    along = _derivatives(law, slip, orbit.friction.real)
    if not np.isfinite(along).all():
        return float("nan")
    orders = np.arange(-most, most + 1)
    waves = np.exp(1j * omega * np.outer(tau, orders))

    def turn(nu: Floats) -> ComplexValues:
        """The determinant over its size."""
        friction = _friction_of_changes(tau, along, waves, nu)
        frequency = nu[:, None] + omega * orders
        reply = body.receptance(np.abs(frequency).ravel()).reshape(frequency.shape)
        mobility = 1j * frequency * np.where(frequency < 0.0, reply.conj(), reply)
        matrix = np.eye(len(orders)) + normal_load * mobility[:, :, None] * friction
        return np.asarray(np.linalg.slogdet(matrix)[0])

    return -_turned(turn, 0.5 * omega) / np.pi


def _turned(turn: Callable[[Floats], ComplexValues], end: float) -> float:
    """The angle through which it turns from 0 to the end."""
    nu = np.linspace(0.0, end, FIRST_TURNS)
    found = turn(nu)
    for _ in range(TURN_HALVINGS):
        wide = np.flatnonzero(np.abs(np.angle(found[1:] / found[:-1])) > SHARPEST_TURN)
        if not len(wide):
            break
        between = 0.5 * (nu[wide] + nu[wide + 1])
        nu, found = np.concatenate([nu, between]), np.concatenate([found, turn(between)])
        order = np.argsort(nu)
        nu, found = nu[order], found[order]
    return float(np.angle(found[1:] / found[:-1]).sum())


def _derivatives(law: BristleLaw, slip: Floats, friction: Floats) -> _Along:
    """Of the rate of the deflection by slip and by it, and of friction by both [4, nodes], along an orbit."""
    moved, rubbed = slip.astype(np.complex128), friction.astype(np.complex128)
    contact = Contact(moved, rubbed, np.ones(slip.shape), True, False)
    z = deflections(law, contact).real
    by_slip, by_depth = SMALL_OFFSET * float(np.abs(slip).max()), SMALL_OFFSET * law.presliding()
    found = np.empty((4, slip.size))
    for i, (v, depth) in enumerate(zip(slip.ravel().tolist(), z.ravel().tolist(), strict=True)):
        # a quotient does not reach over the reversal of slip
        h = min(by_slip, 0.5 * abs(v)) or by_slip
        ahead, behind = bristle_on_the_line(law, v + h, depth), bristle_on_the_line(law, v - h, depth)
        up, down = (bristle_on_the_line(law, v, depth + each) for each in (by_depth, -by_depth))
        found[0, i], found[2, i] = ((a - b) / (2.0 * h) for a, b in zip(ahead, behind, strict=True))
        found[1, i], found[3, i] = ((a - b) / (2.0 * by_depth) for a, b in zip(up, down, strict=True))
    return found


def _friction_of_changes(tau: Floats, along: _Along, waves: ComplexValues, nu: Floats) -> Any:
    """Phi [nu, harmonics of friction, harmonics of slip]: exponential steps between nodes, twice linear in time."""
    rate_v, rate_z, friction_v, friction_z = along
    step = np.diff(tau)
    weights = np.zeros(len(tau))
    weights[:-1] += 0.5 * step
    weights[1:] += 0.5 * step
    to_harmonics = (weights[:, None] * waves.conj()).T / (tau[-1] - tau[0])
    pushed = rate_v[:, None] * waves
    pushed = 0.5 * (pushed[1:] + pushed[:-1])
    decay = 0.5 * (rate_z[1:] + rate_z[:-1])
    direct = _product(to_harmonics * friction_v, waves)
    found = []
    for some in np.array_split(nu, 1 + len(nu) // AT_ONCE):
        exponent = step * (decay - 1j * some[:, None])
        kept = np.exp(exponent)
        near = np.abs(exponent) < SMALL_OFFSET
        gained = step * np.where(near, 1.0, np.expm1(exponent) / np.where(near, 1.0, exponent))
        change = np.zeros((len(some), len(tau), waves.shape[1]), np.complex128)
        for m in range(len(step)):
            change[:, m + 1] = kept[:, m, None] * change[:, m] + gained[:, m, None] * pushed[m]
        left = np.cumprod(np.hstack([np.ones((len(some), 1)), kept]), axis=1)
        change += left[:, :, None] * (change[:, -1] / (1.0 - left[:, -1:]))[:, None]
        found.append(direct + _product(to_harmonics * friction_z, change))
    return np.concatenate(found)


def _product(left: ComplexValues, right: ComplexValues) -> Any:
    """Of matrices, in parts so small that threads, which busy machines wait for, are not set off for them."""
    many = max(1, AT_ONCE_IN_PRODUCTS // (left.shape[0] * right.shape[-1]))
    parts = range(0, left.shape[1], many)
    return sum(left[:, k : k + many] @ right[..., k : k + many, :] for k in parts)
