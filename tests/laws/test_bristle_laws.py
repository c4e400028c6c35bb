"""Laws with a bristle deflection: symmetry, what each declares, passivity, closed forms, limits."""

from __future__ import annotations

import cmath
import math
from typing import Any

import numpy as np
import pytest
from hypothesis import assume, example, given
from hypothesis import strategies as st
from profiles import some
from strategies import (
    BRISTLE_LAWS,
    EXAMPLES,
    VECTOR_LAWS,
    angles,
    signs,
    sizes,
    velocities,
    velocities_on_the_line,
)

from frictionlab.compile.cache import compiled
from frictionlab.compile.decorators import njit
from frictionlab.laws.dahl import Dahl
from frictionlab.laws.elasto_plastic import ElastoPlastic, breakaway_share
from frictionlab.laws.jenkins import Jenkins
from frictionlab.laws.lugre import LuGre
from frictionlab.laws.memory import bristle_in_the_plane, bristle_on_the_line
from frictionlab.motion.contact import resistance
from frictionlab.theory import (
    dahl_describing_function,
    dahl_drift,
    dahl_loop_area,
    dahl_loop_end,
    dahl_path,
    jenkins_describing_function,
)

every_law = pytest.mark.parametrize("name", BRISTLE_LAWS)
EXACT = 1e-12  # relative to the natural scale: a thousand roundings
NODES, WEIGHTS = np.polynomial.legendre.leggauss(60)

shares = st.floats(0.0, 1.0 - 1e-9)
turns = st.builds(lambda angle: cmath.rect(1.0, angle), angles)


def dot(a: complex, b: complex) -> float:
    return (a * b.conjugate()).real


def has_a_vector_form(law: Any) -> bool:
    return not law.no_vector_form()


def in_a_form_of_the_plane(name: str) -> st.SearchStrategy[Any]:
    """A law in any planar form it has a meaning in."""
    return VECTOR_LAWS[name] | BRISTLE_LAWS[name].map(
        lambda law: law.model_copy(update={"planar": "per-axis"})
    )


def dashpot(law: Any) -> float:
    """The friction coefficient per speed that bristle damping and viscosity may add at most."""
    return 10.0 * getattr(law, "bristle_damping", 0.0) + getattr(law, "viscosity", 0.0)


def sharpness(law: Any) -> float:
    """How many times larger a relative error of the deflection may come back in its rate over the speed."""
    largest = law.largest_rate(1e6) / 1e6 * law.largest_deflection()  # where the curve has fallen
    return 20.0 if largest == math.inf else 10.0 + largest


def radius(law: Any) -> float:
    """The largest deflection; less where the rate is infinitely sharp there (Dahl, exponent below one)."""
    return (0.99 if law.largest_rate(1.0) == math.inf else 1.0) * law.largest_deflection()


# Symmetry and scale


@every_law
def test_per_axis_laws_do_not_turn_with_the_slip_and_exceed_their_limit_on_the_diagonal(name):
    law = EXAMPLES[name].model_copy(
        update={"planar": "per-axis", "damping": 0.0}
        if name in ("lugre", "elasto-plastic")
        else {"planar": "per-axis"}
    )
    turn = cmath.rect(1.0, math.pi / 4)

    along, _ = bristle_in_the_plane(law, 1.0 + 0.0j, 1.0 + 0.0j)  # saturated, mu = stiffness = 1
    assert abs(along) <= EXACT
    aslant, _ = bristle_in_the_plane(law, turn, turn)
    assert abs(aslant) > 0.2  # the turned law has none
    corner, friction = bristle_in_the_plane(law, turn, 1.0 + 1.0j)
    assert abs(corner) <= EXACT
    assert abs(friction) == pytest.approx(math.sqrt(2.0))


@every_law
@given(data=st.data(), v=velocities, share=shares, turn=turns)
def test_per_axis_laws_are_the_law_of_one_direction_along_each_axis(name, data, v, share, turn):
    law = data.draw(BRISTLE_LAWS[name]).model_copy(update={"planar": "per-axis"})
    z = share * law.largest_deflection() * turn
    dz, friction = bristle_in_the_plane(law, v, z)

    assert (dz.real, friction.real) == bristle_on_the_line(law, v.real, z.real)
    assert (dz.imag, friction.imag) == bristle_on_the_line(law, v.imag, z.imag)


@njit
def answers(law, v, z, out):
    for i in range(v.size):
        out[0, i], out[1, i] = resistance(law, v[i], z[i])
        out[2, i] = law.deflected(z[i], v[i])


