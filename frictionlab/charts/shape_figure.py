"""The shape of curves: each with its chord, the area between them and the verdict in words."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
import pandas as pd
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from frictionlab.charts.curves import CurveData, Family, drawn_once, some_of
from frictionlab.charts.looks import Looks
from frictionlab.charts.onsets import rows_of_curve, speed_scale
from frictionlab.charts.style import LINE, PANEL_HEIGHT, blank_figure, page_of
from frictionlab.charts.words import BESIDE, label_once, sentence, shortened, write_title
from frictionlab.columns import BELT_SPEEDS, CURVES, word
from frictionlab.printable import with_error
from frictionlab.study.figure_options import FigureOptions

MOST_SHAPES = 12
SHADE = "0.5"


class Chord(NamedTuple):
    """Of a curve: its ends in the units of the axes, the area with its error, the verdict."""

    end: float
    low: float
    high: float
    area: float
    error: float
    verdict: str

    @property
    def sentence(self) -> str:
        """The verdict and what it was made of."""
        area = with_error(self.area, self.error).replace("-", "\N{MINUS SIGN}")
        return f"{self.verdict}: area {area}"


@dataclass(frozen=True)
class ShapeFigure:
    """Curves and their chords, some of many. left_out: how many are not drawn."""

    family: Family
    chosen: Sequence[tuple[CurveData, Chord]]
    looks: Looks
    title: str
    options: FigureOptions
    left_out: int = 0

    @classmethod
    def of(
        cls, family: Family, curves: pd.DataFrame, title: str, options: FigureOptions
    ) -> ShapeFigure | None:
        """That of a table; None where no curve has a verdict. curves: of ``curves.csv``."""
        if family.abscissa not in BELT_SPEEDS or "shape_start" not in curves:
            return None
        looks = Looks(drawn_once(family.curves, ["mean_friction"]))
        found = [
            (curve, chord) for curve in looks.curves if (chord := chord_of(curve, curves, family.abscissa))
        ]
        if not found:
            return None
        chosen = some_of(found, MOST_SHAPES)
        return cls(family, chosen, looks, title, options, len(found) - len(chosen))

    def draw(self) -> Figure:
        """The figure, with matplotlib's settings as they are."""
        width, wide = page_of(len(self.chosen), self.options.width)
        high = -(-len(self.chosen) // wide)
        figure = blank_figure(width, high * PANEL_HEIGHT)
        above = write_title(figure, self.title if self.options.title else "")
        if self.left_out:
            said = f"{len(self.chosen)} of {len(self.chosen) + self.left_out} curves"
            figure.supxlabel(said, fontsize=7, color="0.3")
        figure.set_figheight(high * PANEL_HEIGHT + LINE * (above + (self.left_out > 0)))
        for place, (curve, chord) in enumerate(self.chosen, start=1):
            self._draw(figure.add_subplot(high, wide, place), curve, chord)
        label_once(figure.axes, wide)
        return figure

    def _draw(self, axes: Axes, curve: CurveData, chord: Chord) -> None:
        x, y = (curve.rows[name].to_numpy(dtype=float) for name in (self.family.abscissa, "mean_friction"))
        inside = np.isfinite(y) & (x > 0.0) & (x < chord.end)
        at = np.concatenate([[0.0], x[inside], [chord.end]])
        under = chord.low + (chord.high - chord.low) * at / chord.end
        over = np.concatenate([[chord.low], y[inside], [chord.high]])
        axes.fill_between(at, under, over, color=SHADE, alpha=0.3, linewidth=0)
        axes.plot(
            [0.0, chord.end], [chord.low, chord.high], color="0.2", linewidth=0.7, linestyle=(0, (5, 2))
        )
        axes.plot(x, y, **self.looks.sample(curve))
        axes.set_xlabel(self.family.word(self.family.abscissa))
        axes.set_ylabel(word("mean_friction", 16))  # two lines of title leave less height
        axes.margins(x=0.02)
        axes.set_ylim(min(0.0, axes.get_ylim()[0]), None)
        settings = [sentence(each) for each in (*curve.panel, *([curve.member] if curve.member else []))]
        names = [shortened(curve.law, BESIDE)] if ("law", curve.law) not in curve.panel else []
        several = len({each.method for each in self.looks.curves}) > 1
        names += [shortened(curve.method, BESIDE)] if several else []
        axes.set_title("\n".join([", ".join(names + settings), chord.sentence]), loc="left")


def chord_of(curve: CurveData, curves: pd.DataFrame, speed: str) -> Chord | None:
    """The chord that a curve's shape was judged against; None without a verdict. speed: the column along the axis."""
    found = rows_of_curve(curve, curves, CURVES)
    if len(found) != 1 or found["shape"].isna().any():
        return None
    row = found.iloc[0]
    end = float(row["reversal_end"]) * speed_scale(curve)
    known = curve.rows[curve.rows["mean_friction"].notna()]
    # at the end itself, where points lie on either side of the kink, no straight line between them finds it
    high = float(np.interp(0.5 * end, known[speed], known["mean_friction"])) / float(row["shape_half"])
    area, error = float(row["shape_area"]), float(row["shape_area_error"])
    return Chord(end, float(row["shape_start"]), high, area, error, str(row["shape"]))
