"""How near elastic friction under a prescribed slip comes to Coulomb friction of a body.

Writes the two figures of docs/dynamic_laws.md (python docs/equivalence_figures.py), in a minute or two.
Distances are in shares of mu, at fifty belt speeds
up to V_lin (the reverse at ten), from which on all curves are mu. The slip has the velocity amplitude V_lin and the
displacement amplitude X; its curve depends on presliding length over X alone, and rises with it everywhere: what lies
above the curve of one and below that of the next bounds what any between them can reach.
"""

from __future__ import annotations

from functools import cache
from pathlib import Path
from typing import Any, NamedTuple

import matplotlib as mpl
import numpy as np
from matplotlib.axes import Axes
from matplotlib.collections import QuadMesh
from matplotlib.colors import LogNorm, Normalize
from matplotlib.lines import Line2D
from matplotlib.patheffects import withStroke
from numpy.typing import NDArray

import frictionlab as fl
from frictionlab.analysis.fit.equivalent import Norm
from frictionlab.charts.maps import cell_edges
from frictionlab.charts.sheet import CYCLE, NO_HEADING, STYLE, Sheet, write_figure
from frictionlab.theory import friction_free_velocity, mean_prescribed_longitudinal, mean_soft_dahl

FIGURES = Path(__file__).parent / "figures"
MU, LOAD = 0.4, 10.0
COULOMB = fl.Coulomb(mu=MU)
SHARES = np.arange(1, 51) / 50
"""Belt speeds over V_lin."""


class Nearest(NamedTuple):
    """The least distance that a presliding length gives, a bound below it, and that length over X."""

    distance: float
    at_least: float
    softness: float


def body(frequency: float, ratio: float, damping: float = 0.1) -> fl.Scene:
    """A body under a load; ratio: friction over load."""
    drive = fl.Drive(amplitude=LOAD, frequency=frequency)
    return fl.Scene(damping_ratio=damping, normal_load=ratio * LOAD / MU, belt_speed=1, drive=drive)


def planar_body() -> fl.Scene:
    """Equal loads along and across the belt, Omega 4, omega_r 0.5: a curve of the paper's Fig. 8a."""
    across = fl.Transverse(natural_frequency=0.5, damping_ratio=0.1, load=fl.Load(unbalance=10))
    drive = fl.Drive(unbalance=10, frequency=4)
    return fl.Scene(damping_ratio=0.1, normal_load=1, belt_speed=1, drive=drive, transverse=across)


def slip_of(scene: fl.Scene) -> tuple[fl.Scene, float]:
    """The prescribed slip of velocity amplitude V_lin, and its displacement amplitude."""
    speed, frequency = v_lin(scene), scene.drive.frequency
    return fl.Scene(
        belt_speed=1, slip=fl.Slip(velocity_amplitude=speed, frequency=frequency)
    ), speed / frequency


def v_lin(scene: fl.Scene) -> float:
    """The velocity amplitude along the belt without friction."""
    return float(friction_free_velocity(scene.with_(transverse=None)))


def means(scene: fl.Scene, law: fl.FrictionLaw, speeds: Any) -> NDArray[np.float64]:
    """Mean friction over mu."""
    rows = fl.curve(scene, law, speeds, columns=["mean_friction"], progress=False)
    return rows["mean_friction"].to_numpy(dtype=float) / MU


