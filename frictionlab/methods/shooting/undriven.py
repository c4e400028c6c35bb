"""What an undriven mass on a moving belt does in the long run: steady sliding, a cycle, or rest on a belt at rest."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from frictionlab.laws.base import FrictionLaw
from frictionlab.methods.base import Answers, Status
from frictionlab.methods.shooting.undriven_follower import PeriodicMotion, Undriven
from frictionlab.methods.shooting.undriven_path import TURN, NotFound
from frictionlab.scene.scene import Scene


def solve_undriven(scenes: Sequence[Scene], law: FrictionLaw, tolerance: float) -> Answers:
    """Answer undriven scenes, each by the state it reaches from its start."""
    numbers = np.full((5, len(scenes)), np.nan)
    mean, error, period, multipliers, seconds = numbers
    status: list[Status] = ["failed"] * len(scenes)
    reason, model, kind = [""] * len(scenes), [""] * len(scenes), [""] * len(scenes)
    found: dict[int, tuple[Undriven, PeriodicMotion]] = {}
    for i, scene in enumerate(scenes):
        undriven = Undriven(scene, law, tolerance)
        try:
            motion = undriven.motion()
        except NotFound as problem:
            reason[i] = str(problem)
            continue
        finally:
            seconds[i] = undriven.effort.seconds
        found[i] = undriven, motion
        status[i], model[i], kind[i] = "ok", f"undriven: {motion.kind}", "estimated"
        mean[i], error[i] = motion.mean, motion.error
        period[i], multipliers[i] = motion.period / TURN, motion.multiplier
        if not motion.error <= tolerance:
            reason[i] = f"the error is above the tolerance {tolerance:.1e}"
    return Answers(
        status=status,
        reason=reason,
        model=model,
        error_kind=kind,
        mean=mean,
        error=error,
        period=period,
        floquet=lambda: multipliers,
        seconds=seconds,
        orbit=lambda i: found[i][0].orbit(found[i][1]) if i in found else None,
    )
