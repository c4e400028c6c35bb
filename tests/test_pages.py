"""What the pages for beginners show is what happens; the pages of the Python interface have every public name."""

from __future__ import annotations

import re
import runpy
from pathlib import Path
from pkgutil import resolve_name
from typing import Any

import numpy as np
import pytest
from profiles import deep

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


def test_the_python_of_the_first_page_runs() -> None:
    table = _names(_block("start.md", "python"))["table"]

    assert list(table["status"]) == ["ok"] * 120  # type: ignore[index]


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
    shown = set(re.findall(r":: frictionlab\.(\w+)", page)) | set(re.findall(r"`(\w+)`", page))

    assert sorted(set(fl.__all__) - shown) == []


def test_every_entry_of_the_pages_is_in_its_module() -> None:
    pages = "".join(page.read_text() for page in DOCS.glob("*.md"))
    entries = re.findall(r"^\.\. auto\w+:: ([\w.]+)", pages, re.MULTILINE)

    assert entries
    for entry in entries:
        assert resolve_name(entry).__doc__, entry


def test_the_table_of_parts_in_si_units_has_every_number_that_is_theirs() -> None:
    rows = re.findall(r"^\| `([a-z_.]+)` \| (.*) \|$", (DOCS / "api_scenes.md").read_text(), re.MULTILINE)
    parts = {name for name in Dimensional.model_fields if nested(Dimensional, name)}

    assert {name for name, _ in rows} >= parts
    for name, told in rows:
        own, counterpart = (
            record_at(record, tuple(name.split("."))).model_fields for record in (Dimensional, fl.Scene)
        )
        assert set(own) - set(counterpart) <= set(re.findall(r"`(\w+)`", told)) <= set(own)


@deep("reads all studies")
def test_the_gallery_shows_every_study_that_it_speaks_of() -> None:
    gallery = runpy.run_path(str(DOCS / "gallery" / "make.py"))
    shown = gallery["exhibits"]()

    assert (DOCS / "gallery" / "index.md").read_text() == gallery["index"](shown)
    for exhibit in shown:
        page = (DOCS / "gallery" / f"{exhibit.name}.md").read_text()
        assert page == exhibit.page()
        assert (DOCS / "gallery" / "figures" / f"{exhibit.name}.svg").stat().st_size < 250_000
