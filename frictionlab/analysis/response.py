"""A contact's answer to small and to harmonic slip: impedance, describing function.

A law linearized about steady sliding or about rest: what friction makes of small changes of the slip velocity.

The impedance of a contact: change of friction per change of slip velocity.

The describing function of a law: harmonics of friction over the amplitude of a harmonic slip velocity.
"""

from __future__ import annotations

import cmath
import math
from collections.abc import Callable
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from frictionlab.analysis.quotients import derivative
from frictionlab.laws.base import FrictionLaw, SlidingLaw
from frictionlab.laws.memory import BristleLaw, MemoryLaw, bristle_in_the_plane, bristle_on_the_line
from frictionlab.methods.prescribed.memory import MemoryPoint
from frictionlab.motion.orbit.sample import HarmonicParts
from frictionlab.runner.arguments import given_law
from frictionlab.runner.state import OrbitOf
from frictionlab.runner.steady_state import steady_state
from frictionlab.scene.scene import Scene, Slip, TransverseSlip
from frictionlab.theory.loops import Complexes
from frictionlab.theory.sliding_stability import steady_deflection
from frictionlab.values.quantities import EPSILON, Floats, Written, at_least_one

_WIDEST = 0.5
"""Largest offset of difference quotients, relative to the number."""
_STEADY = 1e-9
"""Rate that a memory may have in steady sliding, over the terms that change it."""
_SHARP = 1e-6
"""Relative error of a derivative above which there is a corner."""


class Linearized(NamedTuple):
    """Small changes: memory' = by_memory memory + by_slip v, friction = from_memory memory + from_slip v."""

    by_slip: Floats
    by_memory: Floats
    from_slip: float
    from_memory: Floats

    def impedance(self, s: Complexes) -> Complexes:
        """Change of friction per change of slip velocity at each s [1/time]; infinite at a pole."""
        found = np.full(s.shape, self.from_slip + 0j)
        for place in np.ndindex(s.shape if self.by_slip.any() else (0,)):
            lag = s[place] * np.eye(len(self.by_slip)) - self.by_memory
            try:
                found[place] += self.from_memory @ np.linalg.solve(lag, self.by_slip)
            except np.linalg.LinAlgError:
                found[place] = np.inf
        return found


def linearized(law: FrictionLaw, speed: float, across: bool) -> Linearized:
    """Return the law about steady sliding at this speed, or about rest at 0, along the slip or across it.

    Raises ValueError where there is no such state or where the law has a corner there.
    """
    if why := _no_steady_state(law, speed, across):
        raise ValueError(f"impedance: {why}")
    memory = _steady_memory(law, speed)
    n = len(memory)
    if speed > 0.0 and not across and isinstance(law, BristleLaw | MemoryLaw) and law.rate_independent():
        # friction of the path alone is constant while slip does not turn round, corner or not
        return Linearized(np.zeros(n), np.zeros((n, n)), 0.0, np.zeros(n))
    here = np.array([speed, *memory])
    sizes = np.where(here != 0.0, np.abs(here), law.presliding() or 1.0)
    jacobian, steady = _jacobian(law, _answer_of(law, speed, memory, across), sizes)
    if not steady:
        raise ValueError(f"impedance: rate of {law!r} does not vanish where steady puts its memory")
    return Linearized(jacobian[:-1, 0], jacobian[:-1, 1:], float(jacobian[-1, 0]), jacobian[-1, 1:])


def _no_steady_state(law: FrictionLaw, speed: float, across: bool) -> str:
    if not isinstance(law, SlidingLaw | BristleLaw | MemoryLaw):
        return f"{law!r} does not say what it remembers"
    if speed == 0.0 and isinstance(law, SlidingLaw):
        return f"at belt_speed 0 friction of {law!r} jumps where slip turns round; use fl.describing_function"
    if speed == 0.0 and law.memory_kind == "scalars":
        return f"at belt_speed 0 there is no sliding to renew the memory of {law!r}"
    return law.no_vector_form() if across and law.planar_form() == "vectorial" else ""


def _steady_memory(law: FrictionLaw, speed: float) -> list[float]:
    if speed == 0.0 or isinstance(law, SlidingLaw):
        return [0.0] * law.count()
    if isinstance(law, MemoryLaw):
        return [float(law.steady(speed, k)) for k in range(law.count())]
    assert isinstance(law, BristleLaw)
    z = float(steady_deflection(law, speed))
    return [z + law.rate(speed, z) * z / speed]  # a step of Newton's: rates fall as speed z/z_steady


