"""The page of a folder of bench results, what stands on it, and what is told while it is measured."""

from __future__ import annotations

import json
import re
from pathlib import Path

import pytest
from bench_lists import loaded, texts
from matplotlib.lines import Line2D
from pages import Page
from profiles import deep

from frictionlab import bench, cli
from frictionlab.bench import page as pages
from frictionlab.bench.page import MOST_ROWS_ON_PAGE, bench_page, circumstances, print_below, small_print
from frictionlab.bench.peers import base
from frictionlab.charts.sheet import blank_figure
from frictionlab.methods.reduced import common

LIST = """\
schema: 1
title: A page
repeats: 2
seconds: 0.05
scenes:
  - name: W1
    title: at <resonance>
    scene: &line {damping_ratio: 0.1, normal_load: 10, drive: {unbalance: 10, frequency: 1}}
    laws: [{kind: coulomb, mu: 0.4, label: dry}, {kind: coulomb, mu: 0.3, label: half dry}]
    sweep: {scene.belt_speed: [10, 20, 60]}
    references: [{kind: exact, tolerance: 1.0e-12}]
    methods: [{kind: shooting, tolerance: [1.0e-3, 1.0e-6]}, mdsm, harmonic_balance]
    peers: [{kind: heyoka, tolerance: 1.0e-6}]
failures:
  - name: load
    scene: *line
    laws: [{kind: coulomb, mu: 0.4}]
    sweep: {scene.belt_speed: [10, 60], scene.normal_load: [1, 10, 100]}
    references: [{kind: exact, tolerance: 1.0e-12}]
    methods: [mdsm]
    peers: [{kind: heyoka, tolerance: 1.0e-6}]
"""
CURVES = LIST.partition("failures:")[0]


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The results of a list of two curves and a section, on a machine without heyoka."""
    home = tmp_path_factory.mktemp("bench")
    (home / "list.yaml").write_text(LIST)
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(base, "find_spec", lambda name: None)
        assert cli.main(["bench", str(home / "list.yaml"), "-o", str(home / "out")]) == 0
    return home / "out"


@pytest.fixture(scope="module")
def page(folder: Path) -> Page:
    return Page((folder / "index.html").read_text())


def table_of(page: Page, caption: str) -> tuple[list[str], list[list[str]]]:
    """The heads and rows of the table whose caption begins so."""
    (table,) = [
        table
        for table in page.all("table")
        if next(each for each in table.inside if each.tag == "caption").text.startswith(caption)
    ]
    rows = [
        [cell.text for cell in row.inside] for part in table.inside for row in part.inside if row.tag == "tr"
    ]
    return rows[0], rows[1:]


@deep("seconds of charts")
def test_the_page_holds_every_table_and_every_chart(folder: Path, page: Page) -> None:
    for file in folder.glob("*.csv"):
        _, rows = table_of(page, file.stem)
        assert len(rows) == len(texts(file)) <= MOST_ROWS_ON_PAGE
        assert any(link.attributes.get("href") == file.name for link in page.all("a"))
    pictures = page.all("img")
    assert len(pictures) == len(list(folder.glob("*.svg"))) == 3
    assert all(picture.attributes["src"].startswith("data:image/") for picture in pictures)
    assert all(picture.attributes["alt"] for picture in pictures)


@deep("seconds of charts")
def test_the_page_is_sound_and_needs_nothing_else(page: Page) -> None:
    assert page.wrong == []
    assert not {element.tag for element in page.elements} & {"script", "link", "iframe"}
    assert any(element.attributes.get("name") == "viewport" for element in page.all("meta"))
    assert "at <resonance>" in "".join(heading.text for heading in page.all("h2"))


def test_the_page_begins_with_what_is_fastest_and_folds_the_numbers(page: Page) -> None:
    head, rows = table_of(page, "The fastest")
    _, told = table_of(page, "W1_dry")
    near = [row for row in told if float(row[3]) <= 1e-6]

    assert page.all("table")[0].inside[0].text.startswith("The fastest")
    assert head[:3] == ["curve", "to 1e-03", "to 1e-06"]
    assert [row[0] for row in rows] == ["W1 dry", "W1 half dry"]
    assert rows[0][2].endswith(f"by {near[0][0]}")
    folded = [table for fold in page.all("details") for table in fold.inside]
    assert len(page.all("table")) == 1 + len(
        [each for each in folded if "scroll" in each.attributes.get("class", "")]
    )


PRICES = "model alone, μs", "its error alone, μs", "mean and error, μs"


def test_mean_and_median_error_and_both_prices_of_a_model_are_columns(page: Page) -> None:
    head, rows = table_of(page, "W1_dry")

    assert {"largest error", "median error", *PRICES} <= set(head)
    by_solver = {row[0]: dict(zip(head, row, strict=True)) for row in rows}
    assert by_solver["shooting"]["model alone, μs"] == ""
    for model in ("mdsm", "harmonic_balance"):
        told = {key: float(cell.replace(",", "")) for key, cell in by_solver[model].items() if key in PRICES}
        assert told["model alone, μs"] > 0.0
        both = told["model alone, μs"] + told["its error alone, μs"]
        assert both == pytest.approx(told["mean and error, μs"], rel=0.01)


def test_finding_its_error_is_what_a_reduced_model_is_slow_for(monkeypatch: pytest.MonkeyPatch) -> None:
    def full_answer(*given: object) -> object:
        raise AssertionError("the model alone asks for no full answer")

    monkeypatch.setattr(common, "full_means", full_answer)
    from frictionlab import Coulomb, Drive, Scene
    from frictionlab.methods.reduced.mdsm import Mdsm

    scene = Scene(damping_ratio=0.1, normal_load=10, belt_speed=10, drive=Drive(unbalance=10, frequency=1))
    Mdsm().model_means([scene], Coulomb(mu=0.4))


def test_machine_date_and_versions_are_on_the_page_and_in_every_chart(folder: Path, page: Page) -> None:
    told = circumstances()
    small = small_print(told)

    assert told["date"] in small
    assert f"numba {told['packages']['numba']}" in small
    for name in ("numpy", "numba", "scipy"):
        assert [name, told["packages"][name]] in table_of(page, "Machine")[1]
    assert "".join(item.text for item in page.all("p")).count(small) == 3  # a part each
    for file in folder.glob("*.svg"):
        lines = re.findall("<text[^>]*>([^<]*)</text>", file.read_text())
        assert small in " ".join(lines)


def test_peers_that_are_not_installed_are_one_line_of_the_page(folder: Path, page: Page) -> None:
    (line,) = (each.text for each in page.all("p") if "heyoka" in each.text and "left out" in each.text)

    assert "pip install frictionlab[peers]" in line
    tables = [table for table in page.all("table") if "Machine" not in table.text]
    assert tables
    assert not any("heyoka" in element.text for element in [*tables, *page.all("pre"), *page.all("h2")])
    assert not list(folder.glob("*heyoka*"))


def test_files_have_no_spaces(folder: Path) -> None:
    assert {"W1_dry.csv", "W1_half_dry.csv", "W1_half_dry.svg"} <= {path.name for path in folder.iterdir()}
    assert not [path for path in folder.iterdir() if " " in path.name]


@deep("seconds of charts")
def test_what_was_measured_before_stays_on_the_page(tmp_path: Path) -> None:
    (tmp_path / "list.yaml").write_text(CURVES.replace("[{kind: shooting", "[exact, {kind: shooting"))
    for name in ("W1 half dry", "W1 dry"):
        command = ["bench", str(tmp_path / "list.yaml"), "-o", str(tmp_path / "out"), "--only", name]
        assert cli.main(command) == 0

    found = Page((tmp_path / "out" / "index.html").read_text())
    assert [heading.text.partition(":")[0] for heading in found.all("h2")] == [
        "W1 half dry", "W1 dry", "Machine and versions",
    ]  # fmt: skip


def test_of_a_long_table_the_first_rows_are_shown_and_the_file_is_named(folder: Path, tmp_path: Path) -> None:
    parts = pages.read_account(folder)
    head, *_ = (folder / "failures_mdsm.csv").read_text().splitlines()
    rows = [f"load,scene.normal_load,{i},1,1,ok,,,,,," for i in range(MOST_ROWS_ON_PAGE + 1)]
    (tmp_path / "failures_mdsm.csv").write_text("\n".join([head, *rows]))

    long = Page(bench_page(tmp_path, {"failures_mdsm": parts["failures_mdsm"]}))

    _, shown = table_of(long, "failures_mdsm.csv: the first 20 of 201 rows")
    assert len(shown) == 20
    assert long.all("details")


def test_a_page_that_a_person_wrote_is_not_overwritten(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    (tmp_path / "list.yaml").write_text(LIST)
    (tmp_path / "index.html").write_text("mine")

    assert cli.main(["bench", str(tmp_path / "list.yaml"), "-o", str(tmp_path)]) == 2

    assert "index.html is there already" in capsys.readouterr().err
    assert (tmp_path / "index.html").read_text() == "mine"
    assert not list(tmp_path.glob("*.csv"))


# --- what is told ------------------------------------------------------------------------------------------------


@deep("seconds of a bench")
def test_every_setting_is_told_with_its_place(tmp_path: Path) -> None:
    text, lines = CURVES.replace("mdsm, ", "").replace("heyoka", "scipy"), list[str]()
    (found,) = bench.measure(loaded(text, tmp_path).only(["W1 dry"]), lines.append)

    assert [re.sub(r" \(.*", "", line) for line in lines] == [
        "W1 dry: references", "W1 dry: shooting, tolerance 0.001", "W1 dry: shooting, tolerance 1e-06",
        "W1 dry: harmonic_balance, as is", "W1 dry: scipy, as is",
    ]  # fmt: skip
    assert [line.rpartition("(")[2] for line in lines] == [f"{n} of 5)" for n in range(1, 6)]
    (name,) = pages.write_table(found, tmp_path)
    text = (tmp_path / name).with_suffix(".md").read_text()
    assert "| model alone, μs | its error alone, μs |" in text
    assert json.loads(json.dumps(pages.entry_of(found, [], []))).keys() == pages.ENTRY_KEYS


@pytest.mark.parametrize("width", [3.0, 6.9])
def test_small_print_lies_below_the_legend_and_within_the_figure(width: float) -> None:
    figure = blank_figure(width, 3.0)
    line = Line2D([], [], label="a peer")
    figure.add_subplot().set_xlabel("time")
    legend = figure.legend(handles=[line, line, line], loc="outside lower center")
    print_below(figure, small_print(circumstances()))
    figure.canvas.draw()
    text = figure.texts[0].get_window_extent()

    assert text.y1 < legend.get_window_extent().y0
    assert text.x0 > 0.0
    assert figure.axes[0].xaxis.label.get_window_extent().y0 > legend.get_window_extent().y1
