"""A scene of a law as the search for closed orbits sees it: maps at addresses, and the numbers that judge them.

The search knows states, which are vectors of numbers, and maps of them. It is compiled once, whatever the law, on the
line and in the plane; the maps are compiled for each kind of memory and body, and called where they lie.
"""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np

from frictionlab.compile.addresses import (
    NUMBER,
    TRUTH,
    VECTOR,
    Addressed,
    Interface,
    addresses_of,
    bytes_of,
    call_at,
    machine_type,
    written_to,
)
from frictionlab.compile.call import MadeByKernel
from frictionlab.compile.decorators import inner
from frictionlab.compile.dispatch import by_dimension, by_law
from frictionlab.compile.interpret import interpreted
from frictionlab.laws.base import FrictionLaw
from frictionlab.methods.periodic.first_guess import first_guess, free_inverse
from frictionlab.methods.periodic.period_map import (
    coarsest_of,
    hidden_error_of,
    image_by_path,
    map_kind,
    paced_image,
    rest_of,
    size_of,
    start_of,
    unit_of_scalars,
    unpack,
)
from frictionlab.methods.periodic.steady_sliding import ends_sliding, write_sliding
from frictionlab.motion.equation import bare, belt_advance, changed, fastest_slip, span
from frictionlab.motion.linalg import dimension
from frictionlab.motion.maps.case import Pace, Stepping, case_of, keeping, noting, pace_of, repeating
from frictionlab.motion.orbit.recorder import Track, track_of
from frictionlab.scene.body import BodyNumbers


class SpanImage(NamedTuple):
    """Sums of a map on its way: the integral of friction, in shares of the mean normal load, as x1 + i x2; the time
    at rest, the slowest slip, when rest ended last (-1: it did not), and the steps (-1: it gave up)."""

    friction_impulse: complex
    stuck: float
    closest: float
    released: float
    steps: int


class Orders(NamedTuple):
    """Facts of a law that its maps use.

    finer: how much finer the two maps are that agree in the end. share: of the error before a Newton step to a map
    finer by ``FINER``, what stands in where two means agree by chance. Of order eight both are fitted to 2,500 random
    rows: of 399 others none was uncovered, and half of the errors stated were below 27 times the true; of order five
    see tests/benchmarks/campaign.py bristles. shift: of a state for a central quotient, and accuracy of the maps
    relative to it. kept_shift, kept_accuracy: the same over the steps of another motion, where both maps are in error
    by nearly the same and one-sided quotients will do; relative to the size of the state.
    """

    finer: float
    share: float
    shift: float
    kept_shift: float
    kept_accuracy: float


class Scales(NamedTuple):
    """Numbers of which bounds on a mean are made: the span of a map, the damping along x1, the mean normal load."""

    period: float
    damping: float
    normal_load: float


class Scalars(NamedTuple):
    """Coordinates of a state that are logarithms of scalars, and the smallest unit they are measured by."""

    first: int
    end: int
    unit: float


class Maps(NamedTuple):
    """A law on a body: where its functions and its numbers lie, and what a search asks about them."""

    place: Any
    follow: Any
    rest: Any
    start: Any
    slide: Any
    ends: Any
    guess: Any
    free: Any
    size: int  # of a state
    scalars: Scalars
    remembers: bool
    planar: bool
    per_drive: Scales  # over one period of the drive
    fastest: float  # speed of the friction-free motion against the belt's vibration; infinite if not known
    orders: Orders
    coarsest: float  # accuracy that a map is made with, whatever is asked
    hidden_error: float  # of the mean, that comparing two maps cannot reveal, per accuracy: constant part
    hidden_error_per_time: float  # and the part that is divided by the span


class Setting(NamedTuple):
    """Maps of a law on a body, the speed of the belt, and how many periods of the drive a map spans."""

    maps: Maps
    belt_speed: float
    periods: float


@inner
def scales_on(body: BodyNumbers) -> Scales:
    """Over the span of the body."""
    return Scales(span(body), body.damping_mean + body.damping_split, body.normal_load)


# --- the functions at addresses -------------------------------------------------------------------------------------


class LawOnBody(NamedTuple):
    """Kinds of scene that maps are compiled for."""

    law: Any
    body: BodyNumbers


_of_kind = by_dimension(lambda value, zero: value.real, lambda value, zero: value)
"""_of_kind(value, zero): a vector as the kind of number that motions are told by."""


@inner
def _over(body: BodyNumbers, periods: float) -> BodyNumbers:
    """Return the body, its map spanning so many periods."""
    return changed(body, periods, body.varying)


def _followed_by(image_of_state: Any) -> Any:
    @inner
    def follow(
        on: LawOnBody, belt_speed: float, periods: float, state: Any, residual: Any, stepping: Stepping
    ) -> SpanImage:
        case = case_of(on.law, _over(on.body, periods), belt_speed)
        image = image_of_state(case, state, residual, stepping)
        impulse = image.friction_impulse + 0j
        return SpanImage(impulse, image.stuck, image.closest, image.released, image.steps)

    return follow


