"""The equation of motion has one address: what is changed there is changed for every method."""

from __future__ import annotations

import ast
import json
import math
import os
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from profiles import deep
from strategies import sizes

import frictionlab
from frictionlab.compile.cache import compiled
from frictionlab.compile.decorators import njit
from frictionlab.compile.interpret import interpreted
from frictionlab.methods.exact import legs
from frictionlab.methods.exact.forcing import forcing_of
from frictionlab.methods.exact.oscillator import oscillator_at
from frictionlab.motion import equation as motion
from frictionlab.motion.equation import START, Instant
from frictionlab.motion.steppers.step import growth_factor
from frictionlab.scene.body import BodyNumbers, Mass, in_the_plane, on_the_line
from frictionlab.scene.scene import Scene

HOUSE = Path(frictionlab.__file__).parent
HERE = Path(__file__).parent

# --- what is replaced is replaced everywhere ----------------------------------------------------------------------


def answers(name: str) -> dict[str, tuple[list, list]]:
    """By case: status, mean, error, work put in and heat as for the changed scene, and with a function replaced."""
    command = [sys.executable, str(HERE / "changed_mechanics.py"), name]
    environment = {**os.environ, "NUMBA_DISABLE_JIT": "1", "PYTHONPATH": str(HOUSE.parent)}
    told = subprocess.run(command, capture_output=True, text=True, env=environment, check=False)
    assert told.returncode == 0, told.stderr
    return {case: (expected, found) for case, expected, found in map(json.loads, told.stdout.splitlines())}


slow = deep("all methods, run by Python")


@pytest.mark.parametrize(
    "name",
    [pytest.param(name, marks=slow) for name in ("load", "normal_load")],
)
def test_every_method_answers_as_for_the_changed_scene_where_a_function_is_replaced(name):
    for case, (expected, found) in answers(name).items():
        status, mean, error, put_in, heat = found
        assert status == expected[0] == "ok", case
        # the same steps of the same motion but for the reference: far closer than the errors of the coarse steppers
        close, alike = 2.0 * min(error + expected[2], 1e-6), 1e-5
        if case == "rk4 of elements":  # they start from another motion, and stick where that leaves them
            close, alike = error + expected[2], 1e-3
        assert abs(mean - expected[1]) <= close, case
        assert [put_in, heat] == pytest.approx(expected[3:], rel=alike, abs=1e-6), case


MECHANICS = ("restoring_force", "load_sine", "load_cosine", "balanced_sine", "balanced_cosine")
ADDRESSES = {"scene/body.py", "motion/equation.py"}


def uses_of(names: tuple[str, ...]) -> set[str]:
    """The files that call a function or read a field of these names."""
    found = set()
    for path in HOUSE.rglob("*.py"):
        for node in ast.walk(ast.parse(path.read_text())):
            called = node.func if isinstance(node, ast.Call) else node
            if isinstance(called, ast.Attribute | ast.Name) and isinstance(
                getattr(called, "ctx", None), ast.Load
            ):
                name = called.attr if isinstance(called, ast.Attribute) else called.id
                if name in names:
                    found.add(path.relative_to(HOUSE).as_posix())
    return found


@deep("reads all sources")
def test_the_numbers_of_the_load_are_read_at_one_address():
    assert uses_of(MECHANICS[1:]) <= ADDRESSES


@deep("reads all sources")
def test_the_springs_are_asked_by_few_beside_the_equation_of_motion():
    implicit = {"methods/march/adapters.py", "motion/steppers/moreau.py"}  # springs at the end of the step
    momentum = {
        "motion/maps/stick.py",
        "motion/maps/step.py",
    }  # over the first moment of slip, and of one that creeps
    polar = {
        "motion/maps/polar.py",
        "motion/maps/polar_step.py",
    }  # implicit steps, their tangent
    rest = {"methods/shooting/undriven_path.py"}  # what friction holds in the end
    slope = {"motion/maps/linearization.py"}  # of the acceleration in time
    assert uses_of(MECHANICS[:1]) <= ADDRESSES | implicit | momentum | polar | rest | slope


# --- the functions of one group agree -----------------------------------------------------------------------------

amplitudes = st.builds(complex, st.floats(-9.0, 9.0), st.floats(-9.0, 9.0))
masses = st.builds(
    Mass,
    damping=st.floats(0.05, 3.0),
    stiffness=st.just(1.0),
    transverse_damping=st.floats(0.05, 3.0),
    transverse_stiffness=sizes(1e-1, 1e1),
    normal_load=sizes(1e-1, 1e1),
    frequency=sizes(3e-1, 3.0),
    force=amplitudes,
    transverse_force=amplitudes,
    varying=st.just(()),
    bends=st.just(()),
)
times, speeds = st.floats(0.5, 9.0), st.floats(-3.0, 3.0)
STEP = 1e-4


