"""Laws with bristles on their way from a study to the table of curves: stiffness told in three ways, units, ends."""

from __future__ import annotations

import math
import re
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd
import pytest
from fake_methods import Fake
from hypothesis import given, settings
from hypothesis import strategies as st
from numpy.typing import NDArray
from profiles import some
from strategies import BRISTLE_LAWS, sizes

import frictionlab as fl
from frictionlab.charts.curves import family_of
from frictionlab.curves.ends import Shakedown, shakedown_of_body, shakedown_of_slip
from frictionlab.curves.verdict import UnreadableCurve
from frictionlab.laws.compliant import CompliantLaw
from frictionlab.laws.memory import BristleLaw
from frictionlab.runner.curve_table import curve_table
from frictionlab.scene.units import Units
from frictionlab.study import registry
from frictionlab.study.load import parse_study
from frictionlab.study.records import law_record
from frictionlab.theory import friction_free_velocity, mean_soft_elasto_plastic
from frictionlab.values.columns import SCALED, word
from frictionlab.values.notes import StudyError
from frictionlab.values.quantities import dimensions

Floats = NDArray[np.float64]
DOCS = Path(__file__).parents[2] / "docs"

BODY: dict[str, Any] = {
    "damping_ratio": 0.1,
    "normal_load": 10,
    "belt_speed": 5,
    "drive": {"unbalance": 10, "frequency": 2},
}
LAWS: dict[str, dict[str, Any]] = {
    "dahl": {"mu": 0.4},
    "lugre": {"mu_kinetic": 0.3, "mu_static": 0.5, "damping": 0.1},
    "elasto-plastic": {"mu_kinetic": 0.3, "breakaway_ratio": 0.5},
    "dupont": {"mu_kinetic": 0.3},
    "jenkins": {"mu": 0.4},
}
"""One of each registered bristle law, but for its stiffness."""


def study(law: dict[str, Any], scene: dict[str, Any] = BODY, **more: Any) -> dict[str, Any]:
    return {"schema": 1, "scene": scene, "laws": [law], **more}


def mistakes(study: dict[str, Any], *overrides: str) -> list[str]:
    with pytest.raises(StudyError) as caught:
        parse_study(study, overrides)
    return [str(mistake).partition("\n")[0] for mistake in caught.value.mistakes]


def solved(scene: fl.Scene, law: fl.FrictionLaw) -> fl.SteadyState:
    """By a method that asks nothing of a law but its sliding friction."""
    return fl.steady_state(scene, law, method=Fake())


# Stiffness


def test_every_law_with_bristles_that_comes_along_is_tried_here() -> None:
    laws = {name: registry.law_class(name) for name in registry.law_names()}
    ours = {name: law for name, law in laws.items() if law.__module__.startswith("frictionlab.")}
    with_bristles = {name for name, law in ours.items() if issubclass(law, BristleLaw)}

    assert with_bristles == set(LAWS)


def test_a_contact_stiffness_means_another_law_under_every_normal_load() -> None:
    law = {"kind": "lugre", "mu_kinetic": 0.4, "contact_stiffness": 40, "contact_damping": 8}
    cases = parse_study(study(law, sweep={"scene.normal_load": [2, 5], "scene.belt_speed": [1, 2]})).cases()

    assert [case.law.bristle_stiffness for case in cases] == [20, 20, 8, 8]  # type: ignore[attr-defined]
    assert [case.law.bristle_damping for case in cases] == [4, 4, 1.6, 1.6]  # type: ignore[attr-defined]
    assert all(case.given_law.contact_stiffness == 40 for case in cases)  # type: ignore[attr-defined]


@pytest.mark.parametrize("kind", LAWS)
@pytest.mark.parametrize("told", ["stiffness", "presliding_length", "contact_stiffness"])
def test_any_of_the_three_may_be_swept_where_the_file_gives_none(kind: str, told: str) -> None:
    law = {"kind": kind, **LAWS[kind], "planar": "per-axis"}
    read = parse_study(study(law, sweep={f"laws.{kind}.{told}": [0.5, 2]}))
    laws = [case.law for case in read.cases()]

    assert all(isinstance(law, CompliantLaw) for law in laws)
    lengths = [law.presliding() for law in laws]  # type: ignore[attr-defined]
    assert lengths[1] / lengths[0] == pytest.approx(4 if told == "presliding_length" else 0.25)
    assert parse_study(read.resolved()) == read


