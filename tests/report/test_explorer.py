"""The explorer's page: one file that needs nothing else, the table of a run in it, and the page in a browser."""

from __future__ import annotations

import json
import re
import shutil
import subprocess
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd
import pytest
from fig_4b import COULOMB, over_speeds
from pages import Page, complaints

import frictionlab as fl
from frictionlab import cli
from frictionlab.charts.curves import CurveData, family_of
from frictionlab.report.explorer import explorer, label, page_scene, run_data
from frictionlab.runner.files import FolderError
from frictionlab.theory.linear import friction_free_velocity

BROWSERS = map(shutil.which, ("chromium", "chromium-browser", "google-chrome"))
CHROMIUM = next(filter(None, BROWSERS), None)
WITHOUT = "chromium is not installed: the explorer is not opened in a browser"
OWN = {"<script>"}
"""What the page has and a report may not."""
STUDY = over_speeds({"start": 5, "stop": 55, "num": 11}, methods=["exact", "mdsm"])
STUDY["laws"] = [COULOMB, {"kind": "coulomb", "mu": 0.3, "label": "other"}]
STUDY["sweep"] |= {"scene.drive.frequency": [1, 2], "laws.other.mu": [0.2, 0.3]}
STUDY["title"] = "Two laws </script> & more"


@pytest.fixture(scope="module")
def saved(tmp_path_factory: pytest.TempPathFactory) -> fl.Run:
    return fl.run(STUDY, out=tmp_path_factory.mktemp("explored") / "run")


def data_of(text: str) -> Any:
    (held,) = re.findall(r'<script type="application/json" id="run-data">(.*?)</script>', text)
    return json.loads(held)


def with_table(saved: fl.Run, table: pd.DataFrame) -> fl.Run:
    """The run with another table."""
    return replace(saved, readers={"table": lambda: table})


def test_the_page_needs_nothing_else_and_is_light(saved: fl.Run) -> None:
    for text in (explorer(), explorer(saved)):
        assert set(complaints(text)) == OWN
        assert not re.search(r"https?://(?!www\.w3\.org/2000/svg)", text)
        assert "{{" not in text
    assert len(explorer().encode()) < 400_000 / 4


def test_every_slider_has_words(saved: fl.Run) -> None:
    page = Page(explorer(saved))
    named = {element.attributes["for"] for element in page.all("label")}

    for element in page.all("input"):
        assert element.attributes["id"] in named or element.attributes["aria-label"]
    assert len(page.all("input")) == 8


def test_a_run_is_embedded_whole(saved: fl.Run) -> None:
    data = data_of(explorer(saved))

    assert [quantity["values"] for quantity in data["swept"]] == [[1.0, 2.0], [0.2, 0.3]]
    assert data["abscissa"]["label"] == "Belt speed v_{b}"
    assert [len(curve["x"]) for curve in data["curves"]] == [len(curve["mean"]) for curve in data["curves"]]
    means = [mean for curve in data["curves"] for mean in curve["mean"]]
    assert len(means) == len(saved.table)
    assert sorted(mean for mean in means if mean is not None) == sorted(saved.table["mean_friction"].dropna())
    assert [quantity["label"] for quantity in data["swept"]][1] == "Friction coefficient \u03bc of other"
    assert {curve["law"]: curve["at"][1] for curve in data["curves"]}["coulomb"] is None


def test_what_has_no_number_is_empty_and_has_no_look(saved: fl.Run) -> None:
    table = saved.table.copy()
    table.loc[table["law"] == "other", ["mean_friction", "error"]] = np.nan
    data = run_data(with_table(saved, table))

    looks = {(curve["law"], curve["method"]): curve["look"] for curve in data["curves"]}
    assert [looks["coulomb", "exact"], looks["coulomb", "mdsm"]] == [0, 1]
    assert looks["other", "exact"] is None
    assert all(mean is None for curve in data["curves"] if curve["law"] == "other" for mean in curve["mean"])


def curve_of(saved: fl.Run, **changed: Any) -> CurveData:
    """The first curve of the run with columns changed, or left out where they are None."""
    family = family_of(saved.table)
    assert family is not None
    gone = [name for name in changed if changed[name] is None]
    return replace(family.curves[0], rows=family.curves[0].rows.assign(**changed).drop(columns=gone))


def test_the_solver_of_the_page_takes_the_scenes_that_are_its_own(saved: fl.Run) -> None:
    speed = "scene.belt_speed"

    assert page_scene(curve_of(saved), speed) == pytest.approx((1.0, 0.1, 0.4, 0.4, 50.0), rel=1e-14)
    for changed in (
        {"scene.damping_ratio": 0.0},
        {"scene.drive.waveform": "square"},
        {"scene.transverse.natural_frequency": 1.0, "scene.transverse.damping_ratio": 0.1},
        {"normalized_friction": np.linspace(0.3, 0.4, 11)},
        {"velocity_ratio": None},
    ):
        assert page_scene(curve_of(saved, **changed), speed) is None
    assert page_scene(curve_of(saved), "scene.drive.frequency") is None


