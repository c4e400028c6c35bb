"""What theory says of every steady state under Coulomb friction, seen in what the methods answer.

Scenes are random; the numbers, where there are some, were computed elsewhere or follow from a closed form.
"""

from __future__ import annotations

import math

import numpy as np
import pytest
from answered import with_columns
from hypothesis import assume, example, given
from hypothesis import strategies as st
from profiles import deep
from strategies import MU, angles, scenes_in_the_plane, scenes_on_the_line, signs, sizes

from frictionlab.compile.cache import compiled
from frictionlab.compile.decorators import njit
from frictionlab.laws.coulomb import Coulomb
from frictionlab.methods.exact.forcing import forcing_of
from frictionlab.methods.exact.method import Exact
from frictionlab.methods.exact.oscillator import oscillator_at
from frictionlab.methods.exact.return_map import passage
from frictionlab.methods.periodic.continuation import DIFFERENTIATED
from frictionlab.methods.periodic.problem import PeriodicProblem
from frictionlab.methods.shooting.method import Shooting
from frictionlab.motion.orbit.recorder import WEIGHTS
from frictionlab.motion.orbit.sample import sample
from frictionlab.scene.scene import Drive, Initial, Load, Scene, Slip, Transverse, TransverseSlip
from frictionlab.theory import friction_free_velocity

LAW = Coulomb(mu=MU)
TIGHT = 1e-9
planar_paper = {"damping_ratio": 0.1, "normal_load": 1.0, "drive": Drive(unbalance=10.0, frequency=4.0)}

# counterexamples found
slow_belt = Scene(
    damping_ratio=1.0,
    normal_load=4.445698525097306,
    belt_speed=-0.005,
    drive=Drive(amplitude=1.0, frequency=1.0),
)
at_the_kink = Scene(
    damping_ratio=0.1,
    normal_load=4.445698525097307,
    belt_speed=-2.7476133817092494,
    drive=Drive(amplitude=10.0, frequency=3.8910245728895014),
)

ratios = st.builds(lambda size, sign: sign * size, sizes(1e-4, 1.5), signs)


class Answer:
    """The columns of one scene as attributes, and its orbit with integrals over the period."""

    def __init__(self, answers, i):
        assert answers.status[i] == "ok", answers.reason[i]
        self.__dict__ |= {name: float(values[i]) for name, values in answers.columns.items()}
        self.orbit = answers.orbit(i)

    def mean(self, values):
        """Time mean of what is given at the nodes of the orbit."""
        half = 0.5 * (self.orbit.tau[:, -1:] - self.orbit.tau[:, :1])
        return float((half * WEIGHTS * values).sum() / (2.0 * half.sum()))


def exact(scene, law=LAW):
    return Answer(with_columns(Exact(), [scene], law, 1e-11), 0)


def shooting(scene, law=LAW):
    return Answer(with_columns(Shooting(), [scene], law, TIGHT), 0)


def moved(scene, **changes):
    return scene.model_copy(update=changes)


def along_the_belt_only(scene):
    """The planar scene without its load across the belt."""
    return moved(scene, transverse=moved(scene.transverse, load=None))


def on_the_line(scene):
    return moved(scene, transverse=None)


def friction_of(scene):
    """f = mu gamma^2."""
    return MU * scene.normal_load


# --- one steady state, which attracts everything ------------------------------------------------------------------


@njit
def followed(forcing, belt_speed, state, end, small, most):
    """Period after period (the part up to ``end``) until one changes less than ``small``; and its impulse."""
    body, x, w, impulse = oscillator_at(forcing, belt_speed), state[0], state[1], np.nan
    for _ in range(most):
        there = passage(body, x, w, 0.0, end * body.period)
        change = math.hypot(there.x - x, there.w - w)
        x, w = there.x, there.w
        if change <= small:
            impulse = there.friction
            break
    return x, w, impulse


states = st.tuples(st.floats(-5.0, 5.0), st.floats(-5.0, 5.0))


@deep("an integrator to compile")
@given(scene=scenes_on_the_line(speed=(0.01, 1.2)), start=states)
def test_every_start_settles_to_the_same_steady_state(scene, start):
    found, forcing, v = exact(scene), forcing_of(scene.mass(), MU), abs(scene.belt_speed)
    assume(found.floquet < 0.99)
    scale = np.abs(found.orbit.x).max() + np.abs(found.orbit.v).max() + v + friction_of(scene)
    small = 1e-11 * scale * (1.0 - found.floquet)
    _, _, impulse = compiled(followed)(forcing, v, scale * np.array(start), 1.0, small, 20_000)
    mean = -impulse * scene.frequency / (2.0 * math.pi * scene.normal_load)

    assert mean == pytest.approx(
        abs(found.mean_friction), abs=found.error + 1e-10 * scale / scene.normal_load
    )