@pytest.mark.parametrize("kind", LAWS)
def test_a_sweep_of_one_that_the_file_gives_otherwise_is_a_mistake(kind: str) -> None:
    law = {"kind": kind, **LAWS[kind], "stiffness": 40}

    assert mistakes(study(law, sweep={f"laws.{kind}.presliding_length": [1, 2]})) == [
        f"study: sweep.laws.{kind}.presliding_length: the law '{kind}' gives stiffness, so presliding_length "
        "cannot be swept"
    ]


def test_every_wrong_value_of_a_law_is_told_at_once_then_every_rule_that_is_broken() -> None:
    law = {"kind": "elasto-plastic", "mu_kinetic": 0.4, "mu_static": 0.2, "damping": 1, "contact_damping": 1}
    wrong = law | {"breakaway_ratio": 1, "planar": "rotatd"}

    def told(law: dict[str, Any]) -> set[str]:
        return {line.removeprefix("study: laws[0].").partition(":")[0] for line in mistakes(study(law))}

    assert told(wrong) == {"breakaway_ratio", "planar"}
    assert told(law) == {"mu_static", "contact_damping", "stiffness"}


# Units


units = st.builds(Units, sizes(1e-9, 1.0), sizes(1e-6, 1.0), sizes(1e-3, 1e6))


def _body_of(scales: Units) -> dict[str, Any]:
    """A body of these scales, of normal load 10 of them."""
    stiffness = scales.force / scales.length
    return {
        "mass_kg": stiffness * scales.time**2,
        "stiffness_N_per_m": stiffness,
        "damping_N_s_per_m": 0.0,
        "length_m": scales.length,
        "normal_load_N": 10.0 * scales.force,
        "belt_speed_m_per_s": 5.0 * scales.velocity,
        "drive": {"amplitude_N": scales.force, "frequency_rad_per_s": 2.0 / scales.time},
    }


@some(2, "a law each")
@pytest.mark.parametrize("kind", BRISTLE_LAWS)
@given(units, st.data())
@settings(max_examples=15)
def test_a_law_in_si_units_is_the_nondimensional_one(kind: str, scales: Units, data: Any) -> None:
    law = data.draw(BRISTLE_LAWS[kind])
    contact = data.draw(st.booleans())
    plain = law.model_dump(exclude_none=True)
    if contact and "stiffness" in plain:
        plain["contact_stiffness"] = 10.0 * plain.pop("stiffness")
    if contact and "damping" in plain:
        plain["contact_damping"] = 10.0 * plain.pop("damping")
    si = {name: value * scales.of(dimensions(type(law))[name]) for name, value in plain.items()
          if name in dimensions(type(law))}  # fmt: skip
    (case,) = parse_study(study({"kind": kind, **plain, **si}, {"dimensional": _body_of(scales)})).cases()

    assert case.law.numbers() == {
        name: pytest.approx(value, rel=1e-9) for name, value in law.under_load(10.0).numbers().items()
    }


def test_the_table_tells_the_parameters_of_a_contact_in_both_scales() -> None:
    scales = Units(1e-3, 0.05, 0.8)
    law = {"kind": "lugre", "mu_kinetic": 0.3, "contact_stiffness": 4000.0, "contact_damping": 80.0}
    scene = fl.Scene.model_validate({"dimensional": _body_of(scales)})
    made = registry.law_class("lugre").model_validate({k: v for k, v in law.items() if k != "kind"})
    (row,) = fl.curve(scene, made, [1.0], method=Fake()).to_dict("records")

    assert (row["law.contact_stiffness"], row["law.contact_damping"]) == (4000, 80)
    assert row[f"{SCALED}contact_stiffness"] == pytest.approx(4000 / 800)
    assert row[f"{SCALED}contact_damping"] == pytest.approx(80 / (800 * 0.05))


