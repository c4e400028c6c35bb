"""The exact method on random scenes that vary in time.

python tests/benchmarks/random_varying.py [SCENES] [COMPARED] [SEED] [DECADES]

SCENES (default 10,000) with waveforms, vibrating belts and changing normal loads are solved one by one; the first
COMPARED (default 0) are also followed by an unrelated integration, for a period from our state. DECADES (default 1):
spread of frequencies and friction. Exit code 1 where an answer is missing or its error does not cover the difference.
"""

from __future__ import annotations

import sys
import time
from collections import Counter
from pathlib import Path

import numpy as np

sys.path.insert(0, str(Path(__file__).parents[1]))
sys.path.insert(0, str(Path(__file__).parents[1] / "methods" / "exact"))
from test_varying import difference
from varying_scenes import draw_varying

from frictionlab.methods.exact.method import Exact

INTEGRATION = 1e-10
"""What the unrelated integration may be off."""


def count(scenes: int, rng: np.random.Generator, decades: float) -> tuple[Counter[str], float]:
    """What became of each scene, its status, and for ``ok`` the decade its error stays below; the slowest [s]."""
    found, slowest = Counter[str](), 0.0
    for number in range(scenes):
        one, law = draw_varying(rng, decades)
        if reason := Exact().refusal(one, law):
            found[f"refused: {reason}"] += 1
            continue
        answers = Exact().solve([one], law, 1e-8)
        status, error = answers.status[0], float(answers.error[0])
        slowest = max(slowest, float(answers.seconds[0])) if number else 0.0
        found[status] += 1
        if status == "ok":
            decade = next((d for d in (-12, -11, -10, -9, -8) if error <= 10.0**d), 0)
            found[f"ok, error <= 1e{decade}" if decade else "ok, error above 1e-8, said so"] += 1
            silent = not decade and not answers.reason[0]
            wrong = silent or not abs(answers.mean[0].real) <= law.mu * (1.0 + 1e-9)
        else:
            wrong = status != "not_unique" or not answers.reason[0]
        if wrong:
            found["WRONG"] += 1
            print(number, status, answers.reason, error, one, law)
    return found, slowest


def compare(scenes: int, rng: np.random.Generator, decades: float) -> int:
    """How many answers an unrelated integration does not confirm."""
    uncovered = 0
    for number in range(scenes):
        one, law = draw_varying(rng, decades)
        off, error = difference(one, law)
        if not off <= INTEGRATION + error:
            uncovered += 1
            print(number, "uncovered", off, error, one, law)
    return uncovered


if __name__ == "__main__":
    given = sys.argv[1:]
    wanted, compared, seed = (int(text) for text in (given + ["10000", "0", "1"][len(given) :])[:3])
    decades = float(given[3]) if len(given) > 3 else 1.0
    start = time.perf_counter()
    found, slowest = count(wanted, np.random.default_rng(seed), decades)
    for line in sorted(found.items()):
        print(*line)
    print(f"slowest {slowest:.3f} s; {time.perf_counter() - start:.0f} s in all")
    uncovered = compare(compared, np.random.default_rng(seed + 1), decades)
    print(f"{compared} compared, {uncovered} uncovered; {time.perf_counter() - start:.0f} s")
    sys.exit(bool(uncovered or found["WRONG"]))
