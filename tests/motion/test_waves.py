"""Polynomials about the anchor of a step are the sums of waves and lines that they stand for."""

from __future__ import annotations

from typing import Any

import pytest
from hypothesis import given
from hypothesis import strategies as st

import frictionlab as fl
from frictionlab.compile.interpret import interpreted
from frictionlab.motion import equation as motion
from frictionlab.motion.events import reference_acceleration
from frictionlab.motion.steppers.dop853 import TIMES
from frictionlab.scene.body import in_the_plane, on_the_line

LAW = fl.Coulomb(mu=0.4)
HARMONICS = {"harmonics": [{"order": 1, "amplitude": 1}, {"order": 5, "amplitude": 0.3, "phase": 40}]}


@st.composite
def scenes(draw: Any) -> fl.Scene:
    """Draw a scene in which several functions of time vary, along the belt or in the plane."""
    waveform = st.sampled_from(["sine", "square", "triangle", HARMONICS])
    drive = {
        "amplitude": draw(st.sampled_from([0.0, 1.5])),
        "frequency": 1.3,
        "phase": draw(st.floats(0, 360)),
    }
    keys = {"damping_ratio": 0.2, "normal_load": 3, "belt_speed": draw(st.floats(-2, 2))}
    more = {
        "belt_vibration": {"velocity_amplitude": 0.7, "frequency_ratio": 2, "waveform": draw(waveform)},
        "normal_load_variation": {"amplitude": 0.6, "frequency_ratio": 3, "waveform": draw(waveform)},
        "transverse": {
            "natural_frequency": 2,
            "damping_ratio": 0,
            "load": {"amplitude": 0.8, "waveform": draw(waveform)},
        },
    }
    chosen = {name: part for name, part in more.items() if draw(st.booleans())}
    return fl.Scene(**keys, drive={**drive, "waveform": draw(waveform)}, **chosen)


def called(name: str, *arguments: Any) -> Any:
    """Return what a function of the equation of motion does, as Python runs it."""
    return interpreted(getattr(motion, name))(*arguments)


def in_a_piece(scene: fl.Scene, piece: int, share: float) -> Any:
    """Return a body in a piece of its period, and a problem with an anchor within it."""
    whole: Any = in_the_plane(scene.mass()) if scene.planar else on_the_line(scene.mass())
    body, (begin, end) = called("in_piece", whole, piece), called("piece_ends", whole, piece)
    anchor = begin + share * min(end - begin, 9.0)
    return body, called("anchored", LAW, body, scene.belt_speed, 1.0, anchor)


@given(scene=scenes(), piece=st.integers(0, 7), share=st.floats(0.05, 0.9), part=st.floats(-0.7, 0.7))
def test_what_varies_near_an_anchor_is_what_varies_at_any_time(
    scene: fl.Scene, piece: int, share: float, part: float
) -> None:
    body, flow = in_a_piece(scene, piece, share)
    tau, u = flow.anchor + part / called("quickest_of", body), 0.3 + 0.0 * body.reference_sine
    near, there = called("instant_near", flow, tau), called("instant_at", body, tau)
    v = called("reference_velocity", body, there.sine, there.cosine)
    a = interpreted(reference_acceleration)(body, there.sine, there.cosine)
    jerk = -(body.frequency**2) * v - called("belt_rate", body, there, 2)
    left = called("load", body, there) - body.balanced_sine * there.sine - body.balanced_cosine * there.cosine
    slip = u + v - called("belt_velocity", body, scene.belt_speed, there)

    assert called("deviation_slip", flow, near, u) == pytest.approx(slip, rel=1e-11, abs=1e-11)
    rate = u + a - called("belt_rate", body, there, 1)
    assert called("deviation_slip_rate", flow, near, u) == pytest.approx(rate, rel=1e-11, abs=1e-11)
    assert called("reference_jerk", flow, near) == pytest.approx(jerk, rel=1e-11, abs=1e-11)
    assert called("unbalanced_load", body, near) == pytest.approx(left, rel=1e-11, abs=1e-11)
    for name in ("normal_load", "normal_load_rate", "normal_load_bend"):
        assert called(name, body, near) == pytest.approx(called(name, body, there), rel=1e-11, abs=1e-11)


@given(scene=scenes(), share=st.floats(0.05, 0.9), step=st.floats(0.01, 0.6))
def test_stages_hold_what_varies_at_their_times(scene: fl.Scene, share: float, step: float) -> None:
    body, flow = in_a_piece(scene, 0, share)
    h = step / called("quickest_of", body)

    called("note_instants", flow, flow.anchor, h)

    for stage in range(1, len(TIMES)):
        then = flow.anchor + TIMES[stage] * h
        noted, near = called("instant_of_stage", flow, stage, then), called("instant_near", flow, then)
        slip = called("deviation_slip", flow, near, 0.0 * body.reference_sine)
        assert noted.swing == pytest.approx(slip, rel=1e-12, abs=1e-13)
        assert noted.push == pytest.approx(called("unbalanced_load", body, near), rel=1e-12, abs=1e-13)
        assert noted.share == pytest.approx(called("load_share", body, near), rel=1e-12, abs=1e-13)


@pytest.mark.parametrize("law", [LAW, fl.Dahl(mu=0.4, stiffness=30)])
def test_a_second_harmonic_of_nothing_changes_nothing(law: fl.FrictionLaw) -> None:
    both: Any = {"harmonics": [{"order": 1, "amplitude": 1}, {"order": 2, "amplitude": 1e-13}]}
    drives = [fl.Drive(amplitude=3, frequency=1.3, waveform=form) for form in ("sine", both)]
    scenes = [fl.Scene(damping_ratio=0.1, normal_load=1, belt_speed=0.8, drive=each) for each in drives]
    one, other = (fl.steady_state(scene, law, method="shooting") for scene in scenes)

    assert (other.status, other.unique) == (one.status, one.unique)
    assert abs(other.mean_friction - one.mean_friction) <= one.error + other.error + 1e-12
