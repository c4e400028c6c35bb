"""Explorer of a run: its curves with errors, the swept quantities that select among them.

Also the scenes that the page's own solver takes for these curves.

The explorer: one HTML file that needs nothing else, made of the parts beside this module.
"""

from __future__ import annotations

import json
import math
import re
from html import escape, unescape
from pathlib import Path
from typing import Any, NamedTuple

import pandas as pd

from frictionlab import __version__
from frictionlab.charts.curves import CurveData, Family, family_of
from frictionlab.report.question import scene_told
from frictionlab.report.tables import html
from frictionlab.runner.curve_loads import scene_of
from frictionlab.runner.files import FolderError
from frictionlab.runner.folder import check_page, write_page
from frictionlab.runner.results import Results
from frictionlab.runner.words import counted
from frictionlab.values.columns import is_belt_speed, word
from frictionlab.values.units import in_shown_units

_RATIOS = "velocity_ratio", "normalized_friction"
Quantity = tuple[str, str]
"""A swept input and the law whose parameter it is, "" for one of the scene."""


def run_data(saved: Results) -> dict[str, Any]:
    """Return the curves of a run as numbers, words and None, for JSON. Raises FolderError where it has none."""
    family = family_of(in_shown_units(saved.shown, saved.study.units))
    if family is None:
        raise FolderError(f"{saved.folder}: its study sweeps no number, so there is no curve to explore")
    swept = _swept(family)
    looks = list(dict.fromkeys((curve.law, curve.method) for curve in family.curves if _has_numbers(curve)))
    places = sorted({float(value) for curve in family.curves for value in curve.rows[family.abscissa]})
    curves = [_curve(curve, family.abscissa, swept, looks) for curve in family.curves]
    return {
        "abscissa": {"label": label(family.abscissa), "values": places},
        "swept": [{"label": label(*quantity), "values": values} for quantity, values in swept.items()],
        "curves": curves,
        "start": _start(curves, places[(len(places) - 1) // 2]),
    }


def _start(curves: list[dict[str, Any]], speed: float) -> dict[str, float] | None:
    """Choose what the sliders of the page's solver begin with: the first scene that it solves, to six digits."""
    shown = (curve["coulomb"] for curve in curves if curve["coulomb"] and not any(curve["at"]))
    if (first := next(shown, None)) is None:
        return None
    chosen = {name: first[name] for name in ("frequency", "damping", "friction")}
    chosen["belt"] = abs(speed) / first["limit"]
    return {name: float(f"{value:.6g}") for name, value in chosen.items()}


def label(name: str, law: str = "") -> str:
    """Words, symbol and unit of an input, and the law it belongs to; subscripts after "_"."""
    marked = str(html(word(name))).replace("<sub>", "_{").replace("</sub>", "}")
    plain = unescape(re.sub(r"<[^>]*>", "", marked))
    return f"{plain[:1].upper()}{plain[1:]}{f' of {law}' if law else ''}"


def _has_numbers(curve: CurveData) -> bool:
    """Check whether any point can be drawn: a mean, or the range of one that is not unique."""
    return bool(curve.rows.reindex(columns=["mean_friction", "mean_low"]).notna().to_numpy().any())


def _settings(curve: CurveData) -> dict[Quantity, float | str]:
    """List what selects a curve among those of its law and method."""
    given = [*curve.panel, *([] if curve.member is None else [curve.member])]
    told = {(name, curve.law if name.startswith("law.") else ""): value for name, value in given}
    return {quantity: value for quantity, value in told.items() if value is not None}


def _swept(family: Family) -> dict[Quantity, list[float | str]]:
    """List the swept quantities beside the abscissa, each with its values: numbers ascending, words as they come."""
    found: dict[Quantity, dict[float | str, None]] = {}
    for curve in family.curves:
        for quantity, value in _settings(curve).items():
            found.setdefault(quantity, {})[value] = None
    several = {quantity: values for quantity, values in found.items() if len(values) > 1}
    return {quantity: sorted(values, key=_rank) for quantity, values in several.items()}


def _rank(value: float | str) -> float:
    return math.inf if isinstance(value, str) else value


def _curve(
    curve: CurveData,
    abscissa: str,
    swept: dict[Quantity, list[float | str]],
    looks: list[tuple[str, str]],
) -> dict[str, Any]:
    """Return the data of one curve.

    at: for each swept quantity the index of its value, None where the law does not have it. look: a number for each
    law and method, None where no point of the two can be drawn. coulomb: the scene for the page's solver, None where
    it takes none.
    """
    settings, rows, solved = _settings(curve), curve.rows, page_scene(curve, abscissa)
    look, kinks = (curve.law, curve.method), curve.kinks or [None]
    at = [values.index(settings[each]) if each in settings else None for each, values in swept.items()]
    numbers = rows.reindex(columns=[abscissa, "mean_friction", "error", "mean_low", "mean_high"])
    told = zip(("x", "mean", "error", "low", "high"), numbers.columns, strict=True)
    return {
        "law": curve.law,
        "method": curve.method,
        "look": looks.index(look) if look in looks else None,
        "at": at,
        **{name: _numbers(numbers[column]) for name, column in told},
        "status": rows["status"].astype(str).tolist(),
        "kink": kinks[-1],
        "coulomb": solved and solved._asdict(),
    }


def _numbers(column: pd.Series) -> list[float | None]:
    """A column as JSON can hold it."""
    return [value if math.isfinite(value) else None for value in column.astype(float).tolist()]


# --- the scenes that the page solves itself -----------------------------------------------------------------------


class PageScene(NamedTuple):
    """Body of one degree of freedom under one sine, as the page's solver takes it.

    frequency, damping: of the scene, both > 0; friction: mu * normal load over the load's amplitude; mu: of sliding;
    limit: V_lin in the units of the curve's belt speeds.
    """

    frequency: float
    damping: float
    friction: float
    mu: float
    limit: float


def page_scene(curve: CurveData, abscissa: str) -> PageScene | None:
    """Return the scene of a curve over belt speed; None where it is none that the page solves.

    It solves a body along the belt, damped, under one sine, with one coefficient of sliding friction.
    """
    if not is_belt_speed(abscissa) or any(name not in curve.rows for name in _RATIOS):
        return None
    scene = scene_of(curve.rows.iloc[0].to_dict())
    load = 0.0 if scene.drive is None else scene.drive.size(scene.frequency)
    on_a_line = scene.degrees_of_freedom == 1 and not scene.is_free
    if not (on_a_line and scene.is_harmonic and load and scene.damping_ratio):
        return None
    rows = curve.rows[curve.rows["velocity_ratio"].abs() > 0.0]
    left = rows["normalized_friction"] != 0.0
    friction = (rows["mean_friction"] / rows["normalized_friction"])[left].abs()
    if friction.empty or not friction.max() - friction.min() <= 1e-12 * friction.max():
        return None
    limit = float((rows[abscissa] / rows["velocity_ratio"]).median())
    mu = float(friction.iloc[0])
    share = mu * (scene.normal_load or 1.0) / abs(load)
    return PageScene(scene.frequency, scene.damping_ratio, share, mu, limit)


PAGE_PARTS = Path(__file__).parent / "explorer_parts"
OWN_SCENE = "A body on a spring and a dashpot lies on a moving belt, and a load shakes it along the belt."
TITLE = "Mean friction of a vibrated body on a moving belt"


def write_explorer(file: Path, saved: Results | None = None) -> Path:
    """Write the page, with the table of a run if one is given; where it is.

    Raises FolderError where a page that a person wrote is in the way or the run sweeps nothing, SaveError.
    """
    check_page(file)
    write_page(file, explorer(saved))
    return file


def explorer(saved: Results | None = None) -> str:
    """Return the page as text. Raises FolderError."""
    scripts = ["address.js", "solver.js", "chart.js", "coulomb.js"]
    values = {"generator": f"frictionlab {__version__}", "title": TITLE, "style": _part("page.css")}
    of_run = {"scene": OWN_SCENE, "run": "", "data": ""}
    if saved is not None:
        scripts.append("run.js")
        told = {"title": escape(saved.title), "sentence": _sentence(saved)}
        of_run = {"scene": str(scene_told(saved.study)), "run": _filled("run.html", told)}
        of_run["data"] = _embedded(run_data(saved))
    return _filled("page.html", values | of_run | {"script": "\n".join(map(_part, scripts))})


def _sentence(saved: Results) -> str:
    """Count the points, and name their laws and methods, as HTML."""
    table = saved.shown
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
    text = json.dumps(data, ensure_ascii=False, allow_nan=False, separators=(",", ":"))
    safe = text.replace("<", "\\u003c")
    return f'<script type="application/json" id="run-data">{safe}</script>'
