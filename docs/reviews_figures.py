"""Laws of the reviews on the scenes of the paper: ``python docs/reviews_figures.py``.

Runs two studies of studies/reviews, writes the two figures of docs/reviews.md, and prints its table: how far from
Coulomb's the curves of each law lie, and what a point costs. About two minutes, and more for kernels on a machine
that has none.
"""

from __future__ import annotations

import time
from collections.abc import Mapping
from pathlib import Path
from typing import Any

import matplotlib as mpl
import numpy as np
import pandas as pd
from matplotlib.lines import Line2D

import frictionlab as fl
from frictionlab.charts.sheet import CYCLE, NO_HEADING, STYLE, Sheet, write_figure
from frictionlab.study.load import load_study

FIGURES = Path(__file__).parent / "figures"
STUDIES = Path(__file__).parents[1] / "studies" / "reviews"
LOAD, FREQUENCY, ACROSS, SPEED = (
    f"scene.{name}"
    for name in ("normal_load", "drive.frequency", "transverse.natural_frequency", "belt_speed")
)
MU = 0.4
ALONG = {
    "load along, Ω 1, friction 0.04 of the load": {LOAD: 1, FREQUENCY: 1},
    "Ω 1, friction 0.4 of the load": {LOAD: 10, FREQUENCY: 1},
    "Ω 1.5, 0.18 of the load": {LOAD: 10, FREQUENCY: 1.5},
    "Ω 4, 0.025 of the load": {LOAD: 10, FREQUENCY: 4},
}
BOTH = {
    "loads along and across, resonant both ways": {FREQUENCY: 1, ACROSS: 1},
    "resonant along": {FREQUENCY: 1, ACROSS: 4},
    "resonant across": {FREQUENCY: 4, ACROSS: 4},
    "resonant neither way": {FREQUENCY: 4, ACROSS: 1},
}
DRAWN = "coulomb", "threlfall", "ambrosio", "dahl", "elasto-plastic", "bliman-sorine", "gonthier"
"""Laws whose curves are drawn; those of the others lie between."""


def at(table: pd.DataFrame, where: Mapping[str, float]) -> pd.DataFrame:
    """Rows with these values."""
    for name, value in where.items():
        table = table[np.isclose(table[name], value)]
    return table


def distances(table: pd.DataFrame, where: Mapping[str, float]) -> dict[str, float]:
    """Largest distance of each law from Coulomb's, over mu."""
    means = at(table, where).pivot(index=SPEED, columns="law", values="mean_friction")
    apart = means.sub(means["coulomb"], axis=0).abs().max() / MU
    return {str(law): float(value) for law, value in apart.items()}


def draw_curves(along: pd.DataFrame, both: pd.DataFrame, words: Mapping[str, str]) -> None:
    """Curves of some laws in four scenes."""
    looks: dict[str, Any] = dict(zip(DRAWN, CYCLE, strict=False))
    pictures = [(along, title, ALONG[title]) for title in [*ALONG][1:]] + [(both, *next(iter(BOTH.items())))]
    with mpl.rc_context(STYLE):
        entries = [Line2D([], [], label=words[law], **looks[law]) for law in DRAWN]
        sheet = Sheet.blank(len(pictures), NO_HEADING, entries)
        for place, (table, title, where) in enumerate(pictures):
            axes = sheet.axes(place)
            for law in DRAWN:
                rows = at(table, where)
                rows = rows[rows["law"] == law].sort_values(SPEED)
                axes.plot(rows[SPEED], rows["mean_friction"], **looks[law])
            axes.set(xlabel="belt speed", ylabel="mean friction coefficient", ylim=(0, 0.42))
            axes.set_title(title, loc="left")
    write_figure(sheet.figure, FIGURES / "reviews_curves", ("svg",))


def draw_areas(
    curves: Mapping[str, tuple[pd.DataFrame, Mapping[str, float]]], words: Mapping[str, str]
) -> None:
    """Area between each curve and its chord, scene by scene: concave to the right, convex to the left."""
    judged = {law for table, _ in curves.values() for law in table.loc[table["shape"].notna(), "law"]}
    laws = [law for law in words if law in judged][::-1]
    with mpl.rc_context(STYLE):
        sheet = Sheet.blank(
            1,
            NO_HEADING,
            [
                Line2D([], [], label=name, ls="none", marker=mark, color=color)
                for name, mark, color in zip(
                    curves, "osD^v<>P", [each["color"] for each in CYCLE] * 2, strict=False
                )
            ],
        )
        axes = sheet.axes(0)
        for (table, where), mark, color in zip(
            curves.values(), "osD^v<>P", [each["color"] for each in CYCLE] * 2, strict=False
        ):
            found = at(table, where).set_index("law")["shape_area"].reindex(laws)
            axes.plot(found, range(len(laws)), ls="none", marker=mark, color=color, markersize=4)
        axes.axvline(0, color="0.4", linewidth=0.6)
        axes.set_yticks(range(len(laws)), [words[law] for law in laws])
        axes.set_xlabel("area between curve and chord")
    write_figure(sheet.figure, FIGURES / "reviews_shapes", ("svg",))


def milliseconds(scene: fl.Scene, law: fl.FrictionLaw) -> float:
    """Processor time of a point of a curve of 60 at an error of 1e-6, kernels made before."""
    speeds = np.linspace(1, 60, 60)
    fl.curve(scene, law, speeds[::6], tolerance=1e-6)
    took = []
    for _ in range(3):
        begun = time.process_time()
        fl.curve(scene, law, speeds, tolerance=1e-6)
        took.append(time.process_time() - begun)
    return 1e3 * min(took) / len(speeds)


def main() -> None:
    """Run the studies, write figures, print the table."""
    done = {name: fl.run(load_study(STUDIES / f"paper_{name}.yaml")) for name in ("along", "across")}
    study, words = done["along"].study, done["along"].study.in_words["law"]
    tables = {name: run.table for name, run in done.items()}
    draw_curves(tables["along"], tables["across"], words)
    scenes = {title: (done["along"].curves, where) for title, where in ALONG.items()}
    scenes |= {title: (done["across"].curves, where) for title, where in BOTH.items()}
    draw_areas(scenes, words)
    apart = [distances(tables["along"], where) for where in ALONG.values()]
    apart += [distances(tables["across"], where) for where in BOTH.values()]
    for choice in study.laws:
        law = choice.law()
        cost = milliseconds(study.scene, law)
        print(
            f"| {words[choice.label]} | {' | '.join(f'{each[choice.label]:.3f}' for each in apart)} | {cost:.2g} |"
        )


if __name__ == "__main__":
    main()
