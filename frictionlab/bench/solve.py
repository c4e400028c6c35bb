"""Points solved by a method or a peer, failures included, what references know of them, and the time of a task."""

from __future__ import annotations

import gc
import os
import pickle
import subprocess
import sys
import tempfile
import time
from collections.abc import Callable, Sequence

import numpy as np
import pandas as pd

from frictionlab.bench.contenders import ReferenceSource
from frictionlab.bench.peers.base import Peer
from frictionlab.laws.base import FrictionLaw
from frictionlab.methods.base import Method
from frictionlab.runner.pieces import Chunk, Task
from frictionlab.runner.solve import FROM_METHODS, answer, number_columns
from frictionlab.scene.scene import Scene
from frictionlab.scene.scenes import Scenes
from frictionlab.values.quantities import Floats

CAREFUL = 10.0
LOOSER = 100.0
"""Times the tolerance of a peer, for an answer that tells how well the first is known."""


def solve_points(
    solver: Method | Peer,
    scenes: Sequence[Scene],
    law: FrictionLaw,
    tolerance: float,
    more: Sequence[str] = (),
) -> pd.DataFrame:
    """Status, reason, mean and error of each point, NaN where there is none; more: columns of a method's orbits."""
    if isinstance(solver, Peer):
        return _by_peer(solver, scenes, law, tolerance)
    pieces, along = [], Scenes.of(scenes)
    for places, found in answer(Chunk(along, law, solver, Task(tolerance))):
        read = number_columns(found, along.taken(places), more) if more and "ok" in found.status else {}
        own = {"status": found.status, "reason": found.reason, "mean": found.mean.real, "error": found.error}
        pieces.append(pd.DataFrame(own | {name: read.get(name, np.nan) for name in more}, index=places))
    return pd.concat(pieces).sort_index()


def _by_peer(peer: Peer, scenes: Sequence[Scene], law: FrictionLaw, tolerance: float) -> pd.DataFrame:
    """All scenes at once where that is quicker; one that fails leaves the others their answers."""
    nothing = pd.DataFrame({"mean": np.full(len(scenes), np.nan), "error": np.nan})
    if (reason := peer.refusal(scenes[0], law)) is not None:
        return nothing.assign(status="refused", reason=reason)
    if peer.together or len(scenes) == 1:
        try:
            found = nothing.assign(mean=peer.solve(scenes, law, tolerance))
            good = np.isfinite(found["mean"])
            told = np.where(good, "", "the answer is no finite number")
            return found.assign(status=np.where(good, "ok", "failed"), reason=told)
        except Exception as problem:  # another's library may raise anything, and keeps its place all the same
            if len(scenes) == 1:
                return nothing.assign(status="failed", reason=str(problem) or type(problem).__name__)
    return pd.concat([_by_peer(peer, [each], law, tolerance) for each in scenes], ignore_index=True)


def known_means(
    reference: ReferenceSource, scenes: Sequence[Scene], law: FrictionLaw, more: Sequence[str] = ()
) -> pd.DataFrame:
    """Mean and error of a reference at each point, NaN where it has no answer; more: as of ``solve_points``.

    A method states its error. That of a peer is taken from asking once more, for ``LOOSER`` times the tolerance:
    ``CAREFUL`` times how far that answer is away, and as often the tolerance. Where an integrator gets no nearer the
    errors of both are of one size, and their difference may be small by chance.
    """
    solver, tolerance = reference.solver, reference.tolerance
    if solver is None:
        means = np.array([reference.value(scene.belt_speed) for scene in scenes])
        return pd.DataFrame({"mean": means, "error": np.where(np.isnan(means), np.nan, tolerance)})
    found = solve_points(solver, scenes, law, tolerance, more)
    if isinstance(solver, Peer):
        loose = solve_points(solver, scenes, law, LOOSER * tolerance)
        found["error"] = CAREFUL * ((loose["mean"] - found["mean"]).abs() + tolerance)
    good = (found["status"] == "ok") & np.isfinite(found["error"])
    return found.assign(mean=found["mean"].where(good), error=found["error"].where(good))


def whole_task(
    method: Method, scenes: Sequence[Scene], law: FrictionLaw, tolerance: float
) -> Callable[[], object]:
    """Every column of a method's answers."""
    return lambda: number_columns(method.solve(scenes, law, tolerance), scenes, FROM_METHODS)


def time_task(task: Callable[[], object], repeats: int, seconds: float) -> Floats:
    """Times [s] of a task run so often, or for so long if that is less, but once at least; warmed up before."""
    spent: list[float] = []
    collecting = gc.isenabled()
    gc.disable()
    try:
        while not spent or (len(spent) < repeats and sum(spent) < seconds):
            start = time.perf_counter()
            task()
            spent.append(time.perf_counter() - start)
    finally:
        if collecting:
            gc.enable()
    return np.array(spent)


SCRIPT = """
import pickle, sys, time
method, scenes, law, tolerance = pickle.load(sys.stdin.buffer)
from frictionlab.bench.solve import whole_task
whole_task(method, scenes, law, tolerance)()
print(time.process_time())
"""


def first_run(method: Method, scenes: Sequence[Scene], law: FrictionLaw, tolerance: float) -> float:
    """Processor time [s] of every column of a curve, imports and compiling included.

    Raises CalledProcessError where the method raises.
    """
    with tempfile.TemporaryDirectory() as empty:
        environment = {name: value for name, value in os.environ.items() if name != "FRICTIONLAB_COMPILE"}
        environment["FRICTIONLAB_CACHE"] = empty
        given, command = pickle.dumps((method, list(scenes), law, tolerance)), [sys.executable, "-c", SCRIPT]
        return float(subprocess.check_output(command, input=given, env=environment))
