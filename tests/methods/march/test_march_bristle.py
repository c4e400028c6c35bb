"""Time stepping of laws with bristles: orders, limits and errors against references of unrelated methods."""

from __future__ import annotations

import math

import numpy as np
import pytest
from answered import with_columns
from hypothesis import given
from hypothesis import strategies as st
from profiles import deep
from resonance import at_resonance as scene
from strategies import sizes

from frictionlab.compile.cache import compiled
from frictionlab.compile.call import KernelCall
from frictionlab.compile.decorators import njit
from frictionlab.laws.dahl import Dahl
from frictionlab.laws.elasto_plastic import ElastoPlastic
from frictionlab.laws.jenkins import Jenkins
from frictionlab.laws.lugre import LuGre
from frictionlab.methods.march.adapters import Rk4, Sdirk2
from frictionlab.methods.march.lap import MarchSettings
from frictionlab.methods.march.laps import MarchState, march_laps
from frictionlab.methods.march.method import March
from frictionlab.motion.contact import advance_bristle, project_to_yield
from frictionlab.motion.steppers.rk4 import DECAY
from frictionlab.scene.body import Mass, on_the_line
from frictionlab.scene.scene import Scene

STEPPERS = {"rk4": Rk4(), "sdirk2": Sdirk2()}
compiling = deep("more kernels to compile")
STEADY = LuGre(mu_kinetic=0.4, presliding_length=1.0, damping=0.05)
FALLING = LuGre(mu_kinetic=0.25, mu_static=0.4, stribeck_speed=10.0, presliding_length=1.0, damping=0.05)


def solve(one, law, tolerance=1e-5, **keys):
    return with_columns(March(**keys), one, law, tolerance)


# --- against references ------------------------------------------------------------------------------------------


# --- orders -------------------------------------------------------------------------------------------------------


END = 10.37
PUSHED = Mass(0.2, 1.0, 0.0, 1.0, 10.0, 1.0, 10.0 + 0j, 0j)
"""P = 10, gamma^2 = 10, beta = 0.1."""
FREE = Mass(0.0, 0.0, 0.0, 0.0, 1e-12, 1.0, 0j, 0j)
"""A mass that next to nothing slows down: slip at a fixed velocity."""


def stepped(stepper, mass, steps, h, law=STEADY, **start):
    """So many equal steps of a mass in one lap."""
    values = {"belt_speed": 0.0, "v": 0.0, "z": 0.0, **start}
    settings = MarchSettings(
        belt_speed=values["belt_speed"], driven=True, steps=steps, span=h * steps, first=h, slack=0.5, reach=h,
        enough=0.0, most=1, stride=2, rate=0.0, work=10**9, window=50, room=0, refined=1,
    )  # fmt: skip
    begin = MarchState(0.0, values["v"], np.array([values["z"]]))
    laps = KernelCall(march_laps, law)(on_the_line(mass), STEPPERS[stepper], settings, begin).laps
    return np.array([laps.x[-1].real, laps.v[-1].real, laps.z[-1, 0].real])


def order_of(stepper, grids, shifts, **case):
    """The slope of the largest error of several neighbouring grids: one alone may round reversals luckily."""
    exact = stepped("rk4", PUSHED, 400_000, END / 400_000, **case)
    errors = [
        max(
            np.abs(stepped(stepper, PUSHED, steps, END / steps, **case) - exact).sum()
            for steps in range(grid, grid + 3 * shifts, 3)
        )
        for grid in grids
    ]
    return float(np.polyfit(-np.log(grids), np.log(errors), 1)[0])


@deep("more kernels to compile")
@pytest.mark.parametrize(("stepper", "order"), [("rk4", 4), pytest.param("sdirk2", 2, marks=compiling)])
def test_slip_that_does_not_reverse_is_stepped_at_the_declared_order(stepper, order):
    soft = STEADY.model_copy(update={"presliding_length": 30.0})
    assert order_of(stepper, [200, 400, 800], 1, law=soft, belt_speed=60.0) == pytest.approx(order, abs=0.2)


@deep("more kernels to compile")
@pytest.mark.parametrize("stepper", ["rk4", pytest.param("sdirk2", marks=compiling)])
def test_where_slip_reverses_the_order_is_two(stepper):
    assert 1.6 <= order_of(stepper, [1600, 6400, 25_600], 6, belt_speed=5.0) <= 2.5


# --- limits -------------------------------------------------------------------------------------------------------


def slid(stepper, slip, h, steps, z=0.0):
    """The deflection after so many steps at a fixed slip velocity."""
    return stepped(stepper, FREE, steps, h, v=slip, z=z)[2]


@deep("more kernels to compile")
@pytest.mark.parametrize("speed", [0.3, 30.0])
def test_rk4_is_stable_up_to_its_limit_and_not_beyond(speed):
    rest, limit = STEADY.presliding(), DECAY / STEADY.largest_rate(speed)
    assert slid("rk4", speed, 0.97 * limit, 400) == pytest.approx(rest, rel=1e-6)
    assert abs(slid("rk4", speed, 1.05 * limit, 60)) > 1e3 * rest


@deep("more kernels to compile")
@pytest.mark.parametrize("share", [-1.0, 0.0, 0.9])
def test_sdirk2_forgets_in_one_step_what_decays_a_million_times_faster(share):
    speed, largest = 30.0, STEADY.largest_deflection()
    h = 1e6 / STEADY.largest_rate(speed)
    assert slid("sdirk2", speed, h, 1, share * largest) == pytest.approx(largest, rel=2e-5)


