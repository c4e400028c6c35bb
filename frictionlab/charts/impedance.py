"""Impedance of a contact over frequency: modulus and phase (Bode), and its path in the complex plane (Nyquist)."""

from __future__ import annotations

from typing import Any

import matplotlib as mpl
import numpy as np
from matplotlib.figure import Figure
from matplotlib.lines import Line2D

from frictionlab.charts.sheet import Sheet
from frictionlab.charts.style import CYCLE, PAGE, STYLE, blank_figure

_HEIGHT = 3.4  # [inch]


def impedance_figure(speeds: Any, frequencies: Any, values: Any) -> Figure:
    """A line for each belt speed; arrays of one shape: belt speeds, circular frequencies, impedances.

    In the complex plane a mark stands at the lowest frequency; left of the upright line friction feeds a motion.
    """
    speeds, frequencies, values = (np.ravel(each) for each in (speeds, frequencies, values))
    with mpl.rc_context(STYLE):
        figure = blank_figure(PAGE, _HEIGHT)
        grid = figure.add_gridspec(2, 2)
        modulus = figure.add_subplot(grid[0, 0])
        phase = figure.add_subplot(grid[1, 0], sharex=modulus)
        plane = figure.add_subplot(grid[:, 1])
        entries = []
        for place, speed in enumerate(dict.fromkeys(speeds.tolist())):
            own = np.flatnonzero((speeds == speed) & np.isfinite(values))
            own = own[np.argsort(frequencies[own], kind="stable")]
            look, z = CYCLE[place % len(CYCLE)], values[own]
            drawn = frequencies[own] > 0.0  # zero has no place on a logarithmic axis
            omega = frequencies[own][drawn]
            modulus.plot(omega, np.abs(z)[drawn], **look)
            phase.plot(omega, np.angle(z, deg=True)[drawn], **look)
            plane.plot(z.real, z.imag, **look)
            plane.plot(z.real[:1], z.imag[:1], color=look["color"], marker="o")
            entries.append(Line2D([], [], label=f"belt speed {speed:g}", **look))
        scales = ("log" if (np.abs(each) > 0.0).any() else "linear" for each in (frequencies, values))
        modulus.set(ylabel=r"modulus $|Z|$", **dict(zip(("xscale", "yscale"), scales, strict=True)))
        modulus.tick_params(labelbottom=False)
        phase.set(xlabel="circular frequency", ylabel="phase [degrees]", ylim=(-190, 190))
        phase.set_yticks([-180, -90, 0, 90, 180])
        plane.set(
            xlabel=r"real part of $Z$: damping",
            ylabel=r"imaginary part of $Z$: inertia, or stiffness below 0",
        )
        for line in (plane.axvline, plane.axhline):
            line(0.0, color="0.5", linewidth=0.6, zorder=0)
        Sheet(figure, 2, 2).add_legend(entries)
    return figure
