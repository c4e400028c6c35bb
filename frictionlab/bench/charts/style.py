"""Looks that the charts of a bench share."""

from __future__ import annotations

from typing import Any

from matplotlib.axes import Axes

OURS = ("#08306b", "#7f0000", "#00441b", "#4a1486", "#662506", "#252525")
THEIRS = ("#e6550d", "#31a354", "#756bb1", "#858585")
LINE_STYLES = ("solid", (0, (5, 1.5)), (0, (1, 1.2)), (0, (5, 1.5, 1, 1.5)))


def dress(axes: Axes, title: str, **look: Any) -> None:
    """A title at the left, and a pale grid behind."""
    axes.set_title(title, loc="left", **look)
    axes.grid(which="major", color="0.9", linewidth=0.5)
    axes.set_axisbelow(True)
