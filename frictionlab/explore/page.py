"""The explorer: one HTML file that needs nothing else, made of the parts beside this module."""

from __future__ import annotations

import json
from html import escape
from pathlib import Path
from typing import Any

from frictionlab import __version__
from frictionlab.explore.run_data import run_data
from frictionlab.report.question import scene_sentences
from frictionlab.results.words import counted
from frictionlab.runner.folder import check_page, write_page
from frictionlab.runner.saved import Saved

PAGE_PARTS = Path(__file__).parent / "parts"
OWN_SCENE = "A body on a spring and a dashpot lies on a moving belt, and a load shakes it along the belt."
TITLE = "Mean friction of a vibrated body on a moving belt"


def write_explorer(file: Path, saved: Saved | None = None) -> Path:
    """Write the page, with the table of a run if one is given; where it is.

    Raises FolderError where a page that a person wrote is in the way or the run sweeps nothing, SaveError.
    """
    check_page(file)
    write_page(file, explorer(saved))
    return file


def explorer(saved: Saved | None = None) -> str:
    """The page as text. Raises FolderError."""
    data = None if saved is None else run_data(saved)
    scripts = ["address.js", "solver.js", "chart.js", "coulomb.js", *([] if data is None else ["run.js"])]
    values = {
        "generator": f"frictionlab {__version__}",
        "title": TITLE,
        "style": _part("page.css"),
        "scene": OWN_SCENE if saved is None else escape(scene_sentences(saved.study)),
        "run": ""
        if saved is None
        else _filled("run.html", {"title": escape(saved.title), "sentence": _sentence(saved)}),
        "data": "" if data is None else _embedded(data),
        "script": "\n".join(map(_part, scripts)),
    }
    return _filled("page.html", values)


def _sentence(saved: Saved) -> str:
    """How many points of which laws and methods there are, as HTML."""
    table = saved.table
    shown = counted(len(table), "point")
    of = f" of {saved.size}, spread over them" if len(table) < saved.size else ""
    laws, methods = (escape(", ".join(map(str, table[name].unique()))) for name in ("law", "method"))
    return f"{shown}{of}. Laws: {laws}. Methods: {methods}."


def _part(name: str) -> str:
    return (PAGE_PARTS / name).read_text(encoding="utf-8").strip()


def _filled(name: str, values: dict[str, str]) -> str:
    """A part whose ``{{name}}`` are replaced; what is put in is not looked through again."""
    first, *rest = _part(name).split("{{")
    cut = [piece.partition("}}") for piece in rest]
    return first + "".join(values[key] + after for key, _, after in cut)


def _embedded(data: dict[str, Any]) -> str:
    """Data as a script element that nothing in it can end."""
    text = json.dumps(data, ensure_ascii=False, allow_nan=False, separators=(",", ":")).replace(
        "<", "\\u003c"
    )
    return f'<script type="application/json" id="run-data">{text}</script>'
