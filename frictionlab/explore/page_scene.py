"""Which curves of a run the page's own solver can hold against Coulomb friction, and the scenes it takes for them."""

from __future__ import annotations

from typing import NamedTuple

from frictionlab.charts.curves import CurveData
from frictionlab.columns import BELT_SPEEDS
from frictionlab.results.loads_in_time import scene_of

RATIOS = "velocity_ratio", "normalized_friction"


class PageScene(NamedTuple):
    """One degree of freedom under one sine, as the page's solver takes it.

    frequency, damping: of the scene, both > 0; friction: mu * normal load over the load's amplitude; mu: of sliding;
    limit: V_lin in the units of the curve's belt speeds.
    """

    frequency: float
    damping: float
    friction: float
    mu: float
    limit: float


def page_scene(curve: CurveData, abscissa: str) -> PageScene | None:
    """The scene of a curve over belt speed; None where it is none that the page solves.

    It solves a body along the belt, damped, under one sine, with one coefficient of sliding friction.
    """
    if abscissa not in BELT_SPEEDS or any(name not in curve.rows for name in RATIOS):
        return None
    scene = scene_of(curve.rows.iloc[0].to_dict())
    load = 0.0 if scene.drive is None else scene.drive.size(scene.frequency)
    if scene.degrees_of_freedom != 1 or not scene.is_harmonic or not load or not scene.damping_ratio:
        return None
    rows = curve.rows[curve.rows["velocity_ratio"].abs() > 0.0]
    left = rows["normalized_friction"] != 0.0
    friction = (rows["mean_friction"] / rows["normalized_friction"])[left].abs()
    if friction.empty or not friction.max() - friction.min() <= 1e-12 * friction.max():
        return None
    limit = float((rows[abscissa] / rows["velocity_ratio"]).median())
    mu = float(friction.iloc[0])
    share = mu * (scene.normal_load or 1.0) / abs(load)
    return PageScene(scene.frequency, scene.damping_ratio, share, mu, limit)
