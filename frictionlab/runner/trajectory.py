"""Motions in time from Python: transients, several periods, what never repeats, and the events on the way."""

from __future__ import annotations

from math import inf
from typing import Any

import numpy as np
import pandas as pd

from frictionlab.laws.base import FrictionLaw
from frictionlab.methods.base import Method
from frictionlab.motion.orbit.record import Orbit
from frictionlab.motion.orbit.recorder import interpolation_weights
from frictionlab.runner.arguments import given_law, given_method, given_scene, given_tolerance
from frictionlab.runner.engine import within
from frictionlab.runner.part import beside_in_si, si_scales
from frictionlab.scene.scene import Initial, Scene
from frictionlab.study.grid import law_in_scene
from frictionlab.values.quantities import Floats, at_least_one

_STILL, _PLACES = 1e-12, np.linspace(-1.0, 1.0, 65)
"""Slip over the largest velocity, and rest over the time, that are rounding; places in a panel between which slip is
taken to turn once."""
_LOOKS = interpolation_weights(_PLACES)
NO_MOTION = "no motion in time is known of this scene and law by {name}: {why}"
NOT_DRIVEN = "it needs a mass, a law that is not solved axis by axis, and method auto or shooting"


class Trajectory(pd.DataFrame):  # type: ignore[misc]  # pandas tells mypy no types
    """Motion in time, a row for each instant.

    Attributes
    ----------
    events : pandas.DataFrame
        A row for each event along the belt, in the order of time: ``tau``, ``event`` ("stick begins", "stick
        ends" or "reversal" of the slip), ``x1``, ``v1``; in SI units, too, if the scene is.
    """

    _metadata = ["events"]  # noqa: RUF012 - pandas asks for a list
    events: pd.DataFrame

    @property
    def _constructor(self) -> type[pd.DataFrame]:
        """Make a plain table of a part of the rows, of which these are no longer the events."""
        return pd.DataFrame


def trajectory(
    scene: Scene,
    law: FrictionLaw,
    periods: int = 10,
    samples: int = 200,
    initial: Initial | None = None,
    method: str | Method = "auto",
    tolerance: float = 1e-8,
) -> Trajectory:
    """Compute the motion of a mass from an initial state.

    A period is the common period of all that changes in time; if nothing drives the mass it is that of the free
    mass without damping, 2 pi. Instants of stick and reversal are located.

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
    initial : Initial or dict, optional
        Position and velocity at tau = 0. ``scene.initial`` if left out; if the scene has none either the
        friction-free motion, or rest on the belt if nothing drives the mass. In SI units a mapping,
        ``{"x": "1 mm"}``.
    method : str or Method, default "auto"
        "auto" or "shooting".
    tolerance : float, > 0, default 1e-8
        Absolute bound [-] on the error of the mean friction of a period.

    Returns
    -------
    Trajectory
        Table of pandas with a row for each instant. The columns are those of ``state.orbit(n)``: ``tau``, ``x1``,
        ``v1``, ``x2``, ``v2``, ``friction``, ``load``, ``slip``, ...; for a scene in SI units ``tau_s``,
        ``x1_m``, ``v1_m_per_s``, ..., too. Its ``.events`` has a row for each begin and end of stick, and each
        reversal of slip.

    Raises
    ------
    ValueError
        If the method does not follow such a motion, no spring holds the body, or a value makes no sense.
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
    >>> block = fl.Scene(damping_ratio=0, normal_load=1, belt_speed=0, initial=fl.Initial(x=4.5, velocity=0))
    >>> fl.trajectory(block, fl.Coulomb(mu=1), periods=2).events["event"].tolist()
    ['reversal', 'stick begins']
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


def _sampled(scene: Scene, law: FrictionLaw, found: list[Orbit], samples: int) -> Trajectory:
    from frictionlab.motion.orbit.sample import sample_at, work_of  # imports numba: only where it is needed

    rows, done = [], 0.0
    for place, orbit in enumerate(found):
        last = place == len(found) - 1
        times = np.linspace(orbit.tau[0, 0], orbit.tau[-1, -1], samples + 1)
        part = pd.DataFrame(sample_at(orbit, scene, law, times if last else times[:-1]).columns())
        rows.append(part.assign(work=part.work + done))
        done += work_of(orbit, scene)
    motion, events = pd.concat(rows, ignore_index=True), _events(scene, found)
    scales = {} if scene.dimensional is None else si_scales(scene)
    told = Trajectory(motion.assign(**beside_in_si(motion, scales)))
    told.events = events.assign(**beside_in_si(events, scales))
    return told


def _events(scene: Scene, found: list[Orbit]) -> pd.DataFrame:
    """Return where stick along the belt begins and ends, and where slip turns round, in the order of time."""
    from scipy.optimize import brentq

    belt, rows, side, sticking = scene.signals().belt[0], list[tuple[Any, ...]](), 0.0, False
    released: tuple[float, ...] | None = None  # where stick ended, until slip has a side
    for orbit in found:
        rests = np.zeros(len(orbit.tau), bool) if orbit.stick is None else orbit.stick
        for tau, x, v, sticks in zip(orbit.tau, orbit.x.real, orbit.v.real, rests, strict=True):
            slip = v - scene.belt_speed - belt(tau)
            here = float(tau[0]), float(x[0]), float(v[0])
            if sticks and not sticking:
                rows.append((here[0], "stick begins", *here[1:]))
            elif sticking and not sticks and here[0] - rows[-1][0] <= _STILL * here[0]:
                rows.pop()  # a rest of no length
            elif sticking and not sticks:
                rows.append((here[0], "stick ends", *here[1:]))
                released = here
            sticking = bool(sticks)
            fine = _LOOKS @ slip
            signs = np.where(np.abs(fine) > _STILL * np.abs(v).max(), np.sign(fine), 0.0)
            for k in () if sticks else np.flatnonzero(signs).tolist():
                if side * signs[k] < 0.0:
                    place = float(_PLACES[max(k - 1, 0)])
                    if k > 0 and fine[k - 1] * fine[k] < 0.0:
                        place = brentq(_at, place, float(_PLACES[k]), (slip,))
                    then = released or tuple(_at(place, each) for each in (tau, x, v))
                    rows.append((then[0], "reversal", *then[1:]))
                side, released = signs[k], None
    return pd.DataFrame(rows, columns=["tau", "event", "x1", "v1"])


def _at(place: float, values: Floats) -> float:
    """Compute the polynomial through the values at the nodes of a panel."""
    return float(interpolation_weights(np.array([place]))[0] @ values)
