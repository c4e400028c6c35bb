"""Checks that friction does not depend on the choice of axes, directions and units."""

from __future__ import annotations

from frictionlab.laws.memory import MemoryLaw
from frictionlab.scene.units import Units, scaled_law
from frictionlab.testing.contact import Response, has_direction, memory_after_slip, reflect, response, rotate
from frictionlab.testing.example import Given, law_check
from frictionlab.testing.strategies import directions, sizes

BEYOND_LIMIT = 1.5
"""Factor by which a test deflection exceeds that of steady sliding, so that the contact surely yields."""


@law_check(
    change="let `rate` and `friction` change sign with v and the deflections; `abs(v)` alone has no direction",
)
def oddness(one: Given) -> None:
    """Reverse slip and deflections: friction and rates of deflections must change sign, nothing else."""
    law = one.law()
    v = one.slip()
    back = -1.0 if has_direction(law) else 1.0
    for memory in (one.memory(law), memory_after_slip(law, v, BEYOND_LIMIT)):
        got = response(law, -v, tuple(back * each for each in memory))
        there = response(law, v, memory)
        should = Response(tuple(back * rate for rate in there.rates), -there.friction)
        one.require_same(law, (v, memory), got, should, "slip turned round")


@law_check(
    change="write v / abs(v) and (v * z.conjugate()).real in place of v.real, v.imag or a fixed direction",
    seldom="no parameters drawn have a form in the plane that turns with the slip",
)
def rotation(one: Given) -> None:
    """Rotate slip and memory in the plane: friction must rotate by the same angle (not in per-axis forms)."""
    law = one.planar_law(lambda law: getattr(law, "planar", "vectorial") != "per-axis")
    v = one.planar_slip()
    turn = one.draw("turn", directions)
    memories = [one.memory(law, planar=True)]
    if has_direction(law):
        memories += [
            tuple(BEYOND_LIMIT * each for each in memories[0]),
            memory_after_slip(law, v, BEYOND_LIMIT),
        ]
    for memory in memories:
        there = response(law, v, memory)
        got = response(law, turn * v, rotate(law, memory, turn))
        should = Response(rotate(law, there.rates, turn), turn * there.friction)
        one.require_same(law, (v, memory), got, should, "everything turned")


@law_check(
    change="write v / abs(v) and (v * z.conjugate()).real in place of v.imag or a fixed sense of turning",
    seldom="no parameters drawn have a form in the plane",
)
def reflection(one: Given) -> None:
    """Mirror slip and memory about x1: friction must be mirrored."""
    law = one.planar_law()
    v, memory = one.motion(law, planar=True)
    there = response(law, v, memory)
    got = response(law, v.conjugate(), reflect(law, memory))
    should = Response(reflect(law, there.rates), there.friction.conjugate())
    one.require_same(law, (v, memory), got, should, "everything mirrored")


@law_check(
    change="write abs(v) and v / abs(v), which mean the same on the line and in the plane",
    seldom="no parameters drawn have a form in the plane",
)
def straight_planar_slide(one: Given) -> None:
    """Slide along x1 in the plane: friction and rates must equal those on the line, with zero across."""
    law = one.planar_law()
    v, memory = one.motion(law)
    scalars = isinstance(law, MemoryLaw) and not has_direction(law)
    across = memory if scalars else tuple(map(complex, memory))
    got = response(law, complex(v, 0.0), across)
    one.require(isinstance(got.friction, complex), "friction in the plane must be complex", got=got.friction)
    one.require_same(law, (v, memory), got, response(law, v, memory), "slip along the line in the plane")


@law_check(
    change="annotate parameters with a dimension as fl.Speed, fl.PerSpeed, fl.Length or fl.Stiffness",
)
def unit_scaling(one: Given) -> None:
    """Change units of length and time: friction must stay the same, rates of memory scale with the units.

    Every parameter is converted by the dimension in its annotation.
    """
    law = one.law()
    v, memory = one.motion(law)
    scales = Units(
        one.draw("unit of length", sizes(1e-3, 1e3)), one.draw("unit of time", sizes(1e-3, 1e3)), 1.0
    )
    there, here = scaled_law(law, scales), response(law, v, memory)
    if not isinstance(law, MemoryLaw) or has_direction(law):
        other = response(there, v / scales.velocity, tuple(each / scales.length for each in memory))
        other = Response(tuple(rate * scales.velocity for rate in other.rates), other.friction)
    else:
        assert isinstance(there, MemoryLaw)
        before = one.drawn["speed slid at before"]
        same = tuple(there.steady(before / scales.velocity, k) for k in range(law.count()))
        other = Response(here.rates, response(there, v / scales.velocity, same).friction)
        _same_pace(one, (law, v, before), (there, v / scales.velocity, before / scales.velocity), scales.time)
    one.require_same(law, (v, memory), other, here, "the same contact in other units")


def _same_pace(
    one: Given, here: tuple[MemoryLaw, float, float], there: tuple[MemoryLaw, float, float], time: float
) -> None:
    """Require that scalars change at the same rate in other units.

    Units of scalars are unknown here: compared instead is the steady-sliding speed that corresponds to each.
    """
    law, v, before = here
    paces, others, quicker = _paces(law, v, before), _paces(*there), _paces(law, 2.0 * v, before)
    for k, (pace, other, size) in enumerate(zip(paces, others, quicker, strict=True)):
        gap = abs(other / time - pace)
        room = 1e-4 * (abs(pace) + abs(other) / time) + 1e-9 * abs(size) + 1e-300
        one.require(gap <= room, f"rate of memory {k} in other units", got=other / time, expected=pace)


def _paces(law: MemoryLaw, v: float, before: float) -> list[float]:
    """Return d ln(s)/dtau of each memory [1/scene time].

    s is the sliding speed at which the present memory would be steady.
    """
    step = 1e-5
    steady = [law.steady(before, k) for k in range(law.count())]
    slopes = [
        (law.steady(before * (1.0 + step), k) - law.steady(before * (1.0 - step), k)) / (2.0 * step)
        for k in range(law.count())
    ]
    rates = response(law, v, tuple(steady)).rates
    return [rate / slope if slope else 0.0 for rate, slope in zip(rates, slopes, strict=True)]
