# ruff: noqa: RUF001
# Pages have Greek letters, minus and multiplication signs, as here.
"""The report of a run: everything is on the page, nothing on it runs, and nothing is fetched for it."""

from __future__ import annotations

import json
import re
import shutil
from collections.abc import Callable
from functools import partial
from pathlib import Path
from typing import Any

import pandas as pd
import pytest
from fake_methods import Fake, breaks_down, faked, register
from fig_4b import COULOMB
from markupsafe import Markup
from pages import Page, complaints
from profiles import deep, some
from run_folders import interrupted_after_one_piece, without_stamps

import frictionlab as fl
from frictionlab.cli.scaffold import new_study
from frictionlab.report import tables
from frictionlab.report.facts import Facts
from frictionlab.report.figures import pictures
from frictionlab.report.page import report, wall, write_index, write_report
from frictionlab.report.sources import bibtex, sources
from frictionlab.report.tables import html, symbol_html
from frictionlab.runner.files import FolderError
from frictionlab.study.bibliography import read_bibtex
from frictionlab.values.columns import _IN_SI, _NAMES

PLAIN = faked([4.0, 13.0, -2.0, 9.0, 3.0, 5.0])
SLIP = {"velocity_amplitude": 1, "frequency": 1}
HOSTILE = "<script>alert(1)</script></title></style> & \"quotes\" 'and' {{ 7 * 7 }} $\\mu$"
SVG = '<svg xmlns="http://www.w3.org/2000/svg"/>'


@pytest.fixture(autouse=True)
def _with_a_method_that_does_as_told(monkeypatch: pytest.MonkeyPatch) -> None:
    register(monkeypatch, fake=Fake)


Runner = Callable[..., fl.Run]


@pytest.fixture
def ran(tmp_path: Path) -> Runner:
    """Runs a study, with pictures of nothing in place of figures."""

    def run(name: str = "run", **changes: Any) -> fl.Run:
        done = fl.run(PLAIN | changes, out=tmp_path / name)
        (tmp_path / name / "figures").mkdir()
        for figure in ("mean_friction", "velocity", "energies"):
            (tmp_path / name / "figures" / f"{figure}.svg").write_text(SVG)
        return done

    return run


def page_of(saved: fl.Run) -> Page:
    return Page(report(saved))


def at_speeds(*speeds: float) -> dict[str, Any]:
    """The sweep of a study."""
    return {"sweep": {"scene.belt_speed": list(speeds)}}


ODD_STUDIES: dict[str, dict[str, Any]] = {
    "markup everywhere": {
        "title": HOSTILE,
        "source": HOSTILE,
        "laws": [COULOMB | {"label": label} for label in (HOSTILE, "_{^")],
        "methods": [{"kind": "fake", "label": HOSTILE}],
        "expect": [{"column": "mean_friction", "below": 1, "because": HOSTILE}],
    },
    "other scripts": {"title": "Ωμέγα, трение, 摩擦 🙂", "laws": [COULOMB | {"label": "µ 摩"}]},
    "forty curves": {"sweep": {"scene.drive.frequency": [*range(1, 41)], "scene.belt_speed": [1.0, 2.0]}},
    "no point that is ok": at_speeds(13.0),
    "one point": {"sweep": {}},
    "prescribed slip": {"scene": {"belt_speed": 0.5, "slip": SLIP}},
    "panels": {
        "sweep": {f"scene.{name}": [1.0, 2.0] for name in ("normal_load", "damping_ratio", "belt_speed")}
    },
}


@some(2, "a page each")
@pytest.mark.parametrize("name", ODD_STUDIES)
def test_a_page_is_sound_html_that_needs_nothing_else_and_can_be_heard(name: str, ran: Runner) -> None:
    assert complaints(report(ran(**ODD_STUDIES[name]))) == []


def test_the_reader_of_pages_sees_what_is_wrong_with_one() -> None:
    bad = (
        '<html><body><h1>A</h1><h3 onclick="x">B</h3><img src="http://x/y.png"><script>1</script><b>'
        '<a href="#no">c</a></i><table><tr><th>d</th></tr></table><i id="e"></i><i id="e"></i>'
        "<style>p { background: url(x) }</style></body></html>"
    )

    found = " ".join(complaints(bad))

    for complaint in ("no language", "level 3", "onclick", "<script>", "http://x", "without words", "url("):
        assert complaint in found
    for complaint in ("closes", "stays open", "nowhere: #no", "without scope", "without caption", "twice: e"):
        assert complaint in found


