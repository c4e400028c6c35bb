"""Shape of curves: each with its chord, the area between them and the verdict in words."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any, NamedTuple

import numpy as np
import pandas as pd
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from frictionlab.charts.curves import CurveData, Family, drawn_once
from frictionlab.charts.looks import Looks
from frictionlab.charts.sheet import NO_HEADING, Heading, Sheet, part_told
from frictionlab.charts.sweeps import BESIDE, headings, shortened, some_of
from frictionlab.values.columns import CURVES, is_belt_speed, word
from frictionlab.values.printable import with_error

MOST_SHAPES = 12
SHADE = "0.5"
CHORD_LOOK: Any = {"color": "0.2", "linewidth": 0.7, "linestyle": (0, (5, 2))}


class Chord(NamedTuple):
    """Shape of a curve: its ends in the units of the axes, and the verdict with what it was made of."""

    end: float
    low: float
    high: float
    sentence: str


@dataclass(frozen=True)
class ShapeFigure:
    """Curves and their chords, some of many. left_out: how many are not drawn."""

    family: Family
    chosen: Sequence[tuple[CurveData, Chord]]
    looks: Looks
    left_out: int = 0

    @classmethod
    def of(cls, family: Family, curves: pd.DataFrame) -> ShapeFigure | None:
        """Collect what the figure of a table shows; None where no curve has a verdict. curves: of ``curves.csv``."""
        if not is_belt_speed(family.abscissa) or "shape_start" not in curves:
            return None
        looks = Looks(drawn_once(family.curves, ["mean_friction"]))
        chords = [(curve, chord_of(curve, curves, family.abscissa)) for curve in looks.curves]
        found = [(curve, chord) for curve, chord in chords if chord is not None]
        chosen = some_of(found, MOST_SHAPES)
        return cls(family, chosen, looks, len(found) - len(chosen)) if chosen else None

    def draw(self, heading: Heading = NO_HEADING) -> Figure:
        """Return the figure, with matplotlib's settings as they are."""
        told = part_told(len(self.chosen), len(self.chosen) + self.left_out, "curves")
        sheet = Sheet.blank(len(self.chosen), heading, told)
        settings = [(*curve.panel, *([curve.member] if curve.member else [])) for curve, _ in self.chosen]
        for place, ((curve, chord), same) in enumerate(zip(self.chosen, headings(settings), strict=True)):
            axes = sheet.axes(place)
            self._draw(axes, curve, chord)
            name = ", ".join([*self._names(curve), *([same] if same else [])])
            axes.set_title(f"{name}\n{chord.sentence}", loc="left")
        sheet.label_once(sheet.figure.axes)
        return sheet.figure

    def _draw(self, axes: Axes, curve: CurveData, chord: Chord) -> None:
        x, y = curve.column(self.family.abscissa), curve.column("mean_friction")
        inside = np.isfinite(y) & (x > 0.0) & (x < chord.end)
        at = np.concatenate([[0.0], x[inside], [chord.end]])
        under = chord.low + (chord.high - chord.low) * at / chord.end
        over = np.concatenate([[chord.low], y[inside], [chord.high]])
        axes.fill_between(at, under, over, color=SHADE, alpha=0.3, linewidth=0)
        axes.plot([0.0, chord.end], [chord.low, chord.high], **CHORD_LOOK)
        axes.plot(x, y, **self.looks.sample(curve))
        # two lines of title leave less height
        axes.set(xlabel=self.family.word(self.family.abscissa), ylabel=word("mean_friction", 16))
        axes.margins(x=0.02)
        axes.set_ylim(min(0.0, axes.get_ylim()[0]), None)

    def _names(self, curve: CurveData) -> list[str]:
        several = len({each.method for each in self.looks.curves}) > 1
        names = [curve.law] * (("law", curve.law) not in curve.panel) + [curve.method] * several
        return [shortened(name, BESIDE) for name in names]


def chord_of(curve: CurveData, curves: pd.DataFrame, speed: str) -> Chord | None:
    """Chord that a curve's shape was judged against; None without a verdict. speed: the column along the axis."""
    found = curve.rows_in(curves, CURVES)
    if len(found) != 1 or found["shape"].isna().any():
        return None
    row = found.iloc[0]
    end = float(row["reversal_end"]) * curve.speed_scale()
    known = curve.rows[curve.rows["mean_friction"].notna()]
    # at the end itself, where points lie on either side of the kink, no straight line between them finds it
    high = float(np.interp(0.5 * end, known[speed], known["mean_friction"])) / float(row["shape_half"])
    area = with_error(row["shape_area"], row["shape_area_error"]).replace("-", "\N{MINUS SIGN}")
    return Chord(end, float(row["shape_start"]), high, f"{row['shape']}: area {area}")
