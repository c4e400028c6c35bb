"""The time steppers alone: the orders they declare, stability, and friction's impulse within its disk."""

from __future__ import annotations

import math
from typing import Any, NamedTuple

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from profiles import deep, some
from strategies import sizes

from frictionlab.compile.cache import compiled
from frictionlab.compile.call import KernelCall
from frictionlab.compile.decorators import inner
from frictionlab.laws.coulomb import Coulomb
from frictionlab.laws.stribeck import Stribeck
from frictionlab.methods.march.adapters import Moreau, Rk4, Smoothed, _expanded_force, _slopes_at
from frictionlab.methods.march.lap import NOTHING, MarchSettings
from frictionlab.methods.march.laps import TIRED, MarchState, march_laps
from frictionlab.motion import contact as smoothing
from frictionlab.motion.steppers.moreau import moreau_step
from frictionlab.motion.steppers.step import StepStart
from frictionlab.scene.body import BodyNumbers, Mass, in_the_plane, on_the_line

LAW = Coulomb(mu=0.4)
END = 10.37
GRIDS = 200 * 2 ** np.arange(8)


class Push(NamedTuple):
    """A mass from rest, gamma^2 = 10, beta = 0.1, loads P along x1 and across at a quarter period's lag."""

    load: float
    belt_speed: float
    planar: bool


CROSSING, STICK = Push(10.0, 14.0, False), Push(6.0, 0.5, False)
SMOOTH = Push(10.0, 14.0, True)


def body_of(push: Push) -> BodyNumbers:
    """The body of a push, all of its load on it."""
    mass = Mass(
        damping=0.2,
        stiffness=1.0,
        transverse_damping=0.3,
        transverse_stiffness=2.0,
        normal_load=10.0,
        frequency=1.0,
        force=complex(push.load),
        transverse_force=1j * push.load,
    )
    return in_the_plane(mass) if push.planar else on_the_line(mass)


def alike() -> BodyNumbers:
    """The planar body with springs and dashpots that know no direction."""
    body = body_of(SMOOTH)
    return body._replace(damping_mean=0.2, damping_split=0.0, stiffness_mean=1.0, stiffness_split=0.0)


def settings_of(push: Push, steps: int, **changes: Any) -> MarchSettings:
    """Once from tau = 0 to the end in equal steps."""
    values = {
        "belt_speed": push.belt_speed, "driven": True, "steps": steps, "span": END, "first": END / steps,
        "slack": 0.5, "reach": END / steps, "enough": 0.0, "most": 1, "stride": 2, "rate": 0.0,
        "work": 10**9, "window": 50, "room": 0, "refined": 1,
    }  # fmt: skip
    return MarchSettings(**(values | changes))


def marched(stepper: Any, push: Push, steps: int, **changes: Any) -> Any:
    """The march once to the end, from rest."""
    start = 0j if push.planar else 0.0
    settings = settings_of(push, steps, **changes)
    return KernelCall(march_laps, LAW)(
        body_of(push), stepper, settings, MarchState(start, start, 0.0 * start + NOTHING)
    )


def end_of(stepper: Any, push: Push, steps: int, **changes: Any) -> np.ndarray:
    """Position and velocity at the end."""
    march = marched(stepper, push, steps, **changes)
    assert march.progress.verdict != TIRED
    return np.array([march.laps.x[-1], march.laps.v[-1]])


def reference(push: Push) -> np.ndarray:
    """By another stepper: smooth motion by the eighth-order one with next to no smoothing, jumps by many steps."""
    if push.planar:
        return end_of(Smoothed(1e-3, smoothing.TANH, 1e-13), push, 100, first=1e-3, slack=1e-9, refined=0)
    return end_of(Moreau(0.5), push, 3_276_800)


def worst_order(stepper: Any, push: Push, shifts: int) -> float:
    """The slope of the largest error of several neighbouring grids: one alone may round reversals luckily."""
    exact = reference(push)
    errors = [
        max(np.abs(end_of(stepper, push, steps + 3 * shift) - exact).sum() for shift in range(shifts))
        for steps in GRIDS.tolist()
    ]
    return float(np.polyfit(np.log(1.0 / GRIDS), np.log(errors), 1)[0])


@some(1, "seconds of steps")
@pytest.mark.parametrize(
    ("push", "stepper", "low", "high"),
    [
        (CROSSING, Rk4(), 0.7, 1.5),
        (CROSSING, Moreau(0.5), 0.8, 1.5),
        (CROSSING, Moreau(1.0), 0.9, 1.1),
        (STICK, Rk4(), 0.7, 1.5),
        (STICK, Moreau(0.5), 1.7, 2.3),
        (STICK, Moreau(1.0), 0.9, 1.1),
    ],
)
def test_jumps_of_friction_leave_the_orders_that_are_known_of_them(push, stepper, low, high):
    assert low <= worst_order(stepper, push, 6) <= high


