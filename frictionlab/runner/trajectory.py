"""Motions in time from Python: transients, several periods, and what never repeats."""

from __future__ import annotations

from math import inf

import numpy as np
import pandas as pd

from frictionlab.laws.base import FrictionLaw
from frictionlab.methods.base import Method
from frictionlab.motion.orbit.record import Orbit
from frictionlab.runner.arguments import given_law, given_method, given_scene, given_tolerance
from frictionlab.runner.execute import within
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
    """The motion of a driven mass from a start, for so many periods of all that changes in time.

    initial: position and velocity at tau = 0; where left out scene.initial, without that the friction-free motion.
    samples: rows a period, evenly spaced, and one at the end. Columns as ``state.orbit(n)``: tau, x1, v1, x2, v2,
    friction, load, slip, ..., of a scene in SI units tau_s, x1_m, v1_m_per_s, ... too.
    tolerance: on the mean of a period; instants of stick and reversal are located.

    >>> import frictionlab as fl
    >>> drive = fl.Drive(unbalance=10, frequency=1)
    >>> scene = fl.Scene(damping_ratio=0.1, normal_load=10, belt_speed=5, drive=drive)
    >>> motion = fl.trajectory(scene, fl.Coulomb(mu=0.4), periods=3, samples=50, initial=fl.Initial(x=3))
    >>> len(motion), float(motion.x1[0])
    (151, 3.0)

    Raises ValueError where no method follows such a motion, ValueError or TypeError for what makes no sense.
    """
    scene, law, ready = given_scene(scene), given_law(law), given_method(method)
    periods, samples = at_least_one("periods", periods), at_least_one("samples", samples)
    if initial is not None:
        scene = scene.with_(initial=initial)
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