def _answer_of(law: Any, speed: float, memory: list[float], across: bool) -> Callable[[Floats], Floats]:
    """Return a function of small changes of slip and memory, along or across: the rates of all, and friction."""
    unit: Any = 1j if across else 1.0
    change = 1.0 if law.memory_kind == "scalars" else unit

    def answer(by: Floats) -> Floats:
        v, *moved = by.tolist()
        numbers = [z + dz * change for z, dz in zip(memory, moved, strict=True)]
        rates, friction = _rates_and_friction(law, speed + v * unit, numbers, across, speed == 0.0)
        part = [each.imag if across else each.real for each in (*rates, friction)]
        return np.array(part, dtype=np.float64)

    return answer


def _rates_and_friction(law: Any, v: Any, memory: list[Any], across: bool, at_rest: bool) -> Any:
    if isinstance(law, SlidingLaw):
        return [], law.sliding_vector(v) if across else law.sliding_friction(v)
    if isinstance(law, BristleLaw):
        rate, friction = (bristle_in_the_plane if across else bristle_on_the_line)(law, v, memory[0])
        return [rate], friction
    rates = [v if at_rest and law.remembers_stick() else law.rate(v, memory, k) for k in range(len(memory))]
    return rates, law.friction(v, memory, rates)


def _jacobian(law: FrictionLaw, answer: Callable[[Floats], Floats], sizes: Floats) -> tuple[Floats, bool]:
    """Derivatives of all that is answered by all numbers, and whether memory is steady. Raises ValueError."""
    ways = np.eye(len(sizes)) * sizes
    here = answer(np.zeros(len(sizes)))
    terms = np.abs(here) + np.sum([np.abs(answer(_WIDEST * way) - here) / _WIDEST for way in ways], axis=0)
    columns = []
    for way in ways:

        def along(offsets: Floats, way: Floats = way) -> list[Floats | None]:
            return [answer(offset * way) for offset in offsets]

        found = derivative(along, here, _WIDEST, 4.0 * EPSILON * terms, scatters=False)
        if found.reason or (found.error > _SHARP * terms).any():
            raise ValueError(
                f"impedance: {law!r} has a corner in steady sliding at this speed, so no derivative"
            )
        columns.append(found.value)
    return np.column_stack(columns) / sizes, bool((np.abs(here) <= _STEADY * terms)[:-1].all())


def impedance(
    law: FrictionLaw,
    belt_speed: ArrayLike,
    frequencies: ArrayLike,
    plot: bool = False,
    *,
    across: bool = False,
) -> Any:
    """Compute the impedance of a contact: change of friction per change of slip velocity.

    The change is small, varies as exp(i frequency time), and is about steady sliding on the belt. A positive
    real part damps. A positive imaginary part is inertia, a negative one is stiffness.

    Z = f_v + f_z (i frequency - r_z)^-1 r_v, with derivatives of friction f and of the rate r of the memory
    z. Each is found by differences extrapolated to zero. Z is 0 in sliding if friction depends on the path
    alone (Dahl, Jenkins).

    Parameters
    ----------
    law : FrictionLaw
        Law of friction.
    belt_speed : array_like of float
        Belt speed of steady sliding [velocity]; 0 is about rest, at an undeflected bristle.
    frequencies : array_like of float, shape (n,)
        Angular frequencies [rad/time]; an array of belt speeds is broadcast against them.
    plot : bool, default False
        Whether to return the figure, Bode and Nyquist plots, instead of the numbers.
    across : bool, default False
        Whether slip and friction change across the belt, in the plane.

    Returns
    -------
    numpy.ndarray of complex, shape (n,), or matplotlib.figure.Figure
        Impedance Z [1/velocity] at each frequency, in the units of the law.

    Raises
    ------
    ValueError
        If there is no steady sliding, if the law has a corner there, or if a value makes no sense.
    TypeError
        If a value is of another kind.

    References
    ----------
    LuGre in closed form: Canudas de Wit et al. (1995), IEEE TAC 40, 419, linearized.

    Examples
    --------
    >>> import frictionlab as fl
    >>> law = fl.LuGre(mu_kinetic=0.3, mu_static=0.4, stribeck_speed=2, stiffness=40, damping=1)
    >>> fl.impedance(law, 2, [0, 1, 100]).round(4)
    array([-0.0368+0.j    , -0.0368-0.0008j, -0.0641-0.065j ])
    """
    law = given_law(law)
    speeds, circular = np.broadcast_arrays(
        finite("belt_speed", belt_speed), finite("frequencies", frequencies)
    )
    found = np.empty(circular.shape, complex)
    for speed in np.unique(np.abs(speeds)).tolist():
        here = np.abs(speeds) == speed
        found[here] = linearized(law, speed, across).impedance(1j * circular[here])
    if not plot:
        return found[()]
    from frictionlab.charts.fits import impedance_figure  # imports matplotlib: only where it is needed

    return impedance_figure(speeds, circular, found)


