"""Steady states from Python, without a table."""

from __future__ import annotations

from collections.abc import Sequence
from math import inf

import numpy as np

from frictionlab.laws.base import FrictionLaw
from frictionlab.methods.base import Method
from frictionlab.runner.arguments import given_law, given_method, given_scene, given_tolerance
from frictionlab.runner.engine import within
from frictionlab.runner.free_body import MotionOnSprings
from frictionlab.runner.part import Answered, Part, si_columns, si_scales
from frictionlab.runner.pieces import Chunk, Task
from frictionlab.runner.solve import answer, columns_answered, solve
from frictionlab.runner.state import InSI, OrbitOf, SteadyState
from frictionlab.runner.words import in_si_words
from frictionlab.scene.scene import Scene
from frictionlab.scene.scenes import Scenes
from frictionlab.study.grid import law_in_scene
from frictionlab.values.columns import ALL, RESULTS, selected


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
        part, motion = within(inf, solve, chunk), MotionOnSprings(chunk, _motion_of)
    else:
        (found,) = within(inf, answer, chunk)  # an interrupt is obeyed while a kernel runs
        part, motion = within(inf, columns_answered, chunk, [found]), _motion_in(found, chunk)
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


def _in_si(part: Part, scene: Scene) -> InSI:
    """Return the columns in SI units; none where the scene is not given in them."""
    if scene.dimensional is None:
        return InSI()
    found = {name: part.numbers.get(name, np.full(1, np.nan)) for name in RESULTS}
    scales = {name: np.array([scale]) for name, scale in si_scales(scene).items()}
    return InSI({name: float(column[0]) for name, column in si_columns(found, scales).items()})
