"""Maxwell-slip friction: the springs and sliders one by one, what a loop remembers, what a slip forgets."""

from __future__ import annotations

import cmath
import itertools
from pathlib import Path

import pytest
from hypothesis import given
from hypothesis import strategies as st
from maxwell_slip import MaxwellSlip
from profiles import deep

import frictionlab as fl

LAW = MaxwellSlip(mu=[0.2, 0.15, 0.05], stiffness=[1, 3, 10])
REST = [0.0, 0.0, 0.0]
sizes = st.floats(0.01, 10.0)
elements = st.lists(st.tuples(sizes, sizes), min_size=1, max_size=5)
paths = st.lists(st.floats(-3.0, 3.0), min_size=1, max_size=8)
turns = st.floats(-3.1, 3.1).map(lambda angle: cmath.rect(1.0, angle))


def law_of(pairs: list[tuple[float, float]]) -> MaxwellSlip:
    return MaxwellSlip(mu=[mu for mu, _ in pairs], stiffness=[stiffness for _, stiffness in pairs])


def force(law: MaxwellSlip, memory: list[float]) -> float:
    return float(law.friction(0.0, memory, memory).real)


def virgin(law: MaxwellSlip, x: float) -> float:
    """Return the force of the first loading, each element's own."""
    return sum(min(stiffness * x, mu) for mu, stiffness in zip(law.mu, law.stiffness, strict=True))


def test_one_element_of_stiffness_two_and_limit_three_goes_round_its_loop_exactly():
    law, memory, forces = MaxwellSlip(mu=[3], stiffness=[2]), [0.0], []
    for start, end in itertools.pairwise([0, 0, 5, 3.5, 2, -5, -3.5, -2, 0]):
        memory = law.deflected(memory, end - start)
        forces.append(force(law, memory))

    assert forces == [0, 3, 0, -3, -3, 0, 3, 3]


@given(mu=sizes, stiffness=sizes, v=turns, z=turns, share=st.floats(0.0, 1.0) | st.just(1.0))
def test_one_element_is_jenkins_in_the_plane_and_along_a_line(mu, stiffness, v, z, share):
    law, jenkins = MaxwellSlip(mu=[mu], stiffness=[stiffness]), fl.Jenkins(mu=mu, stiffness=stiffness)

    for slip, deflection in ((v, share * jenkins.reach * z), (v.real, share * jenkins.reach)):
        dz = jenkins.rate(slip, deflection)
        assert law.rate(slip, [deflection], 0) == pytest.approx(dz, abs=1e-13)
        assert law.friction(slip, [deflection], [dz]) == jenkins.friction(slip, deflection, dz)


@pytest.mark.parametrize("turned", [0.1, 0.4, 1.0])
def test_unloading_is_the_first_loading_twice_as_large_by_masing(turned):
    memory = LAW.deflected(REST, turned)

    for back in (0.01, 0.15, 0.3, 0.7):
        away = force(LAW, memory) - force(LAW, LAW.deflected(memory, -back))
        assert away == pytest.approx(2.0 * virgin(LAW, back / 2.0), abs=1e-14) or back > 2.0 * turned


@given(pairs=elements, before=paths, minor=st.floats(0.0, 1.0))
def test_after_a_closed_minor_loop_force_is_what_it_was_before(pairs, before, minor):
    law, memory = law_of(pairs), [0.0] * len(pairs)
    for path in before:
        memory = law.deflected(memory, path)

    loop = minor * abs(before[-1])  # no longer than the branch it leaves, else it is no minor loop
    back = law.deflected(memory, -loop if before[-1] > 0.0 else loop)
    closed = law.deflected(back, loop if before[-1] > 0.0 else -loop)

    assert force(law, closed) == pytest.approx(force(law, memory), abs=1e-12 * law.sliding_friction(0.0))


@deep("kernels of its own")
def test_under_a_given_slip_the_means_of_its_elements_add_up():
    law, mean = MaxwellSlip(mu=[0.2, 0.1, 0.1], stiffness=[0.2, 0.02, 0.005]), 0.0
    scene = fl.Scene(belt_speed=5, slip=fl.Slip(velocity_amplitude=10, frequency=1))
    for mu, stiffness in zip(law.mu, law.stiffness, strict=True):
        mean += fl.steady_state(scene, fl.Jenkins(mu=mu, stiffness=stiffness), method="exact").mean_friction

    state = fl.steady_state(scene, law)
    assert state.status == "ok"
    assert abs(state.mean_friction - mean) <= state.error + 1e-13


@deep("kernels of its own")
def test_its_study_keeps_its_promises():
    done = fl.run(Path(__file__).parent / "study.yaml")

    assert [verdict.sentence for verdict in done.verdicts if not verdict.passed] == []
    assert set(done.table["status"]) == {"ok"}


JOINT = MaxwellSlip(mu=[0.2, 0.5, 1.0], stiffness=[1.0, 0.5, 0.5])
"""Three sliders of reach 0.2, 1 and 2."""


@pytest.mark.parametrize("amplitude", [0.3, 1.1, 1.5, 1.9, 2.1])
def test_sliders_that_never_let_go_leave_the_mean_of_a_belt_at_rest_open(amplitude: float) -> None:
    """A slider whose reach is beyond the amplitude keeps its deflection: any mean up to k (reach - amplitude)."""
    scene = fl.Scene(belt_speed=0, slip=fl.Slip(velocity_amplitude=amplitude, frequency=1))
    pairs = zip(JOINT.mu, JOINT.stiffness, strict=True)
    most = sum(max(0.0, mu - stiffness * amplitude) for mu, stiffness in pairs)

    state = fl.steady_state(scene, JOINT)

    if most > 0.0:
        assert state.status == "not_unique"
        assert (state.mean_low, state.mean_high) == pytest.approx((-most, most), abs=1e-7)
    else:
        assert state.status == "ok"
        assert abs(state.mean_friction) <= state.error + 1e-12
