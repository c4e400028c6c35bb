"""Draw the figure of docs/atlas.md from where ``run studies/atlas`` wrote: ``python docs/atlas_figures.py RUNS``."""

from __future__ import annotations

import sys
from pathlib import Path
from typing import Any, NamedTuple

import matplotlib.pyplot as plt
import numpy as np
import pandas as pd
from matplotlib.axes import Axes
from matplotlib.colors import ListedColormap
from matplotlib.lines import Line2D
from matplotlib.patches import Patch

from frictionlab.charts.maps import cell_edges
from frictionlab.charts.sheet import write_figure

FIGURES = Path(__file__).parent / "figures"
LAWS = {
    "coulomb": "Coulomb",
    "stribeck": "Stribeck",
    "lugre": "LuGre, damped",
    "dahl": "Dahl",
    "elasto-plastic": "elasto-plastic",
    "jenkins": "Jenkins",
}
SHAPES = {"convex": "#9ecae1", "mixed": "#e3e3dc", "undecided": "#ffffff", "concave": "#f4a582"}
FREQUENCY = "scene.drive.frequency"


WEAKEST_DAHL = 0.472
"""Presliding length over amplitude at which a Dahl contact under prescribed slip has an area of zero."""
LINE: Any = {"color": "#7f0f26", "linewidth": 1.6, "linestyle": "solid"}


class Atlas(NamedTuple):
    """A study, and the number beside the drive's frequency that its maps are over: its words and what scales it."""

    study: str
    over: str
    words: str
    scale: float = 1.0
    log: bool = False


ATLASES = (
    Atlas("frequency_and_friction", "scene.normal_load", "friction over load", 0.04),
    Atlas("contact_stiffness", "law.contact_stiffness", "contact over spring stiffness", log=True),
    Atlas("transverse_stiffness", "scene.transverse.natural_frequency", r"natural frequency across"),
    Atlas("direction", "scene.drive.direction", "direction of the drive [deg]"),
)


def table(runs: Path, atlas: Atlas, name: str) -> pd.DataFrame:
    """A table of the run of a study."""
    return pd.read_csv(runs / atlas.study / f"{name}.csv")


def draw_panel(axes: Axes, atlas: Atlas, curves: pd.DataFrame, lines: pd.DataFrame) -> None:
    """The shapes of the curves of one law, and the lines on which the area over the chord is zero."""
    order = [*SHAPES]
    grid = curves.pivot(index=atlas.over, columns=FREQUENCY, values="shape")
    colours = ListedColormap([SHAPES[name] for name in order])
    known = grid.map(lambda name: order.index(name) if name in SHAPES else np.nan).to_numpy(dtype=float)
    edges = cell_edges(grid.columns.to_numpy()), cell_edges(grid.index.to_numpy()) * atlas.scale
    look: Any = {"cmap": colours, "vmin": -0.5, "vmax": len(order) - 0.5, "rasterized": True}
    axes.pcolormesh(*edges, np.ma.masked_invalid(known), **look)
    for _, line in lines.groupby("piece"):
        axes.plot(line[FREQUENCY], line[atlas.over] * atlas.scale, **LINE)
    axes.set_yscale("log" if atlas.log else "linear")
    axes.set(xlim=edges[0][[0, -1]], ylim=edges[1][[0, -1]])


def draw_weak_friction(axes: Axes, friction: float, load: float, damping: float) -> None:
    """The line of a Dahl contact of so little friction that the body moves as if there were none."""
    frequency = np.linspace(*axes.get_xlim(), 200)
    amplitude = load / np.abs(1.0 - frequency**2 + 2j * damping * frequency)
    axes.plot(
        frequency, friction / (WEAKEST_DAHL * amplitude), **LINE | {"linestyle": "dashed", "linewidth": 1.0}
    )


def draw_row(row: list[Axes], runs: Path, atlas: Atlas) -> None:
    """A panel for each law."""
    curves, lines = table(runs, atlas, "curves"), table(runs, atlas, "boundaries")
    first = True
    for axes, (law, words) in zip(row, LAWS.items(), strict=True):
        own = curves[curves["law"] == law]
        axes.set_visible(not own.empty)
        if own.empty:
            continue
        draw_panel(axes, atlas, own, lines[(lines["law"] == law) & (lines["measure"] == "shape_area")])
        axes.set_title(words, loc="left")
        axes.set_xlabel(r"drive frequency $\Omega$")
        axes.set_ylabel(atlas.words if first else "")
        first = False
        if atlas.over == "law.contact_stiffness" and law == "dahl":
            draw_weak_friction(axes, 2.0, 10.0, 0.1)


def main(runs: Path) -> None:
    """A row for each atlas, written as SVG."""
    plt.style.use("frictionlab.charts.frictionlab")
    figure, axes = plt.subplots(len(ATLASES), len(LAWS), figsize=(11.0, 8.6), layout="constrained")
    for row, atlas in zip(axes, ATLASES, strict=True):
        draw_row([*row], runs, atlas)
    look: Any = {"edgecolor": "0.4", "linewidth": 0.5}
    entries = [Patch(facecolor=colour, label=shape, **look) for shape, colour in SHAPES.items()]
    entries.append(
        Line2D([], [], color="#7f0f26", linewidth=1.6, label="area over the chord zero, solved for")
    )
    figure.legend(handles=entries, loc="outside upper left", ncols=len(entries))
    write_figure(figure, FIGURES / "atlas", ("svg",))


if __name__ == "__main__":
    main(Path(sys.argv[1]))
