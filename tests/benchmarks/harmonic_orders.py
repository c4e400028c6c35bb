"""How harmonic balance converges with its harmonics: python tests/benchmarks/harmonic_orders.py.

Six scenes, H = 1 ... 300, with the tail and without, against proved or exact means. Prints the fitted orders and the
time a point, and writes docs/figures/harmonic_balance_orders.svg (and .png beside the temporary files).
"""

from __future__ import annotations

import math
import shutil
import tempfile
import time
from pathlib import Path
from typing import NamedTuple

import matplotlib as mpl
import numpy as np
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.figure import Figure

from frictionlab.bench.drawing import save_figure
from frictionlab.charts.figures import PAGE, STYLE
from frictionlab.laws.coulomb import Coulomb
from frictionlab.methods.exact.method import Exact
from frictionlab.methods.reduced.harmonic_balance import HarmonicBalance
from frictionlab.scene.scene import Drive, Scene
from frictionlab.theory import friction_free_velocity

PICTURE = Path(__file__).parents[2] / "docs" / "figures" / "harmonic_balance_orders.svg"
LAW = Coulomb(mu=0.4)
TOLD = [1, 2, 4, 8, 16, 32, 64, 128, 300]
HARMONICS = sorted({*TOLD, *np.round(np.geomspace(1.0, 300.0, 40)).astype(int).tolist()})
FITTED_FROM = 8
LEAST = 1e-13
"""Errors below are the rounding of both."""
POINTS = 64
"""Belt speeds of a curve that is timed."""


def scene(belt_speed: float, drive: Drive, normal_load: float = 10.0, damping: float = 0.1) -> Scene:
    """Along the belt."""
    return Scene(damping_ratio=damping, normal_load=normal_load, belt_speed=belt_speed, drive=drive)


SCENES = {
    "Fig. 4b, belt speed 10": scene(10.0, Drive(unbalance=10.0, frequency=1.0)),
    "Fig. 4b, belt speed 40": scene(40.0, Drive(unbalance=10.0, frequency=1.0)),
    "Fig. 4a, belt speed 8": scene(8.0, Drive(unbalance=10.0, frequency=1.5)),
    "Fig. 3b, weak friction, 20": scene(20.0, Drive(unbalance=10.0, frequency=1.0), normal_load=1.0),
    "rests for two thirds": scene(0.5, Drive(amplitude=2.5, frequency=0.5)),
    "overdamped, rests twice": scene(0.5, Drive(unbalance=10.0, frequency=1.0), damping=2.0),
}


class Line(NamedTuple):
    """Errors of the mean at each number of harmonics, NaN where it is refused; order: fitted slope."""

    errors: np.ndarray
    order: float


def converged(one: Scene, tail: bool) -> Line:
    """Of one scene."""
    known = float(Exact().solve([one], LAW, 1e-12).mean[0].real)
    methods = [HarmonicBalance(harmonics=h, tail=tail if h > 1 else None) for h in HARMONICS]
    errors = np.array([abs(float(method.model_means([one], LAW)[0]) - known) for method in methods])
    errors[0] = np.nan if tail else errors[0]  # one harmonic has no tail
    fitted = (np.array(HARMONICS) >= FITTED_FROM) & (errors > LEAST)
    if fitted.sum() < 8:
        return Line(errors, math.nan)
    return Line(
        errors, -float(np.polyfit(np.log(HARMONICS), np.log(np.where(fitted, errors, 1.0)), 1, w=fitted)[0])
    )


def picture(found: dict[tuple[str, bool], Line]) -> Figure:
    """A panel a scene."""
    figure = Figure(figsize=(PAGE, 4.6), layout="constrained")
    FigureCanvasAgg(figure)
    panels = figure.subplots(2, 3, sharex=True, sharey=True)
    orders = np.array([4.0, 300.0])
    for axes, name in zip(panels.flat, SCENES, strict=True):
        axes.loglog(orders, 0.03 / orders, color="0.75", linewidth=0.7)
        axes.loglog(orders, 0.2 / orders**3, color="0.75", linewidth=0.7)
        for tail, color, marker in ((False, "#b2182b", "s"), (True, "#2166ac", "o")):
            line = found[name, tail]
            label = "with the tail" if tail else "those beyond left out"
            axes.loglog(
                HARMONICS,
                np.maximum(line.errors, LEAST),
                color=color,
                marker=marker,
                markerfacecolor=color if tail else "white",
                markersize=3.0,
                linewidth=0.9,
                linestyle="-" if tail else "--",
                label=label,
            )
        axes.set_title(name, loc="left", fontsize=7)
        axes.grid(which="major", color="0.9", linewidth=0.5)
        axes.set_axisbelow(True)
        axes.set_ylim(LEAST, 1.0)
    panels[0, 0].text(300.0, 2e-4, r"$H^{-1}$", fontsize=6, color="0.4", ha="right")
    panels[0, 0].text(300.0, 1.5e-8, r"$H^{-3}$", fontsize=6, color="0.4", ha="right")
    for axes in panels[1]:
        axes.set_xlabel("harmonics H")
    figure.supylabel("error of the mean friction", fontsize=8)
    figure.legend(*panels[0, 0].get_legend_handles_labels(), loc="outside lower center", ncols=2)
    return figure


def timed(harmonics: int, tail: bool) -> tuple[float, float]:
    """Of a curve of Fig. 4b without rest: the model alone, and with its error, a point [s]; the least of ten."""
    one = SCENES["Fig. 4b, belt speed 10"]
    speeds = np.linspace(0.2, 0.85, POINTS) * friction_free_velocity(one)
    scenes = [one.model_copy(update={"belt_speed": speed}) for speed in speeds.tolist()]
    method = HarmonicBalance(harmonics=harmonics, tail=tail if harmonics > 1 else None)
    times = []
    for call in (lambda: method.model_means(scenes, LAW), lambda: method.solve(scenes, LAW, 1e-8)):
        spent = []
        for _ in range(10):
            start = time.process_time()
            call()
            spent.append(time.process_time() - start)
        times.append(min(spent) / POINTS)
    return times[0], times[1]


if __name__ == "__main__":
    lines = {(name, tail): converged(one, tail) for name, one in SCENES.items() for tail in (False, True)}
    for (name, tail), line in lines.items():
        told = " ".join(f"{line.errors[HARMONICS.index(h)]:8.1e}" for h in TOLD)
        print(f"{name:30s} {'tail ' if tail else 'plain'} order {line.order:5.2f}  {told}")
    for harmonics in TOLD[1:]:
        print(harmonics, *(f"{1e6 * each:7.1f}" for tail in (False, True) for each in timed(harmonics, tail)))
    with tempfile.TemporaryDirectory() as folder, mpl.rc_context(STYLE):
        save_figure(picture(lines), Path(folder), "orders")
        shutil.copy(Path(folder) / "orders.svg", PICTURE)
        shutil.copy(Path(folder) / "orders.png", Path(tempfile.gettempdir()) / "harmonic_balance_orders.png")
