"""Reference values for errors: never the results of the method itself."""

from __future__ import annotations

import csv
import math
from collections.abc import Sequence
from pathlib import Path as FilePath
from typing import Any

import numpy as np

from frictionlab.bench.contenders import peer_of
from frictionlab.bench.peers.base import Peer
from frictionlab.bench.peers.listing import PEERS
from frictionlab.bench.record import ReferenceMeans, ReferenceSource, Workload
from frictionlab.bench.solvers import SolverAnswers, solve_points
from frictionlab.laws.base import FrictionLaw
from frictionlab.mistakes.notes import Notes, Path
from frictionlab.quantities import Floats
from frictionlab.scene.scene import Scene
from frictionlab.study.choices import items, method_choice

REFERENCE_COLUMNS = ("belt_speed", "mean_friction")
CAREFUL = 10.0
LOOSER = 100.0
"""Times the tolerance of a peer, for an answer that tells how well the first is known."""


def read_references(given: Any, path: Path, file: FilePath, notes: Notes) -> tuple[ReferenceSource, ...]:
    """The references of a list or of one of its scenes; those with mistakes are noted."""
    if given == []:
        return ()
    listed = items(given, path, "[{kind: shooting, tolerance: 1.0e-12}]", notes)
    read = [_trusted(item, (*path, index), file, notes) for index, item in enumerate(listed)]
    return tuple(trusted for trusted in read if trusted is not None)


def _trusted(item: Any, path: Path, file: FilePath, notes: Notes) -> ReferenceSource | None:
    if notes.mapping(item, path) is None:
        return None
    if "values" in item:
        return _values(item, path, file, notes)
    if "tolerance" not in item:
        notes.add((*path, "tolerance"), "required key is missing")
        return None
    tolerance = notes.positive(item["tolerance"], (*path, "tolerance"))
    told = {key: value for key, value in item.items() if key != "tolerance"}
    if told.get("kind") == "auto":
        notes.add((*path, "kind"), "auto only chooses: name a method it chooses from")
        return None
    if told.get("kind") in PEERS:
        return _peer_reference(told, tolerance, path, notes)
    choice = method_choice(told, path, notes)
    if choice is None or tolerance is None:
        return None
    return ReferenceSource(f"{choice.label} at {tolerance:g}", choice.name, choice.method, tolerance, {})


def _peer_reference(
    told: dict[str, Any], tolerance: float | None, path: Path, notes: Notes
) -> ReferenceSource | None:
    peer = peer_of(told, path, notes)
    if peer is None or tolerance is None:
        return None
    return ReferenceSource(f"{told.get('label', peer.name)} at {tolerance:g}", peer.name, peer, tolerance, {})


def _values(item: dict[str, Any], path: Path, file: FilePath, notes: Notes) -> ReferenceSource | None:
    """``{values: FILE, error: x, label: TEXT}``; the path is relative to the list."""
    notes.mapping(item, path, ("values", "error", "label"))
    if "error" not in item:
        notes.add((*path, "error"), "required key is missing: how well the values are known")
        return None
    error = notes.positive(item["error"], (*path, "error"))
    name = notes.text(item["values"], (*path, "values"))
    label = notes.text(item.get("label", name), (*path, "label"))
    table = _table(file.parent / name, (*path, "values"), notes) if name else None
    return None if error is None or table is None else ReferenceSource(label, "", None, error, table)


def _table(file: FilePath, path: Path, notes: Notes) -> dict[float, float] | None:
    """Mean friction by belt speed."""
    try:
        with file.open(encoding="utf-8", newline="") as text:
            rows = [[float(row[column]) for column in REFERENCE_COLUMNS] for row in csv.DictReader(text)]
    except OSError as problem:
        notes.add(path, f"cannot be read: {problem.strerror}")
    except (KeyError, TypeError, ValueError):
        notes.add(path, f"must be a CSV file of numbers with the columns {' and '.join(REFERENCE_COLUMNS)}")
    else:
        return {speed: mean for speed, mean in rows}
    return None


def reference_means(work: Workload) -> list[ReferenceMeans]:
    """Every reference of a workload at each of its points."""
    return [_reference_means(trusted, work) for trusted in work.references]


def _reference_means(trusted: ReferenceSource, work: Workload) -> ReferenceMeans:
    if trusted.solver is None:
        means = np.array([_known(trusted.values, speed) for speed in work.speeds()])
        return ReferenceMeans(
            trusted.label, "", means, np.where(np.isnan(means), math.nan, trusted.tolerance)
        )
    outcome = solve_points(trusted.solver, work.scenes, work.law, trusted.tolerance)
    means, errors = known_means(trusted, outcome, work.scenes, work.law)
    return ReferenceMeans(trusted.label, trusted.kind, means, errors)


def known_means(
    trusted: ReferenceSource, outcome: SolverAnswers, scenes: Sequence[Scene], law: FrictionLaw
) -> tuple[Floats, Floats]:
    """What a solver's answers are worth as a reference: means and their errors, NaN where it has no answer.

    A method states its error. That of a peer is taken from asking once more, for ``LOOSER`` times the tolerance:
    ``CAREFUL`` times how far that answer is away, and as often the tolerance. Where an integrator gets no nearer the
    errors of both are of one size, and their difference may be small by chance.
    """
    good = np.array(outcome.status) == "ok"
    errors = outcome.errors
    if isinstance(trusted.solver, Peer) and good.any():
        loose = solve_points(trusted.solver, scenes, law, LOOSER * trusted.tolerance)
        errors = CAREFUL * (np.abs(loose.means - outcome.means) + trusted.tolerance)
        good &= np.isfinite(errors)
    return np.where(good, outcome.means, math.nan), np.where(good, errors, math.nan)


def _known(values: dict[float, float], speed: float) -> float:
    """The value at this belt speed, give or take its last digits."""
    return next((mean for at, mean in values.items() if math.isclose(at, speed, rel_tol=1e-12)), math.nan)


def independent(found: Sequence[ReferenceMeans], kind: str, places: Sequence[int]) -> ReferenceMeans | None:
    """The first reference not made by this kind of method or peer that knows one of these points."""
    others = (each for each in found if each.kind != kind)
    return next((each for each in others if np.isfinite(each.means[list(places)]).any()), None)