@given(
    line=scenes_on_the_line(), plane=scenes_in_the_plane(), others=st.lists(ratios, min_size=1, max_size=4)
)
def test_the_neighbours_a_curve_comes_from_do_not_change_a_point(line, plane, others):
    for scene, method, tolerance in ((line, Exact(), 1e-11), (plane, Shooting(), TIGHT)):
        speeds = np.unique([scene.belt_speed, *(scene.belt_speed * ratio for ratio in others)])
        curve = with_columns(method, [moved(scene, belt_speed=float(v)) for v in speeds], LAW, tolerance)
        i = int(np.flatnonzero(speeds == scene.belt_speed)[0])
        alone = Answer(with_columns(method, [scene], LAW, tolerance), 0)

        assert curve.status == ["ok"] * len(speeds)
        difference = abs(curve.columns["mean_friction"][i] - alone.mean_friction)
        assert difference <= curve.columns["error"][i] + alone.error


@given(scene=scenes_on_the_line(), one=states, other=states, end=st.floats(0.01, 1.0))
def test_two_motions_on_the_line_never_move_apart_in_energy(scene, one, other, end):
    forcing, v = forcing_of(scene.mass(), MU), abs(scene.belt_speed)
    size = 5.0 * scene.drive.amplitude
    before = size * np.array([one, other])
    after = np.array([compiled(followed)(forcing, v, state, end, 0.0, 1)[:2] for state in before])

    apart = np.hypot(*(after[1] - after[0]))
    rounding = 1e-13 * (np.abs(before).max() + size / scene.damping_ratio + v + friction_of(scene))
    assert apart <= np.hypot(*(before[1] - before[0])) + rounding


@given(scene=scenes_in_the_plane())
def test_no_disturbance_of_a_steady_state_in_the_plane_grows_in_energy(scene):
    curve, _ = PeriodicProblem(scene, LAW, 1e-8).close([scene], wanted=DIFFERENTIATED)

    assert np.linalg.norm(curve.matrices[0], 2) <= 1.0 + 1e-6


# --- means --------------------------------------------------------------------------------------------------------


@given(scene=scenes_on_the_line())
@example(scene=slow_belt)
def test_the_mean_position_carries_the_mean_friction_on_the_line(scene):
    for found in (exact(scene), shooting(scene)):
        carried = found.mean(found.orbit.x.real) / scene.normal_load
        size = np.abs(found.orbit.x).max() / scene.normal_load

        assert carried == pytest.approx(found.mean_friction, abs=found.error + TIGHT + 1e-12 * size)


@given(scene=scenes_in_the_plane())
def test_the_mean_position_carries_the_mean_friction_in_the_plane(scene):
    found = shooting(scene)
    x = found.orbit.x / scene.normal_load
    stiffness = scene.transverse.natural_frequency**2
    within = found.error + TIGHT * (1.0 + np.abs(x).max())

    assert found.mean(x.real) == pytest.approx(found.mean_friction, abs=within)
    assert stiffness * found.mean(x.imag) == pytest.approx(
        found.mean_friction_transverse, abs=within * (1.0 + stiffness)
    )


@given(scene=scenes_in_the_plane(), line=scenes_on_the_line())
def test_no_mean_exceeds_the_friction_coefficient(scene, line):
    planar, found = shooting(scene), exact(line)

    assert math.hypot(planar.mean_friction, planar.mean_friction_transverse) <= MU + planar.error
    assert abs(found.mean_friction) <= MU + found.error
    slip = np.abs(planar.orbit.v - scene.belt_speed)
    moving = slip > 1e-6 * slip.max()  # what is too short to be stepped through is recorded as still held
    assert np.abs(planar.orbit.friction[moving]).max() <= MU * (1.0 + 1e-9)


@given(scene=scenes_on_the_line(speed=(1.0, 50.0)))
@example(scene=at_the_kink)
def test_a_belt_faster_than_the_friction_free_motion_feels_full_friction(scene):
    assume(abs(scene.belt_speed) >= friction_free_velocity(scene))
    found, side = exact(scene), math.copysign(1.0, scene.belt_speed)
    mass, tau = scene.mass(), found.orbit.tau
    dynamic = 1.0 - mass.frequency**2 + 1j * mass.damping * mass.frequency
    linear = (mass.force / dynamic * np.exp(1j * mass.frequency * tau)).imag
    shifted = linear + side * friction_of(scene)

    beyond_rounding = abs(scene.belt_speed) > friction_free_velocity(scene) * (1.0 + 1e-14)
    assert found.mean_friction == pytest.approx(
        side * MU, rel=0.0, abs=0.0 if beyond_rounding else found.error
    )
    np.testing.assert_allclose(found.orbit.x.real, shifted, rtol=0, atol=1e-11 * np.abs(shifted).max())
    assert found.reversals == 0.0 or not beyond_rounding
    confirmed = shooting(scene)
    assert confirmed.mean_friction == pytest.approx(side * MU, abs=confirmed.error)