@inner
def _rest(on: LawOnBody, belt_speed: float, periods: float, state: Any) -> float:
    body = _over(on.body, periods)
    case = case_of(on.law, body, belt_speed)
    y, _u = unpack(body, state, case.zero)
    # the belt carries the mass until the spring overcomes friction: all whole spans before that are alike
    return rest_of(on.law, body, belt_speed, y + belt_advance(body, belt_speed))


@inner
def _start(on: LawOnBody, state: Any, x: complex, v: complex, z: complex) -> float:
    zero = case_of(on.law, on.body, 0.0).zero
    start_of(on.law, on.body, state, _of_kind(x, zero), _of_kind(v, zero), _of_kind(z, zero))
    return 0.0


@inner
def _slide(on: LawOnBody, belt_speed: float, state: Any) -> float:
    return write_sliding(case_of(on.law, on.body, belt_speed), state)


@inner
def _ends(on: LawOnBody, belt_speed: float, periods: float, state: Any) -> bool:
    return ends_sliding(case_of(on.law, _over(on.body, periods), belt_speed), state)


@inner
def _guess(on: LawOnBody, belt_speed: float, state: Any) -> float:
    return first_guess(on.law, on.body, belt_speed, state)


@inner
def _free(on: LawOnBody, periods: float, rubbing: float, inverse: Any) -> float:
    free_inverse(_over(on.body, periods), rubbing, inverse, case_of(on.law, on.body, 0.0).zero)
    return 0.0


_ROW, _TABLE = machine_type(np.empty(0)), machine_type(np.empty((0, 0)))
_IMAGE = machine_type(SpanImage(0j, 0.0, 0.0, 0.0, 0))
_STEPPING = machine_type(Stepping(0.0, interpreted(track_of)(0), interpreted(pace_of)(0), False))
_FOLLOW = Interface((NUMBER, NUMBER, _ROW, _ROW, _STEPPING), _IMAGE)
_REST = Interface((NUMBER, NUMBER, _ROW), NUMBER)
_START = Interface((_ROW, VECTOR, VECTOR, VECTOR), NUMBER)
_SLIDE = Interface((NUMBER, _ROW), NUMBER)
_ENDS = Interface((NUMBER, NUMBER, _ROW), TRUTH)
_FREE = Interface((NUMBER, NUMBER, _TABLE), NUMBER)
_follow_at, _rest_at, _start_at = call_at(_FOLLOW), call_at(_REST), call_at(_START)
_slide_at, _ends_at, _free_at = call_at(_SLIDE), call_at(_ENDS), call_at(_FREE)


_OF_ORDER_EIGHT = Orders(16.0, 0.035, 1e-5, 1e-6, 1e-8)
_BY_PATH = Orders(16.0, 0.035, 1e-4, 1e-6, 1e-8)
"""Bristles never stick: their maps bend less, and cost more."""
_WITH_MEMORY = Orders(5.7, 0.15, 1e-4, 3e-6, 3e-8)
"""As many steps more as for ``FINER`` are the square root of two times as many; of order 5 there are many more for
finer maps, and where events are found is less exact."""


def _remembers(law: Any) -> bool:
    return True


_has_memory = by_law(lambda law: False, _remembers, _remembers)


def _made_by(image_of_state: Any, of_sliding: Orders, of_memory: Orders) -> Any:
    """Return the kernel ``maps_of(law, body)``, its spans followed by ``image_of_state``."""
    addresses = addresses_of(
        [
            Addressed(_followed_by(image_of_state), _FOLLOW),
            Addressed(_rest, _REST),
            Addressed(_start, _START),
            Addressed(_slide, _SLIDE),
            Addressed(_ends, _ENDS),
            Addressed(_guess, _SLIDE),
            Addressed(_free, _FREE),
        ]
    )

    @inner
    def maps_of(law: Any, body: BodyNumbers) -> Any:
        table = body.varying.table.copy()  # steps write into it
        on = LawOnBody(law, bare(body, table))
        zero = case_of(law, body, 0.0).zero
        room = np.empty(bytes_of(on), np.uint8)
        at = addresses(on)
        hidden_error, per_time = hidden_error_of(law, on.body, zero)
        scales = scales_on(_over(body, 1.0))
        remembers = _has_memory(law)
        size = size_of(law, zero)
        scalars = Scalars(2 * dimension(zero), size, unit_of_scalars(law, on.body, zero))
        return (room, table), Maps(
            written_to(on, room), at[0], at[1], at[2], at[3], at[4], at[5], at[6],
            size, scalars, remembers, dimension(zero) == 2, scales, fastest_slip(on.body),
            of_memory if remembers else of_sliding,
            coarsest_of(law, on.body), hidden_error, per_time,
        )  # fmt: skip

    return maps_of