def test_a_swept_stiffness_has_its_unit_where_the_scene_is_in_si_units() -> None:
    law = {"kind": "dahl", "mu": 0.4}
    sweep = {"laws.dahl.presliding_length": [1e-4, 2e-4], "scene.dimensional.belt_speed_m_per_s": [0.1, 0.2]}
    in_si = study(law, {"dimensional": _body_of(Units(1e-3, 0.05, 0.8))}, sweep=sweep, methods=["mdsm"])
    plain = study(law, sweep={"laws.dahl.presliding_length": [1, 2]}, methods=["mdsm"])
    told = [family_of(fl.run(each).table) for each in (in_si, plain)]

    assert told[0] is not None
    assert told[1] is not None
    assert told[0].member is not None
    assert word(told[0].member) == r"presliding length $\delta$ [m]"
    assert [curve.member[1] for curve in told[0].curves if curve.member] == [1e-4, 2e-4]
    assert word(told[1].abscissa) == r"presliding length $\delta$"


# The table


@pytest.mark.parametrize("kind", ["elasto-plastic", "dupont"])
def test_a_row_has_the_name_its_law_was_chosen_by(kind: str) -> None:
    law = {"kind": kind, "mu_kinetic": 0.3, "stiffness": 4}
    table = fl.run(study(law, methods=["mdsm"])).table

    assert table[["law", "kind"]].to_numpy().tolist() == [[kind, kind]]
    assert table["law.breakaway_ratio"].tolist() == [0.7]
    assert table["law.planar"].tolist() == ["vectorial"]


def test_friction_is_told_against_its_own_sliding_friction_and_the_drive() -> None:
    law = fl.LuGre(mu_kinetic=0.3, mu_static=0.5, stribeck_speed=4, viscosity=0.01, stiffness=3)
    steady = 0.3 + 0.2 * math.exp(-((5 / 4) ** 2)) + 0.05
    state = solved(fl.Scene.model_validate(BODY), law)

    assert state.normalized_friction == pytest.approx(state.mean_friction / steady, rel=1e-14)
    assert state.friction_to_drive == pytest.approx(10 * steady / 40, rel=1e-14)


@pytest.mark.parametrize("kind", LAWS)
@pytest.mark.parametrize("told", ["stiffness", "presliding_length", "contact_stiffness"])
def test_the_presliding_ratio_is_the_presliding_length_over_the_vibration(kind: str, told: str) -> None:
    law_class = registry.law_class(kind)
    law = law_class.model_validate(LAWS[kind] | {told: 3.0})
    mu = LAWS[kind].get("mu", LAWS[kind].get("mu_kinetic"))
    length = {"stiffness": mu / 3, "presliding_length": 3, "contact_stiffness": mu / 0.3}[told]
    body = fl.Scene.model_validate(BODY)
    slip = fl.Scene(belt_speed=1, normal_load=10, slip=fl.Slip(velocity_amplitude=7, frequency=2))
    across = fl.Scene(belt_speed=1, transverse_slip=fl.TransverseSlip(velocity_amplitude=7, frequency=2))

    assert solved(body, law).presliding_ratio == pytest.approx(length * 2 / friction_free_velocity(body))
    assert solved(slip, law).presliding_ratio == pytest.approx(length * 2 / 7)
    assert math.isnan(solved(across, law).presliding_ratio)


@pytest.mark.parametrize("scene", [
    BODY,
    BODY | {"transverse": {"natural_frequency": 0.5, "damping_ratio": 0.1, "load": {"unbalance": 10}}},
    {name: value for name, value in BODY.items() if name != "drive"},
    {"belt_speed": 0.5, "slip": {"velocity_amplitude": 1, "frequency": 1}},
    {"belt_speed": 0.5, "transverse_slip": {"velocity_amplitude": 1, "frequency": 1}},
])  # fmt: skip
def test_every_law_and_method_plans_an_answer_or_a_reason(scene: dict[str, Any]) -> None:
    laws = [{"kind": kind, **given, "stiffness": 4} for kind, given in LAWS.items()]
    laws.append({"kind": "dahl", "mu": 0.4, "stiffness": 4, "exponent": 2, "label": "steep"})
    methods = [name for name in registry.method_names() if name not in ("fake", "another")]
    cases = parse_study(study({}, scene, methods=methods) | {"laws": laws}).cases()
    reasons = [case.method.refusal(case.scene, case.law) for case in cases]

    assert all(reason is None or reason.strip() for reason in reasons)


# What is listed and documented