@deep("seconds of reports")
def test_text_of_a_study_is_text_on_the_page(ran: Runner) -> None:
    page = page_of(ran(**ODD_STUDIES["markup everywhere"]))

    assert page.title == page.all("title")[0].text == HOSTILE
    assert {row[0] for row in page.table("The friction laws")[1:]} == {HOSTILE, "_{^"}
    assert HOSTILE in page.table("What the study expects")[1][1]
    assert HOSTILE in [each.text for each in page.all("dd")]
    assert HOSTILE in page.all("figcaption")[0].text
    assert HOSTILE in page.all("img")[0].attributes["alt"]


def test_the_page_forbids_a_browser_to_run_or_fetch_anything(ran: Runner) -> None:
    told = [each.attributes for each in page_of(ran()).all("meta") if "http-equiv" in each.attributes]
    allowed = "default-src 'none'; img-src data:; style-src 'unsafe-inline'"

    assert told == [{"http-equiv": "Content-Security-Policy", "content": allowed}]


def test_what_was_asked_is_there_in_words_symbols_and_numbers(ran: Runner) -> None:
    laws = [{"kind": "coulomb", "mu": mu, "label": label} for mu, label in ((0.4, "a.b"), (0.2, "slippery"))]
    sweep = {"scene.belt_speed": {"start": 0.5, "stop": 10, "num": 20}, "laws.a.b.mu": [0.1, 0.3]}
    page = page_of(ran(laws=laws, sweep=sweep, tolerance=1e-6, keep={"orbit": 20}))

    scene = {row[0]: row[1:] for row in page.table("The scene")}
    assert scene["normal load"] == ["γ2", "10"]
    assert scene["drive frequency"] == ["Ω", "1"]
    assert scene["belt speed"] == ["vb", "swept"]
    assert [row[-1] for row in page.table("The friction laws")[1:]] == ["μ = swept", "μ = 0.2"]
    assert page.table("The sweep")[1:] == [
        ["belt speed vb", "scene.belt_speed", "0.5 … 10, 20 values in steps of 0.5"],
        ["friction coefficient μ of a.b", "laws.a.b.mu", "0.1, 0.3"],
    ]
    words = " ".join(page.all("main")[0].text.split())
    assert "one degree of freedom, on a moving belt. The load along the belt varies as a sine." in words
    assert "the study asks for an error of at most 1e-06." in words
    assert "Of every steady state 20 samples are kept" in words


@deep("seconds of reports")
def test_there_is_a_line_for_every_curve_and_what_tells_it_apart(ran: Runner) -> None:
    sweep = {"scene.drive.frequency": [1.0, 1.5], "scene.belt_speed": [1.0, 2.0, 13.0]}
    head, *rows = page_of(ran(sweep=sweep)).table("Curves")

    mean = "mean friction μ̄, least … greatest"
    assert head[:6] == ["law", "curve", "points", mean, "largest error", "at"]
    assert [row[:4] for row in rows] == [
        ["Coulomb", "Ω = 1", "2 ok, 1 refused", "0.101546 … 0.128537"],
        ["Coulomb", "Ω = 1.5", "2 ok, 1 refused", "0.101546 … 0.128537"],
    ]


@deep("seconds of reports")
def test_the_measures_of_curves_are_shown_with_their_errors_where_there_are_any(ran: Runner) -> None:
    saved = ran()
    without_stamps(saved.folder)
    measured = {"law": ["coulomb"], "kind": ["coulomb"], "method": ["fake"], "scene.normal_load": [10.0]}
    measured |= {"reversal_end": [50.0], "reversal_end_error": [5e-13], "shape_area": [0.0577]}
    measured |= {"shape_area_error": [2e-4], "shape": ["concave"], "reason": [None]}
    (saved.folder / "curves.csv").write_text(pd.DataFrame(measured).to_csv(index=False))

    with_them = page_of(fl.load(saved.folder))
    (saved.folder / "curves.csv").unlink()
    without = page_of(fl.load(saved.folder))

    assert with_them.table("Shape") == [
        ["law", "shape", "area between curve and chord", "end of reversal"],
        ["Coulomb", "concave", "0.0577 ± 0.0002", "50"],
    ]
    assert not any("Shape" in caption.text for caption in without.all("caption"))


