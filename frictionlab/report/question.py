"""What a study asks, in words and tables: scene, laws, methods, sweep."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from itertools import pairwise
from typing import Any, NamedTuple

from markupsafe import Markup

from frictionlab.report.sources import law_text, method_text
from frictionlab.report.tables import Cell, Grid, grid, html, number, symbol_html
from frictionlab.runner.words import in_words
from frictionlab.scene.scene import Scene
from frictionlab.scene.signals import Signal
from frictionlab.scene.units import own_length
from frictionlab.scene.waveforms import SINE, as_fraction
from frictionlab.study.axes import FRICTION, GridValue, SpeedRange
from frictionlab.study.study import Study
from frictionlab.values.columns import SHOWN_IN, symbol, typeset, without_shown_unit, word
from frictionlab.values.quantities import Written
from frictionlab.values.units import ShownUnit

MOST_LISTED = 8
"""Values of a sweep that are listed one by one; of more, the ends and how many."""
CHOSEN = "chosen until straight lines between points are within {} of the mean"


def scene_sentences(study: Study) -> str:
    """What kind of scene it is, and what in it is no sine at the drive's frequency."""
    return " ".join([_kind(study), *_shapes(study)])


def _kind(study: Study) -> str:
    scene, drive = study.scene, _Shaking(study, "drive")
    if scene.degrees_of_freedom == 0:
        return "Prescribed slip: a body whose slip over the belt is given, not computed."
    if scene.undriven:
        shaken = "which nothing shakes"
    elif not scene.is_driven:
        shaken = "without a load"
    elif drive.is_turned:
        shaken = f"shaken {drive.direction}"
    else:
        shaken = "shaken along it" if scene.signals().load[1] == Signal() else "shaken along and across it"
    kind = (
        "one degree of freedom" if scene.degrees_of_freedom == 1 else "two degrees of freedom, in the plane"
    )
    loose = ", that no spring holds along the belt" if scene.is_free else ""
    return f"A body with {kind}{loose}, on a moving belt, {shaken}."


def _shapes(study: Study) -> Iterator[str]:
    """A sentence for every load, slip, belt vibration and normal load that is more than a sine along the belt."""
    drive, load = _Shaking(study, "drive"), _Shaking(study, "transverse.load")
    belt, normal = _Shaking(study, "belt_vibration"), _Shaking(study, "normal_load_variation")
    if (drive.part and drive.part.offset) or (load.part and load.part.offset):
        yield "A constant force pushes it."
    if study.scene.is_driven and drive.is_told:
        yield f"The load{'' if drive.is_turned else ' along x1'} varies {drive.wave}."
    if load.part and load.is_told:
        yield f"The load across the belt varies {load.wave}."
    for slip, where in ((_Shaking(study, "slip"), "x1"), (_Shaking(study, "transverse_slip"), "x2")):
        if slip.part and (slip.is_told or slip.is_turned):
            along = slip.direction if slip.is_turned else f"along {where}"
            yield f"The slip velocity {along} varies {slip.wave}."
    if belt.part:
        yield f"The belt vibrates {belt.direction}, its velocity {belt.wave}."
    if normal.part:
        contact = _CONTACTS["" if normal.is_swept("contact") else normal.part.contact]
        yield f"The normal load varies {normal.wave}; {contact}."


_CONTACTS = {
    "per_load": "the stiffness of bristles follows it",
    "constant": "the stiffness of bristles stays that of its mean",
    "": "the stiffness of bristles follows it or stays that of its mean",
}


class _Shaking(NamedTuple):
    """A part of a scene that changes in time, by its path."""

    study: Study
    path: str

    @property
    def part(self) -> Any:
        """None where the scene has none."""
        found: Any = self.study.scene
        for name in self.path.split("."):
            found = found and getattr(found, name)
        return found

    def is_swept(self, name: str) -> bool:
        return any(f"scene.{unit}{self.path}.{name}" in self.study.sweep for unit in ("", "dimensional."))

    @property
    def is_told(self) -> bool:
        """Whether it has a waveform or a frequency of its own."""
        own = getattr(self.part, "frequency_ratio", None) is not None
        return own or self.part.waveform not in (None, SINE) or self.is_swept("waveform")

    @property
    def is_turned(self) -> bool:
        return bool(getattr(self.part, "direction", None)) or self.is_swept("direction")

    @property
    def direction(self) -> str:
        if self.is_swept("direction"):
            return "in several directions"
        at = self.part.direction
        return f"at {number(at)}° to its motion" if at else "along its motion"

    @property
    def wave(self) -> str:
        """As what it varies, and how often where that is not the drive's frequency."""
        form, ratio = self.part.waveform or SINE, getattr(self.part, "frequency_ratio", None)
        wave = "in several waveforms" if self.is_swept("waveform") else f"as {form.words}"
        if self.is_swept("frequency_ratio"):
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
    rows = [
        [
            *_named(shown_name(study, name)),
            "swept" if study.sweep.get(name) is not None else _told_value(study, name, value),
        ]
        for name, value in given_of(study).items()
    ]
    return grid("The scene", ["quantity", "symbol", "value"], rows)