@deep("more kernels to compile")
@pytest.mark.parametrize(
    ("stepper", "order", "grids"), [(Rk4(), 4, 400), (Moreau(0.5), 2, 800), (Moreau(1.0), 1, 12_800)]
)
def test_planar_slip_without_rest_is_stepped_at_the_declared_order(stepper, order, grids):
    exact = reference(SMOOTH)
    coarse, fine = (np.abs(end_of(stepper, SMOOTH, n) - exact).sum() for n in (grids, 4 * grids))
    assert math.log(coarse / fine, 4.0) == pytest.approx(order, abs=0.25 if order < 4 else 1.0)


@some(2, "millions of steps")
@pytest.mark.parametrize("steps", [12_800, 51_200, 102_403, 1_638_400])
@pytest.mark.parametrize("stepper", [Rk4(), Moreau(1.0)])
def test_equal_steps_end_with_the_lap_however_their_sum_is_rounded(stepper, steps):
    """One more, of rounding's length, would read a load beyond the last."""
    assert marched(stepper, CROSSING, steps).progress.steps == steps


# --- moreau -------------------------------------------------------------------------------------------------------


class Problem(NamedTuple):
    """What a step of moreau sees."""

    law: Any
    body: BodyNumbers
    grid: Any
    stepper: Moreau


@inner
def one_step(law, body, grid, stepper, start, h):
    """One step, for tests."""
    return moreau_step(_expanded_force, _slopes_at, Problem(law, body, grid, stepper), start, h)


def step(body, belt_speed, load, theta, x, v, h, law=LAW):
    """One step of moreau under a constant load."""
    grid = np.array([load, body.normal_load, belt_speed] * 3)
    return compiled(one_step, law)(body, grid, Moreau(theta), StepStart(0, 0.0, x, v), h)


planar = st.builds(
    lambda size, angle: size * complex(math.cos(angle), math.sin(angle)),
    sizes(1e-3, 1e3),
    st.floats(-3.2, 3.2),
)
thetas = st.sampled_from([0.5, 1.0])


@given(x=planar, v=planar, load=planar, h=sizes(1e-5, 1e3), theta=thetas)
def test_the_impulse_of_friction_never_leaves_its_disk(x, v, load, h, theta):
    law = Stribeck(mu_static=0.6, mu_kinetic=0.3, stribeck_speed=0.5)
    taken = step(body_of(SMOOTH), 0.7, load, theta, x, v, h, law)
    highest = 0.6 if taken.stuck else 0.6 * (1.0 + 1e-12)
    assert abs(taken.impulse) <= highest * h * (1.0 + 1e-12)
    assert not taken.stuck or taken.v == 0.7


@given(
    x=sizes(1e-3, 1e3), v=sizes(1e-3, 1e3), load=st.floats(-100.0, 100.0), h=sizes(1e-5, 1e2), theta=thetas
)
def test_a_step_in_the_plane_along_the_belt_is_the_step_on_the_line(x, v, load, h, theta):
    on_the_line = step(body_of(CROSSING), 14.0, load, theta, x, -v, h)
    in_the_plane = step(alike(), 14.0, complex(load), theta, complex(x), complex(-v), h)
    size = abs(x) + abs(v) + abs(load) + 14.0
    assert in_the_plane.x == pytest.approx(on_the_line.x, abs=1e-11 * size * (1.0 + h))
    assert in_the_plane.v == pytest.approx(on_the_line.v, abs=1e-11 * size)


# --- smoothed -----------------------------------------------------------------------------------------------------


@inner
def share_of(shape, u):
    """The share of friction at u widths, for tests."""
    return smoothing.share(shape, u)


@pytest.mark.parametrize(
    ("shape", "slope", "tail"),
    [
        (smoothing.TANH, 1.0, lambda u: 2.0 * math.exp(-2.0 * u)),
        (smoothing.ARCTAN, 2.0 / math.pi, lambda u: 2.0 / math.pi / u),
    ],
)
def test_smoothing_rises_at_its_slope_and_leaves_its_tail(shape, slope, tail):
    share = compiled(share_of)
    assert share(shape, 1e-6) == pytest.approx(slope * 1e-6, rel=1e-9)
    for u in (3.0, 10.0, 30.0):
        assert 0.0 <= 1.0 - share(shape, u) <= tail(u) * (1.0 + 1e-9) + 1e-15
