"""The logarithm of a slip that creeps: there and back, its rates, and on which scale a law creeps."""

from __future__ import annotations

import math
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest
from hypothesis import example, given
from hypothesis import strategies as st
from rate_and_state import RateAndState

import frictionlab as fl
from frictionlab.compile.interpret import interpreted
from frictionlab.motion.equation import anchored
from frictionlab.motion.maps import creep
from frictionlab.motion.maps.rates import U, workspace
from frictionlab.scene.body import on_the_line

LAW = RateAndState(mu=0.6, a=0.01, b=0.0, slip_length=1.0)
exponents, angles = st.floats(-60.0, 0.0), st.floats(-math.pi, math.pi)
scales = st.floats(-60.0, -1.0).map(lambda exponent: 10.0**exponent)


def slip(exponent: float, angle: float, planar: bool) -> Any:
    size = 10.0**exponent
    return (
        size * complex(math.cos(angle), math.sin(angle)) if planar else math.copysign(size, math.cos(angle))
    )


def step_from(start: Any, scale: float) -> Any:
    """A step from a slip."""
    return SimpleNamespace(start={U: start}, end={U: start}, creep=np.array([scale, 1.0]))


@pytest.mark.parametrize("planar", [False, True], ids=["line", "plane"])
@given(exponents=st.tuples(exponents, exponents), angles=st.tuples(angles, angles), scale=scales)
@example(exponents=(0.0, 0.0), angles=(2.5, 0.0), scale=1e-45)
def test_what_a_step_takes_tells_the_slip(exponents, angles, scale, planar):
    start, w = (slip(*each, planar) for each in zip(exponents, angles, strict=True))
    work = step_from(start, scale)
    taken = interpreted(creep.to_step_variable)(LAW, work, w)
    back = interpreted(creep.from_step_variable)(LAW, work, taken)

    # A logarithm is rounded by its size times 2e-16; across the slip J is smaller than along it by the logarithm, and
    # its inverse magnifies that.
    logarithm = 2.0 + math.log(1.0 / scale)
    assert abs(back - w) <= 4e-16 * logarithm**2 * (abs(w) + scale)
    assert interpreted(creep.to_step_variable)(LAW, work, start) == start


@pytest.mark.parametrize("planar", [False, True], ids=["line", "plane"])
@given(exponents=st.tuples(exponents, exponents), angles=st.tuples(angles, angles), scale=scales)
def test_it_goes_at_the_rate_of_the_slip(exponents, angles, scale, planar):
    start, w = (slip(*each, planar) for each in zip(exponents, angles, strict=True))
    work, a = step_from(start, scale), slip(0.0, angles[0] + 1.0, planar)
    work.creep[creep.SLOW] = 0.0  # none is too slow for inertia
    rate = interpreted(creep.step_variable_rate)(LAW, work, w, a)

    shift = 1e-6 * min(max(abs(w), scale), 1.0)
    ahead, behind = (interpreted(creep.to_step_variable)(LAW, work, w + s * shift * a) for s in (1.0, -1.0))
    assert abs((ahead - behind) / (2.0 * shift) - rate) <= 1e-4 * abs(rate)


@given(age=st.floats(-3.0, 3.0).map(lambda exponent: 10.0**exponent), w=exponents)
def test_the_scale_is_that_of_the_law(age, w):
    law = LAW.model_copy(update={"b": 0.008})
    drive = fl.Drive(amplitude=1.0, frequency=1.0)
    body = on_the_line(fl.Scene(damping_ratio=0.1, normal_load=1.0, belt_speed=1.0, drive=drive).mass())
    work = interpreted(workspace)(law, 0.0, ())
    work.memory[0], work.creep[creep.SLOW] = age, 1e-3
    flow = interpreted(anchored)(law, body, 1.0, 1.0, 0.0)
    interpreted(creep.note_creep)(flow, 10.0**w, 0.0, work)

    creeps = 2.0 * math.exp(-(law.mu + law.b * math.log(age)) / law.a)
    assert (10.0**w >= 1e-3 and work.creep[creep.SCALE] == 0.0) or work.creep[creep.SCALE] == pytest.approx(
        creeps, rel=0.35
    )
