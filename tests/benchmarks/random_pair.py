"""Random scenes of every law and method, solved by two checkouts and compared.

python tests/benchmarks/random_pair.py solve OUT.csv [--count 2000] [--seed 1] [--python /other/.venv/bin/python]
python tests/benchmarks/random_pair.py compare A.csv B.csv

``solve`` draws scenes (the same for a seed, whatever the checkout) and solves each with the frictionlab of the given
python, one scene at a time in a process of its own that is started again where a scene takes more than --limit
seconds of processor time (20; the row is then ``slow`` and not compared). Compiling does not count: a scene that runs
out of time is given --patience seconds (180) to compile, and tried again. The rows of OUT.csv are kept: the same
command goes on with what is left.

``compare`` prints every row whose status is another one or whose means differ by more than the sum of their errors,
and exits with code 1 where there is one. Scenes without one mean (not_unique) are compared by status alone.
"""

from __future__ import annotations

import argparse
import csv
import json
import math
import random
import signal
import subprocess
import sys
import time
from collections import Counter
from pathlib import Path
from typing import Any

from drawers import every_law

COLUMNS = (
    *("number", "family", "freedom", "method", "tolerance", "status", "mean_friction", "error"),
    *("mean_low", "mean_high", "energy_gap", "energy_error", "cpu", "reason", "scene", "law"),
)


# The process that solves, with whichever frictionlab its python has.


def serve() -> None:
    """Answer one scene a line, as JSON, until the input ends; a scene that takes too long ends the process."""
    import frictionlab as fl

    checkout = Path(fl.__file__).parents[1]
    sys.path[:0] = [str(checkout), str(checkout / "tests")]
    import conftest  # noqa: F401  # plugins of that checkout

    print("ready", flush=True)
    for text in sys.stdin:
        start, one = time.process_time(), json.loads(text)
        signal.setitimer(signal.ITIMER_PROF, one["limit"])
        answer = _answered(fl, one)
        signal.setitimer(signal.ITIMER_PROF, 0.0)
        print(json.dumps({**answer, "cpu": round(time.process_time() - start, 4)}), flush=True)


def _answered(fl: Any, one: dict[str, Any]) -> dict[str, Any]:
    from frictionlab.study import registry

    scene, law, method = dict(one["scene"]), dict(one["law"]), dict(one["method"])
    kind = method.pop("kind")
    solver = fl.March(**method) if kind == "march" else kind
    try:
        made = registry.law_class(law.pop("kind"))(**law)
        speeds, energies = [scene["belt_speed"]], {"columns": ["energies"]}
        table = fl.curve(fl.Scene(**scene), made, speeds, solver, one["tolerance"], **energies)
    except Exception as problem:  # told as what it is, and compared like a status
        return {"status": f"raised {type(problem).__name__}", "reason": str(problem)}
    row = table.iloc[0].to_dict()
    names = "status", "mean_friction", "error", "mean_low", "mean_high", "reason"
    told = {name: row.get(name, math.nan) for name in names} | _balance(row)
    return {name: cell for name, cell in told.items() if cell == cell and cell is not None}


def _balance(row: dict[str, Any]) -> dict[str, Any]:
    """What is missing from energy_input = energy_viscous + energy_friction, and what their errors allow."""
    put_in, *taken = "energy_input", "energy_viscous", "energy_friction"
    gap = abs(row.get(put_in, math.nan) - sum(row.get(name, math.nan) for name in taken))
    errors = [row.get(f"{name}_error", math.nan) for name in (put_in, *taken)]
    return {"energy_gap": gap, "energy_error": sum(errors)}


class Solver:
    """A process that solves, and is started again where it takes too long."""

    def __init__(self, python: str) -> None:
        self.command = [python, str(Path(__file__)), "serve"]
        self.process: Any = None

    def solve(self, one: dict[str, Any], limit: float) -> dict[str, Any]:
        """The answer; status slow where it took more than limit seconds, died where the process ended by itself."""
        if self.process is None:
            pipes: dict[str, Any] = {"stdin": subprocess.PIPE, "stdout": subprocess.PIPE, "text": True}
            self.process = subprocess.Popen(self.command, **pipes)
            if self.process.stdout.readline().strip() != "ready":
                raise SystemExit(f"{self.command[0]} cannot import frictionlab and its plugins")
        self.process.stdin.write(json.dumps({**one, "limit": limit}) + "\n")
        self.process.stdin.flush()
        if text := self.process.stdout.readline():
            return json.loads(text)  # type: ignore[no-any-return]
        code, self.process = self.process.wait(), None
        return {"status": "slow" if code == -signal.SIGPROF else "died"}