@deep("reads all sources")
@given(scene=scenes_on_the_line(speed=(0.02, 0.7), friction=(0.05, 0.5)))
def test_the_energy_of_friction_needs_the_sign_of_the_slip_not_of_the_position(scene):
    found = exact(scene)
    at = sample(found.orbit, scene, LAW, 20_000)
    period = 2.0 * math.pi / scene.frequency
    printed = friction_of(scene) * period * np.mean(np.sign(at.x1 - scene.belt_speed) * at.v1)
    corrected = friction_of(scene) * period * np.mean(np.sign(at.v1 - scene.belt_speed) * at.v1)
    scale = friction_of(scene) * period * np.abs(at.v1).max()
    assume(found.stick_fraction == 0.0)  # at rest the printed sign is none

    assert abs(printed) <= 1e-3 * scale
    assert corrected == pytest.approx(found.energy_friction, abs=1e-3 * scale)
    assert corrected >= 0.02 * scale


def test_the_planar_curve_approaches_full_friction_as_the_inverse_square_of_belt_speed():
    across = Transverse(natural_frequency=4.0, damping_ratio=0.1, load=Load(unbalance=10.0))
    gap = []
    for speed in (600.0, 2_000.0, 4_000.0, 8_000.0):
        scene = Scene(belt_speed=speed, transverse=across, **planar_paper)
        found = shooting(scene)
        gap.append(
            (1.0 - found.mean_friction / MU) / (found.transverse_velocity_amplitude / (2.0 * speed)) ** 2
        )
    short = 1.0 - np.array(gap[1:])

    assert gap[0] == pytest.approx(0.02622 / 0.02773, rel=1e-3)
    np.testing.assert_allclose(short[:-1] / short[1:], 4.0, rtol=0.02)


@given(scene=scenes_in_the_plane(friction=(0.02, 0.3)))
def test_a_planar_curve_has_no_kink_but_a_tail(scene):
    swing = shooting(scene)
    far = 30.0 * (swing.velocity_amplitude + swing.transverse_velocity_amplitude)
    found = shooting(moved(scene, belt_speed=math.copysign(far, scene.belt_speed)))
    tail = (found.transverse_velocity_amplitude / (2.0 * far)) ** 2

    assert 1.0 - abs(found.mean_friction) / MU == pytest.approx(tail, rel=0.02, abs=5.0 * found.error)
    assert abs(found.mean_friction) < MU


ellipses = st.tuples(
    sizes(0.01, 100.0), sizes(0.01, 100.0), angles.map(math.degrees), angles.map(math.degrees)
)


def sliding(belt_speed, ellipse):
    along, across, phase, phase_2 = ellipse
    return Scene(
        belt_speed=belt_speed,
        slip=Slip(velocity_amplitude=along, frequency=2.0, phase=phase),
        transverse_slip=TransverseSlip(velocity_amplitude=across, phase=phase_2),
    )


@given(ellipse=ellipses, ratios=st.lists(sizes(1e-3, 1e3), min_size=2, max_size=8, unique=True))
def test_mean_friction_under_prescribed_slip_rises_with_belt_speed_up_to_the_coefficient(ellipse, ratios):
    speeds = np.unique(np.concatenate((-np.array(ratios), ratios))) * max(ellipse[:2])
    answers = with_columns(Exact(), [sliding(float(v), ellipse) for v in speeds], LAW, 1e-9)
    mean, error = answers.columns["mean_friction"], answers.columns["error"]

    assert set(answers.status) == {"ok"}
    assert np.all(np.diff(mean) >= -(error[1:] + error[:-1]))
    assert np.all(np.abs(mean) <= MU + error)
    np.testing.assert_allclose(mean, -mean[::-1], atol=float((error + error[::-1]).max()))


# --- energies -----------------------------------------------------------------------------------------------------


