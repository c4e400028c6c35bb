"""Points whose body no spring holds: solved on ever softer springs, their columns taken to the limit."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import replace
from functools import cached_property
from typing import Any

import numpy as np

from frictionlab.methods.base import STATISTICAL
from frictionlab.methods.under_way import UnderWay, told_to
from frictionlab.methods.words import AUTO, ModelWord
from frictionlab.runner.drift import drift_of
from frictionlab.runner.part import Part, beside_in_si, si_scales
from frictionlab.runner.pieces import Chunk
from frictionlab.scene.free_body import WEIGHTS_OF_SPRINGS, by_new_events, held, springs_for, without_spring
from frictionlab.scene.units import Units, measured
from frictionlab.study.registry import method_class
from frictionlab.theory.rest import size_of_friction
from frictionlab.values.columns import ALSO_IN_SI, COLUMNS
from frictionlab.values.quantities import Floats

_SCALES = {each.name: each.scale for each in COLUMNS if each.scale in ("velocity", "energy")}
_SCALES |= {name: scale for name, (_, scale) in ALSO_IN_SI.items()}
_COUNTS = "reversals", "force_reversals", "period", "window", "harmonic", "seconds"
"""Columns of whole numbers, and the time of kernels: those of the softest spring."""
_INDIFFERENT = "floquet", "floquet_error"
"""Columns that a body has not whose place nothing decides."""
DRIFT = frozenset({"drift_speed", "drift_speed_error"})
SHARE_OF_TOLERANCE = 0.1
"""Tolerance asked with each spring, over that of the point: the errors of three are weighted by 5 in all."""


def on_springs(chunk: Chunk) -> list[tuple[Chunk, Units]]:
    """Return the chunk with each spring, and the units that it is in."""
    task = replace(chunk.task, tolerance=SHARE_OF_TOLERANCE * chunk.task.tolerance)
    return [
        (replace(chunk, scenes=held(chunk.scenes, units), law=measured(chunk.law, units), task=task), units)
        for units in springs_for(chunk.scenes.scene, chunk.law.memory_kind != "none")
    ]


def solved_on_springs(chunk: Chunk, solve: Callable[[Chunk], Part]) -> Part:
    """Return the limit of what is found with each spring, point by point, by ``solve``.

    Where `auto` finds no small enough error shooting solves the points instead: on springs so soft the maps of
    exact solutions have rounding errors of 1e-5 if a force has corners but no jumps.
    """
    part = _limit_of_springs(chunk, solve)
    close = part.numbers["error"] <= chunk.task.tolerance
    if chunk.method.name == "auto" and np.isfinite(part.numbers["error"][~close]).any():
        shot = _limit_of_springs(replace(chunk, method=method_class("shooting")()), solve)
        if np.count_nonzero(shot.numbers["error"] <= chunk.task.tolerance) > np.count_nonzero(close):
            word = f"{AUTO}shooting, {ModelWord.CLOSER})"
            part, shot.text["model"][:] = shot, [model + word for model in shot.text["model"]]
    if not DRIFT.isdisjoint(chunk.task.columns):
        with told_to(UnderWay(0.0, 0.0)):
            drift = drift_of(chunk, solve)
        reasons = part.text["reason"]
        part.text["reason"] = ["; ".join(filter(None, (each, drift.reason))) for each in reasons]
        for name, each in zip(sorted(DRIFT), drift[:2], strict=True):
            part.numbers[name] = np.full(len(chunk), each)
    return part


def _limit_of_springs(chunk: Chunk, solve: Callable[[Chunk], Part]) -> Part:
    """Return the limit of what the method of the chunk finds with each spring."""
    chunks = on_springs(chunk)
    with told_to(UnderWay(0.0, 0.0)):  # the points of the last spring are those that count
        found = [(solve(each), units) for each, units in chunks[:-1]]
    found.append((solve(chunks[-1][0]), chunks[-1][1]))
    parts = [part for part, _ in found]
    text = {name: list(words) for name, words in parts[-1].text.items()}
    numbers = limit_of_columns([(part.numbers, units) for part, units in found])
    limit = size_of_friction(chunk.scenes.scene, chunk.law)
    numbers["error"] = numbers["error"] + limit * by_new_events(chunk.law.memory_kind != "none")
    for i in range(len(chunk)):
        _judge(i, parts, text, numbers, chunk)
    kept = {
        name: {
            at: limit_of_columns([(part.kept[name][at], units) for part, units in found])
            for at in parts[-1].kept[name]
            if name != "states" and all(at in part.kept.get(name, {}) for part in parts)
        }
        for name in parts[-1].kept
    }
    return Part(text, numbers, kept)


def _judge(
    i: int, parts: Sequence[Part], text: dict[str, list[str]], numbers: Mapping[str, Floats], chunk: Chunk
) -> None:
    """Write the status and the words of a point; where it has no mean its numbers are taken away.

    Only the error of the limit decides: with a spring a point may fail by the tolerance that is asked there.
    """
    means = [_has_mean(part, i) for part in parts]
    states = ["ok" if mean else part.text["status"][i] for mean, part in zip(means, parts, strict=True)]
    best = next((part for part in parts if part.text["status"][i] == states[-1]), parts[-1])
    for name, words in text.items():
        words[i] = best.text[name][i]
    error, tolerance = numbers["error"][i], chunk.task.tolerance
    model, auto, why = text["model"][i].partition(AUTO)
    text["model"][i] = f"{'; '.join(filter(None, (model, ModelWord.SOFT_SPRINGS)))}{auto}{why}"
    text["error_kind"][i] = text["error_kind"][i].replace("guaranteed", "estimated")
    others = [(each != "ok", part) for part, each in zip(parts, states, strict=True) if len(set(states)) > 1]
    other = max(others, key=lambda each: each[0])[1] if others else None
    failed = ""
    if other is not None:
        status, reason = other.text["status"][i], other.text["reason"][i]
        failed = f"springs that stand for none lead to different ends: {status}: {reason}"
    elif error > tolerance and chunk.method.name == "auto" and text["error_kind"][i] != STATISTICAL:
        failed = (
            f"springs that stand for none leave an error of {error:.1e}, above the tolerance {tolerance:.1e}"
        )
    elif states[-1] == "ok" != text["status"][i]:  # no spring alone is as close as it was asked to be
        text["status"][i], text["reason"][i] = "ok", ""
        text["error_kind"][i] = "estimated"
    if failed:
        text["status"][i], text["reason"][i] = "failed", failed
        text["error_kind"][i] = text["unique"][i] = ""
        for column in numbers.values() if other is not None else ():
            column[i] = np.nan


def _has_mean(part: Part, i: int) -> bool:
    """Return if a point has a mean friction and an error, be it larger than asked."""
    mean, error = (np.isfinite(part.numbers[name][i]) for name in ("mean_friction", "error"))
    return bool(mean and error and part.text["status"][i] in ("ok", "failed"))


def limit_of_columns(found: Sequence[tuple[Mapping[str, Any], Units]]) -> dict[str, Floats]:
    """Return columns for no spring in the units of the scene: of errors what they are with it, of angles the limit.

    Positions are told from their mean, which the spring sets.
    """
    limit: dict[str, Floats] = {}
    change: dict[str, Floats] = {}
    for name in found[-1][0]:
        values = np.array([_scaled(name, columns[name], units) for columns, units in found], float)
        if name.endswith("phase"):
            values = values + 360.0 * np.round((values[-1] - values) / 360.0)
        limit[name], change[name] = without_spring(values)
        if name.endswith("error"):
            limit[name] = np.tensordot(np.abs(WEIGHTS_OF_SPRINGS), values, 1)
        if name in _COUNTS:
            limit[name] = values[-1]
    for name in (each for each in limit if each.endswith("error")):
        of = "mean_friction" if name == "error" else name.removesuffix("_error")
        limit[name] = limit[name] + change.get(of, 0.0)
    if "stick_fraction" in limit:
        limit["stick_fraction"] = np.clip(limit["stick_fraction"], 0.0, 1.0)
    return limit


def _scaled(name: str, column: Any, units: Units) -> Floats:
    """Return a column in the units of the scene."""
    scale = _SCALES.get(name.removesuffix("_error"))
    values = np.asarray(column, float) * (1.0 if scale is None else getattr(units, scale))
    if name in _INDIFFERENT:
        return values * np.nan
    return values - values.mean() if name in ("x1", "x2") else values


class MotionOnSprings:
    """Orbit of a steady state without a spring: the limit of samples and harmonics of those with springs."""

    def __init__(self, chunk: Chunk, motion_of: Callable[[Chunk], Any]) -> None:
        self._chunk, self._motion_of = chunk, motion_of

    @cached_property
    def _found(self) -> list[tuple[Any, Units]]:
        return [(self._motion_of(each), units) for each, units in on_springs(self._chunk)]

    def sampled(self, n: int) -> dict[str, Any] | None:
        """So many samples as columns, as ``OrbitOf`` has them; None where there is no orbit."""
        found, scene = [(motion.sampled(n), units) for motion, units in self._found], self._chunk.scenes[0]
        if any(columns is None for columns, _ in found):
            return None
        columns = limit_of_columns(found)
        return {**columns, **beside_in_si(columns, {} if scene.dimensional is None else si_scales(scene))}

    def harmonics(self, highest: int, across: bool) -> Any:
        """Harmonics 0 ... highest along or across the belt, as ``OrbitOf`` has them."""
        found = [(motion.harmonics(highest, across), units) for motion, units in self._found]
        if any(parts is None for parts, _ in found):
            return None
        return type(found[0][0])(**limit_of_columns([(parts._asdict(), units) for parts, units in found]))
