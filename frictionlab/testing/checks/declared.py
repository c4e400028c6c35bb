"""Checks of what a law declares: each predicate is used by some method, so each must be true."""

from __future__ import annotations

import math
from itertools import pairwise, product

from hypothesis import assume

from frictionlab.laws.base import FrictionLaw, SlidingLaw
from frictionlab.laws.memory import BristleLaw, MemoryLaw
from frictionlab.testing.contact import (
    ContactMemory,
    deflection_scale,
    dot,
    has_direction,
    memory_after_slip,
    response,
    rounding_noise,
    stored_work,
)
from frictionlab.testing.example import Given, for_laws_of, law_check
from frictionlab.testing.strategies import directions, sizes, speeds

WITH_MEMORY = for_laws_of(BristleLaw, MemoryLaw, without="without memory")
BRISTLES = for_laws_of(BristleLaw, without="of laws with one bristle deflection")
SLIDING = for_laws_of(SlidingLaw, without="of laws without memory")
BARELY_MOVING = 1e-300, 1e-100
"""Speeds below any width: a curve however steep is at its value of rest there."""
SLOW_TO_QUICK = tuple(10.0**exponent for exponent in range(-6, 16))
"""Speeds at which work may be drawn out of a law that is not passive, far above those drawn."""


@law_check(
    change="let constant_sliding_friction() be false for these parameters, or correct sliding_friction",
    declares="constant_sliding_friction",
    seldom="constant_sliding_friction() is false for all parameters drawn",
)
def constant_sliding_friction(one: Given) -> None:
    """Sliding friction that is declared constant is the same at every speed."""
    law = one.law(lambda law: law.constant_sliding_friction())
    one.slip()
    slow, quick = (law.sliding_friction(one.draw(name, speeds)) for name in ("speed", "other speed"))
    one.require(abs(quick - slow) <= 1e-12 * abs(slow), "sliding friction differs", got=quick, expected=slow)


@law_check(
    seldom="steepest_fall() is not declared, or infinite for all parameters drawn",
    change="let steepest_fall() return at least this slope, or leave it out",
)
def steepest_fall(one: Given) -> None:
    """Sliding friction falls nowhere steeper with speed than declared, from rest to the quickest slip drawn."""
    law = one.law(lambda law: law.steepest_fall() < math.inf)
    step = one.draw("from one speed to the next, times", sizes(1.02, 1.2))
    ladder = [0.0, *(1e-6 * step**n for n in range(1 + round(12.0 / math.log10(step))))]
    for slow, quick in pairwise(ladder):
        before, after = law.sliding_friction(slow), law.sliding_friction(quick)
        most = law.steepest_fall() * (quick - slow) * (1.0 + 1e-9) + 1e-12 * (abs(before) + abs(after))
        one.require(
            before - after <= most, f"from speed {slow:g} on it falls by", got=before - after, declared=most
        )


@law_check(
    change="let monotone() be false for these parameters, or leave it out",
    declares="monotone",
    skips=SLIDING,
    seldom="monotone() is false for all parameters drawn",
)
def monotone(one: Given) -> None:
    """Friction that is declared monotone never falls with more slip, rest included."""
    law = one.law_near_the_edge(lambda law: law.monotone())
    v, w = one.planar_slip(), one.planar_slip("other slip velocity")
    a, b = law.sliding_vector(v), law.sliding_vector(w)
    scale = (abs(a) + abs(b)) * (abs(v) + abs(w))
    one.require(
        dot(a - b, v - w) >= -1e-12 * scale, "(T(v) - T(w)).(v - w) is negative", got=dot(a - b, v - w)
    )
    held = law.static_friction()
    one.require(held <= abs(a) * (1.0 + 1e-12), "rest holds more than slip", rest=held, slip=abs(a))
    fall = law.steepest_fall()
    one.require(fall == 0.0, "monotone friction falls nowhere, yet its steepest fall is declared", got=fall)


