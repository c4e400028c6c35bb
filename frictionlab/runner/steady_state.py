"""Steady states from Python, without a table."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from math import inf, isfinite
from numbers import Real
from typing import Any

import numpy as np

from frictionlab.laws.base import FrictionLaw
from frictionlab.methods.base import Method
from frictionlab.runner.arguments import given_law, given_method, given_scene, given_tolerance
from frictionlab.runner.drift import FOR_BALANCE, drift_of
from frictionlab.runner.engine import within as obeying
from frictionlab.runner.free_body import MotionOnSprings
from frictionlab.runner.part import Answered, Part, si_columns, si_scales
from frictionlab.runner.pieces import Chunk, Task
from frictionlab.runner.solve import answer, columns_answered, solve
from frictionlab.runner.state import OrbitOf, ResultsInSI, SteadyState
from frictionlab.runner.words import in_si_words
from frictionlab.scene.scene import Scene
from frictionlab.scene.scenes import Scenes
from frictionlab.study.grid import law_in_scene
from frictionlab.values.columns import ALL, RESULTS, selected
from frictionlab.values.notes import Unfit, python_text
from frictionlab.values.units import in_units


def steady_state(
    scene: Scene, law: FrictionLaw, method: str | Method = "auto", tolerance: float = 1e-8
) -> SteadyState:
    """Compute the steady state of one scene.

    Refused and failed states are returned, too: ``status`` and ``reason`` tell them.

    Parameters
    ----------
    scene : Scene
        Body and belt, and what shakes them.
    law : FrictionLaw
        Law of friction.
    method : str or Method, default "auto"
        Name of a method, or a method such as ``fl.March(steps=1000)``.
    tolerance : float, > 0, default 1e-8
        Absolute bound [-] on the error of ``mean_friction``.

    Returns
    -------
    SteadyState
        Mean friction and all other result columns.

    Raises
    ------
    ValueError
        If a value makes no sense.
    TypeError
        If a value is of another kind.
    BrokenPlugin
        If an installed law or a law from a file cannot be used.

    Examples
    --------
    >>> import frictionlab as fl
    >>> scene = fl.Scene(damping_ratio=0.1, normal_load=10, belt_speed=5, drive=fl.Drive(unbalance=10, frequency=1))
    >>> state = fl.steady_state(scene, fl.Coulomb(mu=0.4))
    >>> round(state.mean_friction, 4), state.error < 1e-8, state.status
    (0.0506, True, 'ok')
    """
    scene, law, ready = given_scene(scene), given_law(law), given_method(method)
    task = Task(given_tolerance(tolerance), columns=selected([ALL]))
    chunk = Chunk(Scenes.of([scene]), law_in_scene(law, scene), ready, task)
    motion: OrbitOf | MotionOnSprings
    if scene.is_free:
        part, motion = obeying(inf, solve, chunk), MotionOnSprings(chunk, _motion_of)
    else:
        (found,) = obeying(inf, answer, chunk)  # an interrupt is obeyed while a kernel runs
        part, motion = obeying(inf, columns_answered, chunk, [found]), _motion_in(found, chunk)
    numbers = {name: float(column[0]) for name, column in part.numbers.items()}
    scales = {} if scene.dimensional is None else si_scales(scene)
    words = {name: in_si_words(column[0], scales) for name, column in part.text.items()}
    return SteadyState(**words, **numbers, si=_in_si(part, scene), motion=motion)  # type: ignore[arg-type]


def _motion_of(chunk: Chunk) -> OrbitOf:
    return _motion_in(answer(chunk)[0], chunk)


def _motion_in(found: Answered, chunk: Chunk) -> OrbitOf:
    return OrbitOf(found.answers.orbit, chunk.scenes[0], chunk.law)


def steady_states(scenes: Scenes, law: FrictionLaw, tolerance: float, columns: Sequence[str]) -> Part:
    """Solve one law along rising belt speeds, on the thread of the caller, who asks hundreds of times.

    Raises BrokenPlugin.
    """
    task = Task(tolerance, columns=selected(columns))
    chunk = Chunk(scenes, law_in_scene(law, scenes.scene), given_method("auto"), task)
    return solve(chunk)


def _in_si(part: Part, scene: Scene) -> ResultsInSI:
    """Return the columns in SI units; none where the scene is not given in them."""
    if scene.dimensional is None:
        return ResultsInSI()
    found = {name: part.numbers.get(name, np.full(1, np.nan)) for name in RESULTS}
    scales = {name: np.array([scale]) for name, scale in si_scales(scene).items()}
    return ResultsInSI({name: float(column[0]) for name, column in si_columns(found, scales).items()})


@dataclass(frozen=True)
class DriftSpeed:
    """Speed at which a body travels over a plate that vibrates; ``fl.drift_speed`` returns it.

    Attributes
    ----------
    speed : float
        Mean velocity of the body, positive along x1 [omega_1 L; m/s if the scene is in SI units].
    error : float
        Bound on its absolute error, estimated.
    scene : Scene
        Scene with the belt at minus this speed, in which the body stays where it is.

    Examples
    --------
    >>> import frictionlab as fl
    >>> shaken = fl.BeltVibration(velocity_amplitude=1, frequency=1, waveform={"square": {"duty": 0.8}})
    >>> scene = fl.Scene(spring=False, damping_ratio=0, normal_load=1, belt_speed=0, belt_vibration=shaken)
    >>> drift = fl.drift_speed(scene, fl.Coulomb(mu=0.01))
    >>> round(drift.speed, 3), drift.scene.belt_speed == -drift.speed
    (0.397, True)
    """

    speed: float
    error: float
    scene: Scene


def drift_speed(
    scene: Scene,
    law: FrictionLaw,
    force: float | str = 0.0,
    within: tuple[float | str, float | str] | None = None,
    method: str | Method = "auto",
    tolerance: float = 1e-8,
) -> DriftSpeed:
    """Compute the speed at which a body that no spring holds travels over a plate that vibrates.

    At this speed the mean of friction, the mean of the loads, the dashpot and ``force`` balance. The belt speed
    of the scene is of no account.

    Parameters
    ----------
    scene : Scene
        Body without a spring (``spring=False``, in SI units ``stiffness=0``), and what shakes it.
    law : FrictionLaw
        Law of friction.
    force : float or str, default 0
        Constant force along x1, beside those of the scene [K_1 L; N if the scene is in SI units, or text with a
        unit there].
    within : tuple of float or str, optional
        Two speeds between which it is sought. If left out it is sought from rest on, ever faster, towards the
        side to which the forces drive a body at rest; where friction falls with speed there may be others.
    method : str or Method, default "auto"
        Name of a method, or a method.
    tolerance : float, > 0, default 1e-8
        Absolute bound [-] on the error of the mean friction at each speed.

    Returns
    -------
    DriftSpeed
        Speed, its error, and the scene in which the body stays.

    Raises
    ------
    ValueError
        If the body has a spring, if there is no such speed, or if a value makes no sense.
    TypeError
        If scene, law or method are of another kind.

    References
    ----------
    Motion of a body on a vibrating plate: Blekhman, Vibrational Mechanics (2000).

    Examples
    --------
    >>> import frictionlab as fl
    >>> waves = {"harmonics": [{"order": 1, "amplitude": 1}, {"order": 2, "amplitude": 0.5, "phase": 90}]}
    >>> scene = fl.Scene.si(
    ...     mass="10 g", stiffness=0, normal_load="98.1 mN", belt_speed=0,
    ...     belt_vibration={"velocity_amplitude": "0.1 m/s", "frequency": "50 Hz", "waveform": waves},
    ... )
    >>> found = fl.drift_speed(scene, fl.Coulomb(mu=0.2))
    >>> round(found.speed, 4), found.error < 1e-6
    (0.049, True)
    """
    scene, law, ready = given_scene(scene), given_law(law), given_method(method)
    if not scene.is_free:
        raise ValueError("drift_speed needs a body without a spring: spring=False, in SI units stiffness=0")
    si = scene.dimensional
    speed_unit, force_unit = (1.0, 1.0) if si is None else (si.scales.velocity, si.scales.force)
    pushed = _number("force", force, "N", scene) / force_unit
    ends = None if within is None else _ends(within, scene, speed_unit)
    chunk = Chunk(
        Scenes.of([scene]),
        law_in_scene(law, scene),
        ready,
        Task(given_tolerance(tolerance), columns=FOR_BALANCE),
    )
    found = obeying(inf, drift_of, chunk, solve, pushed, ends)
    if found.reason:
        raise ValueError(found.reason)
    speed = found.speed * speed_unit
    return DriftSpeed(speed, found.error * speed_unit, scene.at(-speed))


def _number(name: str, value: float | str, unit: str, scene: Scene) -> float:
    """Return the number that is given, as text with a unit, too, where the scene is in SI units."""
    read = in_units(value, unit) if isinstance(value, str) and scene.dimensional is not None else value
    if isinstance(read, Unfit | bool) or not isinstance(read, Real) or not isfinite(read):
        raise ValueError(f"{name}: {getattr(read, 'what', 'must be a number')}, got {python_text(value)}")
    return float(read)


def _ends(within: Any, scene: Scene, unit: float) -> tuple[float, float]:
    """Return the ends of the range that is given, the lower one first."""
    if isinstance(within, str) or not isinstance(within, Sequence) or len(within) != 2:
        raise ValueError(f"within: must be two speeds, got {python_text(within)}")
    low, high = sorted(_number("within", one, "m/s", scene) / unit for one in within)
    if low == high:
        raise ValueError(f"within: must be two different speeds, got {python_text(within)}")
    return low, high
