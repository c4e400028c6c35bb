"""What a study asks, in words and tables: scene, laws, methods, sweep."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from itertools import pairwise
from typing import Any

from markupsafe import Markup

from frictionlab.columns import symbol, word
from frictionlab.report.markup import html, symbol_html
from frictionlab.report.sources import law_text, method_text
from frictionlab.report.tables import Cell, Grid, grid, number
from frictionlab.results.words import in_words
from frictionlab.scene.scene import Scene
from frictionlab.study import LawChoice, Study

MOST_LISTED = 8
"""Values of a sweep that are listed one by one; of more, the ends and how many."""


def scene_sentence(scene: Scene) -> str:
    """What kind of scene it is."""
    if scene.degrees_of_freedom == 0:
        return "Prescribed slip: a body whose slip over the belt is given, not computed."
    kind = (
        "one degree of freedom" if scene.degrees_of_freedom == 1 else "two degrees of freedom, in the plane"
    )
    return f"A body with {kind}, on a moving belt, {_shaken(scene)}."


def _shaken(scene: Scene) -> str:
    if scene.undriven:
        return "which nothing shakes"
    return "shaken along it" if scene.load_along_belt_only else "shaken along and across it"


def units_sentence(scene: Scene) -> str:
    """In which units its numbers are."""
    if scene.dimensional is not None:
        return "Given in SI units; a law's parameters are per unit normal load, but for those of the contact."
    return (
        "Nondimensional: lengths in L, times in 1/ω₁, forces in K₁L, speeds in ω₁L; friction coefficients are per "
        "unit normal load."
    )


def scene_grid(study: Study) -> Grid:
    """Every value of the scene, swept ones as what they run over."""
    values = {f"scene.{path}": value for path, value in study.scene.given_values().items()}
    rows = [
        [_words(name), symbol_html(name) if _has_symbol(name) else "", _value(study, name, value)]
        for name, value in values.items()
    ]
    return grid("The scene", ["quantity", "symbol", "value"], rows)


def _words(name: str) -> Cell:
    """The words of an input without its symbol; its path where it has none."""
    if not _has_symbol(name):
        return name.removeprefix("scene.").removeprefix("dimensional.").replace(".", " ").replace("_", " ")
    return html(" ".join(word(name).replace(symbol(name), "", 1).split()))


def _has_symbol(name: str) -> bool:
    return symbol(name).startswith("$")


def _value(study: Study, name: str, value: Any) -> Cell:
    swept = study.sweep.get(name)
    return number(value) if swept is None else Markup("swept: {}").format(values_listed(swept))


def values_listed(values: Sequence[float]) -> str:
    """The values of a sweep: all of a few, else the ends and how many."""
    if len(values) <= MOST_LISTED:
        return ", ".join(map(number, values))
    return f"{number(values[0])} … {number(values[-1])}, {len(values)} values{_spacing(values)}"


def _spacing(values: Sequence[float]) -> str:
    steps = [after - before for before, after in pairwise(values)]
    even = max(steps) - min(steps) <= 1e-9 * max(map(abs, values))
    return f" in steps of {number((values[-1] - values[0]) / (len(values) - 1))}" if even else ""


def laws_grid(study: Study) -> Grid:
    """The laws, what each is, and their parameters."""
    rows = [
        [
            law.label,
            _unless(law.kind, law.label),
            _first_line(law_text(law)),
            _law_parameters(law, study),
        ]
        for law in study.laws
    ]
    return grid("The friction laws", ["label", "law", "what it is", "parameters"], rows)


def methods_grid(study: Study) -> Grid:
    """The methods, what each is, and their parameters."""
    rows = [
        [
            each.label,
            _unless(each.name, each.label),
            _first_line(method_text(each.name)),
            _set(each.parameters),
        ]
        for each in study.methods
    ]
    return grid("The methods", ["label", "method", "what it is", "parameters"], rows)


def _unless(name: str, label: str) -> str:
    """A name where it says more than the label."""
    return "" if name == label else name


def _first_line(text: str) -> str:
    return text.partition("\n")[0]


def _law_parameters(law: LawChoice, study: Study) -> Cell:
    swept = {name: study.sweep.get(f"laws.{law.label}.{name}") for name in law.parameters}
    told = {name: f"swept: {values_listed(values)}" for name, values in swept.items() if values is not None}
    return _set(law.parameters | told)


def _set(parameters: Mapping[str, Any]) -> Cell:
    """Parameters with their values."""
    given = {name: value for name, value in parameters.items() if value is not None}
    told = [
        Markup("{} = {}").format(symbol_html(f"law.{name}"), in_words(value)) for name, value in given.items()
    ]
    return Markup(", ").join(told)


def sweep_grid(study: Study) -> Grid:
    """What is swept, and over what."""
    rows = [[_sweep_name(study, path), path, values_listed(values)] for path, values in study.sweep.items()]
    return grid("The sweep: every combination of these is a point", ["quantity", "key", "values"], rows)


def _sweep_name(study: Study, path: str) -> Cell:
    if path.startswith("scene."):
        return html(word(path))
    owner, _, name = path.rpartition(".")
    group = "law" if study.scene.dimensional is None else "law.dimensional"
    return Markup("{} of {}").format(html(word(f"{group}.{name}")), owner.removeprefix("laws."))
