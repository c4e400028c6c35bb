"""Which other models make a concave curve of mean friction: python docs/rivals_figures.py.

Writes the figure of docs/rivals.md, in several minutes. Two curves are to be come near: of Coulomb friction on the
linear body at resonance, and of a soft Dahl contact under a prescribed slip; both end at belt speed 50. Distances are
the largest over 18 belt speeds, in shares of mu. Of every body the load and the normal load are free, as nobody knows
a moving mass and its stiffness exactly, beside the numbers that make it a rival.
"""

from __future__ import annotations

import sys
from concurrent.futures import ProcessPoolExecutor
from itertools import product
from pathlib import Path
from typing import Any, NamedTuple

import matplotlib as mpl
import numpy as np
from matplotlib.lines import Line2D
from numpy.typing import NDArray
from scipy.optimize import minimize

import frictionlab as fl
from frictionlab.charts.sheet import CYCLE, NO_HEADING, STYLE, Sheet, write_figure
from frictionlab.theory import mean_prescribed_longitudinal, mean_soft_dahl

FIGURES = Path(__file__).parent / "figures"
MU, END = 0.4, 50.0
SPEEDS = np.array([*range(4, 48, 4), 47, 49, 50, 51, 52, 54, 56], float)
"""Of all curves: more of them where reversal ends, in a corner."""
COULOMB = fl.Coulomb(mu=MU)
LINEAR, BENT, FRACTIONAL, RELAXING = (
    "linear, dashpot up to 0.3",
    "dashpot that grows with amplitude",
    "fractional element for a dashpot",
    "relaxing spring for a dashpot",
)
BODIES = LINEAR, BENT, FRACTIONAL, RELAXING
FREQUENCIES = 0.7, 0.85, 1.0, 1.2, 1.5, 2.0
STARTS, EVALUATIONS = 2, 80
LOADS = np.array([1.0, 1.0, 0.0, 0.0])

Model = tuple[fl.Scene, fl.FrictionLaw]


def body(frequency: float, load: float, ratio: float = 0.4, damping: float = 0.1, **terms: Any) -> fl.Scene:
    """A body under a load; ratio: friction over load; terms: of ``fl.Body``."""
    return fl.Scene(
        damping_ratio=damping,
        normal_load=ratio * load / MU,
        belt_speed=1,
        drive=fl.Drive(amplitude=load, frequency=frequency),
        body=fl.Body(**terms) if terms else None,
    )


def under_slip(length: float, amplitude: float = END) -> Model:
    """Dahl friction of this presliding length under a prescribed slip."""
    slip = fl.Slip(velocity_amplitude=amplitude, frequency=1)
    return fl.Scene(belt_speed=1, slip=slip), fl.Dahl(mu=MU, presliding_length=length)


REFERENCES: dict[str, Model] = {
    "resonant Coulomb body": (body(1, 10), COULOMB),
    "soft Dahl contact": under_slip(END),
}


def log(low: float, high: float) -> dict[str, Any]:
    """A range searched by its logarithm."""
    return {"from": low, "to": high, "spacing": "log"}


def rival(kind: str, frequency: float) -> tuple[fl.Scene, fl.FrictionLaw, dict[str, Any]]:
    """A body that moves with about END, and the ranges of its free numbers."""
    stroke, off = END / frequency, abs(1 - frequency**2)
    load = stroke * abs(complex(off, 0.2 * frequency))
    free = {
        "scene.drive.amplitude": log(stroke * max(0.05, 0.8 * off), stroke * (off + 1.2 * frequency)),
        "scene.normal_load": log(0.5 * load, 8 * load),
    }
    if kind == LINEAR:
        return body(frequency, load), COULOMB, free | {"scene.damping_ratio": (0.01, 0.3)}
    if kind == BENT:  # as much damping as of ratios .005 to .5
        grows = body(frequency, load, damping=0.01, amplitude_damping=0.8 / stroke**2)
        return grows, COULOMB, free | {"scene.body.amplitude_damping": log(0.04 / stroke**2, 4 / stroke**2)}
    if kind == FRACTIONAL:
        element = body(frequency, load, damping=0, fractional=fl.Fractional(coefficient=0.2, order=0.5))
        own = {"scene.body.fractional.coefficient": log(0.02, 2), "scene.body.fractional.order": (0.1, 1)}
        return element, COULOMB, free | own
    solid = body(frequency, load, damping=0, relaxation=fl.Relaxation(stiffness=0.2, time=1))
    own = {"scene.body.relaxation.stiffness": log(0.02, 2), "scene.body.relaxation.time": log(0.1, 10)}
    return solid, COULOMB, free | own