def test_every_point_that_is_not_ok_is_counted_with_its_reason_and_examples(
    ran: Runner, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(Fake, "troubles", {float(speed): breaks_down for speed in (20, 21, 22, 23, 24)})
    monkeypatch.setattr(Fake, "nothing_at", frozenset({17.0}))
    saved = ran(**at_speeds(1.0, 13.0, 17.0, 20.0, 21.0, 22.0, 23.0, 24.0))
    head, *rows = page_of(saved).table("Points that are not plainly ok")

    assert head == ["status", "points", "reason", "laws", "methods", "for example"]
    told = {row[2]: row for row in rows}
    assert sum(int(row[1]) for row in rows) == (saved.table["status"] != "ok").sum() == 7
    assert told["thirteen, of all numbers"][:2] == ["refused", "1"]
    broken = told["ZeroDivisionError: float division by zero"]
    assert broken[:2] == ["failed", "5"]
    assert broken[-1] == "vb = 20; vb = 21; vb = 22; and 2 points more"


def test_a_point_that_is_ok_with_a_reservation_and_one_that_has_a_range_are_told(ran: Runner) -> None:
    saved = ran(**at_speeds(1.0, 2.0, 3.0))
    remark = "the error is above the tolerance; tested: 2 starts ended here"
    saved.table["reason"] = [None, remark, "three starts, two means"]
    saved.table.loc[2, ["mean_low", "mean_high", "window"]] = [0.1, 0.25, 100.0]
    saved.table.loc[2, "status"] = "not_unique"
    first, second = page_of(saved).table("Points that are not plainly ok")[1:]

    assert first[:3] == ["not unique", "1", "three starts, two means"]
    assert first[-1] == "vb = 3: means from 0.1 to 0.25 over 100 periods"
    assert second[:3] == ["ok, but", "1", "the error is above the tolerance"]


@deep("seconds of reports")
def test_how_it_is_known_that_a_state_is_the_only_one_is_no_trouble(ran: Runner) -> None:
    saved = ran(**at_speeds(1.0, 2.0, 3.0, 4.0))
    saved.table["unique"] = ["proved", "tested", None, "no"]
    saved.table["model"] = "fake; unique: damped (auto: fake, it is cheap)"
    saved.table["reason"] = [None, "tested: 2 starts up to 5 apart ended here", None, None]
    page = page_of(saved)
    head, *rows = page.table("Whether every start ends there")

    assert head == ["unique", "how it is known", "points", "laws"]
    theorem = "dashpots damp and friction never falls with speed (Leine & van de Wouw, 2008)"
    assert [row[:3] for row in rows] == [
        ["proved", theorem, "1 point"],
        ["tested", "2 starts up to 5 apart ended here", "1 point"],
        ["no", "other starts end elsewhere", "1 point"],
    ]
    assert not any("look at" in heading.text for heading in page.all("h2"))


def test_a_run_without_trouble_says_so_at_the_top_and_nowhere_else(ran: Runner) -> None:
    page = page_of(ran(**at_speeds(1.0)))

    assert "Nothing needs attention: 1 point ok." in page.all("header")[0].text
    assert {"odd", "expected"}.isdisjoint(each.attributes.get("id") for each in page.elements)


def test_an_interrupted_run_is_told_to_be_one(tmp_path: Path) -> None:
    study = PLAIN | {"sweep": {"scene.drive.frequency": [1.0, 1.5], "scene.belt_speed": [1.0, 2.0]}}
    study |= {"expect": [{"column": "mean_friction", "below": 1}]}
    interrupted_after_one_piece(study, tmp_path / "stopped")
    text = report(fl.load(tmp_path / "stopped"))
    page = Page(text)
    words = " ".join(page.all("body")[0].text.split())

    assert complaints(text) == []
    assert "Needs attention: not reached at 2 of 4 points, as the run was interrupted." in words
    assert "The study has 1 expectations; none was judged" in words
    (row,) = page.table("Points that are not plainly ok")[1:]
    assert (row[0], row[1], row[2]) == ("killed", "2", "interrupted")
    assert "frictionlab run study.yaml -o . " in words


def test_verdicts_are_those_of_the_run_and_failed_ones_come_first(ran: Runner) -> None:
    at_four = {"column": "mean_friction", "where": {"scene.belt_speed": 4}}
    page = page_of(ran(expect=[at_four | {side: 0.9} for side in ("below", "above")]))

    (_, failed, passed) = page.table("What the study expects")
    assert failed[0] == "FAILED"
    assert failed[1].startswith("mean_friction above 0.9 where scene.belt_speed 4: 0.133")
    assert passed[0] == "passed"
    assert "1 of 2 expectations FAILED" in page.all("header")[0].text


@deep("seconds of reports")
def test_many_expectations_are_folded_and_not_left_out_where_they_all_hold(ran: Runner) -> None:
    claims = [{"column": "error", "below": 1, "because": f"reason {n}"} for n in range(20)]
    held, failed = (
        page_of(ran(name, expect=expect, **at_speeds(1.0)))
        for name, expect in (("held", claims), ("failed", [*claims[:19], {"column": "error", "above": 1}]))
    )

    assert len(held.table("What the study expects")) == 21
    assert "What the study expects holds: 20 expectations." in held.all("header")[0].text
    assert "All 20 hold" in [each.text for each in held.all("summary")]
    assert failed.table("What the study expects")[1][0] == "FAILED"
    assert "What the study expects holds" not in failed.all("header")[0].text
    assert [each.text for each in failed.all("summary")] == [
        "In full, and as BibTeX, frictionlab included",
        "Versions, and when it ran",
        "The study, with every default and every sweep written out",
    ]


@deep("seconds of reports")
def test_errors_above_the_tolerance_are_counted_by_curve_whatever_their_kind(ran: Runner) -> None:
    saved = ran(**at_speeds(1.0, 2.0, 3.0), tolerance=1e-6)
    saved.table["error"] = [1e-9, 3e-5, 2e-4]
    saved.table["error_kind"] = ["guaranteed", "estimated", "statistical"]
    page = page_of(saved)

    (row,) = page.table("Curves")[1:]
    assert row[-4:] == ["2.0e-04", "vb = 3", "guaranteed, estimated, statistical", "2 points"]
    told = " ".join(page.all("header")[0].text.split())
    assert "errors up to 0.0002 above the tolerance of 1e-06 at 2 points." in told


def test_models_are_counted_and_those_alike_but_for_numbers_are_one_line(ran: Runner) -> None:
    saved = ran(**at_speeds(1.0, 2.0, 3.0))
    models = ["march, rk4: 50 steps", "march, rk4: 26 steps", "no reversal (auto: exact, cheapest)"]
    saved.table["model"] = models

    told = (
        "closed form: slip never reverses, for the belt is as fast as V_lin or faster; "
        "auto chose exact: it accepts the scene, and no method is cheaper"
    )
    assert page_of(saved).table("What produced the numbers")[1:] == [
        ["fake", "march, rk4: 26 ... 50 steps", "", "2 points", "Coulomb"],
        ["fake", "no reversal (auto: exact, cheapest)", told, "1 point", "Coulomb"],
    ]


@deep("seconds of reports")
def test_a_table_of_few_points_is_shown_whole(ran: Runner) -> None:
    few = page_of(ran(**at_speeds(1.0, 2.0))).table("Every number found")
    many = page_of(ran("many"))

    assert few[0] == ["quantity", "Coulomb by fake, vb = 1", "Coulomb by fake, vb = 2"]
    assert few[1][0] == "mean friction coefficient μ̄"
    assert not any(caption.text == "Every number found" for caption in many.all("caption"))


@deep("seconds of reports")
def test_a_long_table_says_how_many_rows_it_leaves_to_the_file(
    ran: Runner, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(tables, "MOST_ROWS", 5)
    page = page_of(ran(**ODD_STUDIES["forty curves"]))

    assert len(page.table("Curves")) == 6
    assert "... and 35 more curves, all of them in results.csv" in page.all("main")[0].text


def test_sources_are_those_of_the_study_its_laws_and_the_methods_at_work(ran: Runner) -> None:
    saved = ran(source="Smith (1999), Fig. 3", methods=["auto"], **at_speeds(60.0))
    saved.table["model"] = "no reversal (auto: exact, cheapest)"
    cited = {each.what: each.words for each in sources(saved)}

    assert cited["the study"] == "Smith (1999), Fig. 3"
    assert cited["law coulomb"].startswith("Sources: Amontons (1699)")
    assert "Den Hartog" in cited["method exact, which auto chose"]
    assert not any("shooting" in what for what in cited)
    assert "Den Hartog" in page_of(saved).all("dl")[0].text


@deep("seconds of reports")
def test_where_auto_does_not_name_its_choice_all_it_may_choose_is_cited_as_such(ran: Runner) -> None:
    saved = ran(methods=["auto"], **at_speeds(60.0))
    saved.table["model"] = "closed form"

    cited = {each.what for each in sources(saved)}
    assert {f"method {name}, which auto may choose" for name in ("exact", "shooting")} <= cited


def test_what_gave_no_number_is_not_cited(ran: Runner) -> None:
    laws = [{"kind": "coulomb", "mu": 0.4}, {"kind": "dahl", "mu": 0.4, "stiffness": 1.0}]
    saved = ran(laws=laws)
    saved.table.loc[saved.table["kind"] == "dahl", ["mean_friction", "status"]] = [float("nan"), "refused"]

    assert [each.what for each in sources(saved) if each.what.startswith("law")] == ["law coulomb"]
    keys = {each.key for each in read_bibtex(bibtex([saved]))}
    assert keys == {"frictionlab", "amontons1699", "coulomb1785", "sulollari"}


@deep("seconds of reports")
def test_sources_in_words_alone_are_cited_in_these_words(ran: Runner) -> None:
    text = bibtex([ran("one", source="My own & unpublished @ home"), ran("two", source="Yours")])
    entries = {each.key: each for each in read_bibtex(text)}

    assert entries["the-study"].fields["note"] == r"My own \& unpublished at home"
    assert entries["the-study-2"].fields["note"] == "Yours"
    assert text.count("@misc{frictionlab,") == 1


@deep("seconds of reports")
def test_the_page_shows_publications_in_full_and_as_bibtex(ran: Runner) -> None:
    saved = ran(source="Dahl (1968), section 2")
    page = page_of(saved)

    assert any("TOR-0158(3107-18)-1" in item.text for item in page.all("li"))
    assert bibtex([saved]) in [block.text for block in page.all("pre")]


@deep("seconds of reports")
def test_versions_runs_and_overrides_are_those_of_the_account(tmp_path: Path, ran: Runner) -> None:
    saved = ran()
    account = json.loads((saved.folder / "provenance.json").read_text())
    account["packages"]["numpy"] = "9.8.7"
    account["runs"][0] |= {"overrides": ["scene.normal_load=3"], "seconds": 83.4}
    (saved.folder / "provenance.json").write_text(json.dumps(account))
    page = page_of(fl.load(saved.folder))

    assert ["numpy", "9.8.7"] in page.table("Versions")
    assert ["python", account["python"]] in page.table("Versions")
    assert page.table("When it ran")[1][1:] == ["83 s", "6 points", "--set scene.normal_load=3"]


@pytest.mark.parametrize(
    ("seconds", "words"),
    [(0.0123, "0.012 s"), (1.26, "1.3 s"), (99.4, "99 s"), (100.0, "1 min 40 s"), (3601, "60 min 1 s")],
)
def test_wall_times_are_written_to_the_digits_that_matter(seconds: float, words: str) -> None:
    assert wall(seconds) == words


def test_the_study_on_the_page_is_the_study(ran: Runner) -> None:
    saved = ran(**ODD_STUDIES["markup everywhere"])
    (shown,) = [each for each in page_of(saved).all("pre") if "schema: 1" in each.text]

    assert shown.text.strip() == (saved.folder / "study.yaml").read_text().strip()


def test_every_symbol_of_a_figure_has_its_letters_on_the_page() -> None:
    for name in [*_NAMES, *(f"scene.dimensional.{name}" for name in _IN_SI)]:
        assert not re.search(r"[\\${}^_]", symbol_html(name))
        assert symbol_html(name).striptags()


def test_symbols_are_letters_with_accents_and_levels_and_other_text_is_escaped() -> None:
    assert html(r"a < b $\bar\mu$, $\hat V_1$ [m/s$^2$]") == (
        "a &lt; b <i>μ\u0304</i>, <i>V\u0302</i><sub>1</sub> [m/s<sup>2</sup>]"
    )
    assert html(r"$E_\mathrm{in}$") == "<i>E</i><sub>in</sub>"


# Figures


def test_captions_say_what_is_drawn_what_tells_curves_apart_and_what_is_held_fixed(ran: Runner) -> None:
    sweep = {"scene.drive.frequency": [1.0, 1.5], "scene.belt_speed": [1.0, 13.0]}
    first = pictures(Facts(ran(sweep=sweep)))[0]

    assert first.caption.striptags() == (
        "Mean friction coefficient μ̄ against belt speed vb. Law Coulomb; method fake. A curve for each Ω = 1, 1.5. "
        "Held fixed: β1 = 0.1, γ2 = 10, α = 10. Without a number, and marked as such: 2 points refused."
    )
    assert first.description.endswith("mean friction coefficient μ̄: from 0.1015 to 0.1015.")


@deep("seconds of reports")
def test_a_first_figure_of_one_picture_stands_beside_what_is_said_of_it(ran: Runner) -> None:
    page = page_of(ran(title="All beyond V_lin", **at_speeds(1.0, 2.0)))

    assert page.all("header")[0].attributes.get("class") == "beside"
    assert page.all("h1")[0].text == "All beyond Vlin"
    assert "Every number: results.csv" in page.all("nav")[0].text


def test_the_caption_of_differences_names_the_laws_that_are_drawn(ran: Runner) -> None:
    laws = [
        {"kind": "coulomb", "mu": mu, "label": label} for mu, label in ((0.4, "rough"), (0.2, "slippery"))
    ]
    saved = ran(laws=laws, figures={"against": "rough", "finding": "differences"}, **at_speeds(1.0, 2.0))
    (saved.folder / "figures" / "differences.svg").write_text(SVG)
    first = pictures(Facts(saved))[0]

    assert first.name == "differences"
    assert "Law slippery; " in first.caption.striptags()


def test_a_scene_in_si_units_is_told_in_them_throughout(ran: Runner) -> None:
    given = {"mass_kg": 3, "stiffness_N_per_m": 300, "damping_N_s_per_m": 2, "length_m": 0.01}
    given |= {"belt_speed_m_per_s": 0.1, "drive": {"amplitude_N": 5, "frequency_rad_per_s": 10}}
    path = "scene.dimensional."
    sweep = {f"{path}drive.amplitude_N": [5.0, 6.0], f"{path}belt_speed_m_per_s": [0.1, 0.2, 0.3]}
    saved = ran(scene={"dimensional": given}, sweep=sweep)
    without = page_of(saved)
    saved.curves["shape"] = "concave"
    page = page_of(saved)
    caption = pictures(Facts(saved))[0].caption.striptags()

    assert complaints(report(saved)) == []
    assert ["mass [kg]", "M", "3"] in page.table("The scene")
    assert "against belt speed Vb [m/s]. " in caption
    assert "A curve for each F1 = 5, 6 N. Held fixed: M = 3 kg, K1 = 300 N/m," in caption
    for name in ("Curves", "Shape"):
        assert [row[1] for row in page.table(name)[1:]] == ["F1 = 5 N", "F1 = 6 N"]
    assert not any(caption.text.startswith("Shape") for caption in without.all("caption"))


@deep("seconds of reports")
def test_a_length_that_was_left_out_is_told_as_taken(ran: Runner) -> None:
    body = {"mass": "3 kg", "stiffness": "300 N/m", "damping": "2 N s/m", "belt_speed": "0.1 m/s"}
    body |= {"belt_vibration": {"frequency": "10 rad/s", "displacement_amplitude": "10 mm"}}
    saved = [ran(name, scene={"dimensional": body | given}, sweep={}) for name, given in LENGTHS.items()]
    told = [page_of(each).table("The scene") for each in saved]

    taken = "0.01, taken from the others, to scale nondimensional columns"
    for row, length in zip(told, (taken, "0.02"), strict=True):
        assert ["length scale [m]", "L", length] in row


LENGTHS: dict[str, dict[str, float]] = {"left_out": {}, "given": {"length_m": 0.02}}


@deep("seconds of reports")
def test_a_run_without_a_sweep_has_no_figures_and_no_heading_for_them(ran: Runner) -> None:
    page = page_of(ran(sweep={}))

    assert page.all("figure") == []
    assert "Figures" not in [heading.text for heading in page.all("h2")]


@deep("seconds of reports")
def test_a_figure_that_is_not_there_is_said_to_be_missing(ran: Runner) -> None:
    saved = ran()
    (saved.folder / "figures" / "mean_friction.svg").unlink()
    text = report(saved)

    assert complaints(text) == []
    assert "figures/mean_friction.svg is not there" in Page(text).all("figure")[0].text


# The folder of a run


@deep("seconds of reports")
def test_the_page_made_from_the_folder_is_the_page_made_by_the_run(ran: Runner) -> None:
    saved = ran(title="A title", expect=[{"column": "error", "below": 1}])

    assert report(fl.load(saved.folder)) == report(saved)


@deep("seconds of reports")
def test_a_page_takes_its_name_from_the_study_its_file_or_the_folder(tmp_path: Path, ran: Runner) -> None:
    saved = ran("a folder")
    file = tmp_path / "some_study.yaml"
    file.write_text((saved.folder / "study.yaml").read_text())
    fl.run(file, out=tmp_path / "x")

    assert saved.title == "a folder"
    assert fl.load(tmp_path / "x").title == "some_study"
    assert ran("y", title="The title").title == "The title"


@deep("seconds of reports")
def test_title_source_and_expectations_may_be_edited_in_the_folder(ran: Runner) -> None:
    saved = ran(title="Old")
    edited(saved.folder, "Old", "New")

    assert page_of(fl.load(saved.folder)).title == "New"


def one_folder_up(folder: Path) -> None:
    (folder / "inner").mkdir()
    for name in ("results.parquet", "study.yaml", "provenance.json"):
        (folder / name).rename(folder / "inner" / name)


def cut_short(folder: Path) -> None:
    whole = (folder / "results.parquet").read_bytes()
    (folder / "results.parquet").write_bytes(whole[: len(whole) // 2])


def retold(change: Callable[[pd.DataFrame], pd.DataFrame]) -> Callable[[Path], None]:
    """Put the changed table in the place of the table."""

    def damage(folder: Path) -> None:
        change(pd.read_parquet(folder / "results.parquet")).to_parquet(folder / "results.parquet")

    return damage


def edited(folder: Path, old: str, new: str) -> None:
    study = folder / "study.yaml"
    study.write_text(study.read_text().replace(old, new))


def of_files(name: str, text: str | None = None) -> Callable[[Path], None]:
    """Write into a file, or remove it."""
    return lambda folder: (folder / name).unlink() if text is None else (folder / name).write_text(text)


lawless = retold(lambda table: table.drop(columns="law"))
shorter = retold(lambda table: table.iloc[1:])
wordy = retold(lambda table: table.assign(error="small"))
heavier = partial(edited, old="normal_load: 10", new="normal_load: 11")
NO_TABLE, NO_STUDY = "is not a result table:", "study.yaml is not the study of results.parquet"
DAMAGES: dict[str, Callable[[Path], Any]] = {
    "no such folder; RUN is a folder that 'frictionlab run STUDY -o RUN' wrote": shutil.rmtree,
    "is not the folder of a run: no provenance.json in it; RUN is a folder that": of_files("provenance.json"),
    "it holds runs, give one of them: ": one_folder_up,
    "results.parquet cannot be read (": cut_short,
    f"{NO_TABLE} it has no column law; run the study again: frictionlab run STUDY": lawless,
    f"{NO_STUDY} (it has 6 points, the table 5": shorter,
    f"{NO_TABLE} its column error does not hold numbers; run the study": wordy,
    "provenance.json is not the account of a run; run the study again": of_files("provenance.json", "{"),
    f"{NO_STUDY} (it asks for other numbers; only title": heavier,
}


@some(3, "a folder each")
@pytest.mark.parametrize("message", DAMAGES)
def test_what_is_no_run_or_a_damaged_one_is_told_in_one_message(message: str, ran: Runner) -> None:
    folder = ran().folder
    without_stamps(folder)
    DAMAGES[message](folder)
    with pytest.raises(FolderError) as raised:
        fl.load(folder)

    assert message in str(raised.value)
    assert str(raised.value).startswith(str(folder))
    assert "\n" not in str(raised.value)


def test_a_damaged_study_is_told_as_any_study_is(ran: Runner) -> None:
    folder = ran().folder
    (folder / "study.yaml").write_text("schema: 2\n")
    with pytest.raises(FolderError, match=r"study\.yaml:1:9: schema: must be 1") as raised:
        fl.load(folder)
    assert f"frictionlab run STUDY -o {folder}" in str(raised.value)


# The index


@pytest.fixture
def three(ran: Runner) -> list[fl.Run]:
    at_four = {"column": "error", "where": {"scene.belt_speed": 4}}
    return [
        ran("all/first one", title=HOSTILE, **at_speeds(1.0, 13.0)),
        ran("all/second", expect=[at_four | {"below": 0.5}] * 2 + [at_four | {"above": 0.5}]),
        ran("all/third", sweep={}),
    ]


@deep("seconds of reports")
def test_an_index_has_a_row_for_each_study_that_leads_to_its_report(
    three: list[fl.Run], tmp_path: Path
) -> None:
    for saved in three:
        write_report(saved)
    file = write_index(tmp_path / "all", three)
    page = Page(file.read_text())
    rows = page.table("The studies")[1:]

    assert complaints(file.read_text()) == []
    assert [row[0] for row in rows] == [f"{HOSTILE}first one", "second", "third"]
    assert [row[1] for row in rows] == ["1 ok, 1 refused", "5 ok, 1 refused", "1 ok"]
    assert [row[2] for row in rows] == ["none", "1 FAILED, 2 passed", "none"]
    links = [link.attributes["href"] for link in page.all("a")]
    assert links == ["first%20one/report.html", "second/report.html", "third/report.html"]
    assert "3 studies, 9 points" in page.all("header")[0].text


# The first study


def test_a_new_study_is_one_that_runs_and_keeps_its_promise(tmp_path: Path) -> None:
    file = new_study(tmp_path / "mine")
    done = fl.run(file)

    assert file == tmp_path / "mine.yaml"
    assert set(done.table["status"]) == {"ok"}
    assert [verdict.passed for verdict in done.verdicts] == [True]


def test_what_is_commented_out_in_a_new_study_is_right_too(tmp_path: Path) -> None:
    file = new_study(tmp_path / "mine.yml")
    lines = file.read_text().splitlines()
    awake = [re.sub(r"^( *)# (?=[ -]*[{\w.]+[:{ ])", r"\1", line) for line in lines]
    file.write_text("\n".join(awake) + "\n")

    fewer = ["sweep.scene.belt_speed=[5]", "sweep.laws.coulomb.mu=[0.4]", "expect=[]"]
    study = fl.run(file, overrides=fewer).study
    assert study.source
    assert study.keep.orbit == 200
    assert study.scene.degrees_of_freedom == 2
    assert [law.label for law in study.laws] == ["coulomb", "slippery"]


def test_parameters_in_a_list_are_told_one_by_one(ran: Runner) -> None:
    law = {"kind": "maxwell-slip", "mu": [0.3, 0.1], "stiffness": [8, 3]}
    said = Markup(report(ran(laws=[law]))).striptags()

    assert "mu[0] = 0.3" in said
    assert "stiffness[1] = 3" in said


def test_a_frequency_in_hertz_is_f_wherever_it_is_told(ran: Runner) -> None:
    drive = {"frequency": "300 Hz", "amplitude": "40 N"}
    body = {"mass": "3 kg", "stiffness": "20 N/um", "normal_load": "150 N", "belt_speed": "1 mm/s"}
    sweep = {"scene.dimensional.belt_speed": ["1 mm/s", "2 mm/s", "3 mm/s", "4 mm/s", "5 mm/s", "6 mm/s"]}
    said = Markup(report(ran(scene={"dimensional": body | {"drive": drive}}, sweep=sweep))).striptags()

    assert "f = 300 Hz" in said
    assert "ω = 300" not in said
    assert "ω is 2π times the f of the table." in said
