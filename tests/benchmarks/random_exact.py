"""The exact method on random scenes, counted: python tests/benchmarks/random_exact.py [SCENES] [COMPARED] [SEED].

SCENES (default 100,000) are solved one by one; the first COMPARED (default 0) that have one answer are also
followed by brute force. Exit code 1 where an answer is missing or its error does not cover the difference.
"""

from __future__ import annotations

import sys
import time
from collections import Counter
from pathlib import Path

import numpy as np

sys.path.insert(0, str(Path(__file__).parents[1]))
sys.path.insert(0, str(Path(__file__).parents[1] / "methods" / "exact"))
from random_scenes import draw
from test_exact import against_brute_force

from frictionlab.methods.exact.method import Exact


def count(scenes: int, seed: int) -> Counter[str]:
    """What became of each scene: its status, and for ``ok`` the decade its error stays below."""
    rng, found = np.random.default_rng(seed), Counter[str]()
    for number in range(scenes):
        one, law = draw(rng)
        answers = Exact().solve([one], law, 1e-8)
        status, error = answers.status[0], float(answers.error[0])
        found[status] += 1
        if status == "ok":
            decade = next((d for d in (-12, -11, -10, -9, -8) if error <= 10.0**d), 0)
            found[f"ok, error <= 1e{decade}" if decade else "ok, error above 1e-8, said so"] += 1
            silent = not decade and not answers.reason[0]
            if silent or not abs(answers.mean[0].real) <= law.mu * 1.001:
                found["WRONG"] += 1
                print(number, one, law, answers.reason, error)
        elif status != "not_unique" or not answers.reason[0]:
            unbounded = "without bound" in answers.reason[0]
            found["failed, undamped resonance without bound" if unbounded else "WRONG"] += 1
            if not unbounded:
                print(number, status, answers.reason, one, law)
    return found


if __name__ == "__main__":
    given = [int(argument) for argument in sys.argv[1:]]
    wanted, compared, seed = given + [100_000, 0, 1][len(given) :]
    start = time.perf_counter()
    found = count(wanted, seed)
    for line in sorted(found.items()):
        print(*line)
    uncovered = against_brute_force(np.random.default_rng(seed + 1), compared)
    print(
        f"{compared} compared with brute force, {len(uncovered)} uncovered; {time.perf_counter() - start:.0f} s"
    )
    for case in uncovered:
        print(*case)
    sys.exit(bool(uncovered or found["WRONG"]))
