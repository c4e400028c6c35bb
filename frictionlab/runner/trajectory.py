"""Motions in time from Python: transients, several periods, and what never repeats."""

from __future__ import annotations

from math import inf

import numpy as np
import pandas as pd

from frictionlab.laws.base import FrictionLaw
from frictionlab.methods.base import Method
from frictionlab.motion.orbit.record import Orbit
from frictionlab.runner.arguments import given_law, given_method, given_scene, given_tolerance
from frictionlab.runner.engine import within
from frictionlab.runner.part import beside_in_si, si_scales
from frictionlab.scene.scene import Initial, Scene
from frictionlab.study.grid import law_in_scene
from frictionlab.values.quantities import at_least_one

NO_MOTION = "no motion in time is known of this scene and law by {name}: {why}"
NOT_DRIVEN = "it needs a driven mass, and a law that is not solved axis by axis"


def trajectory(
    scene: Scene,
    law: FrictionLaw,
    periods: int = 10,
    samples: int = 200,
    initial: Initial | None = None,
    method: str | Method = "auto",
    tolerance: float = 1e-8,
) -> pd.DataFrame:
    """Compute the motion of a driven mass from an initial state.

    A period is the common period of all that changes in time. Instants of stick and reversal are located.

    Parameters
    ----------
    scene : Scene
        Body and belt, and what shakes them.
    law : FrictionLaw
        Law of friction.
    periods : int, >= 1, default 10
        Number of periods.
    samples : int, >= 1, default 200
        Rows per period, evenly spaced; one more row is the end.
    initial : Initial, optional
        Position and velocity at tau = 0. ``scene.initial`` if left out; the friction-free motion if the scene
        has none either.
    method : str or Method, default "auto"
        Name of a method, or a method such as ``fl.March(steps=1000)``.
    tolerance : float, > 0, default 1e-8
        Absolute bound [-] on the error of the mean friction of a period.

    Returns
    -------
    pandas.DataFrame
        A row for each instant, with the columns of ``state.orbit(n)``: ``tau``, ``x1``, ``v1``, ``x2``,
        ``v2``, ``friction``, ``load``, ``slip``, ...; for a scene in SI units ``tau_s``, ``x1_m``,
        ``v1_m_per_s``, ..., too.

    Raises
    ------
    ValueError
        If the method does not follow such a motion, or a value makes no sense.
    TypeError
        If a value is of another kind.

    Examples
    --------
    >>> import frictionlab as fl
    >>> drive = fl.Drive(unbalance=10, frequency=1)
    >>> scene = fl.Scene(damping_ratio=0.1, normal_load=10, belt_speed=5, drive=drive)
    >>> motion = fl.trajectory(scene, fl.Coulomb(mu=0.4), periods=3, samples=50, initial=fl.Initial(x=3))
    >>> len(motion), float(motion.x1[0])
    (151, 3.0)
    """
    scene, law, ready = given_scene(scene), given_law(law), given_method(method)
    periods, samples = at_least_one("periods", periods), at_least_one("samples", samples)
    if initial is not None:
        scene = scene.with_(initial=initial)
    if scene.is_free:
        raise ValueError(
            NO_MOTION.format(name=ready.name, why="no spring holds the body: give it a soft one")
        )
    accuracy = given_tolerance(tolerance)
    law = law_in_scene(law, scene)
    if why := ready.refusal(scene, law):
        raise ValueError(NO_MOTION.format(name=ready.name, why=why))
    found = within(inf, ready.motion, scene, law, periods, accuracy)
    if not found:
        raise ValueError(NO_MOTION.format(name=ready.name, why=NOT_DRIVEN))
    return _sampled(scene, law, found, samples)


def _sampled(scene: Scene, law: FrictionLaw, found: list[Orbit], samples: int) -> pd.DataFrame:
    from frictionlab.motion.orbit.sample import sample_at, work_of  # imports numba: only where it is needed

    rows, done = [], 0.0
    for place, orbit in enumerate(found):
        last = place == len(found) - 1
        times = np.linspace(orbit.tau[0, 0], orbit.tau[-1, -1], samples + 1)
        part = pd.DataFrame(sample_at(orbit, scene, law, times if last else times[:-1]).columns())
        rows.append(part.assign(work=part.work + done))
        done += work_of(orbit, scene)
    motion = pd.concat(rows, ignore_index=True)
    return motion.assign(**beside_in_si(motion, {} if scene.dimensional is None else si_scales(scene)))