maps_of, maps_by_path = (
    _made_by(paced_image, _OF_ORDER_EIGHT, _WITH_MEMORY),
    _made_by(image_by_path, _BY_PATH, _BY_PATH),
)
"""(law, body): the law and the body where they lie, and their maps; by path: of a bristle whose path is exact."""


def table_of_maps(law: FrictionLaw, body: BodyNumbers) -> MadeByKernel:
    """Return the table of the maps of a law on a body, for other kernels to call."""
    planar = isinstance(body.reference_sine, complex)
    by_path = map_kind(law, planar) == "exact path" and len(body.varying.keeps_stiffness) == 0
    return MadeByKernel(maps_by_path if by_path else maps_of, law, body)


# --- what a search asks ---------------------------------------------------------------------------------------------


@inner
def scales_of(setting: Setting) -> Scales:
    """Over the span of its maps."""
    period, damping, normal_load = setting.maps.per_drive
    return Scales(setting.periods * period, damping, normal_load)


@inner
def paced_map(setting: Setting, state: Any, residual: Any, stepping: Stepping) -> SpanImage:
    """One span from a state; leaves image - state in residual. Steps of laws without memory are not kept.

    steps is -1 where it gave up, or where the events of this state are not those of the steps that it repeats.
    """
    maps = setting.maps
    return _follow_at(
        maps.follow, maps.place, (setting.belt_speed, setting.periods, state, residual, stepping)
    )


@inner
def period_map(setting: Setting, state: Any, residual: Any, accuracy: float) -> SpanImage:
    """Return the image of a state after one span; leaves image - state in residual."""
    return paced_map(setting, state, residual, noting(accuracy, track_of(0)))


@inner
def recorded_map(setting: Setting, state: Any, residual: Any, accuracy: float, track: Track) -> SpanImage:
    """Return the same, noted on a track with room."""
    return paced_map(setting, state, residual, noting(accuracy, track))


@inner
def kept_map(setting: Setting, state: Any, residual: Any, accuracy: float, pace: Pace) -> SpanImage:
    """Return the same, its steps kept in a pace with room."""
    return paced_map(setting, state, residual, keeping(accuracy, pace))


@inner
def repeated_map(setting: Setting, state: Any, residual: Any, accuracy: float, pace: Pace) -> SpanImage:
    """Return the same by the steps of another state."""
    return paced_map(setting, state, residual, repeating(accuracy, pace))


@inner
def spans_at_rest(setting: Setting, state: Any) -> float:
    """Count the whole spans, at least one, for which a mass that rested for one is surely carried on without slip."""
    maps = setting.maps
    return _rest_at(maps.rest, maps.place, (setting.belt_speed, setting.periods, state))


@inner
def write_state(maps: Maps, state: Any, x: complex, v: complex, z: complex) -> None:
    """Write the state of a mass at x moving at v at tau = 0; z: the deflection of its bristle, of another memory the
    velocity of steady sliding that it remembers."""
    _start_at(maps.start, maps.place, (state, x, v, z))


@inner
def write_sliding_state(setting: Setting, state: Any) -> float:
    """State at tau = 0 of a mass that slides as if slip never reversed, under friction at the belt's speed.

    Returns the coefficient of that, with the sign of the belt.
    """
    return _slide_at(setting.maps.slide, setting.maps.place, (setting.belt_speed, state))


@inner
def ends_in_sliding(setting: Setting, state: Any) -> bool:
    """Write a motion on a belt where slip need not reverse; True if it surely slides on in one direction."""
    maps = setting.maps
    return _ends_at(maps.ends, maps.place, (setting.belt_speed, setting.periods, state))


@inner
def slip_keeps_its_side(setting: Setting) -> bool:
    """Check whether dashpots act and the belt is, to rounding, no slower than the vibration without friction."""
    maps = setting.maps
    return maps.per_drive.damping > 0.0 and abs(setting.belt_speed) >= (1.0 - 1e-14) * maps.fastest


@inner
def guess_state(setting: Setting, state: Any, inverse: Any) -> None:
    """Write the start of a search: a state, and the inverse of (monodromy - identity) with friction as a dashpot."""
    maps = setting.maps
    guess_inverse(setting, _slide_at(maps.guess, maps.place, (setting.belt_speed, state)), inverse)


@inner
def guess_inverse(setting: Setting, rubbing: float, inverse: Any) -> None:
    """Write the inverse of (monodromy - identity) with friction as a dashpot of this coefficient."""
    _free_at(setting.maps.free, setting.maps.place, (setting.periods, rubbing, inverse))


@inner
def hidden_error_of_mean(setting: Setting, accuracy: float) -> float:
    """Return the error of the mean that comparing two maps of this accuracy cannot reveal."""
    maps, scales = setting.maps, scales_of(setting)
    return accuracy / scales.normal_load * (maps.hidden_error + maps.hidden_error_per_time / scales.period)
