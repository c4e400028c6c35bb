"""Friction that jumps where slip reverses: the instant between two samples, so that the jump is drawn upright."""

from __future__ import annotations

import numpy as np
import pandas as pd

STEEPER = 4.0  # how much more than before and after it friction changes in a jump
LEAST_SLIP = 1e-9  # of the largest slip: less is rest


def with_jumps(samples: pd.DataFrame) -> pd.DataFrame:
    """Samples in time, with two more at every instant at which friction without memory jumps, before and after it.

    That is where slip reaches zero, as it went until then; friction at rest is that of the stick that follows.
    """
    if "slip" not in samples or ("memory_0" in samples and samples["memory_0"].notna().any()):
        return samples
    slip, friction = (samples[name].to_numpy(dtype=float) for name in ("slip", "friction"))
    slip = np.where(np.abs(slip) > LEAST_SLIP * np.abs(slip).max(), slip, 0.0)
    pieces, done = [], 0
    for at in np.flatnonzero((slip[:-1] != 0.0) & (slip[:-1] * slip[1:] <= 0.0)).tolist():
        share = _reaches_zero(slip, at)
        end = friction[at + 1]
        sticks = at + 2 < len(slip) and slip[at + 1] == slip[at + 2] == 0.0
        if sticks:
            end -= (1.0 - share) * (friction[at + 2] - end)
        around = [abs(friction[at] - friction[at - 1])] if at else [0.0]
        if not sticks and at + 2 < len(slip):
            around.append(abs(friction[at + 2] - end))
        if abs(end - friction[at]) > STEEPER * max(around):
            between = samples.iloc[[at]] + share * (samples.iloc[at + 1] - samples.iloc[at])
            pieces += [
                samples.iloc[done : at + 1],
                *(between.assign(friction=f) for f in (friction[at], end)),
            ]
            done = at + 1
    return pd.concat([*pieces, samples.iloc[done:]], ignore_index=True)


def _reaches_zero(slip: np.ndarray, at: int) -> float:
    """The share of the step after a sample at which slip does, as it went before, else as it is after."""
    slope = slip[at] - slip[at - 1] if at else 0.0
    share = -slip[at] / slope if slope else -1.0
    return float(share if 0.0 < share < 1.0 else slip[at] / (slip[at] - slip[at + 1]))