def solve(out: Path, given: argparse.Namespace) -> None:
    """Solve what OUT does not have yet."""
    rng = random.Random(given.seed)
    drawn = [every_law.draw(rng) for _ in range(given.count)]
    done = {int(row["number"]) for row in read(out)} if out.exists() else set()
    solver = Solver(given.python)
    with out.open("a", newline="") as file:
        rows = csv.DictWriter(file, COLUMNS, lineterminator="\n")
        if not done:
            rows.writeheader()
        for number, one in enumerate(drawn):
            if number in done:
                continue
            answer = solver.solve(one, given.limit)
            if answer["status"] == "slow":  # perhaps it was compiling: only the last kernel is lost
                solver.solve(one, given.patience)
                answer = solver.solve(one, given.limit)
            row = {name: one[name] for name in ("family", "freedom", "tolerance")} | answer
            words = {name: json.dumps(one[name]) for name in ("method", "scene", "law")}
            rows.writerow({"number": number, **row, **words})
            file.flush()
    _sum_up(read(out))


def _sum_up(rows: list[dict[str, str]]) -> None:
    """Statuses, the slowest scene, and the scenes whose energies do not close within their errors."""
    print(*sorted(Counter(row["status"] for row in rows).items()))
    print("slowest:", max(float(row["cpu"] or 0.0) for row in rows), "s")
    told = [row for row in rows if row["status"] == "ok" and row["energy_error"]]
    wide = [row["number"] for row in told if float(row["energy_gap"]) > float(row["energy_error"])]
    print(f"energies close within their errors: {len(told) - len(wide)} of {len(told)}; not:", *wide)
    for row in rows:
        if row["status"] not in ("ok", "refused", "not_unique"):
            print(f"{row['number']}: {row['status']}: {row['family']}, {row['method']}: {row['reason']}")


def read(path: Path) -> list[dict[str, str]]:
    """The rows of a table."""
    with path.open(newline="") as file:
        return list(csv.DictReader(file))


def compare(first: Path, second: Path) -> int:
    """Print the rows that differ; 1 where there are any."""
    new, counted, identical = {row["number"]: row for row in read(second)}, Counter[str](), 0
    for row in read(first):
        other = new.get(row["number"])
        verdict = "only in the first" if other is None else _verdict(row, other)
        counted[verdict] += 1
        if other is not None and verdict in DIFFERENT:
            names = "status", "mean_friction", "error"
            told = [f"{name} {row[name] or '-'} -> {other[name] or '-'}" for name in names]
            print(f"{row['number']}: {verdict}: {'; '.join(told)}; {row['family']}, {row['method']}, "
                  f"{row['scene']}, {row['law']}, tolerance {row['tolerance']}")  # fmt: skip
        identical += other is not None and row["mean_friction"] == other["mean_friction"]
    for name, count in sorted(counted.items()):
        print(f"{name}: {count}")
    print(f"same to the last bit: {identical}")
    return int(any(counted[name] for name in DIFFERENT))


DIFFERENT = "another status", "further apart than their errors"


def _verdict(row: dict[str, str], other: dict[str, str]) -> str:
    if any(row[name] != other[name] for name in ("scene", "law", "method", "tolerance")):
        raise SystemExit(f"row {row['number']}: not the same scene; solve both with one seed and this script")
    if "slow" in (row["status"], other["status"]):
        return "slow, not compared"
    if row["status"] != other["status"]:
        return DIFFERENT[0]
    if row["status"] != "ok":
        return "agree"
    apart = abs(float(row["mean_friction"]) - float(other["mean_friction"]))
    return "agree" if apart <= float(row["error"]) + float(other["error"]) else DIFFERENT[1]


def main() -> int:
    """The command line."""
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    commands = parser.add_subparsers(dest="command", required=True)
    one = commands.add_parser("solve")
    one.add_argument("out", type=Path)
    one.add_argument("--count", type=int, default=2_000)
    one.add_argument("--seed", type=int, default=1)
    one.add_argument("--python", default=sys.executable)
    one.add_argument("--limit", type=float, default=20.0)
    one.add_argument("--patience", type=float, default=180.0)
    two = commands.add_parser("compare")
    two.add_argument("first", type=Path)
    two.add_argument("second", type=Path)
    commands.add_parser("serve")
    given = parser.parse_args()
    if given.command == "serve":
        serve()
    elif given.command == "solve":
        solve(given.out, given)
    else:
        return compare(given.first, given.second)
    return 0


if __name__ == "__main__":
    sys.exit(main())
