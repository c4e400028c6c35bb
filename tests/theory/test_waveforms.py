"""Closed forms of waveforms, vibrating belts and changing normal loads: means, the linear response, V_lin."""

from __future__ import annotations

import math
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from hypothesis import example, given, settings
from hypothesis import strategies as st

from frictionlab.laws.coulomb import Coulomb
from frictionlab.laws.stribeck import Stribeck
from frictionlab.runner.steady_state import steady_state
from frictionlab.scene.scene import Scene
from frictionlab.scene.signals import FULL_TURN, edges_of, signal_of
from frictionlab.scene.waveforms import WAVE_SHAPES, Form, Term, form_of, told
from frictionlab.study.load import load_study
from frictionlab.theory import friction_free_velocity, mean_prescribed_longitudinal
from frictionlab.theory.linear import LinearOscillator
from frictionlab.theory.piecewise import piecewise
from frictionlab.theory.prescribed import mean_direction

angles = st.floats(0.0, 360.0)
terms = st.builds(Term, st.integers(1, 6), st.floats(-1.0, 1.0), angles)
shares = st.floats(0.05, 0.95)
place = st.tuples(st.integers(0, 20), st.integers(-10, 10).map(lambda tenths: tenths / 10))
pairs = st.lists(place, min_size=2, max_size=6, unique_by=lambda one: one[0])
points = pairs.map(lambda found: sorted([share / 20, value] for share, value in found))
forms = (
    st.sampled_from([Form(name) for name in WAVE_SHAPES])
    | st.lists(terms, min_size=1, max_size=4).map(lambda found: Form("harmonics", tuple(found)))
    | shares.map(lambda share: form_of({"square": {"duty": share}}))
    | shares.map(lambda share: form_of({"sawtooth": {"width": share}}))
    | points.filter(lambda found: len({y for _, y in found}) > 1).map(
        lambda found: form_of({"points": found})
    )
)
LAW = Coulomb(mu=0.4)


def direction(
    waveform: Any, phase: float, ratio: float, load: Any = "sine", amplitude: float = 0.0, lead: float = 0.0
) -> Any:
    """Of a slip of amplitude 1 on a belt of speed ``ratio``, in periods of 1, the load ahead by ``lead``."""
    form, other = (each if isinstance(each, Form) else Form(each) for each in (waveform, load))
    slip = signal_of(form, FULL_TURN, phase)
    normal = signal_of(other, FULL_TURN, phase + lead).scaled(amplitude)
    edges = edges_of(sorted({*slip.corners(1.0), *normal.corners(1.0)}), 1.0)
    return mean_direction(piecewise(slip, edges).minus(ratio), piecewise(normal, edges, 1.0))


@given(gap=st.floats(-12.0, -1.0), phase=angles)
@example(gap=-11.793342179739893, phase=142.7570928030736)  # its phasor is rounded
def test_the_error_covers_the_mean_of_a_sine_that_hardly_reverses(gap: float, phase: float) -> None:
    ratio = 1.0 - 10.0**gap
    closed = 1.0 - 4.0 / math.pi * math.asin(math.sqrt(0.5 * (1.0 - ratio)))

    found = direction("sine", phase, ratio)

    assert abs(found.mean - closed) <= found.error


@given(corners=st.lists(st.sampled_from([0.0, 5e-324, 1e-16, 0.25, 0.5, 1.0 - 1e-15, 1.0 - 2.0**-53])))
def test_no_piece_is_a_rounding_error_long(corners: list[float]) -> None:
    """``march`` stepped beyond its array in such a piece."""
    edges = edges_of(sorted({*corners}), 1.0)

    assert (edges[0], edges[-1]) == (0.0, 1.0)
    assert np.diff(edges).min() > 0.2


@given(form=forms)
def test_a_form_reads_back_from_its_cell_and_its_study(form: Form) -> None:
    assert told(str(form)) == form_of(form.plain()) == form


@given(form=forms)
def test_a_velocity_has_no_mean_and_a_force_that_of_its_samples(form: Form) -> None:
    tau = (np.arange(20000) + 0.5) / 20000
    kept, none = (signal_of(form, FULL_TURN, 20.0, mean)(tau) for mean in (True, False))

    assert form.mean == pytest.approx(float(kept.mean()), abs=1e-3)
    assert none == pytest.approx(kept - form.mean, abs=1e-14)