def finite(name: str, values: ArrayLike) -> Floats:
    """Return the values of an argument of this name as an array. Raises ValueError."""
    given = np.asarray(values)
    if given.dtype.kind not in "iuf" or not given.size or not np.isfinite(given).all():
        raise ValueError(f"{name} must be finite numbers, got {values!r}")
    return given.astype(np.float64)


_TOLERANCE = 1e-12
_SAMPLES = 64
"""Samples of a period, times a harmonic, of friction within the elastic range."""


def describing_function(
    law: FrictionLaw,
    amplitude: ArrayLike | tuple[complex, complex],
    frequency: ArrayLike,
    belt_speed: ArrayLike = 0.0,
    normal_load: ArrayLike = 1.0,
    harmonics: int = 1,
) -> Any:
    """Compute the harmonics of the friction coefficient over the amplitude of the slip velocity.

    The slip velocity is -belt_speed + amplitude sin(frequency time); Im(amplitude D_k exp(i k frequency
    time)) is the k-th harmonic of friction. A positive real part of D_1 damps, a negative imaginary part is
    stiffness. The closed loop of the law under that slip is integrated. If the mean depends on the start, the
    loop starts from an undeflected contact.

    Arrays are broadcast.

    Parameters
    ----------
    law : FrictionLaw
        Law of friction.
    amplitude : array_like of float, > 0, or tuple of two complex
        Amplitude of the slip velocity along the belt [velocity]. A tuple has the amplitudes along x1 and x2
        of slip in the plane; complex ones lead by their angle.
    frequency : array_like of float, > 0
        Angular frequency [rad/time].
    belt_speed : array_like of float, default 0
        Belt speed about which slip oscillates [velocity]; 0 is about rest.
    normal_load : array_like of float, > 0, default 1
        Normal load [force] by which ``contact_stiffness`` and ``contact_damping`` of a law are divided.
    harmonics : int, >= 1, default 1
        Number of D_k.

    Returns
    -------
    numpy.ndarray of complex, or complex
        D_k [1/velocity]. The first axis is the harmonic if ``harmonics`` is above 1. In the plane the last
        two axes have 2 x 2 numbers: row i is friction along i, column j is over the slip velocity along j,
        NaN if that is 0.

    Raises
    ------
    ValueError
        If no closed loop is found, or a value makes no sense.
    TypeError
        If a value is of another kind.

    References
    ----------
    Coulomb at rest gives 4 mu/(pi amplitude): Sulollari, van Dalen & Cabboi, Eq. 9.

    Examples
    --------
    >>> import frictionlab as fl
    >>> fl.describing_function(fl.Coulomb(mu=0.4), [1, 2], 1).real.round(4)
    array([0.5093, 0.2546])
    >>> complex(fl.describing_function(fl.Dahl(mu=0.4, stiffness=40), 0.01, 1).round(4))
    (12.1419-29.3003j)
    """
    law, count = _without_units(given_law(law)), at_least_one("harmonics", harmonics)
    names = {"frequency": frequency, "belt_speed": belt_speed, "normal_load": normal_load}
    others = [finite(name, value) for name, value in names.items()]
    if isinstance(amplitude, tuple):
        pair, grid = _pair(amplitude), np.broadcast(*others)
        share = np.array([1.0 / size if size else complex(np.nan, np.nan) for size in pair.tolist()])
        cells = [_friction(law, pair, count, *each).T[:, :, None] * share for each in grid]
    else:
        sizes = finite("amplitude", amplitude)
        if not (sizes > 0.0).all():
            raise ValueError(f"amplitude must be > 0, got {amplitude!r}")
        grid = np.broadcast(sizes, *others)
        cells = [_friction(law, np.array([size, 0j]), count, *each)[0] / size for size, *each in grid]
    found = np.array(cells).reshape(*grid.shape, *cells[0].shape)
    found = np.moveaxis(found, len(grid.shape), 0)
    return found if count > 1 else found[0][()]


