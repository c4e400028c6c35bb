"""A sheet of pictures: side by side, a title above them and a legend below.

What figures of every kind share: widths, text sizes, and the file in which a figure is written.
"""

from __future__ import annotations

import math
import re
import textwrap
from collections.abc import Sequence
from io import BytesIO
from pathlib import Path
from typing import Any, NamedTuple

import matplotlib as mpl
import numpy as np
from matplotlib.axes import Axes
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.figure import Figure, SubFigure
from matplotlib.lines import Line2D

from frictionlab.charts.sweeps import plain
from frictionlab.study.figure_options import WIDTHS

COLUMN, PAGE = (millimetres / 25.4 for millimetres in WIDTHS.values())
"""Widths of a journal's column and page [inch]."""
_FILE = mpl.rc_params_from_file(Path(__file__).with_name("frictionlab.mplstyle"), use_default_template=False)
STYLE: Any = {name: value for name, value in _FILE.items() if name != "axes.prop_cycle"}
"""Settings of ``plt.style.use("frictionlab.charts.frictionlab")`` without the looks of lines."""
CYCLE: list[dict[str, Any]] = list(_FILE["axes.prop_cycle"])
"""Colour and dashes of the first curve, the second, ..."""
_SAVED: dict[str, Any] = {
    "svg": {"metadata": {"Date": None}},
    # level 2 is a third quicker than the usual 6, its files an eighth larger
    "png": {"metadata": {"Software": None}, "pil_kwargs": {"compress_level": 2}},
    "pdf": {"metadata": {"CreationDate": None}},
}
_LONE_ACCENT = re.compile(">([\u0300-\u036f])<")
"""Bar or hat, a text of its own: before it goes a letter of no width, or viewers draw a dotted circle below it."""
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
            if file.suffix == ".svg":
                file.write_text(_LONE_ACCENT.sub(">\u200b\\1<", file.read_text("utf-8")), "utf-8")
    return files


PANEL_HEIGHT, LINE = 2.2, 0.16  # of a picture, and of a line of text around it [inch]
_HIGHEST = 235.0 / 25.4  # of a figure whose width is asked for [inch]
MOST_BELOW = 4  # pictures one below the other in a column of a journal
LEGEND_FONT = 7  # [point]
HANDLE = 3.5  # length of a sample of a line, long enough for its dashes [letter]
TYPED = {"V_lin": r"$V_\mathrm{lin}$", "Omega": "Ω"}
"""Symbols in titles, as studies type them."""
PICTURE_SHARE = 0.8  # of the room of a picture, about, that is inside its axes


class Heading(NamedTuple):
    """Title above the pictures of a figure, and the width that it is to have; as it needs where left out.

    finds: whether it says what was found, rather than what is shown. into: axes of somebody's own figure, which then
    keeps its size and has no title from here.
    """

    title: str = ""
    width: str | None = None
    finds: bool = False
    into: Axes | None = None


NO_HEADING = Heading()


