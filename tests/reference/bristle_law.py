"""What the two generators of bristle references solve: one scene and law in numbers, nothing of the package's.

    x1'' + 2 b x1' + x1 + N T1 = P1 sin(W tau),  x2'' + 2 b2 r x2' + r^2 x2 + N T2 = P2 sin(W tau),
    z' = w - alpha |w| z s0/g(|w|),  T = s0 z + s1 z' + s2 w,  w = (x1' - v_b, x2'),
    g = mu_k + (mu_s - mu_k) exp(-(|w|/v_s)^2);

alpha is 1 (LuGre; Dahl with mu_s = mu_k and s1 = s2 = 0) or that of elasto-plastic friction.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np


class Numbers(NamedTuple):
    """A scene and a law; ``planar`` and ``elastic`` (elasto-plastic, not LuGre) are 0 or 1."""

    planar: float
    damping: float  # 2 b
    normal_load: float
    frequency: float
    load: float
    belt_speed: float
    transverse_damping: float  # 2 b2 r
    transverse_stiffness: float
    transverse_load: float
    elastic: float
    mu_kinetic: float
    mu_static: float
    stribeck_speed: float
    stiffness: float
    bristle_damping: float
    viscosity: float
    breaks_at: float  # deflection

    @property
    def size(self) -> int:
        """Of the state: (x, v, z), or (x1, x2, v1, v2, z1, z2)."""
        return 6 if self.planar else 3

    @property
    def period(self) -> float:
        """Of the loads."""
        return 2.0 * np.pi / self.frequency

    def scales(self) -> np.ndarray:
        """Of the state: amplitudes without friction, at least one static deflection; the presliding length."""
        both = [(1.0, self.damping, self.load)]
        both += [(self.transverse_stiffness, self.transverse_damping, self.transverse_load)] * (
            self.size == 6
        )
        dynamic = [abs(force / complex(k - self.frequency**2, c * self.frequency)) for k, c, force in both]
        x = np.maximum(dynamic, 0.1 * max(dynamic))
        z = np.full(len(both), self.mu_kinetic / self.stiffness)
        return np.concatenate([x, self.frequency * x, z])


def one_degree_of_freedom(belt_speed, law):
    """W1: resonance under strong friction."""
    return Numbers(0, 0.2, 10.0, 1.0, 10.0, belt_speed, 0.0, 1.0, 0.0, *law)


def two_degrees_of_freedom(belt_speed, omega_r, law):
    """W3: both loads at Omega 4, normal load 1."""
    return Numbers(1, 0.2, 1.0, 4.0, 160.0, belt_speed, 0.2 * omega_r, omega_r**2, 160.0, *law)


def lugre(presliding, mu_kinetic=0.4, mu_static=None, stribeck_speed=1.0, damping=0.0):
    """LuGre friction; Dahl where nothing but the presliding length is given."""
    static = mu_kinetic if mu_static is None else mu_static
    return 0, mu_kinetic, static, stribeck_speed, mu_kinetic / presliding, damping, 0.0, 0.0


def dupont(presliding, damping=0.0, breakaway_ratio=0.7):
    """Elasto-plastic friction of constant steady friction 0.4."""
    return 1, 0.4, 0.4, 1.0, 0.4 / presliding, damping, 0.0, breakaway_ratio * presliding