def _without_units(law: FrictionLaw) -> FrictionLaw:
    """Return the law with numbers alone: all arguments are in its units."""
    texts = {name: float(value) for name, value in law if isinstance(value, Written)}
    return law.model_copy(update=texts)


def _pair(amplitudes: tuple[complex, ...]) -> Complexes:
    pair = np.array(amplitudes, dtype=complex)
    if pair.shape != (2,) or not np.isfinite(pair).all() or not pair.any():
        raise ValueError(
            f"amplitude: a tuple is two amplitudes, along x1 and x2, not both 0; got {amplitudes!r}; "
            "several amplitudes along x1 are a list"
        )
    return pair


def _friction(
    law: FrictionLaw, pair: Complexes, count: int, frequency: float, belt_speed: float, normal_load: float
) -> Complexes:
    """Harmonics 1 to ``count`` along x1 and x2 [2, count]: friction is Im(sum of F_k exp(i k frequency tau))."""
    along, across = pair.tolist()
    if along and across and law.planar_form() == "per-axis":  # each axis by itself: one may be elastic alone
        ways = (np.array([along, 0j]), belt_speed), (np.array([0j, across]), 0.0)
        rows = [_friction(law, way, count, frequency, speed, normal_load) for way, speed in ways]
        return np.array([rows[0][0], rows[1][1]])
    slip = Slip(velocity_amplitude=abs(along), frequency=frequency, phase=_degrees(along))
    other = TransverseSlip(velocity_amplitude=abs(across), phase=_degrees(across)) if across else None
    scene = Scene(belt_speed=belt_speed, normal_load=normal_load, slip=slip, transverse_slip=other)
    state = steady_state(scene, law, "shooting", _TOLERANCE)
    motion = state.motion
    if state.status == "not_unique" and isinstance(law, BristleLaw):
        return _elastic(law.under_load(normal_load), pair, frequency, count)
    if state.status == "not_unique" and isinstance(law, MemoryLaw):
        ends = MemoryPoint(scene, law, _TOLERANCE).ends()
        motion = OrbitOf(lambda _: ends[-1].orbit if ends else None, scene, law)
    found = [motion and motion.harmonics(count, across) for across in (False, True)]
    if not all(found):
        raise ValueError(f"describing_function: {state.reason}")
    return np.array([_phasors(each) for each in found if each])


def _degrees(amplitude: complex) -> float:
    return math.degrees(cmath.phase(amplitude))


def _phasors(parts: HarmonicParts) -> Complexes:
    """Return the phasors of friction; a phase is not known where there is none."""
    turn = np.exp(1j * np.radians(np.nan_to_num(parts.friction_phase[1:])))
    return np.asarray(parts.friction_amplitude[1:] * turn)


def _elastic(law: BristleLaw, pair: Complexes, frequency: float, count: int) -> Complexes:
    """Return the friction of deflections that follow a slip about rest: a mean deflection changes no harmonic."""
    theta = np.arange(_SAMPLES * count) * (2.0 * math.pi / (_SAMPLES * count))
    slips, deflections = (
        (each[:, None] * np.exp(1j * theta)).imag for each in (pair, pair / (1j * frequency))
    )
    if pair[1]:
        both = slips[0] + 1j * slips[1], deflections[0] + 1j * deflections[1]
        friction = [bristle_in_the_plane(law, v, z)[1] for v, z in np.transpose(both).tolist()]
    else:
        friction = [
            bristle_on_the_line(law, v, z)[1] for v, z in np.transpose([slips[0], deflections[0]]).tolist()
        ]
    turns = np.exp(-1j * np.outer(theta, np.arange(1, count + 1)))
    return np.asarray(2j / theta.size * np.array([np.real(friction), np.imag(friction)]) @ turns)
