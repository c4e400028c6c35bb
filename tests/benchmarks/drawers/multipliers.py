"""Floquet multipliers of every law against central differences of the period map.

The map is that of shooting, at an accuracy of 1e-13, from the orbit closed at 1e-11; differences are taken over three
shifts, and the change of the largest modulus from shift to shift is the doubt of the reference. The column agrees
where it is within floquet_error of the reference, or within 1e-6 of it, relative to the larger of it and 1e-3, or
within three times the doubt. Where one-sided differences disagree at every shift no number is right.
"""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np
from campaign import WRONG, Campaign, Drawn, Verdicts

import frictionlab as fl
from drawers.driven import draw
from frictionlab.methods.periodic.continuation import CLOSED
from frictionlab.methods.periodic.problem import PeriodicProblem
from frictionlab.study.grid import law_in_scene

RELATIVE, LEAST = 1e-6, 1e-3
SHIFTS = 1e-4, 1e-5, 1e-6
"""Relative to the size of a state."""


class Reference(NamedTuple):
    """The largest modulus by differences of the map, its doubt, and how much one-sided differences disagree."""

    modulus: float
    doubt: float
    kink: float


def by_differences(scene: fl.Scene, law: Any) -> Reference | None:
    """Of the orbit at the belt speed of the scene; None where the fine search finds none."""
    problem = PeriodicProblem(scene, law, 1e-11)
    curve, _ = problem.close([scene], periods=1.0, wanted=CLOSED)
    if curve.results[0, 3] < 0.0:
        return None
    # slip that never reverses is otherwise followed by its closed form
    problem.goal = problem.goal._replace(constant=False)
    state = curve.states[0]
    size = 1.0 + float(np.linalg.norm(state))
    way = abs(scene.belt_speed) * 2.0 * np.pi / scene.frequency

    def image(start: Any) -> Any:
        return problem.followed_on(scene.belt_speed, start.copy(), 1, 1e-13).state

    middle, found, kinks = image(state), [], []
    for relative in SHIFTS:
        shift = min(relative * size, max(0.01 * way, 1e-3 * relative * size))
        ends = [
            np.array([image(state + side * shift * unit) for unit in np.eye(state.size)]).T
            for side in (1.0, -1.0)
        ]
        ahead, behind = (ends[0] - middle[:, None]) / shift, (middle[:, None] - ends[1]) / shift
        moduli = [np.abs(np.linalg.eigvals(each)).max() for each in (0.5 * (ahead + behind), ahead, behind)]
        found.append(float(moduli[0]))
        kinks.append(float(abs(moduli[1] - moduli[2])))
    gaps = [abs(found[1] - found[0]), abs(found[2] - found[1])]
    return Reference(found[1 if gaps[0] < gaps[1] else 2], min(gaps), min(kinks))


def judge(one: Drawn) -> Verdicts:
    """The column of one row."""
    scene, law = one.made()
    row = fl.curve(scene, law, [scene.belt_speed], one.method, one.tolerance).iloc[0]
    found = row["floquet"]
    if row["status"] != "ok":
        yield "no answer", ""
    elif scene.degrees_of_freedom == 2 and scene.load_along_belt_only:
        yield "empty, a plane of a line" if np.isnan(found) else f"{WRONG}: a plane of a line", found
    elif (reference := by_differences(scene, law_in_scene(law, scene))) is None:
        yield "no reference", ""
    elif np.isnan(found):
        yield "empty, with reason" if row["reason"] == row["reason"] else "empty", ""
    else:
        size = max(reference.modulus, LEAST)
        off, allowed = (
            abs(found - reference.modulus),
            max(row["floquet_error"], RELATIVE * size, 3.0 * reference.doubt),
        )
        kinked = "not differentiable" if reference.kink > 1e-2 * size else "not this"
        yield "agrees" if off <= allowed else f"{WRONG}: {kinked}", (found, off, allowed, reference)


CAMPAIGN = Campaign(draw, judge, scenes=500)