def test_the_sliders_begin_at_the_scene_of_the_run(saved: fl.Run) -> None:
    start = {"frequency": 1.0, "damping": 0.1, "friction": 0.4, "belt": 0.6}

    assert run_data(saved)["start"] == start
    undamped = saved.table.assign(**{"scene.damping_ratio": 0.0})
    assert run_data(with_table(saved, undamped))["start"] is None


def test_labels_are_words_with_marked_subscripts() -> None:
    assert label("scene.drive.frequency") == "Drive frequency \u03a9"
    assert label("scene.dimensional.belt_speed_m_per_s") == "Belt speed V_{b} [m/s]"


def test_the_command_writes_the_page_and_says_where(
    saved: fl.Run, tmp_path: Path, monkeypatch: Any, capsys: Any
) -> None:
    monkeypatch.chdir(tmp_path)

    assert cli.main(["explore"]) == 0
    assert cli.main(["explore", str(saved.folder), "-o", "mine.html"]) == 0
    assert capsys.readouterr().out == "explorer.html\nmine.html\n"
    assert 'id="run-data"' not in Path("explorer.html").read_text(encoding="utf-8")
    assert "Two laws &lt;/script&gt; &amp; more" in Path("mine.html").read_text(encoding="utf-8")


def test_a_page_of_somebody_else_is_not_replaced(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    page = tmp_path / "mine.html"
    page.write_text("<h1>Mine</h1>")

    assert cli.main(["explore", "-o", str(page)]) == 2
    assert "was not written by frictionlab" in capsys.readouterr().err
    assert page.read_text() == "<h1>Mine</h1>"


def test_a_run_without_a_sweep_is_refused_with_the_reason(saved: fl.Run) -> None:
    with pytest.raises(FolderError, match="sweeps no number"):
        explorer(with_table(saved, saved.table.iloc[:1]))


DRIVER = """<!DOCTYPE html><body><pre id="told"></pre><script>
const told = { errors: [], states: [], widths: {} }, frames = {};
function move(page, id, value) {
  const slider = page.getElementById(id);
  slider.value = value;
  slider.dispatchEvent(new Event("input", { bubbles: true }));
}
function read(page) {
  const text = (id) => page.getElementById(id).textContent.replace("\\u2212", "-");
  const rows = [...page.querySelectorAll("#run-values tbody tr")]
    .map((row) => [...row.cells].map((cell) => cell.textContent));
  const chosen = {};
  for (const name of ["frequency", "damping", "friction", "belt"])
    chosen[name] = Number(page.getElementById(name + "-number").value);
  return {
    chosen, rows, verdict: text("verdict"), point: text("point"),
    mean: Number(text("number-mean")), stick: Number(text("number-stick").replace(" %", "")),
    work: Number(text("number-work")),
    solved: page.querySelectorAll("#run-curves path[stroke-width='7']").length,
    line: page.querySelector("#curve path[stroke-width='2.5']").getAttribute("d"),
  };
}
function drag(page, id, share) {
  const svg = page.getElementById(id), box = svg.getBoundingClientRect(), { left, right } = { left: 58, right: 14 };
  const at = { clientX: box.left + left + share * (box.width - left - right), bubbles: true };
  for (const kind of ["pointerdown", "pointerup"]) svg.dispatchEvent(new PointerEvent(kind, at));
}
function drive(frame) {
  const page = frame.contentDocument;
  frame.contentWindow.addEventListener("error", (event) => told.errors.push(event.message));
  told.states.push(read(page));
  move(page, "frequency", Math.log(2));
  told.states.push(read(page));
  move(page, "run-0", 1);
  move(page, "run-along", 3);
  told.driven = read(page).chosen;
  move(page, "friction", 0.9);
  move(page, "belt", 0.25);
  told.states.push(read(page));
  move(page, "damping-number", 0.123);
  told.states.push(read(page));
  move(page, "belt-number", 0);
  move(page, "friction", 1.2);
  told.states.push(read(page));
  drag(page, "curve", 0.5);
  told.dragged = read(page).chosen.belt;
  drag(page, "run-curves", 1);
  told.last = page.querySelector("#run-values caption").textContent;
  told.address = frame.contentWindow.location.hash;
}
function opened(width) {
  const frame = document.createElement("iframe");
  frame.style = `width:${width}px;height:900px`;
  frame.onload = () => {
    const root = frame.contentDocument.documentElement;
    told.widths[width] = [root.clientWidth, root.scrollWidth];
    if (width === 1280) drive(frame);
    document.getElementById("told").textContent = JSON.stringify(told);
  };
  frame.src = "explorer.html";
  document.body.append(frame);
}
opened(1280);
opened(390);
</script></body>"""


@pytest.fixture(scope="module")
def opened(saved: fl.Run, tmp_path_factory: pytest.TempPathFactory) -> Any:
    """What the page shows in a browser, before and after its sliders are moved."""
    if CHROMIUM is None:
        pytest.skip(WITHOUT)
    folder = tmp_path_factory.mktemp("browser")
    (folder / "explorer.html").write_text(explorer(saved), encoding="utf-8")
    (folder / "driver.html").write_text(DRIVER, encoding="utf-8")
    command = [CHROMIUM, "--headless", "--no-sandbox", "--disable-gpu", "--allow-file-access-from-files"]
    command += [f"--user-data-dir={folder}/profile", "--enable-logging=stderr", "--virtual-time-budget=5000"]
    command += ["--dump-dom", (folder / "driver.html").as_uri()]
    done = subprocess.run(command, capture_output=True, text=True, timeout=120)
    assert "CONSOLE" not in done.stderr
    (told,) = re.findall(r'<pre id="told">(.*?)</pre>', done.stdout, re.DOTALL)
    return json.loads(told.replace("&lt;", "<").replace("&gt;", ">").replace("&amp;", "&"))


def exact_state(chosen: dict[str, float]) -> fl.SteadyState:
    body = {"damping_ratio": chosen["damping"], "normal_load": chosen["friction"], "belt_speed": 1.0}
    scene = fl.Scene(**body, drive=fl.Drive(amplitude=1.0, frequency=chosen["frequency"]))
    speed = chosen["belt"] * friction_free_velocity(scene)
    return fl.steady_state(scene.with_(belt_speed=speed), fl.Coulomb(mu=1.0), method="exact")


def test_moving_a_slider_changes_the_numbers_to_those_of_exact(opened: Any) -> None:
    assert opened["errors"] == []
    first, faster, third, fourth, _ = opened["states"]
    assert first["chosen"] == {"frequency": 1, "damping": 0.1, "friction": 0.4, "belt": 0.6}
    assert faster["chosen"]["frequency"] == 2
    assert third["chosen"] == {"frequency": 2, "damping": 0.1, "friction": 0.9, "belt": 0.25}
    assert fourth["chosen"]["damping"] == 0.123
    for state in (first, faster, third, fourth):
        wanted = exact_state(state["chosen"])
        assert state["mean"] == pytest.approx(wanted.mean_friction, abs=5.1e-7)
        assert state["stick"] == pytest.approx(100.0 * wanted.stick_fraction, abs=0.051)
        assert state["work"] == pytest.approx(wanted.energy_friction, rel=2e-3)
    assert len({state["line"] for state in (first, faster, third, fourth)}) == 4
    assert len({state["mean"] for state in (first, faster, third, fourth)}) == 4


def test_the_sliders_of_the_run_move_those_of_the_solver(opened: Any, saved: fl.Run) -> None:
    rows = saved.table[saved.table["scene.drive.frequency"] == 2.0]
    here = rows[rows["scene.belt_speed"] == np.unique(rows["scene.belt_speed"])[3]]

    assert (opened["driven"]["frequency"], opened["driven"]["friction"]) == (2, 0.1)
    assert opened["driven"]["belt"] == pytest.approx(here["velocity_ratio"].iloc[0], rel=1e-5)


def test_a_drag_across_a_chart_chooses_and_the_address_keeps_it(opened: Any) -> None:
    assert opened["dragged"] == pytest.approx(0.6, abs=0.01)
    assert opened["last"].endswith("= 55")
    assert {"run-along=10", "friction=1.2"} <= {*opened["address"].lstrip("#").split("&")}


def test_where_friction_holds_the_body_on_a_belt_at_rest_the_page_says_so(opened: Any) -> None:
    held = opened["states"][-1]

    assert held["chosen"]["belt"] == 0
    assert "depends on where it starts, between" in held["point"]
    assert "0.167" in held["point"]


def test_the_sentence_names_the_shape(opened: Any) -> None:
    told = "Up to Vlin the curve is concave by area: it lies above its chord"
    assert opened["states"][0]["verdict"].startswith(told)


def test_the_table_of_the_run_follows_its_sliders(opened: Any, saved: fl.Run) -> None:
    before, after = opened["states"][0]["rows"], opened["states"][2]["rows"]
    speeds = np.unique(saved.table["scene.belt_speed"])

    for rows, frequency, speed in ((before, 1.0, speeds[5]), (after, 2.0, speeds[3])):
        table = saved.table
        here = table[(table["scene.drive.frequency"] == frequency) & (table["scene.belt_speed"] == speed)]
        wanted = []
        for _, row in here[(here["law"] == "coulomb") | (here["law.mu"] == 0.2)].iterrows():
            told = f"{row['mean_friction']:.6f}"
            wanted.append([row["law"], row["method"], told])
            if row["method"] == "exact":
                wanted.append([f"Coulomb, \u03bc = {row['law.mu']}", "solved on this page", told])
        assert sorted(row[:3] for row in rows) == sorted(wanted)
    assert [state["solved"] for state in opened["states"]] == [2] * 5


def test_nothing_is_wider_than_the_screen(opened: Any) -> None:
    assert set(opened["widths"]) == {"1280", "390"}
    for inner, whole in opened["widths"].values():
        assert whole <= inner
