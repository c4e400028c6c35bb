"""Checks of bristles along a path: exact updates, elastic ranges, and where steady sliding leads."""

from __future__ import annotations

import math
from typing import Any

from hypothesis import assume
from hypothesis import strategies as st

from frictionlab.laws.base import FrictionLaw
from frictionlab.laws.memory import BristleLaw, MemoryLaw
from frictionlab.testing.checks.declared import BRISTLES, SLOW_TO_QUICK, WITH_MEMORY
from frictionlab.testing.contact import deflection_scale, dot, response
from frictionlab.testing.example import Given, for_laws_of, law_check
from frictionlab.testing.strategies import directions, evenly, seldom, signs, sizes, speeds

NO_EXACT_PATH = "exact_path() is false for all parameters drawn"
FURTHEST = 1e12
"""Deflection [scene length] beyond which bristles have no bound."""
STEPS = 400
"""Steps of the Runge-Kutta method, along a path of a few largest deflections."""


@law_check(
    change="let sliding_friction(speed) be what rate and friction lead to (and steady, of several numbers)",
    skips=WITH_MEMORY,
)
def steady_sliding(one: Given) -> None:
    """Memory that has become steady gives the friction of ``sliding_friction``."""
    law, speed = one.law(), one.draw("speed", speeds)
    should = law.sliding_friction(speed)
    if isinstance(law, MemoryLaw):
        memory = tuple(law.steady(speed, k) for k in range(law.count()))
        got = response(law, speed, memory)
        for k, rate in enumerate(got.rates):
            step = 1e-6 * (abs(memory[k]) or 1.0)
            moved = response(law, speed, (*memory[:k], memory[k] + step, *memory[k + 1 :])).rates[k]
            still = abs(rate) <= 1e-4 * abs(moved - rate) + 1e-12 * speed
            one.require(still, f"memory {k} moves in steady sliding", rate=rate)
        friction, doubt = got.friction, 0.0
    else:
        friction, doubt = _steady_friction(one, law, speed)
    near = abs(friction - should) <= 1e-9 * (abs(should) + abs(friction)) + doubt
    one.require(near, "steady friction differs from sliding_friction", got=friction, expected=should)


def _steady_friction(one: Given, law: BristleLaw, speed: float) -> tuple[float, float]:
    """Friction where slip from no deflection leads, and how far off it may be where that is neared as a power."""
    one.require(law.rate(speed, 0.0) > 0.0, "slip does not deflect an undeflected bristle")
    ends = [_slowed_to(one, law, speed, share) for share in (1e-9, 1e-12, 1e-15)]
    first, second, third = (float(law.friction(speed, z, 0.0 * speed)) for z in ends)
    left = (
        (third - second) ** 2 / (second - first - third + second)
        if abs(third - second) > 1e-9 * third
        else 0.0
    )
    return third + left, 0.05 * abs(left)  # Aitken (1926): exact for powers


def _slowed_to(one: Given, law: BristleLaw, speed: float, share: float) -> float:
    """Return the least deflection at which its rate is no more than a share of the slip."""
    low, high = 0.0, 1.5 * deflection_scale(law)
    bounded = law.largest_deflection() < math.inf
    while not bounded and law.rate(speed, high) > 1e-12 * speed and high < FURTHEST:
        high *= 2.0  # nothing says how far bristles bend
    one.require(law.rate(speed, high) <= 1e-12 * speed, "the deflection grows without bound", z=high)
    for _ in range(200):
        middle = 0.5 * (low + high)
        if not low < middle < high:
            break
        low, high = (middle, high) if law.rate(speed, middle) > share * speed else (low, middle)
    return high


@law_check(
    change="correct deflected, or leave out exact_path()",
    declares="exact_path",
    skips=BRISTLES,
    share=0.2,
    seldom=NO_EXACT_PATH,
)
def exact_path(one: Given) -> None:
    """``deflected`` is what integrating the rate along a straight path gives."""
    law = one.law(lambda law: law.exact_path() and law.largest_rate(1.0) < math.inf)
    start, path = _start_and_path(one, law)
    assume(law.largest_rate(1.0) * abs(path) < STEPS)  # steps longer than that find nothing
    got, should = law.deflected(start, path), _integrated(law, start, path)
    one.require(
        abs(got - should) <= _room(law, path),
        "deflected differs from the integrated rate",
        got=got,
        expected=should,
    )


def _start_and_path(one: Given, law: BristleLaw) -> tuple[Any, Any]:
    size, planar = deflection_scale(law), law.planar == "vectorial" and one.in_the_plane(law)
    way = one.draw("direction of the path", directions if planar else signs)
    path = size * one.draw("path over deflection", sizes(1e-2, 5.0)) * way
    return one.memory(law, planar)[0], path


