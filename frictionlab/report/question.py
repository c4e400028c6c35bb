"""What a study asks, in words and tables: scene, laws, methods, sweep."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from itertools import pairwise
from typing import Any

from markupsafe import Markup

from frictionlab.columns import symbol, word
from frictionlab.report.markup import html, symbol_html
from frictionlab.report.sources import law_text, method_text
from frictionlab.report.tables import Cell, Grid, grid, number
from frictionlab.results.words import in_words
from frictionlab.scene.scene import Scene
from frictionlab.scene.signals import Signal
from frictionlab.scene.waveforms import SINE, as_fraction
from frictionlab.study import GridValue, LawChoice, Study
from frictionlab.study.axes import FRICTION, Axis
from frictionlab.study.ranges import SpeedRange

MOST_LISTED = 8
"""Values of a sweep that are listed one by one; of more, the ends and how many."""


def scene_sentences(study: Study) -> str:
    """What kind of scene it is, and what in it is no sine at the drive's frequency."""
    return " ".join([_kind(study), *_shapes(study)])


def _kind(study: Study) -> str:
    degrees = study.scene.degrees_of_freedom
    if degrees == 0:
        return "Prescribed slip: a body whose slip over the belt is given, not computed."
    kind = "one degree of freedom" if degrees == 1 else "two degrees of freedom, in the plane"
    return f"A body with {kind}, on a moving belt, {_shaken(study)}."


def _shaken(study: Study) -> str:
    scene = study.scene
    if scene.undriven:
        return "which nothing shakes"
    if scene.drive is None:
        return "without a load"
    if _turned(study, "drive", scene.drive):
        return f"shaken {_direction(study, 'drive', scene.drive)}"
    return "shaken along it" if scene.signals().load[1] == Signal() else "shaken along and across it"


def _shapes(study: Study) -> Iterator[str]:
    """A sentence for every load, slip, belt vibration and normal load that is more than a sine along the belt."""
    scene = study.scene
    load = scene.transverse.load if scene.transverse is not None else None
    if scene.drive is not None and _told(study, "drive", scene.drive):
        where = "" if _turned(study, "drive", scene.drive) else " along x1"
        yield f"The load{where} varies {_wave(study, 'drive', scene.drive)}."
    if load is not None and _told(study, "transverse.load", load):
        yield f"The load across the belt varies {_wave(study, 'transverse.load', load)}."
    for name, where in (("slip", "x1"), ("transverse_slip", "x2")):
        part = getattr(scene, name)
        if part is not None and (_told(study, name, part) or _turned(study, name, part)):
            along = _direction(study, name, part) if _turned(study, name, part) else f"along {where}"
            yield f"The slip velocity {along} varies {_wave(study, name, part)}."
    if (belt := scene.belt_vibration) is not None:
        where = _direction(study, "belt_vibration", belt)
        yield f"The belt vibrates {where}, its velocity {_wave(study, 'belt_vibration', belt)}."
    if (normal := scene.normal_load_variation) is not None:
        name = "normal_load_variation"
        contact = _CONTACTS["" if _is_swept(study, f"{name}.contact") else normal.contact]
        yield f"The normal load varies {_wave(study, name, normal)}; {contact}."


_CONTACTS = {
    "per_load": "the stiffness of bristles follows it",
    "constant": "the stiffness of bristles stays that of its mean",
    "": "the stiffness of bristles follows it or stays that of its mean",
}


def _is_swept(study: Study, path: str) -> bool:
    return f"scene.{path}" in study.sweep or f"scene.dimensional.{path}" in study.sweep


def _told(study: Study, name: str, part: Any) -> bool:
    """Whether it has a waveform or a frequency of its own."""
    own = part.waveform not in (None, SINE) or getattr(part, "frequency_ratio", None) is not None
    return own or _is_swept(study, f"{name}.waveform")


def _turned(study: Study, name: str, part: Any) -> bool:
    return bool(getattr(part, "direction", None)) or _is_swept(study, f"{name}.direction")


def _direction(study: Study, name: str, part: Any) -> str:
    if _is_swept(study, f"{name}.direction"):
        return "in several directions"
    return f"at {number(part.direction)}° to its motion" if part.direction else "along its motion"


def _wave(study: Study, name: str, part: Any) -> str:
    """As what it varies, and how often where that is not the drive's frequency."""
    form, ratio = part.waveform or SINE, getattr(part, "frequency_ratio", None)
    wave = f"as {form.words}"
    if _is_swept(study, f"{name}.waveform"):
        wave = "in several waveforms"
    if _is_swept(study, f"{name}.frequency_ratio"):
        return f"{wave} at several frequencies"
    return wave if ratio in (None, 1.0) else f"{wave} at {as_fraction(ratio)} times the drive's frequency"


def units_sentence(scene: Scene) -> str:
    """In which units its numbers are."""
    if scene.dimensional is not None:
        return "Given in SI units; a law's parameters are per unit normal load, but for those of the contact."
    return (
        "Nondimensional: lengths in L, times in 1/ω₁, forces in K₁L, speeds in ω₁L; friction coefficients are per "
        "unit normal load."
    )


def scene_grid(study: Study) -> Grid:
    """Every value of the scene, but for what swept ones run over."""
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
    return number(value) if swept is None else "swept"


def values_listed(values: Sequence[GridValue]) -> str:
    """The values of a sweep: all words, all of a few numbers, else the ends and how many."""
    numbers = [value for value in values if isinstance(value, float | int)]
    if len(values) <= MOST_LISTED or len(numbers) < len(values):
        return ", ".join(number(value) if isinstance(value, float | int) else str(value) for value in values)
    return f"{number(values[0])} … {number(values[-1])}, {len(values)} values{_spacing(numbers)}"


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
    told = dict.fromkeys(study.swept_parameters(law), "swept")
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
    rows = [
        [_together(study, axis, path), path, _values_of(study, path, values)]
        for axis in study.axes
        for path, values in axis.values.items()
    ]
    return grid("The sweep: every combination of these is a point", ["quantity", "key", "values"], rows)


def _values_of(study: Study, path: str, values: Sequence[GridValue]) -> str:
    along = study.ranges.get(path)
    if isinstance(along, SpeedRange):
        ends = f"{number(along.start)} … {number(along.stop)}"
        return f"{ends}, chosen until straight lines between points are within {number(along.within)} of the mean"
    return values_listed(values)


def _together(study: Study, axis: Axis, path: str) -> Cell:
    """What is swept; of several that advance together, with which."""
    first = next(iter(axis.values))
    name = _sweep_name(study, path)
    return name if path == first else Markup("{}, together with {}").format(name, _sweep_name(study, first))


def _sweep_name(study: Study, path: str) -> Cell:
    if path == FRICTION:
        return Markup("friction coefficient of every law")
    if path.startswith("scene."):
        return html(word(path))
    owner, _, name = path.rpartition(".")
    group = "law" if study.scene.dimensional is None else "law.dimensional"
    return Markup("{} of {}").format(html(word(f"{group}.{name}")), owner.removeprefix("laws."))
