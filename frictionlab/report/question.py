"""Words and tables of what a study asks: scene, laws, methods, sweep."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from itertools import pairwise
from typing import Any

from markupsafe import Markup

from frictionlab.report import sentences as say
from frictionlab.report.sentences import tell
from frictionlab.report.sources import law_text, method_text
from frictionlab.report.tables import Cell, Grid, grid, html, in_order, number, settings, symbol_html
from frictionlab.runner.table import cells
from frictionlab.scene.dimensional import without_unit
from frictionlab.scene.units import own_length
from frictionlab.scene.waveforms import SINE, as_fraction
from frictionlab.study.axes import FRICTION, GridValue, SpeedRange
from frictionlab.study.study import Study
from frictionlab.values.columns import SHOWN_IN, symbol, without_shown_unit, word
from frictionlab.values.units import ShownUnit

MOST_LISTED = 8
"""Values of a sweep that are listed one by one; of more, the ends and how many."""
CHOSEN = "chosen until straight lines between points are within {} of the mean"


_SHAKEN = {
    "drive": ("The load", ""),
    "transverse.load": ("The load", "across the belt"),
    "slip": ("The slip velocity", ""),
    "transverse_slip": ("The slip velocity", "across the belt"),
    "belt_vibration": ("The velocity of the vibrating belt", ""),
    "normal_load_variation": ("The normal load", " "),
}
"""Parts of a scene that change in time, and where they act if they have no direction."""


def scene_told(study: Study) -> Markup:
    """Tell what kind of scene it is, what changes in time in it, and how."""
    parts = [tell(say.ON_SCENE, study.scene), *(_shaken(study, path) for path in _SHAKEN)]
    return Markup(" ").join(filter(None, parts))


def _shaken(study: Study, path: str) -> Markup:
    """Tell along what a part of the scene acts, as what it varies, how often if not as often as the drive."""
    part: Any = study.scene
    for name in path.split("."):
        part = getattr(part, name, None)
    if part is None:
        return Markup("")
    swept = (without_unit(name) for name in study.sweep if f"{path}." in name)
    given = part.model_dump() | {name.rpartition(".")[2]: "swept" for name in swept}
    (what, where), ratio, at = _SHAKEN[path], given.get("frequency_ratio"), given.get("direction")
    turned = {None: "along the belt", 0.0: "along the belt", "swept": "in several directions"}
    where = where or turned.get(at) or f"at {number(at)}° to the motion of the belt"
    wave = "in several waveforms" if given["waveform"] == "swept" else f"as {(part.waveform or SINE).words}"
    pace: dict[Any, str] = {None: "", 1.0: "", "swept": " at several frequencies"}
    often = pace[ratio] if ratio in pace else f" at {as_fraction(ratio)} times the frequency of the drive"
    return tell(say.ON_SHAKEN, given, load=f"{what} {where}".strip(), where=where, wave=wave, often=often)


def units_told(study: Study) -> Markup:
    """Tell in which units its numbers are."""
    return tell(say.ON_UNITS, study.scene)


def scene_grid(study: Study) -> Grid:
    """Every value of the scene, but for what swept ones run over."""
    given = given_of(study).items()
    rows = [[*_named(shown_name(study, name)), _told_value(study, name, value)] for name, value in given]
    return grid("The scene", in_order("quantity", "symbol", "value"), rows)


def _told_value(study: Study, name: str, value: Any) -> Cell:
    if name in study.sweep:
        return "swept"
    taken = ", taken from the others, to scale nondimensional columns" if is_taken(study, name) else ""
    return f"{number(value / study.units[name].size if name in study.units else value)}{taken}"


def is_taken(study: Study, name: str) -> bool:
    """Check whether an input is the length scale that a scene has by itself."""
    body = study.scene.dimensional
    return body is not None and name.endswith(".length_m") and body.length_m == own_length(body)


def given_of(study: Study, defaults: bool = True) -> dict[str, Any]:
    """Return the values of the scene by their columns, those that are defaults where they are asked for."""
    return {f"scene.{path}": value for path, value in study.scene.given_values(defaults).items()}


def shown_name(study: Study, name: str) -> str:
    """Return the name of an input with the unit in which its numbers were written."""
    return f"{name}{SHOWN_IN}{study.units[name].unit}" if name in study.units else name


def _named(name: str) -> list[Cell]:
    """Return the words of an input and its symbol; its path where it has none."""
    if not symbol(name).startswith("$"):
        inside = without_shown_unit(name).removeprefix("scene.").removeprefix("dimensional.")
        return [inside.replace(".", " ").replace("_", " "), ""]
    return [html(" ".join(word(name).replace(symbol(name), "", 1).split())), symbol_html(name)]


def values_listed(values: Sequence[GridValue]) -> str:
    """Return the values of a sweep: all words, all of a few numbers, else the ends and how many."""
    numbers = [value for value in values if isinstance(value, float | int)]
    if len(values) <= MOST_LISTED or len(numbers) < len(values):
        return ", ".join(number(value) if isinstance(value, float | int) else str(value) for value in values)
    steps = [after - before for before, after in pairwise(numbers)]
    even = max(steps) - min(steps) <= 1e-9 * max(map(abs, numbers))
    told = f" in steps of {number((numbers[-1] - numbers[0]) / (len(values) - 1))}" if even else ""
    return f"{number(values[0])} … {number(values[-1])}, {len(values)} values{told}"


_OF_CHOICES = "kind", "what it is", "parameters"


def laws_grid(study: Study) -> Grid:
    """Return the laws, what each is, and their parameters."""
    said, laws = study.in_words["law"], study.laws
    given = [law.parameters | dict.fromkeys(study.swept_parameters(law), "swept") for law in laws]
    rows = [
        _choice(said[law.label], law.kind, law_text(law), own) for law, own in zip(laws, given, strict=True)
    ]
    return grid("The friction laws", in_order("law", *_OF_CHOICES), rows)


def methods_grid(study: Study) -> Grid:
    """Return the methods, what each is, and their parameters."""
    said = study.in_words["method"]
    rows = [
        _choice(said[way.label], way.name, method_text(way.name), way.parameters) for way in study.methods
    ]
    return grid("The methods", in_order("method", *_OF_CHOICES), rows)


def _choice(label: str, name: str, text: str, parameters: Mapping[str, Any]) -> list[Cell]:
    """Return its words, its kind if that is another name, the first line of its text, its parameters with values."""
    told = settings({f"law.{parameter}": value for parameter, value in cells(parameters).items()})
    return [label, "" if name == label else name, text.partition("\n")[0], told]


def sweep_grid(study: Study) -> Grid:
    """List what is swept, and over what; of several that advance together, with which."""
    rows: list[list[Cell]] = []
    for axis in study.axes:
        first, *_ = (_sweep_name(study, path) for path in axis.values)
        for path, values in axis.values.items():
            name = _sweep_name(study, path)
            if name != first:
                name = Markup("{}, together with {}").format(name, first)
            rows.append([name, path, _sweep_values(study, path, values)])
    columns = in_order("quantity", "key", "values")
    return grid("The sweep: every combination of these is a point", columns, rows)


def _sweep_values(study: Study, path: str, values: Sequence[GridValue]) -> str:
    scale, along = study.units.get(_column(path), ShownUnit("")).size, study.ranges.get(path)
    if isinstance(along, SpeedRange):
        start, stop, within = (
            number(each) for each in (along.start / scale, along.stop / scale, along.within)
        )
        return f"{start} … {stop}, {CHOSEN.format(within)}"
    return values_listed([value / scale if isinstance(value, float) else value for value in values])


def _sweep_name(study: Study, path: str) -> Cell:
    if path == FRICTION:
        return "friction coefficient of every law"
    shown = shown_name(study, _column(path))
    if path.startswith("scene."):
        return html(word(shown))
    if study.scene.dimensional is not None:
        shown = shown.replace("law.", "law.dimensional.", 1)
    return Markup("{} of {}").format(html(word(shown)), path.rpartition(".")[0].removeprefix("laws."))


def _column(path: str) -> str:
    """Return the column of what is swept."""
    return path if path.startswith("scene.") else f"law.{path.rpartition('.')[2]}"
