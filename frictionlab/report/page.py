"""Page of a run and that of a folder of runs: HTML files that need nothing else, made of what folders hold.

The page of a fit: sentences, the figure, how well each law fits, the numbers with their errors.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable, Sequence
from functools import cache
from pathlib import Path
from typing import TYPE_CHECKING, Any

import pandas as pd
from jinja2 import Environment, FileSystemLoader, StrictUndefined
from markupsafe import Markup

from frictionlab import __version__
from frictionlab.report import findings, question
from frictionlab.report import sentences as say
from frictionlab.report.answer import paragraphs
from frictionlab.report.equation import equations
from frictionlab.report.facts import Facts
from frictionlab.report.sentences import tell
from frictionlab.report.sources import bibtex, published
from frictionlab.report.tables import Cell, Grid, grid, in_order, number, size, symbol_html
from frictionlab.runner.folder import write_page
from frictionlab.runner.results import Results, folder_of
from frictionlab.runner.words import counted
from frictionlab.study.written import yaml_text
from frictionlab.values.printable import with_error

if TYPE_CHECKING:
    from frictionlab.charts.figures import FigureData


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
    """Return the page of a run."""
    run, shown = Facts(saved, drawn), []
    if saved.study.sweep:
        from frictionlab.report.figures import pictures  # with matplotlib, which takes a second

        shown = pictures(run)
    lines = equations(saved.study)
    symbols = [symbol_html(question.shown_name(saved.study, name)) for name in saved.study.units]
    tables = {"found": findings, "asked": question, "versions": _versions(saved), "runs": _runs(saved)}
    again = {"commands": [GO_ON, *AGAIN] if "killed" in saved.counts else AGAIN, "bibtex": bibtex([saved])}
    return rendered(
        "report.html",
        title=saved.title,
        saved=saved,
        run=run,
        pictures=shown,
        paragraphs=paragraphs(run),
        equations=lines,
        letters=tell(say.ON_LETTERS, " ".join([*lines, *symbols])),
        references=published(run.cited),
        yaml=yaml_text(saved.study.resolved()),
        **tables,
        **again,
    )


def rendered(template: str, **values: Any) -> str:
    """A page from its template; every value that is not markup already is escaped."""
    return _environment().get_template(template).render(generator=GENERATOR, style=_style(), **values)


@cache
def _environment() -> Environment:
    made = Environment(
        loader=FileSystemLoader(REPORT_TEMPLATES),
        autoescape=True,
        undefined=StrictUndefined,
        trim_blocks=True,
        lstrip_blocks=True,
    )
    made.globals |= {"wall": wall, "size_of": size, "counted": counted}
    return made


@cache
def _style() -> Markup:
    return Markup((REPORT_TEMPLATES / "style.css").read_text(encoding="utf-8").strip())


def wall(seconds: float) -> str:
    """A wall time, to the digits that matter."""
    if seconds < 100.0:
        return f"{seconds:.2g} s"
    whole = round(seconds)
    return f"{whole // 60} min {whole % 60} s"


def _versions(saved: Results) -> Grid:
    own = {name: saved.account.get(name) for name in ("frictionlab", "python", "platform")}
    made_with = [(name, str(value)) for name, value in (own | saved.account["packages"]).items() if value]
    return grid("Versions with which the numbers were made", in_order("what", "version"), made_with)


def _runs(saved: Results) -> Grid:
    columns: dict[Cell, Callable[[dict[str, Any]], Cell]] = {
        "started": lambda run: str(run.get("started", "")),
        "took": lambda run: wall(run["seconds"]),
        "computed": lambda run: counted(int(run.get("computed", 0)), "point"),
        "set on the command line": lambda run: " ".join(f"--set {each}" for each in run.get("overrides", [])),
    }
    return grid("When it ran", columns, saved.account["runs"])


def write_index(folder: Path, runs: Sequence[Results]) -> Path:
    """Write the index.html of runs in folders below this one; where it is. Raises SaveError."""
    file = folder / "index.html"
    write_page(file, index(folder, runs))
    return file


def index(folder: Path, runs: Sequence[Results]) -> str:
    """Return the page of a folder of studies."""
    from frictionlab.report.figures import address

    counts = sum((Counter(run.counts) for run in runs), Counter())
    names = [folder_of(run).relative_to(folder).as_posix() for run in runs]
    drawn = (address(folder / name / "figures" / "mean_friction") for name in names)
    thumbnails = [each if len(each) <= LARGEST_THUMBNAIL else "" for each in drawn]
    return rendered(
        "index.html",
        title=f"Studies in {folder.absolute().name}",
        size=f"{len(runs)} studies, {counted(sum(counts.values()), 'point')}",
        counts=dict(counts.most_common()),
        verdicts=[verdict for run in runs for verdict in run.verdicts],
        seconds=sum(run.seconds for run in runs),
        entries=list(zip(runs, names, thumbnails, strict=True)),
    )


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
    """Return the page as HTML."""
    laws, numbers = ([row for _, row in table.iterrows()] for table in (found.laws, found.table))
    return rendered(
        "fit.html",
        title=title,
        picture=picture,
        caption=FIT_CAPTION,
        sentences=found.sentences,
        laws=grid("Laws, by what is left over", _LAWS, laws),
        numbers=grid("Fitted numbers, with the error from blocks", _NUMBERS, numbers),
    )


_LAWS: dict[Cell, Callable[[pd.Series], Cell]] = {
    "law": lambda law: str(law["law"]),
    "rms": lambda law: number(law["rms"], 4),
    "left out": lambda law: with_error(law["left_out_rms"], law["left_out_rms_error"]),
    "AIC": lambda law: number(law["aic"], 5),
    "starts that agree": lambda law: number(law["starts_agreeing"]),
    "why there is no fit": lambda law: "" if law["status"] == "ok" else str(law["reason"]),
}
_NUMBERS: dict[Cell, Callable[[pd.Series], Cell]] = {
    "law": lambda fitted: str(fitted["law"]),
    "number": lambda fitted: str(fitted["parameter"]),
    "value": lambda fitted: with_error(fitted["value"], fitted["block_error"]),
    "naive error": lambda fitted: size(fitted["naive_error"]),
    "95 %": lambda fitted: f"{fitted['low']:.5g} to {fitted['high']:.5g}",
    "profile": lambda fitted: str(fitted["shape"]),
    "on an end of its range": lambda fitted: "yes" if fitted["at_bound"] else "",
}
"""Columns of the tables of a fit."""
