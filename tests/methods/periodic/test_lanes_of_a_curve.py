"""Eight belt speeds at a time: each lane's map is that of its belt speed, and the errors of what is closed cover."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from profiles import deep

import frictionlab as fl
from frictionlab.compile.cache import compiled
from frictionlab.compile.call import KernelCall
from frictionlab.compile.decorators import njit
from frictionlab.compile.interpret import interpreted, interpreted_on_arrays
from frictionlab.compile.lane_arrays import friction_by_lane, takes_lanes
from frictionlab.laws.base import SlidingLaw
from frictionlab.methods.periodic.continuation import CLOSED
from frictionlab.methods.periodic.lane_curve import CLOSED_ORBIT, answer_lanes
from frictionlab.methods.periodic.lane_map import lane_map, rows_for
from frictionlab.methods.periodic.lane_record import differentiate_in_lanes
from frictionlab.methods.periodic.period_map import paced_image
from frictionlab.methods.periodic.problem import PeriodicProblem
from frictionlab.motion.maps.case import case_of, noting
from frictionlab.motion.orbit.recorder import track_of

LAW = fl.Coulomb(mu=0.4)
FALLING = fl.Stribeck(mu_kinetic=0.3, mu_static=0.4, stribeck_speed=2.0)
SPEEDS = np.linspace(0.5, 60.0, 37)


def scene_of(omega: float = 4.0, normal_load: float = 1.0, belt_speed: float = 1.0) -> fl.Scene:
    """W3: two directions, 90 degrees between their loads only by damping."""
    return fl.Scene(
        damping_ratio=0.1,
        normal_load=normal_load,
        belt_speed=belt_speed,
        drive=fl.Drive(unbalance=10, frequency=4),
        transverse=fl.Transverse(natural_frequency=omega, damping_ratio=0.1, load=fl.Load(unbalance=10)),
    )


def problem_of(scene: fl.Scene, law: Any = LAW, tolerance: float = 1e-9) -> PeriodicProblem:
    return PeriodicProblem(scene, law, tolerance)


def closed_one_by_one(problem: PeriodicProblem, tolerance: float, speeds: np.ndarray = SPEEDS) -> Any:
    goal = problem.goal._replace(tolerance=tolerance)
    return problem.called(speeds, np.empty((0, 0)), goal, CLOSED)[0]


@njit
def mapped_in_lanes(law, body, rows, accuracy, alike):
    """The rows that a map leaves."""
    lane_map(law, body, rows, accuracy, alike)
    return rows


@njit
def mapped_one_by_one(law, body, rows, accuracy):
    """The same, by the map of one belt speed; rest is told by a time at rest."""
    z, residual = np.empty(4), np.empty(4)
    for k in range(rows.belt_speed.size):
        z[:] = rows.state[:, k]
        case = case_of(law, body, rows.belt_speed[k])
        image = paced_image(case, z, residual, noting(accuracy, track_of(0)))
        rows.residual[:, k] = residual
        rows.impulse[0, k], rows.impulse[1, k] = image.friction_impulse.real, image.friction_impulse.imag
        rows.closest[k], rows.arrived[k] = image.closest, 0.0 if image.stuck > 0.0 else 1.0
    return rows


def rows_of(speeds: np.ndarray) -> Any:
    rows = interpreted(rows_for)(8)
    rows.belt_speed[:] = speeds
    rows.state[:] = np.random.default_rng(8).normal(size=(4, 8))
    return rows


@deep("more kernels to compile")
@pytest.mark.parametrize("law", [LAW, FALLING], ids=["Coulomb", "Stribeck"])
def test_a_lane_is_the_map_of_its_belt_speed(law):
    problem, speeds = problem_of(scene_of()), np.linspace(5.0, 60.0, 8)
    one, body = compiled(mapped_one_by_one, law)(problem.body, rows_of(speeds), 1e-12), problem.body_in_lanes
    lanes = compiled(mapped_in_lanes, law)(body, rows_of(speeds), 1e-12, False)
    arrays = interpreted(mapped_in_lanes)(law, body, rows_of(speeds), 1e-12, False)

    for found in (lanes, arrays):
        assert found.arrived.all()
        np.testing.assert_allclose(found.residual, one.residual, rtol=0, atol=1e-10)
        np.testing.assert_allclose(found.impulse, one.impulse, rtol=0, atol=1e-10)


@deep("more kernels to compile")
def test_a_lane_that_comes_to_rest_leaves_and_stops_no_other():
    problem = problem_of(scene_of(normal_load=2000.0))
    speeds = np.array([1e-3, *np.linspace(5000.0, 6000.0, 7)])
    one = compiled(mapped_one_by_one, LAW)(problem.body, rows_of(speeds), 1e-12)

    lanes = compiled(mapped_in_lanes, LAW)(problem.body_in_lanes, rows_of(speeds), 1e-12, False)

    assert lanes.arrived.tolist() == one.arrived.tolist() == [0.0] + [1.0] * 7
    np.testing.assert_allclose(lanes.residual[:, 1:], one.residual[:, 1:], rtol=0, atol=1e-8)


@pytest.mark.parametrize("omega", [0.5, 4.0, 10.0])
def test_errors_of_what_lanes_close_cover_at_every_tolerance(omega):
    problem = problem_of(scene_of(omega))
    true = closed_one_by_one(problem, 1e-12).closed
    for tolerance in (1e-2, 1e-4, 1e-5, 1e-6, 1e-7, 1e-8, 1e-9, 1e-10):
        goal = problem.goal._replace(tolerance=tolerance)
        lanes = KernelCall(answer_lanes, LAW)(problem.body_in_lanes, SPEEDS, goal)

        assert (lanes.fate == CLOSED_ORBIT).all()
        found = lanes.closed
        assert (found.error <= tolerance).all()
        assert (np.abs(found.mean - true.mean) <= found.error + true.error).all()
        assert np.mean(found.maps) < 7.0


def test_states_are_as_good_as_the_mean():
    """Columns of an orbit are read from its state."""
    problem = problem_of(scene_of())
    true = closed_one_by_one(problem, 1e-12).states
    lanes = KernelCall(answer_lanes, LAW)(
        problem.body_in_lanes, SPEEDS, problem.goal._replace(tolerance=1e-7)
    )

    assert np.abs(lanes.states - true).max() <= 1e-7


def test_what_meets_rest_is_closed_by_the_search_for_one():
    """Friction that holds the mass for a while at the slow belt speeds alone."""
    scene = scene_of(normal_load=400.0)
    problem, speeds = problem_of(scene), np.linspace(2.0, 200.0, 30)
    lanes = KernelCall(answer_lanes, LAW)(problem.body_in_lanes, speeds, problem.goal)
    left = lanes.fate != CLOSED_ORBIT
    assert 3 <= left.sum() <= 27
    assert np.isnan(lanes.results[left]).all()

    curve, _seconds = problem.close(
        [scene_of(normal_load=400.0, belt_speed=speed) for speed in speeds], wanted=CLOSED
    )
    true, closed = closed_one_by_one(problem, 1e-11, speeds).closed, curve.closed
    assert (closed.maps > 0.0).all()
    assert (np.abs(closed.mean - true.mean) <= closed.error + true.error).all()
    assert (closed.stuck[left] > 0.0).any()


@pytest.mark.parametrize("points", [1, 4, 7, 8, 9, 24])
def test_any_number_of_points_is_closed(points):
    problem, speeds = problem_of(scene_of()), np.linspace(3.0, 50.0, points)
    lanes = KernelCall(answer_lanes, LAW)(problem.body_in_lanes, speeds, problem.goal)

    assert (lanes.fate == CLOSED_ORBIT).all()


@njit
def difference_quotients(law, body, belt_speeds, states, shift, accuracy):
    """Monodromies by the maps of one belt speed [n, 4, 4]."""
    matrices, ahead, behind = np.empty((belt_speeds.size, 4, 4)), np.empty(4), np.empty(4)
    for i in range(belt_speeds.size):
        case = case_of(law, body, belt_speeds[i])
        for column in range(4):
            trial = states[i].copy()
            trial[column] += shift
            paced_image(case, trial, ahead, noting(accuracy, track_of(0)))
            trial[column] -= 2.0 * shift
            paced_image(case, trial, behind, noting(accuracy, track_of(0)))
            for row in range(4):
                identity = 1.0 if row == column else 0.0
                matrices[i, row, column] = (ahead[row] - behind[row]) / (2.0 * shift) + identity
    return matrices


@deep("more kernels to compile")
@pytest.mark.parametrize("omega", [0.5, 4.0, 10.0])
def test_multipliers_are_those_of_difference_quotients(omega):
    problem = problem_of(scene_of(omega))
    speeds = SPEEDS[::9]
    states = KernelCall(answer_lanes, LAW)(problem.body_in_lanes, speeds, problem.goal).states
    fine = interpreted(difference_quotients)(LAW, problem.body, speeds, states, 1e-4, 1e-12)
    lanes = KernelCall(differentiate_in_lanes, LAW)(problem.body_in_lanes, speeds, states)

    moduli = [np.abs(np.linalg.eigvals(matrices)).max(axis=1) for matrices in (fine, lanes)]
    assert np.abs(moduli[0] - moduli[1]).max() < 1e-5
    assert np.abs(fine - lanes).max() < 1e-4


def test_orbits_are_those_of_the_record_of_one():
    """Panel by panel; an orbit that meets rest is recorded by itself."""
    scenes = [scene_of(normal_load=400.0, belt_speed=speed) for speed in np.linspace(2.0, 200.0, 30)]
    problem = problem_of(scenes[0])
    states = list(problem.close(scenes, wanted=CLOSED)[0].states)
    states[20] = None
    together = problem.orbits(scenes, states)

    by_itself = [
        None if state is None else problem.orbits([scene], [state]).one(0)
        for scene, state in zip(scenes, states, strict=True)
    ]
    assert together.one(20) is None
    assert 0 < sum(bool(orbit.stick.any()) for orbit in by_itself if orbit is not None) < 20
    for k, orbit in enumerate(by_itself):
        if orbit is None:
            continue
        found = together.one(k)
        assert (found.stick == orbit.stick).all()
        # the lengths of steps next to rest magnify what two compilations round differently
        for name, within in (("tau", 1e-6), ("x", 1e-5), ("v", 1e-4), ("friction", 1e-2)):
            assert np.abs(getattr(found, name) - getattr(orbit, name)).max() < within, name


@deep("seconds of Python")
def test_without_kernels_a_curve_is_closed_on_arrays(request):
    problem = problem_of(scene_of())
    lanes = KernelCall(answer_lanes, LAW)(problem.body_in_lanes, SPEEDS, problem.goal)
    matrices = KernelCall(differentiate_in_lanes, LAW)(problem.body_in_lanes, SPEEDS, lanes.states)

    kernels = request.getfixturevalue("without_kernels")
    arrays = KernelCall(answer_lanes, LAW)(problem.body_in_lanes, SPEEDS, problem.goal)
    quotients = KernelCall(differentiate_in_lanes, LAW)(problem.body_in_lanes, SPEEDS, lanes.states)

    assert not list(kernels.glob("*.kernel"))
    assert (arrays.fate == CLOSED_ORBIT).all()
    gaps = np.abs(arrays.closed.mean - lanes.closed.mean)
    assert (gaps <= lanes.closed.error + arrays.closed.error).all()
    assert np.abs(matrices - quotients).max() < 1e-6


class Squeezed(SlidingLaw):
    """Less friction across than along."""

    mu: float

    def sliding_friction(self, speed: float) -> float:
        """Along the belt."""
        return self.mu

    def sliding_vector(self, v: complex) -> complex:
        """Half across."""
        speed = abs(v)
        return complex(self.mu * v.real / speed, 0.5 * self.mu * v.imag / speed)


def test_lanes_are_for_friction_along_the_slip_without_memory():
    assert takes_lanes(LAW)
    assert takes_lanes(FALLING)
    assert not takes_lanes(Squeezed(mu=0.3))
    assert not takes_lanes(fl.Dahl(mu=0.3, stiffness=10.0))
    assert problem_of(scene_of(), FALLING).in_lanes(points=4)
    assert not problem_of(scene_of(), FALLING).in_lanes(points=3)
    assert not problem_of(scene_of(), fl.Stribeck(mu_kinetic=0.1, mu_static=0.9)).in_lanes(points=4)


@pytest.mark.parametrize("curve", ["exponential", "hyperbolic", "cubic"])
def test_friction_of_an_array_is_the_laws(curve):
    """By the text of the law where that serves an array, else one by one."""
    law = fl.Stribeck(mu_kinetic=0.3, mu_static=0.4, stribeck_speed=2.0, curve=curve)
    speeds = np.array([1e-3, 0.5, 2.0, 7.0, 200.0])
    found = interpreted_on_arrays(friction_by_lane)(law, speeds)
    np.testing.assert_allclose(found, [law.sliding_friction(speed) for speed in speeds], rtol=1e-13)
