"""Derivatives of the mean friction against differences of steady states, on random scenes of every law.

python tests/benchmarks/random_sensitivities.py [--count 300] [--seed 1] [--numbers 3] [--slowest 0.3] [--out CSV]

Scenes are those of random_multipliers.py, each answered by `auto` within so many seconds of kernel time; of each some
numbers are drawn. The reference is the difference of two steady states over each of four offsets, extrapolated from
each to the next; its doubt is the least change from one to the next. A number counts as

- agrees: the derivative is within its error and the doubt of the reference;
- refused: it is empty, with its reason; no reference: steady states beside this one have no mean, or an onset lies
  between them and it;
- doubtful: the doubt of the reference is larger than the derivative; blunt: the stated error is;
- wrong: none of these. Each is printed.
"""

from __future__ import annotations

import argparse
import csv
import random
import sys
import time
from collections import Counter
from itertools import pairwise
from pathlib import Path
from typing import Any

import numpy as np
import random_multipliers

import frictionlab as fl
from frictionlab.sensitivity.parameters import Pair

OFFSETS = 1e-2, 2e-3, 4e-4, 8e-5
"""Of the size of a number."""
ONE_SIDED = 0.05
"""Difference of the one-sided slopes over an offset, of the slope, from which on an onset may lie within it."""
TOLERANCE = 1e-11


def reference(pair: Pair, path: str, number: float) -> tuple[float, float]:
    """The derivative by differences of steady states, and its doubt; NaN where there is no reference."""
    size = 90.0 if path.endswith("phase") else abs(number) or 1.0
    slopes, noise = [], []
    for offset in OFFSETS:
        try:
            states = [
                fl.steady_state(*pair.with_(path, number + side * offset * size), tolerance=TOLERANCE)
                for side in (1.0, -1.0)
            ]
        except ValueError:
            slopes.append(np.nan)
            noise.append(np.nan)
            continue
        ok = all(state.status == "ok" or state.error < 1e-6 for state in states)
        means = [state.mean_friction if ok else np.nan for state in states]
        slopes.append((means[0] - means[1]) / (2.0 * offset * size))
        noise.append((states[0].error + states[1].error + 1e-15) / (2.0 * offset * size))
        # the steady state itself is the same at every offset
        middle = fl.steady_state(*pair, tolerance=TOLERANCE).mean_friction
        if (
            abs(means[0] - 2.0 * middle + means[1]) / (offset * size)
            > ONE_SIDED * abs(slopes[-1]) + 2.0 * noise[-1]
        ):
            slopes[-1] = np.nan
    ratio = (OFFSETS[0] / OFFSETS[1]) ** 2
    better = [(ratio * b - a) / (ratio - 1.0) for a, b in pairwise(slopes)]
    doubts = [abs(b - a) + n for (a, b), n in zip(pairwise(slopes), noise[1:], strict=True)]
    if not np.isfinite(doubts).any():
        return np.nan, np.nan
    if np.isnan(slopes[-1]):
        return np.nan, np.nan
    best = int(np.nanargmin(doubts))
    return better[best], doubts[best]


def compared(scene: Any, law: Any, rng: random.Random, numbers: int) -> list[dict[str, Any]]:
    """Rows of the account; none where no derivative is asked for."""
    pair = Pair(scene, law)
    paths = sorted(pair.numbers())
    begun = time.process_time()
    table = fl.sensitivities(scene, law, rng.sample(paths, min(numbers, len(paths))))
    seconds, rows = time.process_time() - begun, []
    for row in table.itertuples():
        value, doubt = reference(pair, row.parameter, row.value)
        off = abs(row.derivative - value)
        if row.reason:
            verdict = "refused"
        elif np.isnan(value):
            verdict = "no reference"
        elif off > row.error + doubt:
            verdict = "wrong"
        elif row.error > abs(row.derivative) + 1e-6 / max(abs(row.value), 1e-6):
            verdict = "blunt"
        else:
            verdict = "doubtful" if doubt > abs(value) and not off < 1e-9 else "agrees"
        told = {
            "verdict": verdict,
            "parameter": row.parameter,
            "value": row.value,
            "maps": table.attrs["maps"],
        }
        told |= {
            "derivative": row.derivative,
            "error": row.error,
            "reference": value,
            "doubt": doubt,
            "off": off,
        }
        rows.append(told | {"reason": row.reason, "seconds": seconds})
    return rows


def main() -> int:
    """Draw, compare, count."""
    parser = argparse.ArgumentParser(description=__doc__.partition("\n")[0])
    parser.add_argument("--count", type=int, default=300)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--numbers", type=int, default=3)
    parser.add_argument("--slowest", type=float, default=0.3)
    parser.add_argument("--out", type=Path)
    given = parser.parse_args()
    rng, rows, scenes, start = random.Random(given.seed), [], 0, time.perf_counter()
    while scenes < given.count:
        drawn = random_multipliers.draw(rng)
        if drawn is None:
            continue
        one, scene, law = drawn
        state = fl.steady_state(scene, law)
        if not state.seconds < given.slowest:
            continue
        scenes += 1
        for row in compared(scene, law, rng, given.numbers):
            rows.append({"scene_number": scenes, "family": one["family"], "freedom": one["freedom"], **row})
            rows[-1] |= {"scene": repr(scene.given()), "law": repr(law)}
            if row["verdict"] == "wrong":
                print(rows[-1], flush=True)
        if scenes % 20 == 0:
            counts = Counter(row["verdict"] for row in rows)
            print(f"{scenes} scenes, {time.perf_counter() - start:.0f} s:", dict(counts), flush=True)
            print(
                "  refused:", dict(Counter(row["reason"][:60] for row in rows if row["reason"])), flush=True
            )
    if given.out is not None:
        with given.out.open("w", newline="") as file:
            writer = csv.DictWriter(file, list(rows[0]))
            writer.writeheader()
            writer.writerows(rows)
    for key in sorted({(row["family"], row["freedom"]) for row in rows}):
        print(*key, dict(Counter(row["verdict"] for row in rows if (row["family"], row["freedom"]) == key)))
    print(dict(Counter(row["verdict"] for row in rows)))
    return int(any(row["verdict"] == "wrong" for row in rows))


if __name__ == "__main__":
    sys.exit(main())
