"""Figures of a result table, for the page of a journal, each written in the formats asked for."""

from __future__ import annotations

import re
import warnings
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field, replace
from functools import cached_property, partial
from pathlib import Path
from typing import Any, NamedTuple

import matplotlib as mpl
import pandas as pd
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from frictionlab.charts.bifurcation import bifurcation_figures
from frictionlab.charts.curve_figure import CurveFigure
from frictionlab.charts.curves import LEAST_VISIBLE, Family, family_of
from frictionlab.charts.derived import differences, normalized, reference_law, v_lin_of
from frictionlab.charts.kept_figures import harmonic_figures, orbit_figures
from frictionlab.charts.maps import MapFigure, map_of, map_of_curves
from frictionlab.charts.shape_figure import ShapeFigure
from frictionlab.charts.sheet import STYLE, Heading, write_figure
from frictionlab.study.figure_options import FIGURE_NAMES, FORMATS, USUAL_FIGURES, FigureOptions
from frictionlab.study.study import Study
from frictionlab.values.columns import SI, by_plain_names, plain_word, symbol, word
from frictionlab.values.printable import printable
from frictionlab.values.units import ShownUnit, as_shown

FIGURES = {
    "mean_friction": ["mean_friction"],
    "velocity": ["velocity_amplitude", "transverse_velocity_amplitude"],
    "energies": ["energy_input", "energy_viscous", "energy_friction", "energy_contact"],
}
OTHER_FIGURES = {
    "differences": (
        "Difference of mean friction from that of {reference}{shares} over {abscissa}",
        ", with the sum of both errors as a band",
    ),
    "map": ("Measures of the curves over what else is swept", ": shades with lines of equal value"),
    "shape": (
        "Curves of mean friction with their chords from rest to the end of reversal",
        "; the shaded area decides the verdict",
    ),
    "hysteresis": (
        "Friction coefficient over position",
        ", of kept orbits: the area of a loop is what friction takes per period, over the normal load",
    ),
    "phase": (
        "Velocity over position",
        ", of kept orbits, with their Poincaré points; where a loop runs along the belt speed, the body sticks",
    ),
    "time_series": ("Velocity and friction coefficient over one period", ", of kept orbits"),
    "velocity_harmonics": ("Amplitudes of the harmonics of the velocity", ", a picture each"),
    "friction_harmonics": ("Amplitudes of the harmonics of the friction coefficient", ", a picture each"),
}
"""Figures that only some tables have: what they show, and more of it for a caption."""
BIFURCATION = "Every state that motions end in, over belt speed"
MOST_OF_A_NAME = 24
"""Letters of a law in the axis of differences."""
MOST_UNASKED = 3
"""Figures that are drawn where no more are asked for."""
IN_SI = {made.column: name for name, made in SI.items() if made.scale != "load"}
IN_SHARES = {"mean_friction": "normalized_friction"}
"""Columns drawn in place of others where axes are shares."""
Drawer = Callable[[Heading], Figure]


class Kept(NamedTuple):
    """Tables beside that of a run: a reader of the orbits of rows, and harmonics.csv."""

    orbits: Callable[[Sequence[int]], pd.DataFrame | None]
    harmonics: pd.DataFrame | None


