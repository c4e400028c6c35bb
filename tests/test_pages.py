"""What the pages for beginners show is what happens; the pages of the Python interface have every public name."""

from __future__ import annotations

import builtins
import json
import re
import runpy
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import frictionlab as fl
from frictionlab import tools
from frictionlab.runner.summary import summary
from frictionlab.scene.dimensional import Dimensional
from frictionlab.study.load import load_study
from frictionlab.values.validation import nested, record_at

DOCS = Path(__file__).parent.parent / "docs"


def _block(page: str, name: str) -> str:
    """The one fenced block below the comment of this name."""
    (block,) = re.findall(rf"<!-- {name} -->\n```\w+\n(.*?)```", (DOCS / page).read_text(), re.DOTALL)
    return str(block)


def _names(block: str) -> dict[str, object]:
    names: dict[str, object] = {}
    exec(block, names)
    return names


def test_the_study_of_the_first_page_keeps_its_promise(tmp_path: Path) -> None:
    study = tmp_path / "soft.yaml"
    study.write_text(_block("start.md", "study"))

    done = fl.run(study)

    assert [verdict.passed for verdict in done.verdicts] == [True]
    softer, rigid = (
        done.table[done.table["law"] == law]["mean_friction"].to_numpy() for law in ("soft Dahl", "coulomb")
    )
    assert np.all(softer[:45] > rigid[:45])  # the title; from V_lin = 22.6 mm/s on both are mu
    assert [*softer[45:], *rigid[45:]] == pytest.approx([0.4] * 10)


def test_the_study_in_si_units_of_the_first_page_is_one(tmp_path: Path) -> None:
    study = tmp_path / "si.yaml"
    study.write_text(_block("start.md", "si"))

    done = fl.run(load_study(study))

    printed, shown = (  # whatever the errors are
        {re.sub(r"\d\.\de[-+]\d\d", "", line) for line in lines}
        for lines in (summary(done).splitlines()[1:8], (DOCS / "start.md").read_text().splitlines())
    )
    assert printed - {""} <= shown
    assert done.table["error"].max() <= done.study.tolerance
    at = np.abs(done.table["scene.dimensional.belt_speed_m_per_s"] - 1e-3) < 1e-4
    fast = done.table[at & (done.table["scene.belt_vibration.frequency"] > 0.4)]
    assert fast["mean_friction"].tolist() == pytest.approx([0.149, 0.180], abs=2e-3)  # half, and 0.18


def test_the_notebook_of_the_first_page_runs() -> None:
    cells = json.loads((DOCS / "start.ipynb").read_text())["cells"]
    names: dict[str, Any] = {}
    for cell in cells:
        if cell["cell_type"] == "code":
            exec("".join(cell["source"]), names)

    assert [cell["cell_type"] for cell in cells[:7]] == [*["markdown", "code"] * 3, "markdown"]
    assert list(names["table"]["status"]) == ["ok"] * 120
    assert set(names["found"].table["law"]) == {"coulomb", "dahl"}


def test_the_programs_of_the_page_on_solvers_run_and_the_mean_is_proved() -> None:
    # what the other solver finds is chaos, another one with every rounding: no number of it is asked for
    state = _names(_block("stability.md", "exact"))["state"]
    means = np.array(_names(_block("stability.md", "solver"))["means"])

    assert isinstance(state, fl.SteadyState)
    assert state.mean_friction == pytest.approx(0.02557230631053, abs=1e-13)
    assert state.unique == "proved"
    assert means.shape == (5,)
    assert np.isfinite(means).all()


def test_the_method_of_the_page_for_authors_answers_as_it_says() -> None:
    rounded: Any = _names(_block("api.md", "method"))["Rounded"]
    scene = fl.Scene(
        damping_ratio=0.1, normal_load=10, belt_speed=5, drive=fl.Drive(unbalance=10, frequency=1)
    )

    state = fl.steady_state(scene, fl.Coulomb(mu=0.4), method=rounded())

    assert (state.status, state.mean_friction) == ("ok", 0.0506)
    assert float(state.reason.partition(" ")[0]) == pytest.approx(state.mean_friction, abs=state.error)