@some(4, "a law to compile each")
@every_law
@pytest.mark.parametrize("kind", [float, complex])
@given(data=st.data())
def test_interpreted_and_compiled_bristles_agree_to_rounding(name, kind, data):
    law = data.draw(BRISTLE_LAWS[name] if kind is float else in_a_form_of_the_plane(name))
    size = law.largest_deflection()
    slips = velocities if kind is complex else velocities_on_the_line
    v = np.array(data.draw(st.lists(slips, min_size=1, max_size=10)), dtype=kind)
    turn = turns if kind is complex else signs
    z = np.array([radius(law) * data.draw(shares) * data.draw(turn) for _ in v], dtype=kind)
    assume(np.all(np.abs((z * v.conj()).real) >= 1e-9 * np.abs(z) * np.abs(v)))
    interpreted, machine = np.empty((3, v.size), kind), np.empty((3, v.size), kind)
    answers.py_func(law, v, z, interpreted)
    compiled(answers, law)(v, z, machine)

    gap, speed = np.abs(machine - interpreted), np.abs(v)
    damped = getattr(law, "bristle_damping", 0.0) * sharpness(law)
    assert np.all(gap[0] <= 4e-15 * sharpness(law) * speed)
    assert np.all(gap[1] <= 4e-15 * (law.bristle_stiffness * size + (damped + dashpot(law)) * speed))
    if law.exact_path() and (kind is float or has_a_vector_form(law)):
        assert np.all(gap[2] <= 4e-15 * size)


@every_law
def test_the_contacts_own_stiffness_and_damping_are_shared_by_the_normal_load(name):
    keys = EXAMPLES[name].model_dump() | {"stiffness": None, "contact_stiffness": 6.0}
    if "damping" in keys:
        keys |= {"damping": None, "contact_damping": 3.0}
    law = type(EXAMPLES[name])(**keys).under_load(2.0)

    assert law.bristle_stiffness == 3.0
    assert getattr(law, "bristle_damping", 1.5) == 1.5
    assert law.under_load(7.0) == law
    length = type(law)(**EXAMPLES[name].model_dump() | {"stiffness": None, "presliding_length": 0.25})
    assert (length.bristle_stiffness, length.presliding()) == (4.0, 0.25)


# What a law declares


@pytest.mark.parametrize("change", [{"damping": 0.3}, {"viscosity": 0.3}, {"mu_static": 1.5}])
@pytest.mark.parametrize("kind", [LuGre, ElastoPlastic])
def test_damping_viscosity_and_a_falling_curve_make_friction_depend_on_speed(kind, change):
    keys = {"mu_kinetic": 1.0, "stiffness": 2.0}
    slow, quick = (bristle_on_the_line(kind(**{**keys, **change}), v, 0.45) for v in (0.5, 1.5))

    assert kind(**keys).rate_independent()
    assert not kind(**{**keys, **change}).rate_independent()
    assert abs(slow[0] / 0.5 - quick[0] / 1.5) + abs(slow[1] - quick[1]) > 0.02


@pytest.mark.parametrize("name", ["dahl", "lugre", "elasto-plastic"])
@given(data=st.data(), v=velocities_on_the_line)
def test_the_largest_rate_is_met_somewhere_along_a_line(name, data, v):
    law = data.draw(BRISTLE_LAWS[name].filter(lambda law: law.largest_rate(1.0) < math.inf))
    low, high = -1.0, 1.0
    if name == "elasto-plastic":  # between where breaking away begins and where it ends
        low = law.breakaway_ratio * law.mu_kinetic / law.peak
        high = (law.sliding_friction(abs(v)) - law.viscosity * abs(v)) / law.peak
    z = np.linspace(low, high, 1001)[1:-1] * math.copysign(law.largest_deflection(), v)
    rates = np.array([law.rate(v, a) for a in z.tolist()])

    assert np.max(np.abs(np.diff(rates) / np.diff(z))) >= 0.6 * law.largest_rate(abs(v))


@every_law
def test_only_jenkins_bristles_yield_at_once(name):
    assert (EXAMPLES[name].yield_deflection() < math.inf) == (name == "jenkins")


def test_friction_that_is_only_approached_saturates_nowhere():
    for law in (
        Dahl(mu=1, stiffness=1),
        Dahl(mu=1, stiffness=1, exponent=2),
        LuGre(mu_kinetic=1, stiffness=1),
    ):
        assert law.saturation_path(0.0, 1.0) == math.inf


# Paths