def test_shares_of_one_half_and_one_are_the_waves_with_a_name() -> None:
    tau = (np.arange(240) + 0.5) / 240
    for given_as, name in (
        ({"square": {"duty": 0.5}}, "square"),
        ({"sawtooth": {"width": 0.5}}, "triangle"),
        ({"sawtooth": {"width": 1.0}}, "sawtooth"),
        ({"points": [[0, 0], [0.25, 1], [0.75, -1], [1, 0]]}, "triangle"),
    ):
        found = signal_of(form_of(given_as), FULL_TURN, 0.0)(tau)
        assert found == pytest.approx(signal_of(Form(name), FULL_TURN, 0.0)(tau), abs=1e-12)


def test_a_file_of_a_study_is_read_from_its_folder(tmp_path: Path) -> None:
    (tmp_path / "measured.csv").write_text("time,value\n0,0\n0.5,1\n1.5,-1\n2,0\n")
    slip = "{velocity_amplitude: 2, frequency: 1, waveform: {file: measured.csv}}"
    (tmp_path / "study.yaml").write_text(
        f"schema: 1\nscene: {{belt_speed: 1, slip: {slip}}}\nlaws: [{{kind: coulomb, mu: 0.4}}]\n"
        "sweep: {scene.slip.waveform: [{file: measured.csv}, triangle]}\n"
    )
    plan = load_study(tmp_path / "study.yaml")

    wanted = form_of({"points": [[0, 0], [0.25, 1], [0.75, -1], [1, 0]]})
    assert plan.sweep["scene.slip.waveform"] == (wanted, Form("triangle"))
    assert plan.scene.slip is not None
    assert plan.scene.slip.waveform == wanted


@pytest.mark.parametrize(
    ("text", "told_of"),
    [
        ("time,force\n0,1\n", "must have the columns time and value"),
        ("time,value\n0,1\n1,x\n", "numbers in every row"),
        ("time,value\n1,1\n2,0\n", "must begin at time 0"),
        ("time,value\n0,1\n3,0\n2,1\n", "must be from that before to 1"),
        (None, "cannot be read"),
    ],
)
def test_a_file_that_is_no_waveform_is_told(text: str | None, told_of: str, tmp_path: Path) -> None:
    if text is not None:
        (tmp_path / "wave.csv").write_text(text)

    with pytest.raises(ValueError, match=told_of):
        form_of({"file": str(tmp_path / "wave.csv")})


@pytest.mark.parametrize(("speed", "mean"), [(0.2, -0.192), (-0.2, -0.192), (0.5, 0.2)])
def test_the_mean_under_an_inertia_drive_of_two_levels_is_that_of_their_times(
    speed: float, mean: float
) -> None:
    """Its velocity is 0.4 for 98 % of the period, and -19.6: -mu (2 duty - 1) on a belt that is slower."""
    slip = {"velocity_amplitude": 10.0, "frequency": 1.0, "waveform": {"square": {"duty": 0.98}}}
    scene = Scene.model_validate({"belt_speed": speed, "slip": slip})

    assert steady_state(scene, Coulomb(mu=0.2)).mean_friction == pytest.approx(mean, abs=1e-12)


@given(form=forms)
def test_jumps_and_opposites_are_those_of_its_values(form: Form) -> None:
    signal, tau = signal_of(form, FULL_TURN, 0.0), (np.arange(240) + 1e-9) / 240
    sides = [np.abs(signal(tau) - signal(tau - 2e-9)).max(), np.abs(signal(tau) + signal(tau + 0.5)).max()]

    assert form.jumps == (sides[0] > 1e-3)
    if form.antisymmetric:
        assert sides[1] <= 1e-6
    elif not form.terms and not form.numbers:
        assert sides[1] > 0.1


@given(slip=forms, load=forms, phase=angles, lead=angles, ratio=st.floats(-1.5, 1.5), share=st.floats(0, 0.9))
def test_the_mean_of_any_waveform_is_that_of_samples(
    slip: Form, load: Form, phase: float, lead: float, ratio: float, share: float
) -> None:
    tau = (np.arange(20000) + 0.5) / 20000
    w = signal_of(slip, FULL_TURN, phase)(tau) - ratio
    n = signal_of(load, FULL_TURN, phase + lead)(tau)
    amplitude = share / max(1.0, -float(n.min()))
    found = direction(slip, phase, ratio, load, amplitude, lead)

    near = np.abs(w) < 1e-3  # where samples may miss a reversal
    assert found.mean == pytest.approx(
        -float(np.mean((1 + amplitude * n) * np.sign(w))), abs=5e-3 + 2 * found.at_rest + 4 * near.mean()
    )


