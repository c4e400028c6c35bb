"""The page of a run and that of a folder of runs: HTML files that need nothing else, made of what folders hold.

The page of a fit: sentences, the figure, how well each law fits, the numbers with their errors.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Sequence
from functools import cache
from pathlib import Path
from typing import TYPE_CHECKING, Any
from urllib.parse import quote

import pandas as pd
from jinja2 import Environment, FileSystemLoader, StrictUndefined
from markupsafe import Markup, escape

from frictionlab import __version__
from frictionlab.report import findings, question
from frictionlab.report import sentences as say
from frictionlab.report.answer import paragraphs
from frictionlab.report.equation import equations, letters_sentence
from frictionlab.report.facts import Facts
from frictionlab.report.sentences import told
from frictionlab.report.sources import entries_of, published
from frictionlab.report.tables import Grid, grid, size
from frictionlab.runner.folder import write_page
from frictionlab.runner.results import Results, folder_of
from frictionlab.runner.words import counted
from frictionlab.study.written import yaml_text
from frictionlab.values.printable import with_error

if TYPE_CHECKING:
    from frictionlab.charts.figures import FigureData
    from frictionlab.report.figures import Picture


REPORT_TEMPLATES = Path(__file__).parent / "templates"
GENERATOR = f"frictionlab {__version__}"
LARGEST_THUMBNAIL = 200_000
"""Length of a picture's data above which the index goes without it: the report has it."""
GO_ON = "frictionlab run study.yaml -o .       # go on where it was interrupted"
AGAIN = [
    "frictionlab run study.yaml -o again --cache again   # compute everything anew, into another folder",
    "frictionlab report .                  # draw the figures and write this page anew; nothing is computed",
]


def write_report(saved: Results, drawn: FigureData | None = None) -> Path:
    """Write report.html into the folder of a run; where it is. drawn: what its figures were drawn of, if they were.

    Raises SaveError.
    """
    file = folder_of(saved) / "report.html"
    write_page(file, report(saved, drawn))
    return file


def report(saved: Results, drawn: FigureData | None = None) -> str:
    """The page of a run."""
    run = Facts(saved, drawn)
    parts = _head(run) | _asked(saved) | _found(run) | _last(run)
    return rendered("report.html", title=saved.title, headings=_headings(parts), **parts)


def _headings(parts: dict[str, Any]) -> dict[str, str]:
    """The sections of a page and their headings, those left out of which there is nothing to show."""
    curved = bool(parts["shape"] and parts["shape"].rows)
    sections = {
        "shape": ("Which way the curves bend", curved),
        "curves": (f"The {'curves' if curved else 'numbers'}, and how exact they are", True),
        "pairs": ("Compared in pairs", any(each.rows for each in parts["pairs"])),
        "onsets": ("Where stick begins and ends", parts["onsets"] and parts["onsets"].rows),
        "figures": ("More figures", parts["pictures"]),
        "odd": ("Points to look at", parts["odd"].rows),
        "expected": ("What was expected", parts["expected"]),
        "asked": ("The problem", True),
        "methods": ("How the numbers were found", True),
        "sources": ("Sources", True),
        "again": ("How to run it again", True),
    }
    return {name: heading for name, (heading, shown) in sections.items() if shown}


def rendered(template: str, **values: Any) -> str:
    """A page from its template; every value that is not markup already is escaped."""
    return _environment().get_template(template).render(generator=GENERATOR, style=_style(), **values)


@cache
def _environment() -> Environment:
    return Environment(
        loader=FileSystemLoader(REPORT_TEMPLATES),
        autoescape=True,
        undefined=StrictUndefined,
        trim_blocks=True,
        lstrip_blocks=True,
    )


@cache
def _style() -> Markup:
    return Markup((REPORT_TEMPLATES / "style.css").read_text(encoding="utf-8").strip())


def _head(run: Facts) -> dict[str, Any]:
    rows = len(run.table)
    shown: list[Picture] = []
    if run.saved.study.sweep:
        from frictionlab.report.figures import pictures  # with matplotlib, which takes a second

        shown = pictures(run)
    return {
        "heading": Markup("V<sub>lin</sub>").join(map(escape, run.saved.title.split("V_lin"))),
        "sentences": paragraphs(run),
        "first": shown[:1],
        "pictures": shown[1:],
        "thinned": counted(rows, "point") if rows < run.saved.size else "",
    }


def wall(seconds: float) -> str:
    """A wall time, to the digits that matter."""
    if seconds < 100.0:
        return f"{seconds:.2g} s"
    whole = round(seconds)
    return f"{whole // 60} min {whole % 60} s"


def _asked(saved: Results) -> dict[str, Any]:
    study = saved.study
    return {
        "scene_sentence": question.scene_told(study),
        "units_sentence": told(say.UNITS, study.scene),
        "source": study.source,
        "sketched": study.scene.degrees_of_freedom > 0,
        "pushed": study.scene.drive is not None,
        "equations": equations(study),
        "letters_sentence": letters_sentence(study),
        "scene": question.scene_grid(study),
        "laws": question.laws_grid(study),
        "methods": question.methods_grid(study),
        "sweep": question.sweep_grid(study),
        "tolerance": f"{study.tolerance:g}",
        "keep": study.keep.orbit,
        "yaml": yaml_text(study.resolved()),
    }