def _told_value(study: Study, name: str, value: Any) -> str:
    told = shown_number(study, name, value)
    return (
        f"{told}, taken from the others, to scale nondimensional columns" if is_taken(study, name) else told
    )


def is_taken(study: Study, name: str) -> bool:
    """Whether an input is the length scale that a scene has by itself."""
    body = study.scene.dimensional
    return body is not None and name.endswith(".length_m") and body.length_m == own_length(body)


def given_of(study: Study, defaults: bool = True) -> dict[str, Any]:
    """The values of the scene by their columns, those that are defaults where they are asked for."""
    return {f"scene.{path}": value for path, value in study.scene.given_values(defaults).items()}


def shown_name(study: Study, name: str) -> str:
    """The name of an input with the unit in which its numbers were written."""
    return f"{name}{SHOWN_IN}{study.units[name].unit}" if name in study.units else name


def shown_number(study: Study, name: str, value: Any) -> str:
    """The value of an input in that unit."""
    return number(value / study.units[name].size if name in study.units else value)


def _named(name: str) -> list[Cell]:
    """The words of an input and its symbol; its path where it has none."""
    if not symbol(name).startswith("$"):
        inside = without_shown_unit(name).removeprefix("scene.").removeprefix("dimensional.")
        return [inside.replace(".", " ").replace("_", " "), ""]
    return [html(" ".join(word(name).replace(symbol(name), "", 1).split())), symbol_html(name)]


def values_listed(values: Sequence[GridValue]) -> str:
    """The values of a sweep: all words, all of a few numbers, else the ends and how many."""
    numbers = [value for value in values if isinstance(value, float | int)]
    if len(values) <= MOST_LISTED or len(numbers) < len(values):
        return ", ".join(number(value) if isinstance(value, float | int) else str(value) for value in values)
    steps = [after - before for before, after in pairwise(numbers)]
    even = max(steps) - min(steps) <= 1e-9 * max(map(abs, numbers))
    told = f" in steps of {number((numbers[-1] - numbers[0]) / (len(values) - 1))}" if even else ""
    return f"{number(values[0])} … {number(values[-1])}, {len(values)} values{told}"


def laws_grid(study: Study) -> Grid:
    """The laws, what each is, and their parameters."""
    swept = {law.label: dict.fromkeys(study.swept_parameters(law), "swept") for law in study.laws}
    rows = [
        _choice(study.in_words["law"][law.label], law.kind, law_text(law), law.parameters | swept[law.label])
        for law in study.laws
    ]
    return grid("The friction laws", ["law", "kind", "what it is", "parameters"], rows)


def methods_grid(study: Study) -> Grid:
    """The methods, what each is, and their parameters."""
    said = study.in_words["method"]
    rows = [
        _choice(said[each.label], each.name, method_text(each.name), each.parameters)
        for each in study.methods
    ]
    return grid("The methods", ["method", "kind", "what it is", "parameters"], rows)


def _choice(label: str, name: str, text: str, parameters: Mapping[str, Any]) -> list[Cell]:
    """Its words, its kind where that is another name, the first line of its text, its parameters with values."""
    told = [
        Markup("{} = {}").format(
            symbol_html(f"law.{name}"),
            html(typeset(in_words(value))) if isinstance(value, Written) else in_words(value),
        )
        for name, value in parameters.items()
        if value is not None
    ]
    return [label, "" if name == label else name, text.partition("\n")[0], Markup(", ").join(told)]


def sweep_grid(study: Study) -> Grid:
    """What is swept, and over what; of several that advance together, with which."""
    rows: list[list[Cell]] = []
    for axis in study.axes:
        first, *_ = axis.values
        for path, values in axis.values.items():
            scale = study.units.get(_column(path), ShownUnit("")).size
            shown = [value / scale if isinstance(value, float) else value for value in values]
            name, told, along = _sweep_name(study, path), values_listed(shown), study.ranges.get(path)
            if path != first:
                name = Markup("{}, together with {}").format(name, _sweep_name(study, first))
            if isinstance(along, SpeedRange):
                ends = number(along.start / scale), number(along.stop / scale)
                told = f"{ends[0]} … {ends[1]}, {CHOSEN.format(number(along.within))}"
            rows.append([name, path, told])
    return grid("The sweep: every combination of these is a point", ["quantity", "key", "values"], rows)


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
    """The column of what is swept."""
    return path if path.startswith("scene.") else f"law.{path.rpartition('.')[2]}"