@cache
def family(count: int) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Presliding lengths over X from rigid to soft without end, and their curves."""
    softness = np.array([0.0, *np.geomspace(1e-4, 1e2, count), np.inf])
    slip = fl.Scene(belt_speed=1, slip=fl.Slip(velocity_amplitude=1, frequency=1))
    curves = [means(slip, fl.Dahl(mu=MU, presliding_length=each), SHARES) for each in softness[1:-1]]
    return softness, np.array([mean_prescribed_longitudinal(SHARES), *curves, mean_soft_dahl(SHARES)])


def nearest(curve: NDArray[np.float64], norm: str, count: int = 800) -> Nearest:
    """The curve of prescribed slip that is nearest to this one, by the largest distance or the root mean square."""

    def size(apart: NDArray[np.float64]) -> NDArray[np.float64]:
        return np.abs(apart).max(axis=-1) if norm == "largest" else np.sqrt((apart**2).mean(axis=-1))

    softness, curves = family(count)
    known = size(curves - curve)
    outside = np.maximum(np.maximum(curves[:-1] - curve, curve - curves[1:]), 0.0)
    best = int(known.argmin())
    return Nearest(float(known[best]), float(size(outside).min()), float(softness[best]))


def other_body(frequency: float, ratio: float, softness: float, norm: Norm) -> fl.Equivalent:
    """The Coulomb body of another frequency and damping that is nearest to this body on a Dahl contact."""
    scene = body(frequency, ratio)
    law = fl.Dahl(mu=MU, presliding_length=softness * slip_of(scene)[1])
    free = {"scene.drive.frequency": (0.5 * frequency, 2 * frequency), "scene.damping_ratio": (0.001, 1.0)}
    speeds = SHARES[4::5] * v_lin(scene)
    return fl.equivalent((scene, law), (scene, COULOMB, free), speeds, norm=norm, starts=4)


FREQUENCIES, RATIOS = np.geomspace(0.25, 4, 41), np.linspace(0.05, 1.2, 24)
FEW_FREQUENCIES, FEW_RATIOS = np.geomspace(0.5, 4, 10), np.linspace(0.05, 0.8, 6)


def draw_maps() -> None:
    """The distances over frequency and friction over load, the presliding length, and the reverse."""
    found: dict[str, Any] = {
        norm: np.empty((len(RATIOS), len(FREQUENCIES))) for norm in ("largest", "rms", "soft")
    }
    for at in np.ndindex(found["rms"].shape):
        scene = body(FREQUENCIES[at[1]], RATIOS[at[0]])
        curve = means(scene, COULOMB, SHARES * v_lin(scene))
        for norm in ("largest", "rms"):
            close = nearest(curve, norm)
            found[norm][at] = close.distance
            assert close.distance - close.at_least < 0.003
        found["soft"][at] = np.clip(close.softness, 1e-4, 10)
    reverse = np.full((len(FEW_RATIOS), len(FEW_FREQUENCIES)), np.nan)
    for at in np.ndindex(reverse.shape):
        try:
            reverse[at] = other_body(FEW_FREQUENCIES[at[1]], FEW_RATIOS[at[0]], 0.1, "largest").distance / MU
        except ValueError as why:  # a Dahl body may have two motions
            if "not_unique" not in str(why):
                raise
    apart, few = [0.02, 0.05, 0.1, 0.2, 0.3], (FEW_FREQUENCIES, FEW_RATIOS)
    several = FREQUENCIES, RATIOS
    maps = {
        "Dahl, prescribed slip, for a Coulomb body:\nlargest distance over μ": (
            *several,
            found["largest"],
            apart,
        ),
        "the same:\nroot mean square over μ": (*several, found["rms"], apart),
        "its presliding length over X, by root mean\nsquare (lightest: 10 or any longer)": (
            *several,
            found["soft"],
            [0.01, 0.1, 1],
        ),
        "another Coulomb body for a Dahl body:\nlargest distance over μ (white: two motions)": (
            *few,
            reverse,
            apart,
        ),
    }
    with mpl.rc_context(STYLE):
        sheet = Sheet.blank(4, NO_HEADING, height=2.5)
        for place, (title, shown) in enumerate(maps.items()):
            axes = sheet.axes(place)
            axes.set_title(title, loc="left")
            sheet.figure.colorbar(_draw_map(axes, *shown), ax=axes, pad=0.02)
    write_figure(sheet.figure, FIGURES / "equivalence_maps", ("svg",))


def _draw_map(axes: Axes, frequencies: Any, ratios: Any, values: Any, levels: list[float]) -> QuadMesh:
    white = [withStroke(linewidth=2.4, foreground="white")]
    norm = LogNorm(1e-3, 10) if max(levels) >= 1 else Normalize(0, 0.45)
    mesh = axes.pcolormesh(*map(cell_edges, (frequencies, ratios)), values, norm=norm, rasterized=True)
    lines = axes.contour(frequencies, ratios, values, levels, colors="0.05", linewidths=0.8)
    lines.set(path_effects=white)
    for label in axes.clabel(lines, fontsize=7, fmt="%g", inline=False):
        label.set(path_effects=white)
    axes.set(xscale="log", xlabel="circular frequency Ω", ylabel="friction over load")
    axes.set_xticks([0.25, 0.5, 1, 2, 4], ["0.25", "0.5", "1", "2", "4"])
    axes.minorticks_off()
    axes.set_xlim(frequencies[0], frequencies[-1])
    return mesh


def draw_curves() -> None:
    """Curves that are nearly the same, and three pairs that are not."""
    speeds = np.arange(1, 141) / 100
    curves = {
        "Coulomb body, Ω 2, friction 0.4 of the load,\nand Dahl under a prescribed slip": beside_slip(
            body(2, 0.4)
        ),
        "the same at Ω 0.5": beside_slip(body(0.5, 0.4)),
        "Coulomb body, loads along and across, Ω 4,\nand Dahl under a prescribed slip": beside_slip(
            planar_body()
        ),
        "Dahl body, Ω 2, friction 0.4 of the load,\nand another Coulomb body": beside_another_body(),
    }
    words = "the curve of the body", "Coulomb, prescribed slip", "the nearest curve"
    with mpl.rc_context(STYLE):
        entries = [Line2D([], [], label=label, **look) for label, look in zip(words, CYCLE, strict=False)]
        sheet = Sheet.blank(4, NO_HEADING, entries)
        for place, (title, models) in enumerate(curves.items()):
            axes, end = sheet.axes(place), v_lin(models[0][0])
            for (scene, law), look in zip(models, CYCLE, strict=False):
                axes.plot(speeds, means(scene, law, speeds * end), **look)
            axes.set(xlabel=r"belt speed over $V_\mathrm{lin}$", ylabel="mean friction over μ")
            axes.set(xlim=(0, 1.4), ylim=(0, 1.05))
            axes.set_title(title, loc="left")
    write_figure(sheet.figure, FIGURES / "equivalence_curves", ("svg",))


def beside_slip(scene: fl.Scene) -> list[tuple[fl.Scene, fl.FrictionLaw]]:
    """A Coulomb body, a prescribed slip, and this with the Dahl friction that is nearest to the first."""
    length = nearest(means(scene, COULOMB, SHARES * v_lin(scene)), "largest").softness
    slip, stroke = slip_of(scene)
    return [
        (scene, COULOMB),
        (slip, COULOMB),
        (slip, fl.Dahl(mu=MU, presliding_length=max(length, 1e-4) * stroke)),
    ]


def beside_another_body() -> list[tuple[fl.Scene, fl.FrictionLaw]]:
    """A Dahl body, a prescribed slip, and the Coulomb body that is nearest to the first."""
    scene, found = body(2, 0.4), other_body(2, 0.4, 0.1, "largest").values
    slip, stroke = slip_of(scene)
    other = scene.with_(**{name.removeprefix("scene."): value for name, value in found.items()})
    return [(scene, fl.Dahl(mu=MU, presliding_length=0.1 * stroke)), (slip, COULOMB), (other, COULOMB)]


if __name__ == "__main__":
    draw_curves()
    draw_maps()