@dataclass(frozen=True, eq=False)
class FigureData:
    """Data of figures: a result table, and what else the same run has.

    curves: of ``curves.csv``, with the shapes; attractors, boundaries: of
    ``attractors.csv`` and ``boundaries.csv``. units: in which the numbers of a
    scene in SI units were written; tables given are then in these. words: for labels of laws and methods.
    v_lin: of inputs by their columns.
    """

    table: pd.DataFrame
    title: str = ""
    onsets: pd.DataFrame | None = None
    curves: pd.DataFrame | None = None
    attractors: pd.DataFrame | None = None
    boundaries: pd.DataFrame | None = None
    kept: Kept | None = None
    options: FigureOptions = USUAL_FIGURES
    units: Mapping[str, ShownUnit] = field(default_factory=dict)
    words: Mapping[str, Mapping[str, str]] = field(default_factory=dict)
    v_lin: Callable[[Mapping[str, float | str]], float] | None = None

    def __post_init__(self) -> None:
        """Tables into the units in which they are shown, and the words for laws and methods."""
        for name in ("table", "onsets", "curves", "attractors", "boundaries"):
            if (table := getattr(self, name)) is not None:
                object.__setattr__(self, name, self.shown(table))

    @classmethod
    def of(cls, study: Study, table: pd.DataFrame, title: str = "", **more: Any) -> FigureData:
        """Collect the data of a table of a study, and of what else of its run is given."""
        told: dict[str, Any] = {"options": study.figures, "units": study.units, "words": study.in_words}
        told["v_lin"] = None if study.links else partial(v_lin_of, study)
        return cls(table, title, **told | more)

    def shown(self, table: pd.DataFrame) -> pd.DataFrame:
        """A table of the run in the units in which it is shown, laws and methods in words."""
        return as_shown(table, self.units, self.words)

    @cached_property
    def family(self) -> Family | None:
        """Return the curves; None where no number is swept."""
        return family_of(self.table)

    @cached_property
    def maps(self) -> MapFigure | None:
        """Maps in place of curves; None where lines can tell them apart."""
        return map_of(self.table)

    @cached_property
    def shares(self) -> Family | None:
        """Return the curves in shares of V_lin and of steady sliding; None where they are not drawn so."""
        return normalized(self.family) if self.family and self.options.normalized else None

    def axes_of(self, name: str) -> tuple[list[str], list[str]]:
        """Return what one of ``FIGURES`` is drawn over, and which columns it shows."""
        if self.maps is not None:
            return [*self.maps.over], self.columns[name]
        family = self.shares or self.family
        assert family is not None
        shown = IN_SHARES if self.shares else {}
        return [family.abscissa], [shown.get(column, column) for column in self.columns[name]]

    def described(self, name: str) -> str:
        """Return what a figure shows, in words made from its axes."""
        if name in self.columns:
            over, shown = (map(plain_word, names) for names in self.axes_of(name))
            told = f"{', '.join(shown)} over {' and '.join(over)}"
            return f"{told[:1].upper()}{told[1:]}"
        told, _ = OTHER_FIGURES.get(name, (BIFURCATION, ""))
        family = self.shares or self.family
        shares = ", in shares of steady sliding friction," if self.shares else ""
        abscissa = plain_word(family.abscissa) if family else ""
        return told.format(reference=self.reference, shares=shares, abscissa=abscissa)

    def rank(self, name: str) -> tuple[bool, int]:
        """Place of a figure among others: first the one that shows what the title says, then the most telling."""
        kind = name.lstrip("0123456789").lstrip("_")
        return kind != self.options.finding, FIGURE_NAMES.index(kind)

    def heading(self, name: str, first: bool, into: Axes | None = None) -> Heading:
        """Return what stands above the pictures of a figure: the title where it is the first, else what it shows."""
        finds = first and bool(self.title)
        told = printable(self.title) if finds else self.described(name)
        return Heading(told if self.options.title else "", self.options.width, finds, into)

    @property
    def error_seen(self) -> bool:
        """Check whether the error of the mean could be seen beside the mean."""
        mean = self.table["mean_friction"]
        return bool((self.table["error"] > LEAST_VISIBLE * (mean.max() - mean.min())).any())

    @property
    def reference(self) -> str | None:
        """Return the law that others are held against; None where there is only one."""
        against = self.words.get("law", {}).get(self.options.against or "", self.options.against)
        return reference_law(self.family, against) if self.family else None

    @cached_property
    def columns(self) -> dict[str, list[str]]:
        """Return the columns that each of ``FIGURES`` shows, in SI units where the scene is; none without any."""
        shown = {}
        for name, wanted in FIGURES.items() if self.family else ():
            given = [self._shown.get(IN_SI.get(column, ""), column) for column in wanted]
            shown[name] = [column for column in given if self.table[column].notna().any()]
        return {name: columns for name, columns in shown.items() if columns}

    @cached_property
    def _shown(self) -> dict[str, str]:
        """Return the columns of the table by their names without the unit in which they are shown."""
        return by_plain_names(self.table)


def draw_figures(
    data: FigureData, folder: Path, told: Callable[[int, int], None] = lambda done, total: None
) -> list[Path]:
    """Draw the figures of a run into a folder, onsets marked along belt speed; the files written.

    told: called with the number of figures done and of all. A table without a sweep has no figure, nor has a quantity
    that applies nowhere. Raises OSError where the folder cannot be written.
    """
    found = chosen_of(data)
    if not found:
        return []
    folder.mkdir(parents=True, exist_ok=True)
    files = []
    with mpl.rc_context(STYLE), warnings.catch_warnings():
        warnings.filterwarnings("ignore", "Glyph .* missing from")  # of a title: an empty box says it
        for number, (name, draw) in enumerate(found.items()):
            told(number, len(found))
            files += write_figure(draw(), folder / name, data.options.formats)
    _remove_others(folder, files)
    return files