@given(ratio=st.floats(0.01, 0.99), phase=angles)
def test_the_mean_under_a_parabola_is_that_of_its_time_below_the_belt_speed(
    ratio: float, phase: float
) -> None:
    # the parabola of unit height: the integral of a triangle
    tau = (np.arange(40000) + 0.5) / 40000
    rise = np.where(tau < 0.5, 1 - (4 * tau - 1) ** 2, (4 * tau - 3) ** 2 - 1)

    assert float(mean_prescribed_longitudinal(ratio, "parabola")) == pytest.approx(
        2 * np.mean(rise < ratio) - 1, abs=1e-4
    )


@given(
    form=forms,
    phase=angles,
    damping=st.sampled_from([0.0, 0.02, 1.0, 2.0, 7.0]),
    stiffness=st.floats(0.1, 9.0),
)
def test_the_linear_response_obeys_its_equation_and_repeats(
    form: Form, phase: float, damping: float, stiffness: float
) -> None:
    load, oscillator = signal_of(form, 1.3, phase), LinearOscillator(damping, stiffness)
    period = FULL_TURN / 1.3
    edges = edges_of(load.corners(period), period)
    position, velocity = (oscillator.response(load, edges, order) for order in (0, 1))
    if position is None or velocity is None:
        assert damping == 0.0
        return
    k = np.repeat(np.arange(len(edges) - 1), 5)
    tau = (edges[:-1, None] + np.diff(edges)[:, None] * np.linspace(0.0, 1.0, 5)).ravel()
    (x, v), (same, a) = position.at(tau, k), velocity.at(tau, k)
    force = piecewise(load, edges).at(tau, k)[0]
    size = 1e-12 * max(1.0, position.size() * (1.0 + stiffness), velocity.size() * (1.0 + damping))

    assert v == pytest.approx(same, abs=size)
    assert a + damping * v + stiffness * x == pytest.approx(force, abs=size)
    for of in (x, v):  # at every corner, the end of the period among them
        assert of.reshape(-1, 5)[:, 4] == pytest.approx(np.roll(of.reshape(-1, 5)[:, 0], -1), abs=size)


BODIES: tuple[dict[str, Any], ...] = (
    {},
    {"fractional": {"coefficient": 0.3, "order": 0.4}},
    {"relaxation": {"stiffness": 0.5, "time": 2.0}},
)


def memory(p: Any, fractional: Any = None, relaxation: Any = None) -> Any:
    """Force over x1 of what of a body remembers, at p = i omega."""
    slow = p * relaxation["time"] if relaxation else 0.0
    power = fractional["coefficient"] * p ** fractional["order"] if fractional else 0.0
    return power + (relaxation["stiffness"] * slow / (1.0 + slow) if relaxation else 0.0)


def scene(**keys: Any) -> Scene:
    given = {"damping_ratio": 0.1, "normal_load": 2.0, "belt_speed": 1.0}
    return Scene(**{**given, "drive": {"amplitude": 3.0, "frequency": 1.3}, **keys})


@given(form=forms, phase=angles, lead=angles, body=st.sampled_from(BODIES))
@settings(max_examples=20)
def test_v_lin_is_the_largest_velocity_over_the_belts(
    form: Form, phase: float, lead: float, body: dict[str, Any]
) -> None:
    shaken = scene(
        body=body or None,
        drive={"amplitude": 3.0, "frequency": 1.3, "waveform": form.plain(), "phase": phase},
        belt_vibration={"velocity_amplitude": 0.5, "waveform": "triangle", "frequency_ratio": 0.5},
        normal_load_variation={"amplitude": 0.3, "waveform": "sawtooth", "phase": lead},
    )
    for side in (1.0, -1.0):
        signals, n = shaken.signals(), 2**15
        tau = (np.arange(n) + 0.5) * signals.period / n
        push = signals.load[0](tau) + side * 0.4 * signals.normal_load(tau)
        rate = 2.0 * math.pi * np.fft.rfftfreq(n, signals.period / n)
        dynamic = 1.0 - rate**2 + 0.2j * rate + memory(1j * rate, **body)
        v = np.fft.irfft(np.fft.rfft(push) * 1j * rate / dynamic, n)
        v -= signals.belt[0](tau)

        found = friction_free_velocity(shaken.at(side), LAW)
        assert found == pytest.approx(float((side * v).max()), rel=2e-3)


