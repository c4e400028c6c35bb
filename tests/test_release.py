"""The command of a release tells what is missing, wrong or not at hand; the whole of it runs by hand."""

from __future__ import annotations

from pathlib import Path
from types import SimpleNamespace
from typing import Any

import deep
import pytest
import release
from distributions import listed, package_files, wrong_in_wheel
from interpreters import interpreter


def test_a_wheel_is_held_against_the_source_file_by_file(tmp_path: Path) -> None:
    package = tmp_path / "frictionlab"
    (package / "__pycache__").mkdir(parents=True)
    for name in ("page.js", "py.typed", "law.py", "__pycache__/law.pyc"):
        (package / name).write_text(name)
    files = package_files(package)
    whole = {**files, "frictionlab-1.dist-info/METADATA": b""}

    assert sorted(files) == ["frictionlab/law.py", "frictionlab/page.js", "frictionlab/py.typed"]
    assert listed(["a/law.py", "a/page.js", "a/b/law.py"]) == "2 .py, 1 .js"
    assert wrong_in_wheel(whole, files) == []
    assert wrong_in_wheel({**whole, "tests/test_laws.py": b""}, files) == ["wheel: holds tests/test_laws.py"]
    assert wrong_in_wheel({**whole, "frictionlab/law.py": b"old"}, files) == [
        "wheel: frictionlab/law.py is not that of the source"
    ]
    del whole["frictionlab/page.js"]
    assert wrong_in_wheel(whole, files) == ["wheel: no frictionlab/page.js"]


def test_ten_parts_of_the_same_seconds_hold_every_test_once(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(deep, "seconds_in", lambda table: {"a.py": 1.0, "b.py": 9.0})
    tests: list[Any] = [
        SimpleNamespace(nodeid=f"{file}::{k}") for file in ("a.py", "b.py") for k in range(50)
    ]

    cut = deep.parts(tests)

    assert [test for part in cut for test in part] == tests
    assert [len(part) for part in cut] == [50, *[6, 5] * 4, 6]


def test_every_dependency_has_a_lowest_version_to_try() -> None:
    lowest = release.lowest()

    assert all(one.count("==") == 1 and ">" not in one for one in lowest)
    assert len(lowest) >= len(release.project()["dependencies"])
    assert any(one.startswith("python-flint==") for one in lowest)  # of a plugin


def test_the_versions_tried_are_those_the_package_names_and_the_next() -> None:
    named = [
        line.rpartition(" ")[2]
        for line in release.project()["classifiers"]
        if line.startswith("Programming Language :: Python :: 3.")
    ]

    assert list(release.VERSIONS)[: len(named)] == named
    assert release.project()["requires-python"] == f">={named[0]}"


def test_a_python_that_is_not_at_hand_is_skipped_with_that_sentence(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    assert interpreter("3.99") is None

    monkeypatch.setattr(release, "interpreter", lambda version: None)
    tried = release._tried("3.14", tmp_path, release.Built(tmp_path, None, None, ""), release.TESTS)
    assert (tried.passed, tried.outcome) == (True, "skipped: no Python 3.14 on this machine")


def test_an_environment_that_fails_is_told_with_what_it_printed(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    def fail(*_: object) -> str:
        raise release.Failed("pip install: exit code 1\nno such package")

    monkeypatch.setattr(release, "Environment", lambda folder, python: None)
    monkeypatch.setattr(release, "_steps", fail)
    tried = release._tried("3.11", tmp_path, release.Built(tmp_path, None, None, ""), ())

    assert (tried.passed, tried.outcome) == (False, "failed: pip install: exit code 1")
    assert "no such package" in capsys.readouterr().out


def test_what_is_tested_of_a_release_exists() -> None:
    assert [name for name in (*release.TESTS, release.STUDY) if not (release.PROJECT / name).exists()] == []
