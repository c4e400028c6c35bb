"""The plugins of this project: complete folders, which install, run and are missed when they are gone."""

from __future__ import annotations

import subprocess
import sys
import tomllib
from pathlib import Path

import pytest
from profiles import deep

from frictionlab.study.load import load_study

PROJECT = Path(__file__).parent.parent
FOLDERS = sorted(path.parent for path in PROJECT.glob("plugins/*/pyproject.toml"))
every_folder = pytest.mark.parametrize("folder", FOLDERS, ids=lambda folder: folder.name)


def _project(folder: Path) -> dict[str, str]:
    return dict(tomllib.loads((folder / "pyproject.toml").read_text())["project"])


def _brought(folder: Path, what: str) -> set[str]:
    """Names of the laws or methods of a plugin."""
    return set(_project(folder)["entry-points"].get(f"frictionlab.{what}", {}))  # type: ignore[attr-defined]


def test_there_are_plugins() -> None:
    assert FOLDERS


@every_folder
def test_a_folder_holds_a_law_or_method_a_study_that_runs_it_and_is_told_of(folder: Path) -> None:
    plan, laws, methods = (
        load_study(folder / "study.yaml"),
        _brought(folder, "laws"),
        _brought(folder, "methods"),
    )

    assert laws | methods
    assert {law.kind for law in plan.laws} >= laws
    assert {method.name for method in plan.methods} >= methods
    assert plan.title
    assert plan.source
    assert plan.expect
    assert all(expectation.because for expectation in plan.expect)
    assert all(f"kind: {name}" in (folder / "README.md").read_text() for name in laws | methods)
    page = PROJECT / "docs" / ("write_a_law.md" if laws else "api.md")
    assert f"[{folder.name}](../plugins/{folder.name}/" in page.read_text()


@deep("making an environment")
def test_in_a_fresh_environment_a_plugin_is_listed_and_run_and_missed_when_it_is_gone(tmp_path: Path) -> None:
    subprocess.run([sys.executable, "-m", "venv", tmp_path / "venv"], check=True)
    python, frictionlab = tmp_path / "venv" / "bin" / "python", tmp_path / "venv" / "bin" / "frictionlab"

    def pip(*arguments: str | Path) -> None:
        subprocess.run([python, "-m", "pip", "--quiet", *arguments], check=True)

    def said(*arguments: str | Path) -> subprocess.CompletedProcess[str]:
        return subprocess.run([frictionlab, *arguments], cwd=tmp_path, capture_output=True, text=True)

    pip("install", PROJECT, *FOLDERS)
    listed, schema = said("laws").stdout + said("methods").stdout, said("schema").stdout
    for folder in FOLDERS:
        done = said("run", folder / "study.yaml", "-o", folder.name)
        assert done.returncode == 0, done.stderr
        names = _brought(folder, "laws") | _brought(folder, "methods")
        assert all(name in listed and f'"{name}"' in schema for name in names)

    pip("uninstall", "--yes", *(_project(folder)["name"] for folder in FOLDERS))
    for folder in FOLDERS:
        done = said("run", folder / "study.yaml", "-o", "again")
        assert done.returncode == 2
        assert all(f"unknown law '{name}'" in done.stderr for name in _brought(folder, "laws"))
        assert all(f"unknown method '{name}'" in done.stderr for name in _brought(folder, "methods"))
        assert "install the package that provides it" in done.stderr