def at(body: BodyNumbers, tau: float) -> Instant:
    """An instant, as kernels have it."""
    return interpreted(motion.instant_at)(body, tau)


def difference(function, tau: float):
    """A central difference quotient."""
    return (function(tau + STEP) - function(tau - STEP)) / (2.0 * STEP)


@given(mass=masses, tau=times)
def test_rates_bounds_and_integrals_of_the_load_are_those_of_the_load(mass, tau):
    body, load = in_the_plane(mass), interpreted(motion.load)
    size = abs(mass.force) + abs(mass.transverse_force) + 1e-9
    first, second = interpreted(motion.load_rates)(body, at(body, tau))
    impulse = interpreted(motion.load_impulse)

    assert abs(difference(lambda t: load(body, at(body, t)), tau) - first) <= 1e-5 * size
    assert (
        abs(difference(lambda t: interpreted(motion.load_rates)(body, at(body, t))[0], tau) - second)
        <= 1e-5 * size
    )
    assert abs(second) <= interpreted(motion.load_curvature)(body) * (1.0 + 1e-12)
    assert abs(difference(lambda t: impulse(body, 0.3, t), tau) - load(body, at(body, tau))) <= 1e-5 * size


@given(mass=masses, tau=times, belt_speed=speeds)
def test_the_belt_goes_as_fast_as_it_goes_far(mass, tau, belt_speed):
    body = on_the_line(mass)
    path, area = interpreted(motion.belt_path), interpreted(motion.belt_path_integral)

    def velocity(t):
        return interpreted(motion.belt_velocity)(body, belt_speed, at(body, t))

    def rate(t, order=1):
        return interpreted(motion.belt_rate)(body, at(body, t), order)

    assert difference(lambda t: area(body, belt_speed, 0.3, t), tau) == pytest.approx(
        path(body, belt_speed, 0.3, tau), abs=1e-5
    )
    assert difference(lambda t: path(body, belt_speed, 0.3, t), tau) == pytest.approx(velocity(tau), abs=1e-5)
    assert difference(velocity, tau) == pytest.approx(rate(tau), abs=1e-5)
    assert difference(rate, tau) == pytest.approx(rate(tau, 2), abs=1e-5)
    assert difference(lambda t: rate(t, 2), tau) == pytest.approx(rate(tau, 3), abs=1e-5)


@given(mass=masses, tau=times, belt_speed=speeds, x=amplitudes)
def test_friction_at_rest_leaves_the_mass_the_belts_acceleration(mass, tau, belt_speed, x):
    body, now = in_the_plane(mass), at(in_the_plane(mass), tau)
    hold = interpreted(motion.holding_force)
    held, rate, bend = hold(body, belt_speed, now, x)
    v = interpreted(motion.belt_velocity)(body, belt_speed, now) + 0j
    left = interpreted(motion.acceleration)(
        body, now, x, v, held / interpreted(motion.normal_load)(body, now)
    )
    size = abs(held) + abs(x) * 10.0 + abs(mass.force) + abs(mass.transverse_force) + 10.0

    def carried(t, of=0):
        way = interpreted(motion.belt_path)(body, belt_speed, tau, t)
        return hold(body, belt_speed, at(body, t), x + way)[of]

    assert left == pytest.approx(interpreted(motion.belt_rate)(body, now, 1), abs=1e-12 * size)
    assert abs(difference(carried, tau) - rate) <= 1e-5 * size
    assert abs(difference(lambda t: carried(t, 1), tau) - bend) <= 1e-5 * size
    nodes, weights = np.polynomial.legendre.leggauss(20)
    impulse = sum(0.5 * w * carried(tau + 0.5 * (1.0 + s)) for s, w in zip(nodes, weights, strict=True))
    whole = interpreted(motion.holding_impulse)(body, belt_speed, tau, tau + 1.0, x)
    assert abs(impulse - whole) <= 1e-11 * size


@given(mass=masses, tau=times, y=amplitudes, u=amplitudes, rub=amplitudes)
def test_deviation_and_reference_together_obey_the_equation_of_motion(mass, tau, y, u, rub):
    body, now = in_the_plane(mass), at(in_the_plane(mass), tau)
    x = y + body.reference_sine * now.sine + body.reference_cosine * now.cosine
    v = u + interpreted(motion.reference_velocity)(body, now.sine, now.cosine)
    bent = interpreted(motion.reference_acceleration)(body, now.sine, now.cosine)

    parts = interpreted(motion.deviation_acceleration)(body, now, y, u, rub) + bent
    whole = interpreted(motion.acceleration)(body, now, x, v, rub)
    assert abs(parts - whole) <= 1e-12 * (1.0 + abs(x) + abs(v) + abs(bent) + abs(whole)) * 30.0