class Near(NamedTuple):
    """The nearest model found and its distance over mu."""

    model: Model
    distance: float


def nearest(reference: str, kind: str, frequency: float) -> Near:
    """The body of this kind and drive frequency that comes nearest."""
    scene, law, free = rival(kind, frequency)
    found = fl.equivalent(REFERENCES[reference], (scene, law, free), SPEEDS, starts=STARTS)
    return polished(reference, scene, free, found.values)


def polished(reference: str, scene: fl.Scene, free: dict[str, Any], values: dict[str, float]) -> Near:
    """Nearer still without derivatives: where reversal ends curves have a corner, at which these mislead."""
    target, paths = means(*REFERENCES[reference], SPEEDS), [name.removeprefix("scene.") for name in values]
    ranges = [(each["from"], each["to"]) if isinstance(each, dict) else each for each in free.values()]

    def there(logarithms: Any) -> fl.Scene:
        return scene.with_(**dict(zip(paths, np.exp(logarithms).tolist(), strict=True)))

    def largest(logarithms: Any) -> float:
        return float(np.nan_to_num(np.abs(means(there(logarithms), COULOMB, SPEEDS) - target), nan=1.0).max())

    ends = []
    for wider in (1.0, 1.03):  # a curve that reaches mu below a belt speed has no slope there
        start = np.clip(np.log([*values.values()]) + np.log(wider) * LOADS[: len(values)], *np.log(ranges).T)
        options = {"maxfev": EVALUATIONS, "initial_simplex": _simplex(start, np.log(ranges))}
        ends.append(minimize(largest, start, method="Nelder-Mead", bounds=np.log(ranges), options=options))
    best = min(ends, key=lambda end: float(end.fun))
    return Near((there(best.x), COULOMB), float(best.fun))


def _simplex(start: NDArray[np.float64], ranges: NDArray[np.float64]) -> NDArray[np.float64]:
    """The start and a corner for each number, a little towards the middle of its range."""
    inwards = np.where(start < ranges.mean(axis=1), 0.02, -0.02)
    return np.vstack([start, start + np.diag(inwards)])


def nearest_slip(reference: str) -> Near:
    """The Dahl contact under a prescribed slip that comes nearest."""
    free = {"presliding_length": log(5, 500), "scene.slip.velocity_amplitude": (40, 80)}
    found = fl.equivalent(REFERENCES[reference], (*under_slip(5), free), SPEEDS, starts=STARTS)
    numbers = found.values["presliding_length"], found.values["scene.slip.velocity_amplitude"]
    return Near(under_slip(*numbers), found.distance / MU)


def no_slip_is_nearer(reference: str, lengths: int, amplitudes: int) -> float:
    """A bound below the distance, over mu, of any Dahl contact under any slip that is a sine.

    Curves between a hundred belt speeds are lines, off by less than 1e-4. Mean friction rises with the presliding
    length over the stroke and falls with the slip's velocity: what lies above the softest and slowest of a box, or
    below its stiffest and fastest, bounds what any in the box can reach.
    """
    softness = np.array([0.0, *np.geomspace(0.3, 5, lengths), np.inf])
    speeds = np.array([0.0, *np.geomspace(40, 75, amplitudes), np.inf])
    target, kappa = means(*REFERENCES[reference], SPEEDS), np.arange(1, 101) / 100
    family = [means(*under_slip(length, 1), kappa) for length in softness[1:-1]]
    family = [mean_prescribed_longitudinal(kappa), *family, mean_soft_dahl(kappa)]
    with np.errstate(divide="ignore"):
        shares = SPEEDS[:, None] / speeds
    curves = np.array([np.interp(shares, [0, *kappa], [0, *curve]) for curve in family])
    high, low = curves[1:, :, :-1], curves[:-1, :, 1:]
    apart = np.maximum(np.maximum(low - target[:, None], target[:, None] - high), 0.0)
    return float(apart.max(axis=1).min())


TERMS: dict[str, Any] = {
    "spring that hardens": lambda stroke: {"cubic_stiffness": 0.133 / stroke**2},
    "spring that softens": lambda stroke: {"cubic_stiffness": -0.133 / stroke**2},
    "curved": lambda stroke: {"curvature": 0.1 / stroke},
    "dashpot that grows": lambda stroke: {"amplitude_damping": 0.8 / stroke**2},
    "fractional": lambda stroke: {"fractional": fl.Fractional(coefficient=0.28, order=0.5)},
    "relaxing": lambda stroke: {"relaxation": fl.Relaxation(stiffness=0.4, time=1)},
}
"""Of bodies of this stroke: a spring or strain that changes by a tenth, damping as of a ratio of 0.1."""


