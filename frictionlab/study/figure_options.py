"""How a study wants its figures drawn: the keys of ``figures``."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, fields
from typing import Any

from frictionlab.mistakes.notes import Mistake, Notes, WrongValues, dotted, value_text

WIDTHS = {"single": 85.0, "double": 175.0}
"""Of a journal's column and page [mm]."""
FORMATS = "svg", "png", "pdf"


@dataclass(frozen=True)
class FigureOptions:
    """How figures are drawn; FIGURE_KEYS says what each means. against: None for Coulomb's, else the first law."""

    normalized: bool = False
    against: str | None = None
    inset: bool = False
    width: str | None = None
    formats: tuple[str, ...] = ("svg", "png")
    title: bool = True
    shape: bool = False
    stick: bool = False

    def resolved(self) -> dict[str, Any]:
        """The entry of a study file: what differs from the defaults."""
        given = {each.name: getattr(self, each.name) for each in fields(self)}
        told = {name: value for name, value in given.items() if value != getattr(USUAL_FIGURES, name)}
        return {name: list(value) if isinstance(value, tuple) else value for name, value in told.items()}


USUAL_FIGURES = FigureOptions()
FIGURE_KEYS = {
    "normalized": "mean over steady sliding friction against belt speed over V_lin",
    "against": "label of the law that others are subtracted from in the figure of differences",
    "inset": "a closer view of where curves differ, where they are level over much of the axis",
    "width": "of a journal's column (single, 85 mm) or page (double, 175 mm); what the figure needs where left out",
    "formats": "of the files; the report shows svg or png",
    "title": "whether the study's title stands above",
    "shape": "a figure of each curve with its chord, the area between them and the verdict",
    "stick": "a pale band along curves wherever the body sticks in part of the period",
}
"""The keys and what they mean."""
FLAGS = tuple(
    each.name for each in fields(FigureOptions) if isinstance(getattr(USUAL_FIGURES, each.name), bool)
)


def read_figure_options(given: Any, laws: tuple[str, ...] | None, notes: Notes) -> FigureOptions:
    """How figures are drawn; mistakes are noted. laws: the labels of the study, None where they are uncertain."""
    tree = notes.mapping(given, ("figures",), FIGURE_KEYS) or {}
    told: dict[str, Any] = {}
    for name in (name for name in FLAGS if name in tree):
        if isinstance(tree[name], bool):
            told[name] = tree[name]
        else:
            notes.add(("figures", name), f"must be true or false, got {value_text(tree[name])}")
    if "against" in tree:
        path = ("figures", "against")
        named = notes.text if laws is None else lambda value, at: notes.one_of(value, at, laws)
        told["against"] = named(tree["against"], path)
    if "width" in tree:
        widths = ", ".join(f"{name} is {width:g} mm" for name, width in WIDTHS.items())
        told["width"] = notes.one_of(tree["width"], ("figures", "width"), WIDTHS, widths)
    if "formats" in tree:
        told["formats"] = _formats(tree["formats"], notes)
    return FigureOptions(**told)


def figure_options(given: Mapping[str, Any], laws: tuple[str, ...]) -> FigureOptions:
    """Those of keywords in Python, checked as a study's are. laws: the labels of the study. Raises WrongValues."""
    notes = Notes()
    read = read_figure_options(dict(given), laws, notes)
    if notes.all:
        raise WrongValues(
            [Mistake("figures", None, dotted(note.path[1:]), note.what, note.hint) for note in notes.all]
        )
    return read


def _formats(given: Any, notes: Notes) -> tuple[str, ...]:
    if not isinstance(given, list) or not given:
        notes.add(("figures", "formats"), f"must be a list such as [svg, pdf], got {value_text(given)}")
        return ()
    read = [notes.one_of(each, ("figures", "formats", at), FORMATS) for at, each in enumerate(given)]
    return tuple(dict.fromkeys(each for each in read if each is not None))