class Sheet(NamedTuple):
    """Figure and how many pictures it has above each other and side by side. limited: to the height of a page."""

    figure: Figure
    high: int
    wide: int
    own: Axes | None = None
    limited: bool = False

    @classmethod
    def blank(
        cls,
        pictures: int,
        heading: Heading,
        entries: Sequence[Any] = (),
        about: str | None = None,
        height: float = PANEL_HEIGHT,
    ) -> Sheet:
        """With room for so many pictures of a height [inch]. entries: of the legend; about: its title.

        Raises ValueError where more than one is to be drawn into given axes.
        """
        if heading.into is not None:
            return cls._in(heading.into, pictures, entries, about)
        wide = abreast(pictures, heading)
        double = heading.width == "double" or (heading.width is None and wide == 2)
        high = -(-pictures // wide)
        figure = blank_figure(PAGE if double else COLUMN, high * height)
        figure.set_figheight(high * height + LINE * write_title(figure, heading))
        sheet = cls(figure, high, wide, limited=heading.width is not None)
        sheet.add_legend(entries, about)
        return sheet

    @classmethod
    def _in(cls, axes: Axes, pictures: int, entries: Sequence[Any], about: str | None) -> Sheet:
        if pictures > 1:
            raise ValueError(f"ax takes a figure of one picture, and this has {pictures}; leave ax out")
        figure = axes.get_figure(root=True)
        assert figure is not None
        sheet = cls(figure, 1, 1, axes)
        sheet.add_legend(entries, about)
        return sheet

    def add_legend(self, entries: Sequence[Any], about: str | None = None) -> None:
        """Below the pictures, with room of its own; inside axes that were given."""
        if self.own is not None:
            if entries:
                self.own.legend(handles=entries, title=about, handlelength=HANDLE)
            return
        lines = _add_legend(self.figure, entries, about)
        height = self.figure.get_figheight() + LINE * lines
        self.figure.set_figheight(min(height, _HIGHEST) if self.limited else height)

    def axes(self, place: int) -> Axes:
        """Return the axes of the picture at this place, from 0, row by row."""
        return self.own or self.figure.add_subplot(self.high, self.wide, place + 1)

    @property
    def picture_width(self) -> float:
        """Estimate the width of the inside of a picture [point]."""
        share = PICTURE_SHARE / self.wide if self.own is None else float(self.own.get_position().width)
        return share * 72 * self.figure.get_figwidth()

    def label_once(self, pictures: Sequence[Axes]) -> None:
        """Leave, of equal labels under each other or side by side, only the lowest and the first."""
        for at, axes in enumerate(pictures):
            below = at + self.wide
            if below < len(pictures) and pictures[below].get_xlabel() == axes.get_xlabel():
                axes.xaxis.label.set_visible(False)
            if at % self.wide and pictures[at - 1].get_ylabel() == axes.get_ylabel():
                axes.yaxis.label.set_visible(False)


def abreast(pictures: int, heading: Heading, rounds: int = 1) -> int:
    """Return how many pictures stand side by side. rounds: how often there are so many, one below the other."""
    return (1 if pictures * rounds <= MOST_BELOW else 2) if heading.width == "single" else min(2, pictures)


def write_title(figure: Figure, heading: Heading) -> int:
    """Write it above the pictures, what was found in bold; the lines it takes."""
    lines = textwrap.wrap(plain(heading.title), round(figure.get_figwidth() * 13))
    if lines:
        weight = "bold" if heading.finds else "normal"
        words = "\n".join(lines)
        for typed, symbol in TYPED.items():
            words = words.replace(typed, symbol)
        figure.suptitle(words, x=0.01, ha="left", fontsize=8, fontweight=weight)
    return len(lines)


def write_heading(axes: Axes, words: str, width: float, pad: float | None = None) -> None:
    """Write above a picture what it is of, in lines that fit its width [point]; pad: the room below it [point]."""
    size, lines = float(axes.title.get_fontsize()), [""]

    def fits(text: str) -> bool:
        return text_width(axes.figure, text, size) <= width

    parts = [part if fits(part) else part.replace(" $", "\n$", 1) for part in words.split(", ")]
    for part in parts:
        longer = f"{lines[-1]}, {part}" if lines[-1] else part
        lines = [*lines[:-1], longer] if not lines[-1] or fits(longer) else [*lines, part]
    axes.set_title(",\n".join(lines), loc="left", pad=pad)


def _add_legend(figure: Figure, entries: Sequence[Any], title: str | None) -> int:
    """Below the pictures, in as many columns as fit, its entries running down them; the lines it takes."""
    if not entries:
        return 0
    style, room = mpl.rcParams, 72 * figure.get_figwidth()
    around = LEGEND_FONT * (HANDLE + style["legend.handletextpad"] + style["legend.columnspacing"])
    widths = [around + text_width(figure, str(entry.get_label()), LEGEND_FONT) for entry in entries]
    counts = (math.ceil(len(entries) / lines) for lines in range(1, len(entries)))
    columns = next((n for n in counts if sum(map(max, np.array_split(widths, n))) <= room), 1)
    figure.legend(
        handles=entries, loc="outside lower center", ncols=columns, title=title, handlelength=HANDLE
    )
    return math.ceil(len(entries) / columns) + (title is not None)


def text_width(figure: Figure | SubFigure, text: str, size: float) -> float:
    """Estimate the width of a line of text in a font of this size [point]."""
    drawn = figure.text(0.0, 0.0, text, fontsize=size)
    pixels = drawn.get_window_extent().width
    drawn.remove()
    return float(72.0 * pixels / figure.dpi)


def scale_alike(pictures: Sequence[Axes], most: float = math.inf) -> None:
    """One scale for pictures of one quantity, where no range is so many times another."""
    ranges = [axes.get_ylim() for axes in pictures]
    heights = [high - low for low, high in ranges]
    linear = all(axes.get_yscale() == "linear" for axes in pictures)
    if ranges and linear and max(heights) < most * min(heights):
        for axes in pictures:
            axes.set_ylim(min(low for low, _ in ranges), max(high for _, high in ranges))


def part_told(shown: int, total: int, what: str) -> list[Line2D]:
    """An entry of the legend that says how many of all are drawn; nothing where all are."""
    return [Line2D([], [], linestyle="none", label=f"{shown} of {total} {what}")] if shown < total else []
