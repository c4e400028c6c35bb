"""What figures of every kind share: widths, text sizes, and the file in which a figure is written."""

from __future__ import annotations

from collections.abc import Sequence
from io import BytesIO
from pathlib import Path
from typing import Any

import matplotlib as mpl
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.figure import Figure

from frictionlab.study.figure_options import WIDTHS

COLUMN, PAGE = (millimetres / 25.4 for millimetres in WIDTHS.values())
"""Widths of a journal's column and page [inch]."""
_FILE = mpl.rc_params_from_file(Path(__file__).with_name("frictionlab.mplstyle"), use_default_template=False)
STYLE: Any = {name: value for name, value in _FILE.items() if name != "axes.prop_cycle"}
"""Of ``plt.style.use("frictionlab.charts.frictionlab")``, too, but for the looks of lines."""
CYCLE: list[dict[str, Any]] = list(_FILE["axes.prop_cycle"])
"""Colour and dashes of the first curve, the second, ..."""
_SAVED: dict[str, Any] = {
    "svg": {"metadata": {"Date": None}},
    # level 2 is a third quicker than the usual 6, its files an eighth larger
    "png": {"metadata": {"Software": None}, "pil_kwargs": {"compress_level": 2}},
    "pdf": {"metadata": {"CreationDate": None}},
}
NOTEBOOK_DPI = 200


class NotebookFigure(Figure):
    """A figure that a notebook shows by itself, though pyplot knows nothing of it."""

    def _repr_png_(self) -> bytes:
        drawn = BytesIO()
        with mpl.rc_context(STYLE):
            self.savefig(drawn, format="png", dpi=NOTEBOOK_DPI)
        return drawn.getvalue()


def blank_figure(width: float, height: float) -> Figure:
    """A figure of this size [inch], without pictures."""
    figure = NotebookFigure(figsize=(width, height), layout="constrained", dpi=STYLE["savefig.dpi"])
    FigureCanvasAgg(figure)
    return figure


def write_figure(figure: Figure, path: Path, formats: Sequence[str] = ("svg", "png")) -> list[Path]:
    """Write a figure as a drawing and as pixels, laid out once for all files; the files. Raises OSError."""
    if layout := figure.get_layout_engine():
        layout.execute(figure)
    files = [path.with_suffix(f".{each}") for each in formats]
    with mpl.rc_context({"figure.constrained_layout.use": False}):
        figure.set_layout_engine(None)
        for file in files:
            figure.savefig(file, **_SAVED[file.suffix[1:]])
    return files