@pytest.mark.parametrize("exponent", [0.0, 0.5, 0.999999, 1.0, 1.0 + 1e-12, 1.5, 2.0, 3.0])
@given(start=st.floats(-3.0, 3.0), path=sizes(1e-4, 1e2), side=signs, stiffness=sizes(1e-5, 1e5))
def test_dahl_bristles_follow_the_closed_form_from_outside_their_limit_too(
    exponent, start, path, side, stiffness
):
    law = Dahl(mu=0.4, stiffness=stiffness, exponent=exponent)
    size = law.saturation
    wanted = float(dahl_path(start, path, exponent))

    assert law.deflected(side * start * size, side * path * size) == pytest.approx(
        side * wanted * size, abs=EXACT * size
    )
    assert abs(1.0 - wanted) <= abs(1.0 - start)  # friction tends to its limit from wherever it is


# Loops


def turning_point(law: Any, amplitude: float) -> float:
    """The deflection where the loop that slip of this amplitude settles to turns, at its lower end."""
    z = 0.0
    for _ in range(math.ceil(10.0 * law.largest_deflection() / amplitude)):  # Dahl forgets as exp(-40) in all
        z = law.deflected(law.deflected(z, 2.0 * amplitude), -2.0 * amplitude)
    return z


def steady_loop(law: Any, amplitude: float) -> tuple[np.ndarray, np.ndarray]:
    """Friction on the two legs of the steady loop, at Gauss nodes of the angle of the slip."""
    gone = amplitude * (1.0 - np.cos(0.5 * math.pi * (1.0 + NODES)))
    low = turning_point(law, amplitude)
    high = law.deflected(low, 2.0 * amplitude)
    forth = np.array([law.deflected(low, way) for way in gone.tolist()])
    back = np.array([law.deflected(high, -way) for way in gone.tolist()])
    return law.bristle_stiffness * forth, law.bristle_stiffness * back


@given(amplitude=sizes(1e-2, 20.0), mu=sizes(1e-2, 10), stiffness=sizes(1e-3, 1e3))
def test_a_dahl_loop_ends_at_the_hyperbolic_tangent_and_has_the_area_of_its_closed_form(
    amplitude, mu, stiffness
):
    law = Dahl(mu=mu, stiffness=stiffness)
    size = amplitude * law.saturation
    forth, back = steady_loop(law, size)
    back_on_forth = forth + back  # the way back is the way forth turned round
    sines = 0.5 * math.pi * np.sin(0.5 * math.pi * (1.0 + NODES))
    area = size * np.sum(WEIGHTS * sines * (forth - back[::-1]))

    assert stiffness * turning_point(law, size) == pytest.approx(
        -mu * float(dahl_loop_end(amplitude)), rel=1e-11
    )
    assert np.max(np.abs(back_on_forth)) <= 1e-11 * mu
    assert area == pytest.approx(mu * law.saturation * float(dahl_loop_area(amplitude)), rel=1e-9)


def first_harmonic(law: Any, amplitude: float) -> complex:
    """k + i Omega c of friction along slip -amplitude cos(angle), by Gauss quadrature of both legs."""
    forth, back = steady_loop(law, amplitude)
    angle = 0.5 * math.pi * (1.0 + NODES)
    wave = np.exp(1j * angle) * WEIGHTS * 0.5 * math.pi
    total = np.sum(wave * forth) + np.sum(-wave * back)  # the way back is half a turn later
    return -complex(total.real, -total.imag) / (math.pi * amplitude)


@given(amplitude=st.floats(0.5, 10.0), stiffness=sizes(1e-3, 1e3))
def test_the_describing_function_of_dahl_is_the_first_harmonic_of_its_loop(amplitude, stiffness):
    law = Dahl(mu=0.4, stiffness=stiffness)
    found = first_harmonic(law, amplitude * law.saturation)
    wanted = stiffness * complex(dahl_describing_function(amplitude))

    assert abs(found - wanted) <= 1e-9 * stiffness


@given(amplitude=sizes(0.1, 1e3), stiffness=sizes(1e-3, 1e3))
@example(amplitude=1.0 + 1e-9, stiffness=1.0)
def test_the_describing_function_of_jenkins_is_the_first_harmonic_of_its_loop(amplitude, stiffness):
    law = Jenkins(mu=0.4, stiffness=stiffness)
    size = amplitude * law.reach
    z = law.deflected(law.deflected(0.0, 3.0 * size), -2.0 * size) if amplitude >= 1.0 else -size
    elastic = math.acos(1.0 - 2.0 / amplitude) if amplitude > 1.0 else math.pi
    total = 0.0j
    for low, high in ((0.0, elastic), (elastic, math.pi)):  # the corner is met exactly
        angle = 0.5 * (low + high) + 0.5 * (high - low) * NODES
        friction = [law.deflected(z, size * (1.0 - math.cos(a))) for a in angle.tolist()]
        total += 0.5 * (high - low) * np.sum(WEIGHTS * np.exp(-1j * angle) * np.array(friction))
    found = -2.0 * total.conjugate() / (math.pi * size)

    assert abs(complex(found.real, abs(found.imag)) - complex(jenkins_describing_function(amplitude))) <= 1e-9