@law_check(
    change="let static_friction() return at least sliding_friction(0), or leave it out",
    skips=SLIDING,
)
def static_friction(one: Given) -> None:
    """Rest holds at least what slip that has only just begun meets."""
    law = one.law()
    held, first = law.static_friction(), law.sliding_friction(0.0)
    one.require(held >= first * (1.0 - 1e-12), "rest holds less than slip", rest=held, slip=first)


@law_check(
    change="correct rate, or largest_deflection() (within(memory) of several numbers), or leave that out",
    skips=WITH_MEMORY,
    seldom="no parameters drawn have a bounded set",
)
def invariant_set(one: Given) -> None:
    """No slip leads a memory out of its set.

    Farther outside a law may lead away: Bouc and Wen's does where unloading gives back more than loading stored.
    """
    law = one.law(lambda law: isinstance(law, MemoryLaw) or law.largest_deflection() < math.inf)
    v = one.slip()
    if isinstance(law, MemoryLaw):
        _stays_within(one, law, v)
        return
    radius = law.largest_deflection() * (1.0 + 1e-13)
    for side in (1.0, -1.0):
        out = side * law.rate(v, side * radius)
        one.require(
            out <= 1e-11 * abs(v), "the deflection grows beyond its largest", z=side * radius, rate=out
        )
    if not law.no_vector_form():
        turn, slip = one.draw("turn", directions), one.planar_slip()
        out = dot(law.rate(slip, radius * turn), turn)
        one.require(out <= 1e-11 * abs(slip), "the deflection grows beyond its largest", rate=out)


def _stays_within(one: Given, law: MemoryLaw, v: float) -> None:
    memory = one.memory(law)
    one.require(law.within(memory), "the memory of slow slip is outside the set", memory=memory)
    rate = law.largest_rate(abs(v))
    assume(0.0 < rate < math.inf)
    for _ in range(20):
        rates = response(law, v, memory).rates
        # from step to step half as long: one that is long passes the corner where a slider begins to move
        tried = (_moved(memory, rates, 0.05 / rate * 0.5**halving) for halving in range(30))
        inside = next((ends for ends in tried if law.within(ends)), None)
        one.require(inside is not None, "slip leads the memory out of its set", memory=memory)
        memory = inside or memory


def _moved(memory: ContactMemory, rates: ContactMemory, step: float) -> ContactMemory:
    return tuple(each + step * slope for each, slope in zip(memory, rates, strict=True))


@law_check(change="let rate(0, z) be zero: take the smoothing width out of the law", skips=BRISTLES)
def held_at_rest(one: Given) -> None:
    """A contact at rest keeps its deflection: one that creeps there has a smoothing width in it."""
    law = one.law()
    _, memory = one.motion(law)
    rate = response(law, 0.0, memory).rates[0]
    one.require(rate == 0.0, "the deflection moves at rest", rate=rate)


@law_check(
    change="leave the smoothing width to a method; or, of a film of fluid, let vanishes_at_rest() be true",
    skips=SLIDING,
)
def not_smoothed(one: Given) -> None:
    """Friction does not vanish with slip unless declared so: dry friction has no width about rest, methods may."""
    law = one.law()
    rest, slow, quicker = (law.sliding_friction(speed) for speed in (0.0, *BARELY_MOVING))
    if law.vanishes_at_rest():
        held = max(rest, law.static_friction())
        one.require(held == 0.0, "friction is declared to vanish at rest, and does not", got=held)
        return
    kept = slow >= 0.5 * rest > 0.0 or slow >= 0.5 * quicker > 0.0
    one.require(kept, "friction vanishes with slip", at_rest=rest, at_1e_300=slow, at_1e_100=quicker)


@law_check(
    change="let passive() be false for these parameters, or leave it out; or correct stored",
    declares="passive",
    skips=WITH_MEMORY,
    seldom="passive() is false for all parameters drawn",
)
def passivity(one: Given) -> None:
    """Friction that is declared passive takes as much work as its memory stores, however quick the slip."""
    law = one.law_near_the_edge(lambda law: law.passive())
    v, memory = one.motion(law, one.in_the_plane(law))
    memories = [memory]
    if isinstance(v, float) or has_direction(law):
        memories += [memory_after_slip(law, v, share) for share in (1.0, 0.7, 0.3, -0.5)]
    for slip, memory in product((v, *(speed * v / abs(v) for speed in SLOW_TO_QUICK)), memories):
        lost, room = _lost(law, slip, memory)
        what = f"at slip speed {abs(slip):g} friction gives work that was never stored"
        one.require(lost >= -room, what, lost_per_time=lost, memory=memory)


