"""The sine and the best drive: each over a period, and the velocity that the body has then."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import matplotlib as mpl
import pandas as pd
from matplotlib.figure import Figure
from matplotlib.lines import Line2D

from frictionlab.charts.sheet import Heading, Sheet
from frictionlab.charts.style import CYCLE, STYLE

_BELT: Any = {"color": "0.5", "linewidth": 0.7}


def best_waveform_figure(motions: Mapping[str, pd.DataFrame], belt_speed: float, slips: bool) -> Figure:
    """motions: by the entry of the legend, a period each, with the drive. slips: whether the drive is the slip."""
    entries = [
        Line2D([], [], label=name, **look) for name, look in zip(motions, CYCLE[: len(motions)], strict=True)
    ]
    with mpl.rc_context(STYLE):
        sheet = Sheet.blank(1 if slips else 2, Heading(), [*entries, Line2D([], [], label="belt", **_BELT)])
        force = None if slips else sheet.axes(0)
        velocity = sheet.axes(0 if slips else 1)
        for motion, look in zip(motions.values(), CYCLE, strict=False):
            turns = motion["tau"] / motion["tau"].iloc[-1]
            velocity.plot(turns, motion["slip"] + belt_speed, **look)
            if force is not None:
                force.plot(turns, motion["drive"], **look)
                force.set(xlabel="time [periods]", ylabel="drive")
        velocity.axhline(belt_speed, **_BELT)
        velocity.set(xlabel="time [periods]", ylabel="velocity along the belt")
    return sheet.figure