def _integrated(law: BristleLaw, z: Any, path: Any) -> Any:
    """Return the deflection after the path at unit speed, by the classical Runge-Kutta method."""
    v, h = path / abs(path), abs(path) / STEPS
    for _ in range(STEPS):
        a = law.rate(v, z)
        b = law.rate(v, z + 0.5 * h * a)
        c = law.rate(v, z + 0.5 * h * b)
        z = z + h / 6.0 * (a + 2.0 * b + 2.0 * c + law.rate(v, z + h * c))
    return z


def _room(law: BristleLaw, path: Any) -> float:
    """Return what steps may be wrong by: fourth order where rates are smooth, a step's length where they jump."""
    if law.yield_deflection() < math.inf:
        return 2.0 * abs(path) / STEPS
    step = min(1.0, law.largest_rate(1.0) * abs(path) / STEPS)
    return (1e-9 + 10.0 * step**4) * deflection_scale(law)


@law_check(
    change="correct deflected, or leave out exact_path()",
    declares="exact_path",
    skips=BRISTLES,
    seldom=NO_EXACT_PATH,
)
def path_splitting(one: Given) -> None:
    """One straight path and its two parts, one after the other, end at the same deflection."""
    law = one.law(lambda law: law.exact_path())
    start, path = _start_and_path(one, law)
    share = one.draw("share of the first part", evenly(0.01, 0.99))
    whole = law.deflected(start, path)
    parts = law.deflected(law.deflected(start, share * path), (1.0 - share) * path)
    sharp = 1e-6 if law.largest_rate(1.0) == math.inf else 1e-10  # a root at the limit magnifies rounding
    one.require(
        abs(whole - parts) <= sharp * deflection_scale(law),
        "two parts of a path differ from it",
        got=parts,
        expected=whole,
    )


@law_check(
    change="let saturation_path return a longer path, or leave it out",
    declares="saturation_path",
    skips=BRISTLES,
    seldom="saturation_path() is infinite for all parameters drawn",
)
def saturation_path(one: Given) -> None:
    """After the path declared, further slip the same way changes the deflection no more."""
    law = one.law(lambda law: law.exact_path() and law.saturation_path(0.0, 1.0) < math.inf)
    (z,), side = one.memory(law), one.draw("side", signs)
    path = max(law.saturation_path(z, side), 0.0) * (1.0 + 1e-9)
    assume(path > 0.0)
    end = law.deflected(z, side * path)
    further = law.deflected(end, side * deflection_scale(law) * one.draw("further", sizes(1e-3, 1e2)))
    one.require(
        abs(further - end) <= 1e-6 * deflection_scale(law),
        "the deflection changes further",
        at=end,
        then=further,
    )


def _follows(one: Given, law: BristleLaw, v: Any, z: Any, back: str = "") -> None:
    """Require that a deflection moves with the slip."""
    rate = law.rate(v, z)
    one.require(
        abs(rate - v) <= 1e-12 * abs(v), f"the bristle does not follow the slip{back}", z=z, rate=rate
    )


@law_check(
    change="let elastic_deflection() return less, or leave it out",
    declares="elastic_deflection",
    skips=BRISTLES,
    seldom="elastic_deflection() is zero for all parameters drawn",
)
def elastic_deflection(one: Given) -> None:
    """Below the deflection declared elastic the bristle moves with the slip, whatever its direction."""
    law = one.law(lambda law: law.elastic_deflection() > 0.0)
    v = one.slip()
    for share in (one.draw("share", evenly(-0.999, 0.999)), 0.999, -0.999):
        _follows(one, law, v, share * min(law.elastic_deflection(), 1e300))


@law_check(
    change="let elastic_unloading() be false for these parameters, or leave it out",
    declares="elastic_unloading",
    skips=BRISTLES,
    seldom="elastic_unloading() is false for all parameters drawn",
)
def elastic_unloading(one: Given) -> None:
    """Deflections that slip makes smaller move with it where unloading is declared elastic."""
    law = one.law(lambda law: law.elastic_unloading())
    v = one.slip()
    for share in (one.draw("share", sizes(1e-6, 1.0)), 0.9, 1.0):
        _follows(one, law, v, -math.copysign(share * deflection_scale(law), v), back=" back")