def test_dahl_friction_turns_round_with_two_to_the_exponent_times_the_stiffness():
    for exponent in (0.0, 0.5, 1.0, 1.5, 2.0, 3.0):
        law = Dahl(mu=0.4, stiffness=5.0, exponent=exponent)

        assert law.rate(-3.0, law.saturation) == pytest.approx(-3.0 * 2.0**exponent, rel=EXACT)
        assert law.rate(-3.0, 0.0) == law.rate(3.0, -0.0) * -1.0 == -3.0


@given(low=st.floats(-0.9, 0.9), high=st.floats(-0.9, 0.9), stiffness=sizes(1e-3, 1e3))
def test_a_dahl_contact_creeps_by_its_closed_form_in_each_cycle_of_force(low, high, stiffness):
    law = Dahl(mu=0.4, stiffness=stiffness)
    low, high = min(low, high), max(low, high)
    middle, half = 0.5 * (low + high), 0.5 * (high - low)
    z = (middle + half * NODES) * law.saturation
    slip = [1.0 / law.rate(1.0, a) + 1.0 / law.rate(-1.0, a) for a in z.tolist()]  # dx/dz up, and down again
    crept = half * float(np.sum(WEIGHTS * np.array(slip)))

    assert crept == pytest.approx(float(dahl_drift(low, high)), abs=1e-10 * (1.0 + abs(crept)))


def test_only_laws_of_constant_g_follow_a_path_in_closed_form():
    assert LuGre(mu_kinetic=1.0, stiffness=1.0, damping=1.0, viscosity=1.0).exact_path()
    assert not LuGre(mu_kinetic=1.0, mu_static=1.1, stiffness=1.0).exact_path()
    assert not ElastoPlastic(mu_kinetic=1.0, stiffness=1.0).exact_path()
    assert Dahl(mu=1.0, stiffness=1.0, exponent=2.0).exact_path()


@given(begins=st.floats(1e-6, 0.999), size=st.floats(0.0, 2.0))
def test_bristles_break_away_smoothly(begins, size):
    ends, step = 1.0, 1e-6 * (1.0 - begins)

    assert 0.0 <= breakaway_share(size, begins, ends) <= 1.0
    for corner, level in ((begins, 0.0), (ends, 1.0)):
        assert breakaway_share(corner, begins, ends) == level
        for side in (-1.0, 1.0):
            assert abs(breakaway_share(corner + side * step, begins, ends) - level) <= 1e-11  # slope zero


# Jenkins in the plane


@every_law
@given(data=st.data(), v=velocities, share=shares, turn=turns)
def test_bristles_unload_elastically_where_the_law_says_so(name, data, v, share, turn):
    law = data.draw(VECTOR_LAWS[name])
    z = share * law.largest_deflection() * turn
    z = z if dot(z, v) <= 0.0 else -z

    if law.elastic_unloading():
        assert law.rate(v, z) == v
    elif share > 1e-3 and z != 0.0 and dot(z, v) < -1e-3 * abs(z) * abs(v):
        assert abs(law.rate(v, z) - v) > 1e-7 * abs(v)


@pytest.mark.parametrize("angle", [0.6, 1.5, 2.9])
def test_radial_return_of_the_spring_approaches_the_tractrix_at_first_order(angle):
    law = Jenkins(mu=1.0, stiffness=1.0)

    def returned(steps: int) -> complex:
        z = cmath.rect(1.0, angle)
        for _ in range(steps):
            z = z + 3.0 / steps
            z = z / max(abs(z), 1.0)
        return z

    exact = law.deflected(cmath.rect(1.0, angle), 3.0 + 0.0j)
    errors = [abs(returned(steps) - exact) for steps in (100, 1000)]
    assert 8.0 < errors[0] / errors[1] < 12.0
    assert errors[0] < 0.05


@every_law
def test_without_damping_viscosity_and_a_fall_friction_knows_only_the_path(name):
    fields = {"mu_static": None, "damping": None, "viscosity": 0.0}
    law = EXAMPLES[name]

    assert law.model_copy(
        update={field: value for field, value in fields.items() if hasattr(law, field)}
    ).rate_independent()
