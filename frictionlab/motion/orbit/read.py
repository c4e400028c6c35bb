"""Columns of the result table read from one orbit: amplitudes, phases, energies, stick and reversals."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from typing import Any, NamedTuple

import numpy as np

from frictionlab.compile.call import KernelCall
from frictionlab.compile.decorators import inner, njit
from frictionlab.compile.interpret import interpreted, interpreted_on_arrays, run_as
from frictionlab.motion.equation import (
    SLIP_ROUNDING,
    bare,
    body_at,
    dissipated,
    instant_at,
    load,
    mean_friction,
    planar,
    slip,
)
from frictionlab.motion.orbit.energy_errors import FOR_ERRORS, Means, energy_errors
from frictionlab.motion.orbit.record import End, Orbit, Orbits
from frictionlab.motion.orbit.recorder import NODES, WEIGHTS, differentiate_panel, interpolate, zero_between
from frictionlab.scene.body import Mass, for_kernels
from frictionlab.scene.scene import Scene
from frictionlab.scene.scenes import belt_speeds_of
from frictionlab.scene.varying import PIECES
from frictionlab.values.columns import FROM_ORBITS
from frictionlab.values.quantities import Floats

READ = (
    "mean_friction",
    "mean_position",
    "mean_friction_transverse",
    "mean_position_transverse",
    "velocity_amplitude",
    "velocity_harmonic",
    "velocity_phase",
    "transverse_velocity_amplitude",
    "transverse_velocity_harmonic",
    "transverse_velocity_phase",
    "stick_fraction",
    "reversals",
    "force_reversals",
    "energy_input",
    "energy_viscous",
    "energy_friction",
    "energy_contact",
    *FOR_ERRORS,
)
"""Columns that ``read`` returns, in this order. The mean positions serve to check the mean balance: <x1> = N
mean_friction, omega_r^2 <x2> = N mean_friction_transverse."""
_SUMS = "duration", "misfit_load", "misfit_speed"
SUMMED = np.array(["energy" in name or "reversals" in name or name in _SUMS for name in READ])
"""Mask of the columns of ``READ`` that are sums and counts over the whole record; all others are means,
phases or extremes."""
LEAST_SLIP = 1e-9
"""Slip velocity, over the largest, that has no sign beside stick: events are located no better."""
ALIKE = 1e-5
"""Largest difference, over its size, of a column of orbits that agree."""


def read_columns(
    scenes: Sequence[Scene],
    orbit: Callable[[int], Orbit | None],
    orbits: Callable[[], Orbits] | None = None,
    means: Means | None = None,
    ends: Callable[[int], Sequence[End]] = lambda i: (),
) -> dict[str, Floats]:
    """Return every column of ``FROM_ORBITS`` for scenes that differ in belt speed alone.

    Columns that do not apply are NaN.

    ends: returns orbits of a scene whose mean may be any in a range; the columns in which they agree are
    told, their difference as a part of the error. means: mean friction of each scene, for the errors of
    energies; these are left out without it. orbit: returns the orbit of one scene, None if it has none.
    orbits: returns all of them at once, where that is cheaper.
    """
    if orbits is not None:
        found = _read_together(scenes, orbits())
    else:
        found = np.array([_read_one(scene, orbit(i)) for i, scene in enumerate(scenes)])
    means = means and means._replace(value=means.value.copy(), error=means.error.copy())
    apart, alike = np.zeros(found.shape), np.ones(found.shape, np.bool_)
    for i in np.flatnonzero(np.isnan(found[:, 0])).tolist():
        if each := ends(i):
            rows = np.array([_read_one(scenes[i], end.orbit) for end in each])
            found[i], apart[i] = rows[-1], np.ptp(rows, axis=0)
            alike[i] = apart[i] <= ALIKE * _sizes(scenes[i], found[i])
            if means is not None:
                means.value[i], means.error[i] = found[i, 0], max(end.error for end in each)
    if scenes[0].remembers:
        # Forces of a body that remembers are not recorded: its dissipation is the rest of the balance.
        put_in, viscous, friction = (
            READ.index(f"energy_{name}") for name in ("input", "viscous", "friction")
        )
        found[:, viscous] = found[:, put_in] - found[:, friction]
    found[:, _not_there(scenes[0])] = np.nan
    columns = {name: np.where(alike[:, place], found[:, place], np.nan) for place, name in enumerate(READ)}
    if means is not None:
        errors = energy_errors(scenes, _mass(scenes[0]), means, dict(zip(READ, found.T, strict=True)))
        for error, values in errors.items():
            name = error.removesuffix("_error")
            values += np.where(np.isnan(columns[name]), np.nan, apart[:, READ.index(name)])
        columns |= errors
    return {name: columns[name] for name in FROM_ORBITS if name in columns}


def _sizes(scene: Scene, row: Floats) -> Floats:
    """Return what differences of each column are compared with: a work of the load, a velocity, else one."""
    swing, duration = row[READ.index("swing")], row[READ.index("duration")]
    work = _mass(scene).normal_load * swing * duration
    least = [work if "energy" in name else swing if "velocity" in name else 1.0 for name in READ]
    return np.fmax(np.abs(row), least)


def _not_there(scene: Scene) -> list[bool]:
    """Mark the columns that do not exist for a scene.

    These are columns across the belt on a line, and those of loads and dashpots without a mass.
    """
    given = scene.degrees_of_freedom == 0
    without = ("energy_input", "energy_viscous") if given else ()
    return [name in without or (not scene.planar and "transverse" in name) for name in READ]


def _mass(scene: Scene) -> Mass:
    """Return the numbers of a scene for kernels; of a prescribed slip only mean load and frequency are used.

    The belt is then steady.
    """
    if scene.degrees_of_freedom:
        return for_kernels(scene.mass())
    motion = scene.motion()
    return for_kernels(Mass(0.0, 1.0, 0.0, 1.0, motion.normal_load, motion.frequency, 0j, 0j))


def _read_together(scenes: Sequence[Scene], found: Orbits) -> Floats:
    out, speeds = np.full((len(scenes), len(READ)), np.nan), belt_speeds_of(scenes)
    panels = OrbitPanels(found.tau, found.x, found.v, found.friction, found.stick)
    KernelCall(read_each)(panels, found.ends, _mass(scenes[0]), speeds, out)
    return out


def _read_one(scene: Scene, orbit: Orbit | None) -> Floats:
    """Read one orbit of several periods; sums and counts are divided by the number of periods."""
    if orbit is None:
        return np.full(len(READ), np.nan)
    mass = _mass(scene)
    if scene.undriven:
        length = float(orbit.tau[-1, -1] - orbit.tau[0, 0]) / orbit.periods
        mass = mass._replace(frequency=2.0 * math.pi / length)
    stick = np.zeros(len(orbit.tau), np.bool_) if orbit.stick is None else orbit.stick
    out, ends = np.full((1, len(READ)), np.nan), np.array([len(orbit.tau)])
    panels = OrbitPanels(orbit.tau, orbit.x, orbit.v, orbit.friction, stick)
    KernelCall(read_each)(panels, ends, mass, np.array([scene.belt_speed]), out)
    if orbit.stick is None:
        out[0, READ.index("stick_fraction")] = np.nan
    return np.where(SUMMED, out[0] / orbit.periods, out[0])


class OrbitPanels(NamedTuple):
    """Orbits as kernels read them: arrays [panels, nodes], and stick [panels]."""

    tau: Any
    x: Any
    v: Any
    friction: Any
    stick: Any


@inner
def _cut(panels: OrbitPanels, first: int, end: int) -> OrbitPanels:
    """Return the panels from ``first`` to before ``end``."""
    return OrbitPanels(
        panels.tau[first:end],
        panels.x[first:end],
        panels.v[first:end],
        panels.friction[first:end],
        panels.stick[first:end],
    )


@njit
def read_each(panels: OrbitPanels, ends: Any, mass: Mass, belt_speeds: Any, out: Any) -> None:
    """Write all columns of ``READ`` for the orbit of belt speed i to row i of ``out``.

    A row without an orbit stays as it is.
    """
    first = 0
    for i in range(belt_speeds.size):
        end = ends[i]
        if end > first:
            row = read(_cut(panels, first, end), mass, belt_speeds[i])
            for column in range(len(row)):
                out[i, column] = row[column]
        first = end


class Sums(NamedTuple):
    """Integrals over one period."""

    duration: float
    position: complex
    friction: complex
    harmonic_1: complex
    harmonic_2: complex
    input: float
    viscous: float
    by_friction: float
    contact: float
    stick: float
    moved: complex  # integral of the velocity: zero, were the motion exactly periodic
    pressed: complex  # integral of the friction force
    swing: float  # integral of the squared velocity
    misfit_load: float  # difference of velocities and positions in each panel times its largest load, summed
    misfit_speed: float  # the same, times its largest speed


NO_SUMS = Sums(0.0, 0j, 0j, 0j, 0j, 0.0, 0.0, 0.0, 0.0, 0.0, 0j, 0j, 0.0, 0.0, 0.0)


@inner
def read(panels: OrbitPanels, mass: Mass, belt_speed: float) -> Any:
    """Return the columns ``READ`` of one period."""
    x, v, stick = panels.x, panels.v, panels.stick
    slips = np.empty(v.shape, np.complex128)
    # Means and energies, by the Gauss-Lobatto weights of every panel.
    sums = _integrals(panels, mass, belt_speed, slips)
    period = sums.duration
    # The recorded motion is not quite periodic. The mean friction force, in presliding many times the loads,
    # would do work on that drift. A periodic motion has no mean velocity, so the work on the drift is subtracted.
    drift = _power(sums.pressed, sums.moved) / period
    # Reversals of slip are not counted in stick; a slip that is rounding of the velocity has no sign. The friction
    # force changes its sign in stick, too, where the slip is zero.
    slip_along = slips.real
    _drop_rounding(slip_along, v, stick)
    return (
        mean_friction(sums.friction.real, period),
        sums.position.real / period,
        mean_friction(sums.friction.imag, period),
        sums.position.imag / period,
        _amplitude(v.real),
        abs(sums.harmonic_1) * 2.0 / period,
        _lead(sums.harmonic_1, mass.force),
        _amplitude(v.imag),
        abs(sums.harmonic_2) * 2.0 / period,
        _lead(sums.harmonic_2, mass.force),
        sums.stick / period,
        1.0 * _sign_changes(slip_along, stick, True),
        1.0 * _sign_changes(panels.friction.real, stick, False),
        sums.input,
        sums.viscous,
        sums.by_friction - drift,
        sums.contact - drift,
        period,
        _open_ends(x[-1, -1] - x[0, 0], v[-1, -1] - v[0, 0], mass),
        math.sqrt(sums.swing / period),
        sums.misfit_load,
        sums.misfit_speed,
    )


@inner
def _open_ends(x: complex, v: complex, mass: Mass) -> float:
    """Return the distance in the norm of energy of two states with these differences."""
    stretched = mass.stiffness * x.real**2 + mass.transverse_stiffness * x.imag**2
    return math.sqrt(stretched + v.real**2 + v.imag**2)


@inner
def _drop_rounding(part: Any, v: Any, stick: Any) -> None:
    """Set slip velocities to zero that are rounding of a velocity or, beside stick, of an event."""
    least, count = LEAST_SLIP * np.abs(part).max(), part.shape[0]
    for panel in range(count):
        beside = stick[panel - 1] or stick[(panel + 1) % count]
        for node in range(part.shape[1]):
            rounding = max(least if beside else 0.0, SLIP_ROUNDING * abs(v[panel, node].real))
            if abs(part[panel, node]) <= rounding:
                part[panel, node] = 0.0


@inner
def _by_panels(panels: OrbitPanels, mass: Mass, belt_speed: float, slips: Any) -> Sums:
    """Return the sums over the period, and leave the slip velocity of every node in ``slips``."""
    body, total, last = bare(planar(mass, 1.0), mass.varying.table), NO_SUMS, NODES.size - 1
    for k in range(panels.tau.shape[0]):
        stuck = 1.0 if panels.stick[k] else 0.0
        parts = panels.tau[k], panels.x[k], panels.v[k], panels.friction[k]
        here = body_at(body, 0.5 * (panels.tau[k, 0] + panels.tau[k, last]))
        total = _with_a_panel(total, here, belt_speed, parts, stuck, slips[k])
    return total


@inner
def _integrals(panels: OrbitPanels, mass: Mass, belt_speed: float, slips: Any) -> Sums:
    """Return ``_by_panels``; Python adds up all panels at once."""
    return _by_panels(panels, mass, belt_speed, slips)


def _integrals_in_python(panels: OrbitPanels, mass: Mass, belt_speed: float, slips: Any) -> Sums:
    """Return the same sums by the same code with all panels at once: node by node, each an array."""
    if mass.varying.table[PIECES] > 1.0:  # every panel has a body of its own
        return interpreted(_by_panels)(panels, mass, belt_speed, slips)
    stuck = panels.stick.astype(float)
    parts = panels.tau.T, panels.x.T, panels.v.T, panels.friction.T
    body = interpreted(planar)(mass, 1.0)
    of_panels = interpreted_on_arrays(_with_a_panel)(NO_SUMS, body, belt_speed, parts, stuck, slips.T)
    return Sums(*(each.sum().item() for each in of_panels))


run_as(_integrals, _integrals_in_python)


@inner
def _with_a_panel(a: Sums, body: Any, belt_speed: float, parts: Any, stuck: float, slips: Any) -> Sums:
    """Add a panel to the sums so far, from numbers at its nodes, or from arrays of them."""
    tau, x, v, friction = parts
    half = 0.5 * (tau[NODES.size - 1] - tau[0])
    position, friction_impulse, harmonic_1, harmonic_2 = 0j, 0j, 0j, 0j
    put_in, viscous, taken, contact = 0.0, 0.0, 0.0, 0.0
    displacement, force, swing, strongest, fastest = 0j, 0j, 0.0, 0.0, 0.0
    for node in range(NODES.size):
        weight, now = half * WEIGHTS[node], instant_at(body, tau[node])
        turn = complex(now.cosine, now.sine)
        velocity, rub = v[node], friction[node]
        w = slip(body, belt_speed, now, velocity)
        slips[node] = w
        # Each direction separately: friction across the belt may be unknown.
        position = position + complex(weight * x[node].real, weight * x[node].imag)
        friction_impulse = friction_impulse + complex(weight * rub.real, weight * rub.imag)
        harmonic_1 = harmonic_1 + weight * velocity.real * turn.conjugate()
        harmonic_2 = harmonic_2 + weight * velocity.imag * turn.conjugate()
        # Powers of the load, of the dashpots (springs return their energy) and of friction. The part of friction in
        # the contact is heat, the rest is work on the belt.
        pressed = weight * body.normal_load
        pushed = load(body, now)
        put_in = put_in + weight * _power(pushed, velocity)
        viscous = viscous + weight * _power(dissipated(body, x[node], velocity), velocity)
        taken = taken + pressed * _power(rub, velocity)
        contact = contact + pressed * _power(rub, w)
        displacement = displacement + weight * velocity
        force = force + pressed * rub
        swing = swing + weight * _power(velocity, velocity)
        strongest, fastest = max(strongest, abs(pushed)), max(fastest, abs(velocity))
    misfit = abs(displacement - (x[NODES.size - 1] - x[0]))
    return Sums(
        a.duration + 2.0 * half,
        a.position + position,
        a.friction + friction_impulse,
        a.harmonic_1 + harmonic_1,
        a.harmonic_2 + harmonic_2,
        a.input + put_in,
        a.viscous + viscous,
        a.by_friction + taken,
        a.contact + contact,
        a.stick + 2.0 * half * stuck,
        a.moved + displacement,
        a.pressed + force,
        a.swing + swing,
        a.misfit_load + strongest * misfit,
        a.misfit_speed + fastest * misfit,
    )


@inner
def _power(force: complex, velocity: complex) -> float:
    return force.real * velocity.real + force.imag * velocity.imag


@inner
def _lead(harmonic: complex, force: complex) -> float:
    """Return the phase [degrees] by which A sin(Omega tau + phase) leads the force; NaN without one.

    harmonic: integral that gives this sine.
    """
    if force == 0 or harmonic == 0:
        return np.nan
    ratio = 1j * harmonic * force.conjugate()
    return math.degrees(math.atan2(ratio.imag, ratio.real))


OVERSHOOT = 0.6
"""(L - 1)/2, rounded up, of the Lebesgue constant L of the nodes."""


@inner
def _amplitude(values: Any) -> float:
    """Return half the difference between the extremes of the panel polynomials."""
    return 0.5 * (_highest(values, 1.0) + _highest(values, -1.0))


@inner
def _highest(values: Any, sign: float) -> float:
    """Return the maximum of sign * the panel polynomials, interior maxima included."""
    highest = -1e300
    for panel in range(values.shape[0]):
        for node in range(values.shape[1]):
            highest = max(highest, sign * values[panel, node])
    row, slope = np.empty(values.shape[1]), np.empty(values.shape[1])
    for panel in range(values.shape[0]):
        low, high = 1e300, -1e300
        for node in range(values.shape[1]):
            row[node] = sign * values[panel, node]
            low, high = min(low, row[node]), max(high, row[node])
        # Between its nodes a polynomial leaves the range of their values by at most OVERSHOOT of it.
        if not high + OVERSHOOT * (high - low) > highest:
            continue
        # An extreme inside a panel lies where its derivative falls through zero between two nodes.
        differentiate_panel(row, slope)
        for node in range(1, values.shape[1]):
            if slope[node - 1] > 0.0 >= slope[node]:
                at = zero_between(slope, NODES[node - 1], NODES[node])
                highest = max(highest, interpolate(row, at))
    return highest


@inner
def _sign_changes(values: Any, stick: Any, skip_stick: bool) -> int:
    """Count crossings of zero within the period, at interior nodes.

    The ends of panels are events: there the value is zero without crossing it.
    """
    changes, first, last = 0, 0.0, 0.0
    for panel in range(values.shape[0]):
        for node in range(1, values.shape[1] - 1):
            value = values[panel, node]
            if (skip_stick and stick[panel]) or value == 0.0:
                continue
            # The motion is periodic: the last sign is compared with the first, too.
            first = value if first == 0.0 else first
            changes += 1 if last * value < 0.0 else 0
            last = value
    return changes + (1 if first * last < 0.0 else 0)