def test_the_page_for_authors_tells_every_tool() -> None:
    page = (DOCS / "api.md").read_text().partition("### Kernels and bodies")[2]

    assert sorted(set(tools.__all__) - set(re.findall(r"`(\w+)`", page))) == []
    assert [name for name in tools.__all__ if getattr(tools, name).__doc__ is None] == []


def test_the_pages_of_the_python_interface_have_every_public_name() -> None:
    page = "".join((DOCS / f"{name}.md").read_text() for name in ("api", "api_scenes", "write_a_law"))
    shown = set(re.findall(r"<!-- frictionlab\.(\w+)", page)) | set(re.findall(r"`(\w+)`", page))

    assert sorted(set(fl.__all__) - shown) == []


def test_the_pages_have_entries_and_files_as_they_are() -> None:
    made = runpy.run_path(str(DOCS / "make.py"))["pages"]()

    behind = [page.relative_to(DOCS).as_posix() for page, text in made.items() if page.read_text() != text]
    assert behind == [], "run: python docs/make.py"


def test_an_entry_has_signature_parameters_and_examples_and_no_markup_but_markdown() -> None:
    entries = re.findall(
        r"^<!-- frictionlab\..*?<!-- end -->", (DOCS / "api.md").read_text(), re.MULTILINE | re.DOTALL
    )

    told = next(entry for entry in entries if "### fl.curve\n" in entry)
    assert '\nfl.curve(scene, law, belt_speed, method="auto", tolerance=1e-08,' in told
    assert "- `scene` ([Scene](api_scenes.md#scene)): Body and belt, and what shakes them.\n" in told
    assert '>>> table["mean_friction"].round(4).tolist()\n[0.0506, 0.2178, 0.3613]\n' in told
    assert not any("``" in re.sub("```", "", entry) or ":class:" in entry for entry in entries)


def test_no_page_has_what_only_the_site_shows() -> None:
    for page in [*DOCS.glob("*.md"), *DOCS.glob("theory/*.md"), *DOCS.glob("gallery/*.md")]:
        assert (
            re.findall(r"^```\{.*|^\(.*\)=$|^\{\..*\}$|\{\w+\}`.*?`", page.read_text(), re.MULTILINE) == []
        ), page.name


def test_what_is_raised_has_a_reason_and_a_row_in_the_table() -> None:
    pages = [(DOCS / f"{name}.md").read_text() for name in ("api", "api_scenes")]
    listed = set(re.findall(r"`(\w+)`", pages[0].partition("## What is raised")[2]))
    lists = re.findall(r"^\*\*Raises\*\*\n\n((?:- .*\n)+)", "".join(pages), re.MULTILINE)
    errors = re.findall(r"^- `(\w+)`: (\w.*)", "".join(lists), re.MULTILINE)

    assert len(errors) == "".join(lists).count("\n") > 0
    assert {error for error, _ in errors} - listed - set(vars(builtins)) == set()


def test_the_table_of_parts_in_si_units_has_every_number_that_is_theirs() -> None:
    rows = re.findall(r"^\| `([a-z_.]+)` \| (.*) \|$", (DOCS / "api_scenes.md").read_text(), re.MULTILINE)
    parts = {name for name in Dimensional.model_fields if nested(Dimensional, name)}

    assert {name for name, _ in rows} >= parts
    for name, told in rows:
        own, counterpart = (
            record_at(record, tuple(name.split("."))).model_fields for record in (Dimensional, fl.Scene)
        )
        assert set(own) - set(counterpart) <= set(re.findall(r"`(\w+)`", told)) <= set(own)


def test_pictures_of_the_gallery_are_small() -> None:
    pictures = [*(DOCS / "gallery" / "figures").glob("*.svg")]

    assert {picture.stem for picture in pictures} == {
        page.stem for page in (DOCS / "gallery").glob("*.md")
    } - {"index"}
    assert [picture.name for picture in pictures if picture.stat().st_size > 250_000] == []
