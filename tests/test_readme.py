"""What the README shows is what happens."""

from __future__ import annotations

import re
import shlex
import subprocess
from fnmatch import fnmatchcase
from functools import cache
from pathlib import Path

import pytest

import frictionlab as fl
from frictionlab.charts.figures import FIGURES
from frictionlab.scene.dimensional import Dimensional
from frictionlab.scene.scene import Scene
from frictionlab.study.load import load_study
from frictionlab.values.columns import CURVES, ONSETS, RESULTS, SI
from frictionlab.values.validation import number_paths, value_paths

PROJECT = Path(__file__).parent.parent
README = (PROJECT / "README.md").read_text()
DOCUMENTS = [PROJECT / "README.md", PROJECT / "CONTRIBUTING.md", *sorted((PROJECT / "docs").rglob("*.md"))]


def _block(name: str) -> str:
    """The one fenced block below the comment of this name."""
    (block,) = re.findall(rf"<!-- {name} -->\n```\w+\n(.*?)```", README, re.DOTALL)
    return str(block)


def test_the_study_runs_and_shows_what_the_title_claims(tmp_path: Path) -> None:
    study = tmp_path / "study.yaml"
    study.write_text(_block("study"))

    done = fl.run(study)

    assert list(done.table["status"]) == ["ok"] * 240
    steady, closed = (
        done.table[done.table["method"] == method]["mean_friction"].to_numpy() for method in ("auto", "mdsm")
    )
    # the caption of the figure: at resonance up to 0.09 too low
    assert (steady - closed).max() == pytest.approx(0.09, abs=5e-3)


def test_the_study_is_about_ten_lines() -> None:
    assert _block("study").count("\n") <= 11


def test_the_python_call_gives_the_number_of_the_reference(capsys: pytest.CaptureFixture[str]) -> None:
    names: dict[str, object] = {}
    exec(_block("python"), names)

    state, table = names["state"], names["table"]
    assert isinstance(state, fl.SteadyState)
    assert state.mean_friction == pytest.approx(0.0505839238363, abs=1e-8)  # reference/sdof_fig4b, v_b = 5
    assert "+-" in capsys.readouterr().out
    assert list(table["status"]) == ["ok"] * 120  # type: ignore[index]


def test_each_command_is_one_line_that_starts_from_nothing() -> None:
    for name in ("run", "test"):
        (line,) = _block(name).splitlines()
        assert line.startswith("python3 -m venv .venv && .venv/bin/pip install ")


def test_the_main_command_runs_a_study_that_exists() -> None:
    command, run, study = shlex.split(_block("run").rpartition("&&")[2])

    assert (command, run) == (".venv/bin/frictionlab", "run")
    assert (PROJECT / study).is_file()
    assert f"`runs/{Path(study).stem}`" in README


def test_the_checks_run_the_test_command_of_the_readme_word_for_word() -> None:
    script = (PROJECT / ".ci" / "run").read_text()
    (reading,) = [line for line in script.splitlines() if line.startswith("test_command=")]

    shown = subprocess.run(
        ["bash", "-c", f'set -euo pipefail; {reading}; echo "$test_command"'],
        cwd=PROJECT,
        capture_output=True,
        text=True,
        check=True,
    )

    assert shown.stdout == _block("test")
    assert 'eval "$test_command"' in script.splitlines()


def test_the_checks_can_be_run() -> None:
    assert (PROJECT / ".ci" / "run").stat().st_mode & 0o111


@cache
def _headings(document: Path) -> set[str]:
    """Names by which code hosts find the headings of a document."""
    words = re.findall(
        r"^#+ (.*)",
        re.sub(r"^```.*?^```", "", document.read_text(), flags=re.MULTILINE | re.DOTALL),
        re.MULTILINE,
    )
    return {re.sub(r"[^\w\- ]", "", each.lower()).replace(" ", "-") for each in words}


@pytest.mark.parametrize("document", DOCUMENTS, ids=lambda path: path.relative_to(PROJECT).as_posix())
def test_every_link_and_picture_of_a_document_leads_to_a_file_and_a_heading(document: Path) -> None:
    outside_code = re.sub(r"^```.*?^```|`[^`\n]*`", "", document.read_text(), flags=re.MULTILINE | re.DOTALL)
    local = [
        found for found in re.findall(r"\]\(([^)#]*)(?:#([^)]*))?\)", outside_code) if "//" not in found[0]
    ]
    targets = [((document.parent / file).resolve() if file else document, heading) for file, heading in local]

    assert [file for file, _ in targets if not file.is_file()] == []
    assert [(file.name, name) for file, name in targets if name and name not in _headings(file)] == []


def test_the_readme_shows_a_picture() -> None:
    (picture,) = re.findall(r"!\[.+\]\((.+)\)", README)

    assert (PROJECT / picture).read_text().lstrip().startswith("<?xml")


REFERENCE = (PROJECT / "docs" / "study.md").read_text()


def test_the_example_of_the_study_reference_is_a_study(tmp_path: Path) -> None:
    example, in_si = re.findall(r"```yaml\n(.*?)```", REFERENCE, re.DOTALL)[:2]
    study, other = tmp_path / "study.yaml", tmp_path / "in_si.yaml"
    study.write_text(example)
    other.write_text(f"schema: 1\nlaws: [{{kind: coulomb, mu: 0.3}}]\n{in_si}")

    assert len(load_study(study).cases()) == 8
    assert {case.scene.degrees_of_freedom for case in load_study(other).cases()} == {2}


RESULTS_PAGE = (PROJECT / "docs" / "results.md").read_text()


def test_the_page_on_results_lists_the_columns_of_the_tables_in_their_order() -> None:
    rows = RESULTS_PAGE.partition("| column |")[2].partition("## Orbits")[0]
    measures = [name for name in CURVES if not name.endswith("_error")]
    first_cells = [line.split("|")[1] for line in rows.splitlines()[2:] if line.startswith("|")]

    assert [name for cell in first_cells for name in re.findall(r"`(\w+)`", cell)] == [
        *RESULTS,
        *SI,
        *measures,
        *ONSETS,
    ]


NOMENCLATURE = (PROJECT / "docs" / "nomenclature.md").read_text()
KEYS = re.findall(r"`([\w.*]+)`", NOMENCLATURE)
VALUES = [f"scene.{path}" for path in value_paths(Scene) if not path.startswith("dimensional.")]
VALUES += number_paths(Dimensional)


@pytest.mark.parametrize("key", VALUES)
def test_the_nomenclature_has_every_number_of_a_scene(key: str) -> None:
    assert any(fnmatchcase(key, listed) for listed in KEYS)


def test_every_column_of_a_figure_is_in_the_nomenclature_or_on_the_page_on_results() -> None:
    for column in (column for columns in FIGURES.values() for column in columns):
        assert f"`{column.removeprefix('transverse_')}`" in NOMENCLATURE + RESULTS_PAGE