def listed(kind: str) -> dict[str, Any]:
    """A law as ``frictionlab laws`` tells of it."""
    return law_record(kind, registry.law_class(kind))


@pytest.mark.parametrize("kind", LAWS)
def test_the_listing_of_a_law_has_every_parameter_with_limits_unit_and_meaning(kind: str) -> None:
    given = {parameter["name"]: parameter for parameter in listed(kind)["parameters"]}

    assert set(given) == set(registry.law_class(kind).model_fields)
    assert {
        name: given[name]["unit"] for name in ("stiffness", "presliding_length", "contact_stiffness")
    } == {
        "stiffness": "1/m",
        "presliding_length": "m",
        "contact_stiffness": "N/m",
    }
    assert given["planar"]["limits"] == "vectorial | per-axis"
    assert all(parameter["limits"] and parameter["meaning"] for parameter in given.values())
    assert {"passive", "rate_independent"} <= set(listed(kind)["declares"])


def test_the_nomenclature_has_every_parameter_of_every_law_with_its_unit() -> None:
    section = (DOCS / "nomenclature.md").read_text().partition("## Laws")[2].partition("\n##")[0]
    rows = re.findall(r"^\| `law\.(\w+)` \|(?: [^|]*\|){3} ([^|]*) \|", section, re.MULTILINE)
    kinds = [*LAWS, "coulomb", "stribeck"]
    parameters = {p["name"]: p["unit"] or "-" for kind in kinds for p in listed(kind)["parameters"]}

    assert dict(rows) == parameters
    assert len(rows) == len(parameters)


@pytest.mark.parametrize("kind", ["dahl", "lugre", "jenkins"])
def test_the_study_reference_names_the_parameters_and_defaults_of_a_law(kind: str) -> None:
    (line,) = re.findall(rf"^\| `{kind}` \| (.*) \|$", (DOCS / "study.md").read_text(), re.MULTILINE)
    told = dict(re.findall(r"([a-z_]+)(?: \(([^)]*)\))?(?:,|;|$)", line.partition("; a stiffness")[0]))
    own = {p["name"]: p for p in listed(kind)["parameters"]}
    shared = {"stiffness", "presliding_length", "contact_stiffness", "damping", "contact_damping", "planar"}

    assert set(told) == set(own) - shared
    assert all(float(text) == own[name]["default"] for name, text in told.items() if text and "=" not in text)


# Where a curve begins and ends


def creeping(law: Any, along: float, across: float, mean: complex) -> float:
    """Mean friction on a belt of 1e-4 presliding lengths per period, 200 periods after deflection ``mean``."""
    steps, length = 60, law.presliding()
    angle = np.linspace(0.0, 2.0 * np.pi, steps, endpoint=False) + np.pi / steps
    shaken = along * np.cos(angle) + 1j * across * np.cos(angle)
    moved = (shaken + 1e-4 * length / (2.0 * np.pi)) * (2.0 * np.pi / steps)
    path: list[Any] = moved.tolist() if across else moved.real.tolist()
    z: Any = mean if across else mean.real
    total = 0.0
    for period in range(200):
        for step in path:
            z = z + law.rate(step, z)
            total += law.friction(0.0, z, 0.0).real if period == 199 else 0.0
    return total / steps


HELD = [("elasto-plastic", 0.5), ("jenkins", 1.0)]
VIBRATIONS = [(0.2, 0.0), (0.45, 0.0), (0.0, 0.3), (0.6, 0.0), (0.0, 0.6)]


@pytest.mark.parametrize(
    ("kind", "elastic", "along", "across"),
    [(*held, *vibration) for held in HELD for vibration in VIBRATIONS] + [("dahl", 1.0, 0.3, 0.0)],
)
def test_bristles_that_do_not_drift_hold_what_the_vibration_leaves(
    kind: str, elastic: float, along: float, across: float
) -> None:
    own = {"exponent": 0} if kind == "dahl" else {}
    law = registry.law_class(kind).model_validate(LAWS[kind] | own | {"presliding_length": 1.0})
    slip = {"scene.slip.velocity_amplitude": 2 * along, "scene.slip.frequency": 2.0}
    other = {"scene.transverse_slip.velocity_amplitude": 2 * across, "scene.transverse_slip.frequency": 2.0}
    assert isinstance(law, BristleLaw)
    limit = shakedown_of_slip(law, lambda name: (slip if along else other).get(name, 0.0)).friction()
    mu = law.sliding_friction(0.0)
    left = max(elastic - along, 0.0) if along else math.sqrt(max(elastic**2 - across**2, 0.0))

    assert limit == pytest.approx(mu * left, abs=1e-12)
    # bristles that begin to drift gently let a creeping belt pull a little farther
    assert creeping(law, along, across, complex(left)) == pytest.approx(limit, abs=0.03 * mu)