@pytest.mark.parametrize("body", BODIES[1:])
def test_v_lin_of_a_sine_is_the_load_over_the_dynamic_stiffness(body: dict[str, Any]) -> None:
    dynamic = 1.0 - 1.3**2 + 0.26j + memory(1.3j, **body)

    assert friction_free_velocity(scene(body=body)) == pytest.approx(3.0 * 1.3 / abs(dynamic), rel=1e-14)


def test_v_lin_of_a_table_is_known_as_far_as_the_table_goes(tmp_path: Path) -> None:
    omega, file = np.linspace(0.0, 4.0, 9), tmp_path / "h.csv"
    values = 1.0 / (1.0 - omega**2 + 0.2j * omega)
    rows = [f"{w},{float(h.real)!r},{float(h.imag)!r}" for w, h in zip(omega, values, strict=True)]
    file.write_text("\n".join(["frequency,real,imaginary", *rows]))

    def found(frequency: float, waveform: str = "sine", **more: float) -> float:
        drive = {"amplitude": 3.0, "frequency": frequency, "waveform": waveform}
        body = {"receptance": {"file": str(file), **more}}
        return friction_free_velocity(scene(damping_ratio=None, drive=drive, body=body))

    assert found(1.5) == pytest.approx(4.5 * abs(values[3]), rel=1e-13)
    assert found(5.0, free_mass=2.0) == pytest.approx(3.0 / (2.0 * 5.0), rel=1e-13)
    assert found(1.0, "square", free_mass=1.0) == pytest.approx(
        friction_free_velocity(scene(drive={"amplitude": 3.0, "frequency": 1.0, "waveform": "square"})),
        rel=1e-2,
    )
    assert math.isnan(found(5.0))
    assert math.isnan(found(1.0, "square"))


def test_v_lin_under_a_changing_normal_load_asks_for_the_law() -> None:
    pulsating = scene(normal_load_variation={"amplitude": 0.3})

    with pytest.raises(ValueError, match="give the law"):
        friction_free_velocity(pulsating)
    falls = Stribeck(mu_kinetic=0.2, mu_static=0.6, stribeck_speed=1.0)
    slow, fast = (friction_free_velocity(pulsating.at(speed), falls) for speed in (0.1, 10.0))
    assert slow != pytest.approx(fast, rel=1e-3)  # friction at the belt's speed pulsates


def test_v_lin_is_infinite_where_any_harmonic_of_the_load_is_at_undamped_resonance() -> None:
    drive = {"amplitude": 1.0, "frequency": 1.0 / 3.0, "waveform": "square"}

    assert friction_free_velocity(scene(damping_ratio=0.0, drive=drive)) == math.inf


def test_a_square_slip_of_the_belts_speed_rests_for_half_of_the_period() -> None:
    found = direction("square", 30.0, 1.0)

    assert found.at_rest == pytest.approx(0.5, abs=1e-14)
    assert found.mean == pytest.approx(0.5, abs=1e-14)
    assert math.isnan(float(mean_prescribed_longitudinal(1.0, "square")))


def test_v_lin_of_a_sine_on_a_belt_that_vibrates_with_it_is_that_of_the_sum() -> None:
    vibration = {"velocity_amplitude": 0.7, "phase": 50.0}
    response = 1.3 * 3.0 * 1j / (1 - 1.3**2 + 2j * 0.1 * 1.3)
    sum_ = response - 0.7 * np.exp(1j * math.radians(50.0))

    assert friction_free_velocity(scene(belt_vibration=vibration)) == pytest.approx(abs(sum_), rel=1e-14)


def test_v_lin_of_a_slip_is_its_largest_velocity_along_the_belt() -> None:
    slip = {"velocity_amplitude": 2.0, "frequency": 1.0, "waveform": "triangle", "direction": 60.0}

    assert friction_free_velocity(Scene(belt_speed=1, slip=slip)) == pytest.approx(1.0, rel=1e-14)
