"""Every study keeps its promises: each is run as a user runs it, and each of its expectations must hold."""

from __future__ import annotations

import re
from pathlib import Path

import pytest
from profiles import deep

import frictionlab as fl
from frictionlab.runner.batch import plan
from frictionlab.study.load import load_study

PROJECT = Path(__file__).parent.parent
SI = sorted((PROJECT / "studies" / "si").glob("*.yaml"))
"""Written in units, as from the table of a paper."""
STUDIES = sorted(path for path in (PROJECT / "studies").rglob("*.yaml") if path.parent.name != "measured")


BY_DEFAULT = [
    "application_slip_joint",
    "application_ultrasonic_contact",
    "closed_form_below_resonance",
    "damping_at_resonance",
    "den_hartog",
    "fig10_phases_at_twice_the_resonance",
    "fig11_phases_at_resonance",
    "fig4_strong_friction",
    "fig5_vibration_amplitude",
    "fig6_energy",
    "fig8a_longitudinal_load",
    "fig8a_transverse_resonance",
    "fig8b_transverse_resonance",
    "frequency_map",
    "internal_resonance",
    "michaux_waveforms",
    "plate_under_slider",
    "prescribed_no_reversal_lugre",
    "rival_bodies",
    "rival_materials",
    "stick_slip_two_levels",
    "storck_along_and_across",
    "thomsen_fidlin",
    "thomsen_smoothing",
]
"""Studies whose kernels other tests need, too, and that take no seconds."""
EVERY = [
    pytest.param(study, marks=() if study.stem in BY_DEFAULT else deep("seconds, or kernels of its own"))
    for study in STUDIES
]


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


@pytest.mark.parametrize("study", EVERY, ids=lambda path: path.stem)
def test_everything_a_study_expects_holds(study: Path) -> None:
    done = fl.run(study)

    assert done.verdicts
    assert [verdict.sentence for verdict in done.verdicts if not verdict.passed] == []
    expected = {expectation.status for expectation in done.study.expect if expectation.status}
    assert set(done.table["status"]) <= {"ok"} | expected
    assert done.table.loc[done.table["status"] != "ok", "reason"].notna().all()