def _lost(law: BristleLaw | MemoryLaw, v: complex, memory: tuple[complex, ...]) -> tuple[float, float]:
    """Return the work lost per time and unit load, and how much of it is rounding."""
    rates, friction = response(law, v, memory)
    work, own = dot(friction, v), rounding_noise(law, v, memory)
    kept, room = 0.0, 1e-9 * abs(work) + 20.0 * own.friction * abs(v)
    for k, rate in enumerate(rates):
        slope, doubt = _slope_of_stored(law, memory, k)
        kept += dot(slope, rate)
        room += (1e-9 * abs(slope) + doubt) * abs(rate) + 20.0 * abs(slope) * own.rates[k] * 1e3
    return work - kept, room


def _slope_of_stored(
    law: BristleLaw | MemoryLaw, memory: tuple[complex, ...], k: int
) -> tuple[complex, float]:
    """Gradient of the stored work with respect to one memory, and what rounding of the whole leaves of it."""
    step = 1e-4 * (abs(memory[k]) or (deflection_scale(law) if isinstance(law, BristleLaw) else 1.0))
    ways = (1.0, 1j) if isinstance(memory[k], complex) else (1.0,)
    slope = 0.0 * memory[k]
    for way in ways:
        ahead, behind = ((*memory[:k], memory[k] + s * step * way, *memory[k + 1 :]) for s in (1, -1))
        slope += way * (stored_work(law, ahead) - stored_work(law, behind)) / (2.0 * step)
    return slope, 1e-15 * stored_work(law, memory) / step


def _rates_tell_all(law: type[FrictionLaw]) -> str:
    """Why slip of steady memories need not find the work that a law gives, or ''."""
    sticks = issubclass(law, MemoryLaw) and law.remembers_stick is not MemoryLaw.remembers_stick
    return "of laws whose deflections do not remember whether they stick" if sticks else WITH_MEMORY(law)


@law_check(
    declares="passive",
    change="let passive() be true for these parameters, or leave it out",
    skips=_rates_tell_all,
    share=0.2,
    seldom="passive() is true for all parameters drawn",
)
def not_passive(one: Given) -> None:
    """Friction that is declared not passive gives, by some slip, work that was never stored."""
    law = one.law(lambda law: not law.passive())
    found = any(
        lost < -room
        for speed in SLOW_TO_QUICK
        for memory in _charged(law)
        for lost, room in [_lost(law, speed, memory)]
    )
    assume(
        found or law.steepest_fall() < math.inf
    )  # a fall without a steepest place may go on beyond any speed
    one.require(found, "no slip was found that gives work which was not stored: is the law passive?")


def _charged(law: BristleLaw | MemoryLaw) -> list[tuple[float, ...]]:
    """Memories that slow slip brings, whole and in part."""
    if isinstance(law, BristleLaw):
        return [(share * deflection_scale(law),) for share in (1.0, 0.7, 0.3, -0.5, -1.0)]
    slow = [[law.steady(10.0**exponent, k) for k in range(law.count())] for exponent in (-6, -3, 0)]
    return [tuple(memory) for memory in slow]


@law_check(
    change="let rate_independent() be false for these parameters, or leave it out",
    declares="rate_independent",
    skips=WITH_MEMORY,
    seldom="rate_independent() is false for all parameters drawn",
)
def rate_independence(one: Given) -> None:
    """Memory that is declared to know only the path moves as many times faster as the slip does."""
    law = one.law(lambda law: law.rate_independent())
    v, memory = one.motion(law, one.in_the_plane(law))
    faster = one.draw("times faster", sizes(1e-3, 1e3))
    quick = response(law, faster * v, memory)
    got = quick._replace(rates=tuple(rate / faster for rate in quick.rates))
    one.require_same(law, (v, memory), got, response(law, v, memory), "slip so many times faster")