def test_the_bristles_of_a_body_hold_what_its_load_leaves_as_a_stiff_contact_holds_coulomb_friction() -> None:
    scene = {"scene.damping_ratio": 0.1, "scene.normal_load": 10.0, "scene.drive.frequency": 0.5}
    law = fl.Jenkins(mu=0.4, stiffness=1e7)
    hold = shakedown_of_body(law, lambda name: scene.get(name, 0.0), 2.5 + 0j, 0j)

    assert hold.friction() == pytest.approx(0.4 * (1 - 2.5 / 4), rel=1e-6)


def test_a_soft_contact_adds_to_the_spring_and_the_dashpot_of_a_body() -> None:
    scene = {"scene.damping_ratio": 0.1, "scene.normal_load": 10.0, "scene.drive.frequency": 3.0}
    law = fl.ElastoPlastic(mu_kinetic=0.4, stiffness=0.02, damping=0.03, viscosity=0.01, breakaway_ratio=0.5)
    hold = shakedown_of_body(law, lambda name: scene.get(name, 0.0), 9j, 0j)

    assert hold.along == pytest.approx(9j / (1 + 0.2 - 9 + 3j * (0.2 + 0.3 + 0.1)))
    assert hold.friction() == pytest.approx(0.02 * (10.0 - abs(hold.along)))


@pytest.mark.parametrize(("along", "across"), [(0.0, 0.0), (0.3, 0.3j)])
def test_a_hold_that_is_not_known_says_so(along: complex, across: complex) -> None:
    with pytest.raises(UnreadableCurve, match="known"):
        Shakedown(1.0, along, across, 1.0, "vectorial").friction()


SHARES = np.arange(0.02, 1.1, 0.02)
"""Belt speeds over V_lin."""


def rows_of(law: dict[str, Any], speed: Floats, mean: Floats, **scene: float) -> pd.DataFrame:
    """Rows of a curve in a scene of these values, as a run would tell them."""
    told = {f"scene.{path}": value for path, value in scene.items()}
    told |= {f"law.{name}": value for name, value in law.items() if name != "kind"}
    told |= {"law": "one", "method": "auto", "kind": law["kind"], "status": "ok", "error": 1e-6}
    told |= {"stick_fraction": 0.0, "reversals": np.nan, "friction_to_drive": np.nan}
    rows = pd.DataFrame({"scene.belt_speed": speed, "mean_friction": mean, "velocity_ratio": SHARES})
    return rows.assign(**told, normalized_friction=mean / mean[-1], velocity_amplitude=speed[0] / SHARES[0])


def curve_of(law: dict[str, Any], mean: Callable[[float], float]) -> Any:
    """What the table of curves tells of a mean friction over belt speeds; slip of amplitude 1, frequency 1."""
    slip = {"normal_load": 1.0, "slip.velocity_amplitude": 1.0, "slip.frequency": 1.0}
    return curve_table(rows_of(law, SHARES, np.array([mean(share) for share in SHARES]), **slip)).iloc[0]


def mean_dahl(presliding: float) -> Callable[[float], float]:
    """Under a sine along the belt, by the exact path update."""
    law = fl.Dahl(mu=0.4, presliding_length=presliding)
    angle = (np.arange(400) + 0.5) * (2.0 * np.pi / 400)

    def mean(ratio: float) -> float:
        path = ((ratio + np.cos(angle)) * (2.0 * np.pi / 400)).tolist()

        def after(z: float) -> tuple[float, float]:
            total = 0.0
            for step in path:
                middle = law.deflected(z, 0.5 * step)
                total, z = total + law.friction(0.0, middle, 0.0), law.deflected(z, step)
            return z, total / 400

        at_0, at_1 = after(0.0)[0], after(presliding)[0]
        return after(at_0 / (1.0 - (at_1 - at_0) / presliding))[1]  # the period map is affine

    return mean