def _found(run: Facts) -> dict[str, Any]:
    verdicts, onsets = run.saved.verdicts, run.saved.shown_onsets
    passed = sum(verdict.passed for verdict in verdicts)
    return {
        "curves": findings.curves_grid(run),
        "whole": findings.whole_grid(run),
        "shape": findings.shape_grid(run),
        "pairs": findings.pair_grids(run),
        "onsets": None if onsets is None else findings.onset_grid(run, onsets),
        "verdicts": findings.verdicts_grid(verdicts),
        "passed": passed,
        "fold": 0 < len(verdicts) == passed,
        "expected": len(run.saved.study.expect),
        "odd": findings.trouble_grid(run),
        "unique": findings.uniqueness_grid(run),
        "models": findings.models_grid(run),
    }


def _last(run: Facts) -> dict[str, Any]:
    saved = run.saved
    return {
        "sources": run.cited,
        "references": published(run.cited),
        "bibtex": entries_of([(saved, run.cited)]),
        "versions": _versions(saved),
        "runs": _runs(saved.account["runs"]),
        "wall": wall(saved.seconds),
        "size": counted(saved.size, "point"),
        "commands": [GO_ON, *AGAIN] if "killed" in saved.counts else AGAIN,
    }


def _versions(saved: Results) -> Grid:
    account = saved.account
    own = {name: account.get(name) for name in ("frictionlab", "python", "platform")}
    rows = [[name, str(value)] for name, value in (own | account["packages"]).items() if value]
    return grid("Versions with which the numbers were made", ["what", "version"], rows)


def _runs(runs: Sequence[dict[str, Any]]) -> Grid:
    rows = [
        [
            str(run.get("started", "")),
            wall(run["seconds"]),
            counted(int(run.get("computed", 0)), "point"),
            " ".join(f"--set {each}" for each in run.get("overrides", [])),
        ]
        for run in runs
    ]
    return grid("When it ran", ["started", "took", "computed", "set on the command line"], rows)


def write_index(folder: Path, runs: Sequence[Results]) -> Path:
    """Write the index.html of runs in folders below this one; where it is. Raises SaveError."""
    file = folder / "index.html"
    write_page(file, index(folder, runs))
    return file


def index(folder: Path, runs: Sequence[Results]) -> str:
    """The page of a folder of studies."""
    entries = [_entry(folder, run) for run in runs]
    counts = sum((Counter(run.counts) for run in runs), Counter())
    return rendered(
        "index.html",
        title=f"Studies in {folder.absolute().name}",
        size=f"{len(runs)} studies, {counted(sum(counts.values()), 'point')}",
        counts=dict(counts.most_common()),
        passed=sum(entry["passed"] for entry in entries),
        failed=sum(entry["failed"] for entry in entries),
        wall=wall(sum(run.seconds for run in runs)),
        entries=entries,
    )


def _entry(folder: Path, run: Results) -> dict[str, Any]:
    """A study's row."""
    from frictionlab.report.figures import address

    own = folder_of(run)
    name, passed = own.relative_to(folder).as_posix(), sum(verdict.passed for verdict in run.verdicts)
    picture = address(own / "figures" / "mean_friction")
    return {
        "name": name,
        "title": run.title,
        "link": f"{quote(name)}/report.html",
        "points": ", ".join(f"{count} {status}" for status, count in run.counts.items()),
        "passed": passed,
        "failed": len(run.verdicts) - passed,
        "error": size(float(run.table["error"].max())),
        "wall": wall(run.seconds),
        "thumbnail": picture if len(picture) <= LARGEST_THUMBNAIL else "",
    }


FIT_CAPTION = (
    "Measured and fitted; what is left, fitted less measured; and how far neighbours in that are alike: "
    "its autocorrelation, which stays within the dashed lines where rows are independent."
)


def write_fit_page(found: Any, path: Any, title: str = "") -> Path:
    """Write the page; where it is. The figure is that of the folder ``figures`` beside it, if there is one.

    Raises SaveError.
    """
    from frictionlab.report.figures import address

    file = Path(path)
    write_page(
        file, fit_page(found, title or "A fit to measurements", address(file.parent / "figures" / "fit"))
    )
    return file


def fit_page(found: Any, title: str, picture: str) -> str:
    """The page as HTML."""
    parts = {"sentences": found.sentences, "laws": _laws(found.laws), "numbers": _numbers(found.table)}
    return rendered("fit.html", title=title, picture=picture, caption=FIT_CAPTION, **parts)


def _laws(table: pd.DataFrame) -> Grid:
    head = ["law", "rms", "left out", "AIC", "starts that agree", "why there is no fit"]
    rows = [
        [
            str(row["law"]),
            f"{row['rms']:.4g}",
            with_error(row["left_out_rms"], row["left_out_rms_error"]),
            f"{row['aic']:.5g}",
            f"{row['starts_agreeing']:.0f}",
            "",
        ]
        if row["status"] == "ok"
        else [str(row["law"]), "", "", "", "", str(row["reason"])]
        for _, row in table.iterrows()
    ]
    return grid("Laws, by what is left over", head, rows)


def _numbers(table: pd.DataFrame) -> Grid:
    head = ["law", "number", "value", "naive error", "95 %", "profile", "on an end of its range"]
    rows = [
        [
            str(row["law"]),
            str(row["parameter"]),
            with_error(row["value"], row["block_error"]),
            size(row["naive_error"]),
            f"{row['low']:.5g} to {row['high']:.5g}",
            str(row["shape"]),
            "yes" if row["at_bound"] else "",
        ]
        for _, row in table.iterrows()
    ]
    return grid("Fitted numbers, with the error from blocks", head, rows)