def with_term(kind: str, frequency: float, ratio: float = 0.5) -> fl.Scene:
    """A body with one such term, moving with about END; a dashpot where the term does not damp."""
    terms = TERMS[kind](END / frequency)
    damping = 0.1 if {"cubic_stiffness", "curvature"} & set(terms) else 0.0
    load = END / frequency * abs(complex(1 - frequency**2, 0.2 * frequency))
    return body(frequency, load, ratio, damping, **terms)


def nearest_linear(scene: fl.Scene) -> fl.Equivalent:
    """Of the linear bodies of any load, normal load, frequency and damping the one nearest to this body."""
    load, frequency = scene.drive.amplitude, scene.drive.frequency
    free = {
        "scene.drive.amplitude": log(load / 3, load * 3),
        "scene.normal_load": log(scene.normal_load / 3, scene.normal_load * 3),
        "scene.drive.frequency": (0.8 * frequency, 1.25 * frequency),
        "scene.damping_ratio": (0.01, 0.5),
    }
    return fl.equivalent((scene, COULOMB), (body(frequency, load), COULOMB, free), SPEEDS, starts=STARTS)


def means(
    scene: fl.Scene, law: fl.FrictionLaw, speeds: Any, column: str = "mean_friction"
) -> NDArray[np.float64]:
    """Mean friction over mu, or another column as it is."""
    rows = fl.curve(scene, law, speeds, columns=[column], progress=False)
    return rows[column].to_numpy(dtype=float) / (MU if column == "mean_friction" else 1)


SLIP = "Dahl contact, slip prescribed"
SHOWN = {LINEAR: 2.0, BENT: 1.0, FRACTIONAL: 1.5}
"""Drive frequencies of the bodies whose curves are drawn."""


def draw() -> None:
    """Distances over drive frequency, and the curves and vibrations of models that can hardly be told apart."""
    asked = [*product(REFERENCES, BODIES, FREQUENCIES)]
    with ProcessPoolExecutor() as pool:
        found = dict(zip(asked, pool.map(nearest, *zip(*asked, strict=True)), strict=True))
    first = next(iter(REFERENCES))
    slip = nearest_slip(first)
    models: dict[str, Model | None] = {"the curve to come near": REFERENCES[first]}
    models |= {f"{kind} (Ω {at:g})": found[first, kind, at].model for kind, at in SHOWN.items()}
    models |= {RELAXING: None, SLIP: slip.model}
    looks = dict(zip((*models,), ({"color": "0.6", "linewidth": 3.5}, *CYCLE), strict=False))
    with mpl.rc_context(STYLE):
        sheet = Sheet.blank(
            4, NO_HEADING, [Line2D([], [], label=name, **look) for name, look in looks.items()]
        )
        for place, reference in enumerate(REFERENCES):
            axes = sheet.axes(place)
            for kind, look in zip(BODIES, [*looks.values()][1:], strict=False):
                apart = [found[reference, kind, at].distance for at in FREQUENCIES]
                axes.plot(FREQUENCIES, apart, marker="o", markersize=3, **look)
            if reference == first:
                axes.axhline(slip.distance, **looks[SLIP])
            axes.set(ylim=(0, 0.055), xlabel="circular frequency Ω of the rival", ylabel="distance over μ")
            axes.set_title(f"from the curve of a {reference}", loc="left")
        for place, column in enumerate(("mean_friction", "velocity_amplitude"), 2):
            axes = sheet.axes(place)
            for model, look in zip(models.values(), looks.values(), strict=True):
                if model:
                    shown = means(*model, np.arange(1, 61), column)
                    axes.plot(np.arange(1, 61), shown / shown[-1], **look)
            axes.set(xlabel="belt speed", ylim=(0, 1.05), xlim=(0, 60))
            axes.set_ylabel("mean friction over μ" if place == 2 else "vibration (fast belt: 1)")
    write_figure(sheet.figure, FIGURES / "rivals", ("svg",))


if __name__ == "__main__":
    sys.path[:0] = [str(Path(__file__).parents[1])]
    import conftest  # noqa: F401 - lets plugins be seen that are not installed

    draw()
