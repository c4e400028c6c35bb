"""Values, labels and the title of a study as figures write them."""

from __future__ import annotations

import textwrap
from collections.abc import Sequence

from matplotlib.axes import Axes
from matplotlib.figure import Figure

from frictionlab.charts.curves import SweptValue
from frictionlab.columns import word

LONGEST_LABEL, BESIDE = 36, 22  # letters of a name alone, and beside another name or a count


def plain(text: str) -> str:
    """Words of the study: a dollar sign in them is one, and begins no formula."""
    return text.replace("$", r"\$")


def shortened(label: str, room: int) -> str:
    """A label of the study, as many letters of it as there is room for."""
    return plain(label if len(label) <= room else f"{label[: room - 1]}…")


def swept_text(value: float | str | None) -> str:
    """A swept value."""
    return shortened(value, LONGEST_LABEL) if isinstance(value, str) else f"{value:.5g}"


def sentence(setting: SweptValue) -> str:
    """The title of a picture: what is the same along its curves."""
    name, value = setting
    if name == "law":
        return swept_text(value)
    return f"no {word(name)}" if value is None else f"{word(name)} = {swept_text(value)}"


def label_once(pictures: Sequence[Axes], abreast: int) -> None:
    """Of equal labels under each other, and side by side, only the lowest and the first are left."""
    for at, axes in enumerate(pictures):
        if at + abreast < len(pictures) and pictures[at + abreast].get_xlabel() == axes.get_xlabel():
            axes.xaxis.label.set_visible(False)
        if at % abreast and pictures[at - 1].get_ylabel() == axes.get_ylabel():
            axes.yaxis.label.set_visible(False)


def write_title(figure: Figure, title: str) -> int:
    """Write it above the pictures; the lines it takes."""
    lines = textwrap.wrap(plain(title), round(figure.get_figwidth() * 13))
    if lines:
        figure.suptitle("\n".join(lines), x=0.01, ha="left", fontsize=8, fontweight="bold")
    return len(lines)
