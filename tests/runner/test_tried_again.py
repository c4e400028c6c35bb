"""Which points of an earlier run are tried again: what failed may succeed with other code, a defect is no answer."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import pytest
from fake_methods import Trouble, breaks_down, faked, is_wrong
from profiles import deep

import frictionlab as fl
from frictionlab.runner import store as code_digest
from frictionlab.study import registry

pytestmark = [deep("seconds of runs"), pytest.mark.usefixtures("fakes")]
STUDY = faked([4, 9])


def test_what_failed_is_tried_again_by_other_code_alone(
    trouble: Trouble, tmp_path: Path, monkeypatch: Any
) -> None:
    trouble({4.0: breaks_down})
    fl.run(STUDY, out=tmp_path / "run")
    again = fl.run(STUDY, out=tmp_path / "run")

    assert again.computed == 0
    assert again.table["reason"].tolist()[0] == "ZeroDivisionError: float division by zero"
    monkeypatch.setattr(code_digest, "own_code", lambda: "mended")
    trouble({})
    again = fl.run(STUDY, out=tmp_path / "run")

    assert (again.computed, again.table["status"].tolist()) == (2, ["ok", "ok"])
    assert fl.run(STUDY, out=tmp_path / "run").computed == 0


def test_a_point_that_failed_by_an_internal_error_is_never_taken_over(
    trouble: Trouble, tmp_path: Path
) -> None:
    trouble({4.0: is_wrong})
    first = fl.run(STUDY, out=tmp_path / "run")
    trouble({})
    again = fl.run(STUDY, out=tmp_path / "run")

    assert first.table["reason"].str.startswith("internal error: ").all()
    assert (again.computed, again.table["status"].tolist()) == (2, ["ok", "ok"])


def test_the_code_of_a_run_holds_that_of_frictionlab_and_of_methods_of_others(monkeypatch: Any) -> None:
    study = fl.run(STUDY).study
    before = code_digest.code_digest(study)
    assert code_digest.code_digest(study) == before
    monkeypatch.setattr(registry, "method_code", lambda name: "edited")
    edited = code_digest.code_digest(study)
    monkeypatch.setattr(code_digest, "own_code", lambda: "edited")

    assert len({before, edited, code_digest.code_digest(study)}) == 3