# --- closed forms obey it -----------------------------------------------------------------------------------------


@given(
    damping=st.floats(0.0, 3.0),
    frequency=sizes(3e-1, 3.0),
    size=sizes(1e-1, 9.0),
    friction=sizes(1e-1, 9.0),
    belt_speed=st.floats(0.0, 3.0),
    tau=times,
    x=st.floats(-3.0, 3.0),
    w=st.floats(0.5, 3.0),
    sign=st.sampled_from([-1.0, 1.0]),
)
def test_legs_of_slip_in_closed_form_have_the_acceleration_of_the_equation_of_motion(
    damping, frequency, size, friction, belt_speed, tau, x, w, sign
):
    mass = Mass(2.0 * damping, 1.0, 0.0, 1.0, friction, frequency, complex(size), 0j)
    closed = interpreted(oscillator_at)(forcing_of(mass, 1.0), belt_speed)
    body, after = on_the_line(mass), 0.02

    def leg(left):
        return interpreted(legs.slip_leg)(closed, tau, x, sign * w, sign, left)

    here = leg(after)
    if leg(after + STEP).event:
        return  # slip ended before
    v = here.w + interpreted(motion.belt_velocity)(body, belt_speed, START)
    a = interpreted(motion.acceleration)(body, at(body, tau + after), here.x, v, sign)
    scale = 1.0 + size + friction + abs(x) + w + belt_speed
    assert difference(lambda t: leg(t).x, after) == pytest.approx(v, abs=1e-5 * scale * (1.0 + damping) ** 2)
    assert difference(lambda t: leg(t).w, after) == pytest.approx(a, abs=1e-5 * scale * (1.0 + damping) ** 3)


@given(
    damping=st.floats(0.0, 3.0), frequency=sizes(3e-1, 3.0), size=sizes(1e-1, 9.0), belt_speed=st.floats(0.0, 3.0),
    tau=times, x=st.floats(-3.0, 3.0),
)  # fmt: skip
def test_legs_of_rest_in_closed_form_are_held_by_the_force_at_rest(
    damping, frequency, size, belt_speed, tau, x
):
    friction, after = 99.0, 0.3
    mass = Mass(2.0 * damping, 1.0, 0.0, 1.0, friction, frequency, complex(size), 0j)
    closed, body = interpreted(oscillator_at)(forcing_of(mass, 1.0), belt_speed), on_the_line(mass)
    leg = interpreted(legs.stick_leg)(closed, tau, x, after)

    held, _rate, _bend = interpreted(motion.holding_force)(body, belt_speed, at(body, tau + after), leg.x)
    assert leg.event == 0.0
    assert leg.x - x == pytest.approx(
        interpreted(motion.belt_path)(body, belt_speed, tau, tau + after), abs=1e-12
    )
    assert leg.net == pytest.approx(held, abs=1e-11)


# --- kernels and Python, steps ------------------------------------------------------------------------------------


@njit
def in_a_kernel(body, tau, x, v, rub):
    """The acceleration, compiled."""
    return motion.acceleration(body, motion.instant_at(body, tau), x, v, rub)


def test_a_formula_means_the_same_to_a_kernel_and_to_a_driver():
    scene = Scene(
        damping_ratio=0.2, normal_load=3.0, belt_speed=1.0, drive={"amplitude": 2.0, "frequency": 1.7}
    )
    body = on_the_line(scene.mass())
    told = interpreted(motion.acceleration)(body, at(body, 0.4), 0.3, -0.7, 0.5)

    assert compiled(in_a_kernel)(body, 0.4, 0.3, -0.7, 0.5) == pytest.approx(told, rel=1e-14)


@pytest.mark.parametrize("order", [5.0, 8.0])
def test_a_step_grows_by_its_order_within_bounds_and_shrinks_where_its_error_is_no_number(order):
    grow = interpreted(growth_factor)

    assert grow(0.1, order) == pytest.approx(0.9 * 10.0 ** (1.0 / order))
    assert grow(1.0, order) == 1.0
    assert grow(1.1, order) < 1.0
    assert (grow(0.0, order), grow(1e-290, order)) == (6.0, 6.0)
    assert [grow(error, order) for error in (math.nan, math.inf)] == [0.1, 0.1]
    assert grow(1e200, order) == 0.1