@given(scene=scenes_in_the_plane())
def test_what_the_loads_put_in_the_dampers_and_friction_take_out(scene):
    found = shooting(scene)
    scale = abs(found.energy_viscous) + abs(found.energy_friction) + abs(found.energy_input)
    period = 2.0 * math.pi / scene.frequency
    belt = scene.belt_speed * scene.normal_load * found.mean_friction * period

    assert found.energy_input == pytest.approx(found.energy_viscous + found.energy_friction, abs=1e-8 * scale)
    assert found.energy_contact == pytest.approx(found.energy_friction + belt, abs=1e-8 * (scale + abs(belt)))
    assert found.energy_contact > 0.0
    assert found.energy_viscous > 0.0


@given(scene=scenes_in_the_plane())
def test_a_steady_state_attracts(scene):
    assert 0.0 <= shooting(scene).floquet < 1.0


# --- reduction and scaling ----------------------------------------------------------------------------------------


@given(scene=scenes_in_the_plane())
def test_without_a_load_across_the_belt_the_plane_is_the_line(scene):
    planar = along_the_belt_only(scene)
    line = exact(on_the_line(scene))
    for found in (exact(planar), shooting(planar)):
        assert found.mean_friction == pytest.approx(line.mean_friction, abs=found.error + line.error)
        assert np.all(found.orbit.x.imag == 0.0)
        assert np.all(found.orbit.v.imag == 0.0)
        assert np.all(found.orbit.friction.imag == 0.0)


# undamped and slow, superharmonics resonate at 1/3, 1/5, ...: there Den Hartog's formula divides by zero
between_resonances = st.tuples(st.floats(0.3, 4.0), st.floats(0.0, 0.6)).filter(
    lambda drawn: abs(drawn[0] - 1.0) > 1e-3 and (drawn[1] > 0.01 or drawn[0] > 0.55)
)


@given(between_resonances, st.floats(0.05, 0.9))
@example((0.8, 0.0), 0.5)
def test_symmetric_motion_without_stops_has_den_hartogs_amplitude(frequency_and_damping, share):
    frequency, damping = frequency_and_damping
    stretch, delay, response = den_hartog(frequency, damping)
    friction = share * min(1.0, response / math.hypot(stretch, delay))
    still = Scene(
        damping_ratio=damping,
        normal_load=friction / MU,
        belt_speed=0.0,
        drive=Drive(amplitude=1.0, frequency=frequency),
    )
    found = exact(still)
    assume(found.stick_fraction == 0.0 and found.reversals == 2.0)
    amplitude = np.abs(found.orbit.x.real[:, [0, -1]]).max()  # pieces end where the velocity does

    expected = -friction * stretch + math.sqrt(response**2 - (friction * delay) ** 2)
    assert amplitude == pytest.approx(expected, rel=1e-9)


def den_hartog(frequency, damping):
    """G, H and 1/q of Den Hartog (1931): amplitude = -f G + sqrt(1/q^2 - f^2 H^2) for a load of one."""
    omega_d, half = math.sqrt(1.0 - damping**2), math.pi / frequency
    below = math.cosh(damping * half) + math.cos(omega_d * half)
    stretch = (math.sinh(damping * half) - damping / omega_d * math.sin(omega_d * half)) / below
    delay = math.sin(omega_d * half) / (frequency * omega_d * below)
    return stretch, delay, 1.0 / math.hypot(1.0 - frequency**2, 2.0 * damping * frequency)


def test_a_stiff_spring_across_the_belt_leaves_one_degree_of_freedom():
    drive = Drive(unbalance=10.0, frequency=2.0)
    line = exact(Scene(damping_ratio=0.1, normal_load=1.0, belt_speed=15.0, drive=drive)).mean_friction
    gaps = []
    for omega_r in (20.0, 40.0, 80.0):
        across = Transverse(natural_frequency=omega_r, damping_ratio=0.1, load=Load(unbalance=10.0))
        scene = Scene(damping_ratio=0.1, normal_load=1.0, belt_speed=15.0, drive=drive, transverse=across)
        gaps.append(abs(shooting(scene).mean_friction - line))

    assert gaps[0] / gaps[1] >= 8.0
    assert gaps[1] / gaps[2] >= 8.0


def test_only_a_mass_that_may_rest_for_ever_remembers_its_start():
    drive = Drive(unbalance=10.0, frequency=0.5)
    held = Scene(damping_ratio=0.1, normal_load=10.0, belt_speed=0.0, drive=drive)
    means = [exact(moved(held, initial=Initial(x=x))).mean_friction for x in (-1.4, 0.0, 1.4)]

    np.testing.assert_allclose(means, [-0.14, 0.0, 0.14], atol=1e-11)
    slow = [exact(moved(held, belt_speed=1e-3, initial=Initial(x=x))).mean_friction for x in (-1.4, 0.0, 1.4)]
    assert slow == [slow[0]] * 3