def test_rk4_refuses_stiff_bristles_and_names_the_steps_that_would_do():
    stiff, one = Dahl(mu=0.4, presliding_length=5e-4), scene(5.0)
    why = March(stepper="rk4", steps=200_000).refusal(one, stiff)
    assert "unstable" in why
    assert "200,000 steps" in why
    named = int(why.split("about ")[1].split(" ")[0].replace(",", ""))
    assert 200_000 < named <= 400_000
    assert March(stepper="rk4", steps=named).refusal(one, stiff) is None
    h = 2.0 * math.pi / named
    assert h * stiff.largest_rate(50.0 + 5.0) <= DECAY
    assert "too many to refine" in March(stepper="rk4").refusal(one, Dahl(mu=0.4, presliding_length=5e-6))


@deep("more kernels to compile")
def test_rk4_stops_where_slip_gets_too_fast_for_its_steps():
    answers = March(stepper="rk4", steps=40).solve([scene(5.0)], STEADY, 1e-5)
    assert answers.status == ["refused"]
    assert "unstable on bristles this stiff with 40 steps" in answers.reason[0]
    assert 40 < int(answers.reason[0].split("about ")[1].split(" ")[0]) < 4000


# --- bristles carried along --------------------------------------------------------------------------------------


@njit
def moved(law, h, v, z):
    """The deflection after constant slip, for tests."""
    return advance_bristle(law, h, v, z)


@njit
def brought_back(law, z):
    """The deflection brought back to where the law yields, for tests."""
    return project_to_yield(law, z)


@given(speed=sizes(1e-3, 1e3), h=sizes(1e-6, 1e6), share=st.floats(-1.0, 1.0))
def test_bristles_on_a_falling_curve_never_leave_the_invariant_set_and_end_in_steady_slip(speed, h, share):
    largest = FALLING.largest_deflection()
    z = compiled(moved, FALLING)(h, speed, share * largest)
    assert abs(z) <= largest * (1.0 + 1e-12)
    steady = FALLING.sliding_friction(speed) / FALLING.bristle_stiffness
    expected = steady + (share * largest - steady) * math.exp(-h * FALLING.largest_rate(speed))
    assert z == pytest.approx(expected, rel=1e-9, abs=1e-9 * largest)


turns = st.floats(-3.2, 3.2)
BREAKING = ElastoPlastic(mu_kinetic=0.25, mu_static=0.4, stiffness=0.5)


@given(speed=sizes(1e-3, 1e3), h=sizes(1e-6, 1e6), share=st.floats(0.0, 1.0), a=turns, b=turns)
def test_bristles_that_break_away_stay_in_their_invariant_set_and_turn_with_the_plane(speed, h, share, a, b):
    largest = BREAKING.largest_deflection()
    v, z = complex(speed, 0.0), share * largest * complex(math.cos(a), math.sin(a))
    turn = complex(math.cos(b), math.sin(b))
    move = compiled(moved, BREAKING)
    after = move(h, v, z)
    assert abs(after) <= largest * (1.0 + 1e-12)
    if abs(z.real) > 1e-9 * abs(
        z
    ):  # at a right angle to the slip rounding decides whether bristles break away
        assert move(h, v * turn, z * turn) == pytest.approx(after * turn, abs=1e-9 * largest)


def test_small_moves_of_bristles_that_break_away_are_of_order_two():
    z, v, law = 0.55, 1.0, BREAKING
    move = compiled(moved, law)

    def gone(n):
        end = z
        for _ in range(n):
            end = move(0.2 / n, v, end)
        return end

    exact, coarse, fine = gone(4096), gone(8), gone(32)
    assert math.log((coarse - exact) / (fine - exact), 4.0) == pytest.approx(2.0, abs=0.2)
    assert move(1e-3, v, 0.0) == pytest.approx(1e-3, rel=1e-12)


def test_forms_of_the_plane_differ_in_what_is_carried():
    z, v, h = complex(0.2, -0.1), complex(0.6, 0.8), 0.3
    line = compiled(moved, BREAKING)
    each = pytest.approx(complex(line(h, v.real, z.real), line(h, v.imag, z.imag)), rel=1e-12)
    assert compiled(moved, BREAKING.model_copy(update={"planar": "per-axis"}))(h, v, z) == each


@given(size=sizes(1e-3, 1e3), angle=turns)
def test_a_step_beyond_yield_is_brought_back_to_it(size, angle):
    law = Jenkins(mu=0.4, stiffness=1.3)
    z = size * complex(math.cos(angle), math.sin(angle))
    back = compiled(brought_back, law)(z)
    if size <= law.reach:
        assert back == z
    else:
        assert law.reach <= abs(back) <= law.reach * (1.0 + 1e-14)


# --- where there is no one number, or no answer -----------------------------------------------------------------


@deep("more kernels to compile")
def test_undriven_bristles_on_a_falling_curve_stick_and_slip_like_dry_friction():
    law = LuGre(mu_kinetic=0.2, mu_static=0.4, stribeck_speed=0.1, presliding_length=1e-3)
    answers = solve(Scene(damping_ratio=0.0, normal_load=1.0, belt_speed=0.1), law, 1e-3)
    assert answers.status == ["ok"]
    assert answers.columns["period"][0] > 1.2
    assert answers.columns["velocity_amplitude"][0] > 0.1
