"""What a figure shows to who looks at it, and tables to draw figures of."""

from __future__ import annotations

from typing import Any

import matplotlib as mpl
import numpy as np
import pandas as pd
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.text import Annotation

from frictionlab.charts.figures import FigureData, figures_of
from frictionlab.charts.sheet import STYLE
from frictionlab.values.columns import RESULTS, TEXT

Curve = tuple[np.ndarray, np.ndarray]
NOTHING = dict.fromkeys((name for name in RESULTS if name not in TEXT), np.nan)
"""The result columns of a row that has no number."""


def drawn(table: pd.DataFrame, name: str = "mean_friction", **given: Any) -> Figure:
    """One figure of a table, and of what else of its run is given."""
    with mpl.rc_context(STYLE):
        return figures_of(FigureData(table, "A title", **given))[name]()


def legend_of(figure: Figure) -> list[str]:
    """Its lines."""
    return [text.get_text() for legend in figure.legends for text in legend.get_texts()]


def titles_of(figure: Figure) -> list[str]:
    """Those of its pictures."""
    return [axes.get_title(loc="left") for axes in figure.axes]


def curves_of(axes: Axes) -> list[Curve]:
    """The lines of more than two points."""
    return [_data(line) for line in axes.lines if len(line.get_xdata()) > 2]


def names_above(axes: Axes) -> dict[float, str]:
    """What is named above a picture, by its place on the axis."""
    notes = [text for text in axes.texts if isinstance(text, Annotation) and text.arrow_patch is None]
    return {text.xy[0]: text.get_text() for text in notes}


def names_of(figure: Figure) -> list[str]:
    """Of its curves, at the ends of those of the first picture or in the legend."""
    notes = [
        text for text in figure.axes[0].texts if isinstance(text, Annotation) and text.arrow_patch is not None
    ]
    return [text.get_text() for text in notes] or legend_of(figure)


def _data(line: Any) -> Curve:
    return np.asarray(line.get_xdata()), np.asarray(line.get_ydata(), dtype=float)
