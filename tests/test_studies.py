"""Every study keeps its promises: each is run as a user runs it, and each of its expectations must hold."""

from __future__ import annotations

import re
from pathlib import Path

import pytest
from profiles import DEEP, deep

import frictionlab as fl
from frictionlab.laws.memory import BristleLaw
from frictionlab.runner.plan import plan
from frictionlab.study import load_study

PROJECT = Path(__file__).parent.parent
SI = sorted((PROJECT / "studies" / "si").glob("*.yaml"))
"""Written in units, as from the table of a paper."""
STUDIES = sorted(path for path in (PROJECT / "studies").rglob("*.yaml") if path.parent.name != "measured")


SLOW = (
    "not_unique_stribeck",
    "bifurcation_stribeck",
    "prescribed_curve_shapes_lugre",
    "popov_contact_stiffness",
    "stick_slip_smoothed_friction",
    "fig2_weak_friction_off_resonance",
    "fig9_transverse_at_resonance",
    "fig3_weak_friction_resonance",
    "fig7a_harmonic_balance_resonance",
    "fig7b_harmonic_balance_off_resonance",
    "popov_normal_phase",
    "prescribed_curve_shapes_dahl",
    "prescribed_elastic_range",
    "prescribed_force_sign_dahl",
    "prescribed_longitudinal_softness",
    "prescribed_shape_measures_dahl",
    "teidelt_compliant_pin",
)
"""Studies with kernels that no other test needs, or of many steps."""


def is_for_the_deep_profile(study: Path) -> bool:
    """Whether a study puts a free body on bristles, or a slip across the belt: such kernels take long to compile."""
    if study.stem in SLOW or study in SI:
        return True
    plan = load_study(study)
    long = any(
        along.scene.degrees_of_freedom > 0 or along.scene.transverse_slip is not None
        for along, _ in plan.scenes_along
    )
    bristles = any(isinstance(law, BristleLaw) for choice in plan.laws for law in plan.laws_in_scenes(choice))
    return long and bristles


@deep("reads all studies")
def test_a_study_has_a_short_name_its_claim_in_the_title_its_source_and_why_it_expects_what() -> None:
    assert STUDIES
    for study in STUDIES:
        plan = load_study(study)
        assert re.fullmatch(r"[a-z][a-z0-9_]{1,39}", study.stem)
        assert " " in plan.title
        assert len(plan.title) <= 76, f"{study}: its title takes more than one line of a figure 175 mm wide"
        assert plan.source, study
        assert all(expectation.because for expectation in plan.expect), study


def test_every_study_in_units_is_planned_with_a_method() -> None:
    for study in SI:
        assert not any(planned.refused for planned in plan(load_study(study)))


@pytest.mark.parametrize("study", STUDIES, ids=lambda path: path.stem)
def test_everything_a_study_expects_holds(study: Path) -> None:
    if not DEEP and is_for_the_deep_profile(study):
        pytest.skip("bodies on bristles, slip across the belt and slow kernels are in the deep profile")
    done = fl.run(study)

    assert done.verdicts
    assert [verdict.sentence for verdict in done.verdicts if not verdict.passed] == []
    expected = {expectation.status for expectation in done.study.expect if expectation.status}
    assert set(done.table["status"]) <= {"ok"} | expected
    assert done.table.loc[done.table["status"] != "ok", "reason"].notna().all()
