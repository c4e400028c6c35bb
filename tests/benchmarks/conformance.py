"""Put every law and plugin of this checkout through the battery; print the tables of docs/conformance.md.

    python tests/benchmarks/conformance.py [LAW...]

Each law twice, in processes of their own: the first begins with no compiled kernels, the second finds them. Times are
seconds of processor time: the same on a busy machine as on a quiet one.
"""

from __future__ import annotations

import json
import os
import resource
import subprocess
import sys
import tempfile
from pathlib import Path
from typing import Any, NamedTuple

ROOT = Path(__file__).parents[2]
BUILT_IN = ("coulomb", "stribeck", "dahl", "jenkins", "lugre", "elasto-plastic")
PLUGINS = ("bouc-wen", "generalised-maxwell-slip", "maxwell-slip", "rate-and-state")
COMMAND = "import conftest, sys; from frictionlab.cli import main; sys.exit(main(sys.argv[1:]))"
"""conftest.py lets plugins be seen that are not installed."""


class Tested(NamedTuple):
    """A law's outcomes by check, and what both runs took [s]."""

    name: str
    outcomes: dict[str, dict[str, Any]]
    first: float
    second: float


def ran(name: str, kernels: str) -> tuple[list[dict[str, Any]], float]:
    """The outcomes of one run, and its processor time [s]."""
    before = resource.getrusage(resource.RUSAGE_CHILDREN)
    paths = os.pathsep.join([str(ROOT), os.environ.get("PYTHONPATH", "")])
    done = subprocess.run(
        [sys.executable, "-c", COMMAND, "laws", "test", name, "--json"],
        env={**os.environ, "FRICTIONLAB_CACHE": kernels, "PYTHONPATH": paths},
        stdout=subprocess.PIPE,
        check=False,
    )
    after = resource.getrusage(resource.RUSAGE_CHILDREN)
    return json.loads(done.stdout), after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime


def tested(name: str) -> Tested:
    """A law without kernels, then with them."""
    with tempfile.TemporaryDirectory() as kernels:
        _, first = ran(name, kernels)
        outcomes, second = ran(name, kernels)
    return Tested(name, {outcome["check"]: outcome for outcome in outcomes}, first, second)


def summary(law: Tested) -> str:
    """A row of the first table."""
    ends = [outcome["result"] for outcome in law.outcomes.values()]
    counts = [str(ends.count(end)) for end in ("passed", "failed", "skipped", "expected failure")]
    examples = sum(outcome["examples"] for outcome in law.outcomes.values())
    return f"| {law.name} | {' | '.join(counts)} | {examples} | {law.first:.0f} | {law.second:.0f} |"


def cell(outcome: dict[str, Any]) -> str:
    """How many examples a check ran, or what became of it."""
    return {"passed": str(outcome["examples"]), "skipped": "-"}.get(outcome["result"], outcome["result"])


def tables(laws: list[Tested]) -> str:
    """Both tables."""
    lines = [
        "| law | passed | failed | skipped | expected to fail | examples | first run [s] | with kernels [s] |",
        "| --- | ---: | ---: | ---: | ---: | ---: | ---: | ---: |",
        *map(summary, laws),
        "",
        f"| check | {' | '.join(law.name for law in laws)} |",
        f"| --- |{' ---: |' * len(laws)}",
    ]
    for check in laws[0].outcomes:
        lines.append(f"| {check} | {' | '.join(cell(law.outcomes[check]) for law in laws)} |")
    return "\n".join(lines)


if __name__ == "__main__":
    print(tables([tested(name) for name in sys.argv[1:] or (*BUILT_IN, *PLUGINS)]))