def _never_sticks(law: type[FrictionLaw]) -> str:
    if not issubclass(law, MemoryLaw):
        return "of laws with several deflections"
    told = any(
        getattr(law, name) is not getattr(MemoryLaw, name) for name in ("remembers_stick", "breakaway")
    )
    return "" if told else "no deflection remembers whether it sticks"


@law_check(change="correct breakaway or rate, or leave out remembers_stick()", skips=_never_sticks)
def breakaway(one: Given) -> None:
    """A deflection that remembers whether it sticks breaks away where it slips steadily, in every direction alike."""
    law = one.law()
    v, turn = one.slip(), one.draw("turn", directions)
    if not law.remembers_stick():
        for k in range(law.count()):
            one.require(law.breakaway(v, k) == math.inf, "nothing sticks, yet something breaks away", k=k)
        return
    one.require(law.memory_kind == "deflections", "only deflections stick", kind=law.memory_kind)
    memory, speed = one.memory(law), abs(v)
    for k in range(law.count()):
        at, away = law.breakaway(v, k), abs(law.steady(v, k))
        one.require(abs(at - away) <= 1e-9 * at, f"deflection {k} slips elsewhere", breakaway=at, steady=away)
        turned = law.breakaway(speed * turn, k)
        one.require(abs(turned - at) <= 1e-9 * at, "breakaway differs by direction", got=turned, expected=at)
        for other in (0.0, speed, *SLOW_TO_QUICK):
            size = law.breakaway(other, k)
            one.require(0.0 < size < math.inf, f"breakaway at speed {other:g}", got=size)
        one.require(
            law.yield_deflection(k) == math.inf, "what remembers that it slips has no yield surface", k=k
        )
        still = law.rate(0.0 * v, memory, k)
        one.require(still == 0.0, f"deflection {k} moves at rest", rate=still)


@law_check(
    change="let rate(v, memory, k) use memory[k] alone",
    skips=for_laws_of(MemoryLaw, without="of laws that remember one number at most"),
    seldom="count() is 1 for all parameters drawn",
)
def uncoupled(one: Given) -> None:
    """Rates depend on slip and on that number alone: steps are solved number by number."""
    law = one.law(lambda law: law.count() > 1)
    v, memory = one.motion(law)
    rates = response(law, v, memory).rates
    for k, rate in enumerate(rates):
        others = tuple(each if j == k else 0.3 * each for j, each in enumerate(memory))
        alone = response(law, v, others).rates[k]
        same = abs(alone - rate) <= 1e-9 * (abs(alone) + abs(rate))
        one.require(same, f"the rate of memory {k} changes with the others", got=alone, expected=rate)


def _yield_surfaces(law: FrictionLaw) -> list[float]:
    """Return the radius of each deflection's yield surface; none for laws that have none in the plane."""
    if isinstance(law, MemoryLaw):
        return [law.yield_deflection(k) for k in range(law.count())] if law.turning else []
    return [law.yield_deflection()] if isinstance(law, BristleLaw) and not law.no_vector_form() else []


def _own_rate(law: Any, v: complex, memory: list[complex], k: int) -> Any:
    """Return the rate of one deflection, whatever form a bristle law takes in the plane."""
    return law.rate(v, memory, k) if isinstance(law, MemoryLaw) else law.rate(v, memory[k])


@law_check(
    change="correct yield_deflection or rate, or leave yield_deflection out",
    declares="yield_deflection",
    skips=for_laws_of(BristleLaw, MemoryLaw, without="of laws with deflections"),
    seldom="yield_deflection() is infinite for all parameters drawn",
)
def yield_deflection(one: Given) -> None:
    """Below the deflection of yield a bristle follows the slip; at it, it moves along a circle."""
    law = one.law(lambda law: any(radius < math.inf for radius in _yield_surfaces(law)))
    v, turn = one.planar_slip(), one.draw("turn", directions)
    share = one.draw("share", seldom(st.just(0.999), evenly(0.0, 0.999)))
    surfaces = _yield_surfaces(law)
    inside = [share * min(radius, 1e300) * turn for radius in surfaces]
    at = [(1.0 + 1e-14) * min(radius, 1e300) * turn for radius in surfaces]
    for k in [k for k, radius in enumerate(surfaces) if radius < math.inf]:
        rate = _own_rate(law, v, inside, k)
        follows = abs(rate - v) <= 1e-12 * abs(v)
        one.require(follows, f"deflection {k} does not follow the slip", share=share, rate=rate)
        assume(dot(v, turn) > 1e-6 * abs(v))
        out = dot(_own_rate(law, v, at, k), turn)
        one.require(
            abs(out) <= 1e-11 * abs(v), f"deflection {k} leaves its circle of yield", outward_rate=out
        )