def _remove_others(folder: Path, files: Sequence[Path]) -> None:
    """Figures of an earlier drawing, with other options, would be shown beside those of this one."""
    known = [folder / f"{name}.{kind}" for name in [*FIGURES, *OTHER_FIGURES] for kind in FORMATS]
    for file in set(known) - set(files):
        file.unlink(missing_ok=True)


def figures_of(data: FigureData, into: Axes | None = None) -> dict[str, Callable[[], Figure]]:
    """Return what draws each figure of a run, by its name, the most telling first."""
    found = {} if data.family is None else _of_table(data, data.family)
    if data.kept is not None and data.family is not None:
        found |= orbit_figures(data.family, data.kept.orbits, data.units)
        if data.kept.harmonics is not None:
            found |= harmonic_figures(data.shown(data.kept.harmonics), data.options)
    if data.attractors is not None:
        found |= bifurcation_figures(data.attractors)
    ranked = sorted(found, key=data.rank)
    return {name: partial(found[name], data.heading(name, name == ranked[0], into)) for name in ranked}


def chosen_of(data: FigureData) -> dict[str, Callable[[], Figure]]:
    """Return those that are drawn: all where that is asked for, else the first and those that need asking."""
    found = figures_of(data)
    first = list(found)[:MOST_UNASKED]
    return {name: draw for name, draw in found.items() if data.options.all or name in {*first, "shape"}}


def figure_of(data: FigureData, name: str = "mean_friction", into: Axes | None = None) -> Figure:
    """One figure of a run, as ``draw_figures`` would write it; nothing is written, and pyplot knows nothing of it.

    into: axes to draw it into where it is one picture. Raises ValueError, with the names there are, where the run has
    no such figure, and where it has several pictures and axes are given.
    """
    if name == "shape":
        data = replace(data, options=data.options.model_copy(update={"shape": True}))
    found = figures_of(data, into)
    if name not in found:
        has = ", ".join(sorted(found)) if found else "none, for no number is swept"
        raise ValueError(f"no figure {name!r}; this table has: {has}")
    with mpl.rc_context(STYLE):
        figure = found[name]()
        figure.draw_without_rendering()  # ticks are made when first drawn, in the style of that moment
    return figure


def _of_table(data: FigureData, family: Family) -> dict[str, Drawer]:
    curves, maps = data.curves, data.maps
    words = {column: word(shown, 28) for column, shown in IN_SHARES.items()} if data.shares else {}
    of_speed = data.onsets if family.along_speed else None
    one = CurveFigure(data.shares or family, (), of_speed, data.options, words)
    found: dict[str, Drawer] = {}
    for name, columns in data.columns.items():
        if maps is not None:
            seen = name == "mean_friction" and data.error_seen
            found[name] = replace(
                maps, columns=[*columns, "error"] if seen else columns, v_lin=data.v_lin
            ).draw
        else:
            found[name] = replace(one, columns=columns).draw
    if maps is None and "mean_friction" in found and (compared := _difference_figure(one, data.reference)):
        found["differences"] = compared.draw
    if curves is None:
        return found
    if (data.options.shape or data.options.all) and (shapes := ShapeFigure.of(family, curves)):
        found["shape"] = shapes.draw
    if (measures := map_of_curves(curves)) is not None:
        found["map"] = replace(measures, boundaries=data.boundaries).draw
    return found


def _difference_figure(one: CurveFigure, law: str | None) -> CurveFigure | None:
    less = None if law is None else differences(one.family, law)
    if less is None or law is None:
        return None
    what = symbol("normalized_friction" if one.words else "mean_friction").strip("$")
    of = rf"({what})" if "/" in what else what
    name = re.sub(r"[^\w ,.()+-]|_", " ", law)[:MOST_OF_A_NAME]  # nothing that a formula reads as its own
    words = {"mean_friction": rf"${what} - {of}_\text{{{name}}}$"}
    return replace(one, family=less, columns=["mean_friction"], words=words, level=True)
