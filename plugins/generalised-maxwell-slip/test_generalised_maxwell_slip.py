"""Generalised Maxwell-slip friction: an integration from event to event, and the laws it is in its limits."""

from __future__ import annotations

import cmath
import csv
import json
import math
from pathlib import Path

import pytest
from generalised_maxwell_slip import GeneralisedMaxwellSlip
from hypothesis import given
from hypothesis import strategies as st
from maxwell_slip import MaxwellSlip
from profiles import deep

import frictionlab as fl

RESULTS = Path(__file__).parents[2] / "tests" / "reference" / "generalised_maxwell_slip.csv"
TOLERANCE = 1e-8
with RESULTS.open(newline="") as _file:
    ROWS = list(csv.DictReader(_file))
FALLING = {"mu_kinetic": 0.25, "mu_static": 0.4, "stribeck_speed": 5.0, "attraction": 2.0}
LAW = GeneralisedMaxwellSlip(share=[2, 1, 1], stiffness=[1, 3, 10], **FALLING)
sizes = st.floats(0.01, 10.0)
elements = st.lists(st.tuples(sizes, sizes), min_size=1, max_size=5)
vectors = st.builds(cmath.rect, sizes, st.floats(-3.1, 3.1))
BODY = fl.Scene(damping_ratio=0.4, normal_load=10, belt_speed=5, drive=fl.Drive(unbalance=10, frequency=1.5))
compiling = deep("more kernels to compile")


@compiling
@pytest.mark.parametrize("row", ROWS, ids=[row["name"] for row in ROWS])
def test_the_mean_is_that_of_an_integration_from_event_to_event(row):
    law = GeneralisedMaxwellSlip(**json.loads(row["law"]))

    found = fl.steady_state(fl.Scene(**json.loads(row["scene"])), law, "shooting", tolerance=TOLERANCE)

    assert found.status == "ok", found.reason
    assert found.error <= TOLERANCE
    assert abs(found.mean_friction - float(row["mean_friction"])) <= found.error + float(row["accuracy"])


def test_the_reference_reverses_breaks_away_and_slides_for_good_and_is_accurate():
    kinds = {(row["name"].split("/")[0], int(row["breakaways"]) > 0) for row in ROWS}

    assert kinds == {
        (kind, breaks) for kind in ("slip", "ellipse", "body", "plane") for breaks in (True, False)
    }
    assert max(float(row["accuracy"]) for row in ROWS) <= 1e-10


@compiling
@pytest.mark.parametrize("name", ["body/3/constant/5", "body/3/constant/2"])
def test_the_reference_of_constant_friction_is_maxwell_slip_along_a_line(name):
    (row,) = (row for row in ROWS if row["name"] == name)
    law = GeneralisedMaxwellSlip(**json.loads(row["law"]))
    same = MaxwellSlip(mu=[law.mu_kinetic * alpha for alpha in law.alpha], stiffness=law.stiffness)

    found = fl.steady_state(fl.Scene(**json.loads(row["scene"])), same, "shooting", tolerance=TOLERANCE)

    off = abs(found.mean_friction - float(row["mean_friction"]))
    assert off - float(row["accuracy"]) <= found.error <= TOLERANCE


@compiling
def test_equal_elements_of_constant_friction_are_jenkins_along_a_line():
    law = GeneralisedMaxwellSlip(share=[1, 1, 1], stiffness=[4 / 3] * 3, mu_kinetic=0.4, attraction=2)

    found = fl.steady_state(BODY, law, "shooting", tolerance=TOLERANCE)
    same = fl.steady_state(BODY, fl.Jenkins(mu=0.4, stiffness=4), tolerance=TOLERANCE)

    assert found.status == "ok", found.reason
    assert abs(found.mean_friction - same.mean_friction) <= found.error + same.error


@given(pairs=elements, v=vectors, z=vectors)
def test_rates_and_breakaway_are_those_of_the_formulas_along_a_line_and_in_the_plane(pairs, v, z):
    numbers = {"share": [share for share, _ in pairs], "stiffness": [k for _, k in pairs], **FALLING}
    law, whole = GeneralisedMaxwellSlip(**numbers), sum(share for share, _ in pairs)

    for slip, deflection in ((v, z), (v.real, z.real)):
        memory = [deflection] * len(pairs)
        sliding = 0.25 + 0.15 * math.exp(-((abs(slip) / 5.0) ** 2))
        for k, (share, stiffness) in enumerate(pairs):
            part = share / whole
            rate = 2.0 * (part / stiffness * slip / abs(slip) - deflection / sliding)
            assert law.rate(slip, memory, k) == pytest.approx(rate, rel=1e-12)
            assert law.breakaway(slip, k) == pytest.approx(part * sliding / stiffness, rel=1e-12)


@given(pairs=elements, v=vectors)
def test_in_steady_sliding_the_elements_hold_their_shares(pairs, v):
    law = GeneralisedMaxwellSlip(
        share=[share for share, _ in pairs], stiffness=[k for _, k in pairs], viscosity=0.01, **FALLING
    )
    memory = [law.steady(v, k) for k in range(law.count())]

    assert math.fsum(law.alpha) == pytest.approx(1.0)
    assert [abs(law.rate(v, memory, k)) for k in range(law.count())] == pytest.approx(
        [0.0] * len(pairs), abs=1e-12
    )
    assert law.friction(v, memory, memory) == pytest.approx(law.sliding_vector(v))
    assert law.within(memory)


def test_shares_are_relative_and_kernels_differ_by_what_sticks():
    double = GeneralisedMaxwellSlip(share=[4, 2, 2], stiffness=[1, 3, 10], **FALLING)

    assert double.alpha == LAW.alpha == (0.5, 0.25, 0.25)
    assert LAW.structure() == ("deflections", "stick", "3 numbers")


@pytest.mark.parametrize(
    ("wrong", "told"),
    [
        ({"share": [1, 2]}, "as many values as share, 2, got 3"),
        ({"mu_static": 0.1}, "must be >= mu_kinetic = 0.25"),
    ],
)
def test_what_makes_no_law_is_refused(wrong, told):
    with pytest.raises(ValueError, match=told):
        GeneralisedMaxwellSlip(**({"share": [1, 1, 1], "stiffness": [1, 3, 10]} | FALLING | wrong))


def test_time_steps_which_remember_no_stick_are_refused():
    found = fl.steady_state(BODY, LAW, "march", tolerance=1e-4)

    assert found.status == "refused"
    assert "march steps follow no stick or slip of single elements; shooting does" in found.reason


@compiling
def test_its_study_keeps_its_promises():
    done = fl.run(Path(__file__).parent / "study.yaml")

    assert [verdict.sentence for verdict in done.verdicts if not verdict.passed] == []
    assert set(done.table["status"]) == {"ok"}