@some(1, "whole curves")
@pytest.mark.parametrize(
    ("presliding", "area", "verdict"),
    [(0.1, -0.193, "convex"), (1.0, 0.141, "concave"), (3.0, 0.239, "concave")],
)
def test_a_dahl_curve_starts_at_zero_ends_at_v_lin_and_turns_concave_as_it_softens(
    presliding: float, area: float, verdict: str
) -> None:
    """Areas of an independent computation, to three digits."""
    row = curve_of({"kind": "dahl", "mu": 0.4, "presliding_length": presliding}, mean_dahl(presliding))

    assert row["reversal_end"] == pytest.approx(1.0, rel=1e-12)
    assert row["shape_area"] == pytest.approx(area, abs=2e-3)
    assert row["shape"] == verdict


def test_a_soft_elasto_plastic_curve_starts_where_its_bristles_hold() -> None:
    law = {"kind": "elasto-plastic", "mu_kinetic": 0.4, "presliding_length": 1e4, "breakaway_ratio": 0.7}
    row = curve_of(law, lambda ratio: 0.4 * float(mean_soft_elasto_plastic(min(ratio, 1.0), 0.7)))
    share = np.linspace(0.0, 1.0, 20001)[1:]
    rise = (mean_soft_elasto_plastic(share, 0.7) - 0.7) / 0.3

    assert row["shape_area"] == pytest.approx(2 * np.mean(rise - share), abs=0.02)
    assert row["shape"] == "concave"


def rows_of_a_body(first: float, law: dict[str, Any]) -> pd.DataFrame:
    """A curve from ``first`` up to mu, of a body that a load below friction shakes (f = 4, P = 2.5)."""
    mean = np.minimum(0.4, first + (0.4 - first) * (SHARES - SHARES[0]))
    body = {"normal_load": 10.0, "damping_ratio": 0.1, "drive.amplitude": 2.5, "drive.frequency": 0.5}
    return rows_of(law, SHARES * 2.0, mean, **body).assign(
        reversals=2.0, normalized_friction=mean / 0.4, friction_to_drive=4 / 2.5
    )


def test_a_body_that_its_bristles_may_hold_is_believed_to_be_held_where_its_friction_says_so() -> None:
    law = {"kind": "jenkins", "mu": 0.4, "contact_stiffness": 1e6}
    held, loose = (curve_table(rows_of_a_body(first, law)).iloc[0] for first in (0.151, 0.02))

    assert held["shape_area"] == pytest.approx(0.0, abs=0.02)
    assert held["shape_area_error"] < 0.05
    assert "the curve would then start at 0.15" in loose["reason"]
    assert np.isnan(loose["shape_area"])


def test_dahl_bristles_hold_no_body_however_strong_friction_is() -> None:
    law = {"kind": "dahl", "mu": 0.4, "stiffness": 1e5, "exponent": 1.0}
    row = curve_table(rows_of_a_body(0.05, law)).iloc[0]

    assert row["reversal_end"] == pytest.approx(2.0)
    assert np.isfinite(row["shape_area"])


def test_what_bristles_hold_is_read_in_the_scale_of_the_scene() -> None:
    scales = Units(1e-3, 0.05, 0.8)
    body = _body_of(scales) | {"drive": {"amplitude_N": 2.5 * scales.force, "frequency_rad_per_s": 10.0}}
    in_si = fl.Scene.model_validate({"dimensional": body})
    plain = fl.Scene(
        damping_ratio=0, normal_load=10, belt_speed=1, drive=fl.Drive(amplitude=2.5, frequency=0.5)
    )
    speed = np.linspace(0.02, 12, 60)
    stiffness = 4 * scales.force / scales.length
    curves = [
        fl.curve(plain, fl.Jenkins(mu=0.4, contact_stiffness=4), speed, method=Fake()),
        fl.curve(
            in_si, fl.Jenkins(mu=0.4, contact_stiffness=stiffness), speed * scales.velocity, method=Fake()
        ),
    ]
    start = 0.4 * (1 - 2.5 / (1 + 4 - 0.25))

    for curve in curves:
        assert f"the curve would then start at {start:.6g}" in curve_table(curve)["reason"].iloc[0]
