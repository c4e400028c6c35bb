"""The figures of a result table, for the page of a journal, each written in the formats asked for."""

from __future__ import annotations

import warnings
from collections.abc import Callable, Sequence
from dataclasses import replace
from pathlib import Path
from typing import NamedTuple

import matplotlib as mpl
import pandas as pd
from matplotlib.figure import Figure

from frictionlab.charts.bifurcation import bifurcation_figures
from frictionlab.charts.curve_figure import CurveFigure
from frictionlab.charts.curves import Family, family_of
from frictionlab.charts.derived import differences, is_along_speed, normalized, reference_law
from frictionlab.charts.harmonics import harmonic_figures
from frictionlab.charts.maps import map_of, map_of_curves
from frictionlab.charts.orbit_figures import orbit_figures
from frictionlab.charts.shape_figure import ShapeFigure
from frictionlab.charts.style import STYLE, write_figure
from frictionlab.charts.words import plain
from frictionlab.columns import SI
from frictionlab.printable import printable
from frictionlab.study.figure_options import FORMATS, USUAL_FIGURES, FigureOptions

FIGURES = {
    "mean_friction": ["mean_friction"],
    "velocity": ["velocity_amplitude", "transverse_velocity_amplitude"],
    "energies": ["energy_input", "energy_viscous", "energy_friction", "energy_contact"],
}
OTHER_FIGURES = {
    "differences": "Mean friction of each law less that of {reference}, with the sum of both errors as a band",
    "map": "Measures of the curves over what else is swept: shades with lines of equal value",
    "shape": "Each curve with its chord from rest to the end of reversal; the shaded area decides the verdict",
    "hysteresis": "Friction coefficient over position of kept orbits: the area of a loop is what friction takes "
    "per period, over the normal load",
    "phase": "Velocity over position of kept orbits, with their Poincaré points; where a loop runs along the line of "
    "belt speed, the body sticks",
    "time_series": "Velocity and friction coefficient of kept orbits over one period",
    "velocity_harmonics": "Amplitudes of the harmonics of the velocity, a picture each",
    "friction_harmonics": "Amplitudes of the harmonics of the friction coefficient, a picture each",
}
"""Those that only some tables have, and what they show."""
IN_SI = {made.column: name for name, made in SI.items() if made.scale != "load"}
IN_SHARES = {"mean_friction": "mean friction over steady\nsliding friction " + r"$\bar\mu/\mu$"}


class Kept(NamedTuple):
    """What a run kept beside its table: what reads the orbits of rows, and harmonics.csv."""

    orbits: Callable[[Sequence[int]], pd.DataFrame | None]
    harmonics: pd.DataFrame | None


class FigureData(NamedTuple):
    """What figures are drawn of: a result table, and of the same run what there is of the rest.

    curves: of ``curves.csv``, with the shapes; attractors: of ``attractors.csv``.
    """

    table: pd.DataFrame
    title: str = ""
    onsets: pd.DataFrame | None = None
    curves: pd.DataFrame | None = None
    attractors: pd.DataFrame | None = None
    kept: Kept | None = None
    options: FigureOptions = USUAL_FIGURES


def draw_figures(
    data: FigureData, folder: Path, told: Callable[[int, int], None] = lambda done, total: None
) -> list[Path]:
    """Draw every figure of a run into a folder, onsets marked along belt speed; the files written.

    told: called with the number of figures done and of all. A table without a sweep has no figure, nor has a quantity
    that applies nowhere. Raises OSError where the folder cannot be written.
    """
    found = figures_of(data)
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


def figures_of(data: FigureData) -> dict[str, Callable[[], Figure]]:
    """What draws each figure of a run, by its name."""
    title = printable(data.title)
    several = {} if data.attractors is None else bifurcation_figures(data.attractors, title)
    family = family_of(data.table)
    if family is None:
        return several
    found = _of_table(family, data._replace(title=title))
    if data.kept is None:
        return found | several
    if (loops := orbit_figures(family, data.kept.orbits, title, data.options)) is not None:
        found |= loops.figures()
    if data.kept.harmonics is not None:
        found |= harmonic_figures(data.kept.harmonics, title, data.options)
    return found | several


def figure_of(data: FigureData, name: str = "mean_friction") -> Figure:
    """One figure of a run, as ``draw_figures`` would write it; nothing is written, and pyplot knows nothing of it.

    Raises ValueError, with the names there are, where the run has no such figure.
    """
    if name == "shape":
        data = data._replace(options=data.options.model_copy(update={"shape": True}))
    found = figures_of(data)
    if name not in found:
        has = ", ".join(sorted(found)) if found else "none, for no number is swept"
        raise ValueError(f"no figure {name!r}; this table has: {has}")
    with mpl.rc_context(STYLE):
        figure = found[name]()
        figure.draw_without_rendering()  # ticks are made when first drawn, in the style of that moment
    return figure


def _of_table(family: Family, data: FigureData) -> dict[str, Callable[[], Figure]]:
    table, title, curves, options = data.table, data.title, data.curves, data.options
    of_speed = data.onsets if is_along_speed(family) else None
    shares = normalized(family) if options.normalized else None
    one = CurveFigure(shares or family, (), title, of_speed, options, IN_SHARES if shares else {})
    maps = map_of(table)
    found: dict[str, Callable[[], Figure]] = {}
    for name, columns in figure_columns(table).items():
        of_mean = name == "mean_friction"
        if maps is not None:
            shown = [*columns, "error"] if of_mean else columns
            found[name] = replace(maps, columns=shown, title=title, options=options).draw
        else:
            found[name] = replace(one, columns=columns, words=one.words if of_mean else {}).draw
    compared = _difference_figure(one) if maps is None else None
    if compared is not None and "mean_friction" in found:
        found["differences"] = compared.draw
    if options.shape and curves is not None and (shapes := ShapeFigure.of(family, curves, title, options)):
        found["shape"] = shapes.draw
    if curves is not None and (measures := map_of_curves(curves)) is not None:
        found["map"] = replace(measures, title=title, options=options).draw
    return found


def _difference_figure(one: CurveFigure) -> CurveFigure | None:
    law = reference_law(one.family, one.options.against)
    less = None if law is None else differences(one.family, law)
    if less is None or law is None:
        return None
    what = r"$\bar\mu/\mu$" if one.words else r"$\bar\mu$"
    words = {"mean_friction": f"{what} less that of\n{plain(law)}"}
    options = one.options.model_copy(update={"inset": False})
    return replace(one, family=less, columns=["mean_friction"], options=options, words=words, level=True)


def figure_columns(table: pd.DataFrame) -> dict[str, list[str]]:
    """The columns that each figure of a table shows; a figure without any is not there."""
    shown = {
        name: [column for column in _as_given(wanted, table) if table[column].notna().any()]
        for name, wanted in FIGURES.items()
    }
    return {name: columns for name, columns in shown.items() if columns}


def _as_given(columns: Sequence[str], table: pd.DataFrame) -> list[str]:
    """Velocities and energies in SI units where the scene is."""
    return [IN_SI[column] if IN_SI.get(column) in table else column for column in columns]