@law_check(
    change="let largest_rate(speed) return at least this, or leave it out",
    declares="largest_rate",
    skips=WITH_MEMORY,
    seldom="largest_rate() is infinite for all parameters drawn",
)
def largest_rate(one: Given) -> None:
    """Memory's rate changes no faster with the memory than declared."""
    law = one.law(lambda law: 0.0 < law.largest_rate(1.0) < math.inf)
    v = one.slip()
    declared, smooth = law.largest_rate(abs(v)), False
    for memory in (one.memory(law), *(memory_after_slip(law, v, share) for share in (0.95, 0.8, 0.5))):
        for k, each in enumerate(memory):
            size = deflection_scale(law) if isinstance(law, BristleLaw) else abs(each) or 1.0
            change, ends, corner = _change_of_rate(law, v, memory, k, 1e-6 * size)
            if corner:
                continue
            smooth = True
            room = 1e-6 * declared + (1e-8 * abs(v) + 1e-9 * ends) / size
            one.require(
                change <= declared + room,
                "the rate changes faster",
                got=change,
                declared=declared,
                memory=memory,
            )
    assume(smooth)


def _change_of_rate(
    law: FrictionLaw, v: float, memory: ContactMemory, k: int, step: float
) -> tuple[float, float, bool]:
    """Return how fast the rate of a memory changes with it, the size of the rates, whether there is a corner."""
    behind, here, ahead = (
        response(law, v, (*memory[:k], memory[k] + s * step, *memory[k + 1 :])).rates[k] for s in (-1, 0, 1)
    )
    corner = abs(ahead + behind - 2.0 * here) > 1e-3 * abs(ahead - behind)
    return abs(ahead - behind) / (2.0 * step), abs(ahead), corner


@law_check(
    change="let damps_across(speed) be false at this speed",
    skips=BRISTLES,
    seldom="damps_across() is false for all parameters drawn",
)
def damps_across(one: Given) -> None:
    """Small motion across the slip only loses energy to friction where that is declared."""
    law = one.planar_law()
    v, memory = one.motion(law)
    assume(law.damps_across(abs(v)))
    for speed in (abs(v), *(10.0**exponent for exponent in range(-6, 7))):
        if law.damps_across(speed):
            slip = math.copysign(speed, v)
            way = _worst_across(law, slip, memory[0])
            lost, terms = _lost_across(law, slip, memory[0], way)
            what = f"at slip speed {speed:g} friction feeds a motion across the slip"
            one.require(lost >= -1e-4 * terms, what, lost_per_time=lost, terms=terms)


def _lost_across(law: BristleLaw, v: float, z: float, way: tuple[float, float]) -> tuple[float, float]:
    """Work lost per time by a small slip and deflection across (shares of v and of the law's size), and its terms."""
    slip = complex(v, 1e-5 * way[0] * v)
    across = 1e-5 * way[1] * deflection_scale(law)
    rates, friction = response(law, slip, (complex(z, across),))
    spring = law.friction(0j, complex(0.0, across), 0j).imag
    taken, stored = friction.imag * slip.imag, spring * rates[0].imag
    return taken - stored, abs(taken) + abs(stored)


def _worst_across(law: BristleLaw, v: float, z: float) -> tuple[float, float]:
    """Return the slip and deflection across that lose least: where the quadratic form of the loss has its minimum."""
    of_slip, of_deflection, of_both = (_lost_across(law, v, z, way)[0] for way in ((1, 0), (0, 1), (1, 1)))
    mixed = of_both - of_slip - of_deflection
    if of_slip <= 0.0 or of_deflection <= 0.0:
        return (1.0, 0.0) if of_slip < of_deflection else (0.0, 1.0)
    share = -0.5 * mixed / of_deflection
    return (1.0, share) if abs(share) < 1.0 else (1.0 / share, 1.0)
