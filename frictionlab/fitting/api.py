"""``fl.fit``: laws to measured curves, or to slip and friction over time."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from typing import Any

from numpy.typing import ArrayLike

from frictionlab.fitting.blocks import blocks_of
from frictionlab.fitting.free import Model, free_numbers
from frictionlab.fitting.measured import Measurements, given_measurements
from frictionlab.fitting.residuals import Residuals
from frictionlab.fitting.result import STOPPED, FittedLaw, FittedLaws
from frictionlab.fitting.search import STARTS, search
from frictionlab.laws.base import FrictionLaw
from frictionlab.runner.arguments import given_law, given_scene
from frictionlab.scene.scene import Scene


def fit(
    data: Any,
    law: FrictionLaw | Sequence[FrictionLaw],
    scene: Scene | None = None,
    free: Mapping[str, Any] | None = None,
    blocks: ArrayLike | None = None,
    starts: int = STARTS,
    tell: Callable[[str], None] | None = None,
) -> FittedLaws:
    """Fit numbers of laws, and of their scene, to measurements by least squares.

    data: a table (or a list of tables, or a mapping of columns) with ``belt_speed`` (``belt_speed_m_per_s`` for a
    scene in SI units) and ``mean_friction``, or with ``time``, ``slip`` [a length] and ``friction`` [coefficient] for
    the law along a measured path, without a body and a scene. ``sigma``, the standard error of a row, and ``block``
    may stand beside; ``mean_friction_N`` or ``friction_N`` with ``normal_load_N`` is a coefficient, too; a column
    ``scene.<path>`` gives the scene of its rows.
    law: one or several; their numbers stand where they are not free. free: ranges by name, ``{"mu": (0.1, 1)}``, each
    law takes those it has, or by path, ``"scene.damping_ratio"``; or from, to and spacing (linear or log).
    blocks: a label for each row, in place of the column: rows of different blocks know nothing of each other.
    starts: of the search, drawn over the ranges. tell: is told what is being fitted.

    >>> import numpy as np
    >>> import frictionlab as fl
    >>> scene = fl.Scene(damping_ratio=0.1, normal_load=10, belt_speed=5, drive=fl.Drive(unbalance=10, frequency=1))
    >>> speeds = np.linspace(2, 60, 12)
    >>> measured = fl.curve(scene, fl.Coulomb(mu=0.4), speeds)["mean_friction"] + 1e-3 * np.sin(7 * speeds)
    >>> data = {"belt_speed": speeds, "mean_friction": measured}
    >>> found = fl.fit(data, fl.Coulomb(mu=0.3), scene, free={"mu": (0.1, 1.0)})
    >>> round(found.values["mu"], 2), found.shapes["mu"]
    (0.4, 'bounded')

    Raises ValueError or TypeError for what makes no sense, with the row and what to do.
    """
    laws = [given_law(each) for each in (law if isinstance(law, Sequence) else [law])]
    body = None if scene is None else given_scene(scene)
    in_si = body is not None and body.dimensional is not None
    measured = given_measurements(data, in_si=in_si, blocks=blocks)
    return fit_measured(measured, laws, body, free or {}, starts, tell)


def fit_measured(
    measured: Measurements,
    laws: Sequence[FrictionLaw],
    scene: Scene | None,
    free: Mapping[str, Any],
    starts: int = STARTS,
    tell: Callable[[str], None] | None = None,
) -> FittedLaws:
    """The same of checked measurements. Raises ValueError."""
    if measured.is_path and scene is not None:
        scene = None
    if not measured.is_path and scene is None:
        raise ValueError(
            "a curve of mean friction needs the scene it was measured in: fit(data, law, scene, ...)"
        )
    numbers = free_numbers(free, laws, scene)
    models = [Model(law, scene, numbers[place]) for place, law in enumerate(laws)]
    for model in models:
        if not model.free:
            raise ValueError(
                f"free: {model.label} has none of {', '.join(free)}; leave it out or free a number of it"
            )
        if len(model.free) >= len(measured.values):
            raise ValueError(
                f"{len(model.free)} free numbers need more than {len(model.free)} rows, got {len(measured.values)}"
            )
    fitted: list[FittedLaw] = []
    failed: dict[str, str] = {}
    for model in models:
        residuals = Residuals(model, measured)
        try:
            found = search(residuals, starts, tell)
        except KeyboardInterrupt:
            if not fitted:
                raise
            failed |= {each.label: STOPPED for each in models[len(fitted) + len(failed) :]}
            break
        raw = residuals.raw(found.best.shares)
        if residuals.unanswered:
            failed[model.label] = (
                f"{residuals.unanswered} of {len(raw)} rows have no mean friction at the optimum"
            )
        else:
            fitted.append(FittedLaw(residuals, found, *blocks_of(measured, raw)))
    if not fitted:
        raise ValueError(
            f"no law could be fitted: {'; '.join(f'{law}: {why}' for law, why in failed.items())}"
        )
    return FittedLaws(measured, tuple(fitted), failed)
