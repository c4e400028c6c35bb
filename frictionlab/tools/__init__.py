"""Tools for methods of your own: kernels, the orbits that they write, responses of linear bodies.

What is compiled is kept on disk under a hash of all the code it can reach, that of the caller's package included:
an edit is never answered by an old kernel.
"""

from __future__ import annotations

from frictionlab.compile.call import KernelCall
from frictionlab.compile.decorators import embedded, fast, fast_embedded, inner, njit
from frictionlab.motion.linalg import eliminate, solve_linear
from frictionlab.motion.orbit.record import Orbits
from frictionlab.motion.orbit.recorder import NODES, Track, grown, track_of
from frictionlab.scene.receptance import LinearBody, linear_body
from frictionlab.theory.linear import friction_free_slip
from frictionlab.theory.periodic_response import periodic_response

__all__ = [
    "NODES",
    "KernelCall",
    "LinearBody",
    "Orbits",
    "Track",
    "eliminate",
    "embedded",
    "fast",
    "fast_embedded",
    "friction_free_slip",
    "grown",
    "inner",
    "linear_body",
    "njit",
    "periodic_response",
    "solve_linear",
    "track_of",
]
