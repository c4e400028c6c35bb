"""Every study keeps its promises: each is run as a user runs it, and each of its expectations must hold."""

from __future__ import annotations

from pathlib import Path

import pytest

import frictionlab as fl
from frictionlab.study import load_study

STUDIES = sorted((Path(__file__).parent.parent / "studies").glob("*.yaml"))


def test_there_are_studies() -> None:
    assert STUDIES


@pytest.mark.parametrize("study", STUDIES, ids=lambda path: path.stem)
def test_everything_a_study_expects_holds(study: Path) -> None:
    done = fl.run(study)

    assert done.verdicts
    assert [verdict.sentence for verdict in done.verdicts if not verdict.passed] == []
    expected = {expectation.status for expectation in done.study.expect if expectation.status}
    assert set(done.table["status"]) <= {"ok"} | expected
    assert done.table.loc[done.table["status"] != "ok", "reason"].notna().all()


@pytest.mark.parametrize("study", STUDIES, ids=lambda path: path.stem)
def test_a_study_says_where_it_comes_from_and_why_it_expects_what_it_expects(study: Path) -> None:
    plan = load_study(study)

    assert plan.title
    assert plan.source
    assert all(expectation.because for expectation in plan.expect)
