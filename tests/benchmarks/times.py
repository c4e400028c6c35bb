"""What points, runs and commands cost, for one checkout or for several side by side.

python tests/benchmarks/times.py [--python PYTHON ...] [--only PART ...] [--repeats 3] [--out TIMES.json]

PYTHON is that of a checkout's environment (its frictionlab and its command are used; default: this one). Of two or
more, every measurement is done by each in turn, A B A B, and the ratios to the first are printed. Parts:

kernels   standard.yaml, bristle.yaml and prescribed.yaml beside this file, our methods alone and of their tolerances
          those of TOLERANCES: kernel seconds per point (column ``seconds``) of ``frictionlab.run``, after a run that
          compiles, and processor time per point of the whole call; and a plugin's law under a prescribed slip
grid      ``frictionlab run`` of 100,000 points of Coulomb friction, belt speed by frequency
cold      ``frictionlab run`` of the study of README.md with an empty folder for kernels
help      ``frictionlab --help``

Least of the repeats (cold: of two), with all of them beside it: processor time of the process and its children, user
and system together, and wall time [s]. Other work on the machine slows all of it down, wall time most: compare
checkouts in one call, not with a file of another day. times_before.json in tests/reference is what this wrote before
the package was put into folders.
"""

from __future__ import annotations

import argparse
import json
import math
import os
import platform
import subprocess
import sys
import tempfile
import time
from collections.abc import Callable, Sequence
from pathlib import Path
from typing import Any

from ruamel.yaml import YAML

HERE = Path(__file__).parent
LISTS = "standard.yaml", "bristle.yaml", "prescribed.yaml"
TOLERANCES = 1e-6, 1e-9
INNER, ENOUGH = 5, 1.0
"""Runs of a curve in one process, the least of which counts; none more once so much processor time [s] is spent."""
ELEMENTS = {"mu": [0.2, 0.15, 0.05], "stiffness": [1.0, 3.0, 10.0]}
MEMORY_SLIP = {"slip": {"velocity_amplitude": 10.0, "frequency": 1.5, "phase": 30.0}}
GRID = {
    "schema": 1,
    "title": "100,000 points",
    "scene": {"damping_ratio": 0.1, "normal_load": 10, "belt_speed": 5, "drive": {"unbalance": 10, "frequency": 1}},
    "laws": [{"kind": "coulomb", "mu": 0.4}],
    "sweep": {
        "scene.drive.frequency": {"start": 0.5, "stop": 4, "num": 200},
        "scene.belt_speed": {"start": 0.5, "stop": 60, "num": 500},
    },
}  # fmt: skip


def studies() -> dict[str, dict[str, Any]]:
    """The studies whose points are timed, by name: one method, one setting, one curve each."""
    found: dict[str, dict[str, Any]] = {}
    for name in LISTS:
        bench = YAML(typ="safe").load(HERE / name)
        for block in bench["scenes"]:
            for told in block.get("methods", bench.get("methods", [])):
                for label, method, tolerance in _settings(
                    {"kind": told} if isinstance(told, str) else dict(told)
                ):
                    found[f"{block['name']}/{label}"] = _study(block, method, tolerance)
    return found


def _settings(told: dict[str, Any]) -> list[tuple[str, dict[str, Any], float]]:
    """Name, method and tolerance of what is timed: of lists, the tolerances of TOLERANCES, else the first two."""
    lists = [key for key, value in told.items() if isinstance(value, list)]
    name = told.get("label", told["kind"])
    if not lists:
        return [(name, told, told.get("tolerance", 1e-8))]
    key = lists[0]
    values = [value for value in told[key] if value in TOLERANCES] if key == "tolerance" else told[key][:2]
    made = [{**told, key: value} for value in values]
    return [(f"{name} {key}={one[key]:g}", one, one.get("tolerance", 1e-8)) for one in made]


def _study(block: dict[str, Any], method: dict[str, Any], tolerance: float) -> dict[str, Any]:
    sweep = {path: dict(along) for path, along in block["sweep"].items()}
    for along in sweep.values():
        along["num"] = min(along["num"], method.get("points", along["num"]))
        belt_speed = along["start"]
    kept = {key: value for key, value in method.items() if key not in ("tolerance", "points")}
    scene = {"belt_speed": belt_speed, **block["scene"]}
    plan = {"scene": scene, "laws": block["laws"], "methods": [kept], "sweep": sweep, "tolerance": tolerance}
    return {"schema": 1, **plan}


# What the python of a checkout runs.


def serve(plan: Path) -> None:
    """Time every study of the plan; print kernel seconds per point as JSON."""
    import frictionlab as fl

    found = {
        name: _points(lambda study=study: fl.run(study).table)
        for name, study in json.loads(plan.read_text()).items()
    }
    sys.path.insert(0, str(Path(fl.__file__).parents[1] / "plugins" / "maxwell-slip"))
    from maxwell_slip import MaxwellSlip

    scene, speeds, law = (
        fl.Scene(belt_speed=1.0, **MEMORY_SLIP),
        [1.0, 3.0, 6.0, 9.0],
        MaxwellSlip(**ELEMENTS),
    )
    for tolerance in TOLERANCES:
        name = f"P_elements/auto tolerance={tolerance:g}"
        found[name] = _points(lambda tolerance=tolerance: fl.curve(scene, law, speeds, tolerance=tolerance))
    print(json.dumps(found))


def _points(solve: Callable[[], Any]) -> dict[str, float]:
    """Least kernel seconds and least processor time per point, once all is compiled."""
    solve()
    kernel, cpu, begun = math.inf, math.inf, time.process_time()
    for _ in range(INNER):
        if cpu < math.inf and time.process_time() - begun > ENOUGH:
            break
        start = time.process_time()
        table = solve()
        cpu = min(cpu, (time.process_time() - start) / len(table))
        kernel = min(kernel, float(table["seconds"].sum()) / len(table))
    return {"seconds_per_point": kernel, "cpu_per_point": cpu}


# Processes and their times.


class Spent:
    """Processor and wall time of a command, and what it printed; raises where it fails."""

    def __init__(self, command: Sequence[str], **environment: str) -> None:
        with tempfile.TemporaryFile("w+") as out:
            start = time.perf_counter()
            process = subprocess.Popen(
                command, stdout=out, stderr=subprocess.STDOUT, env={**os.environ, **environment}
            )
            _, status, usage = os.wait4(process.pid, 0)
            self.wall = time.perf_counter() - start
            self.cpu = usage.ru_utime + usage.ru_stime
            process.returncode = os.waitstatus_to_exitcode(status)
            out.seek(0)
            self.text = out.read()
        if process.returncode != 0:
            raise SystemExit(f"{' '.join(command)} ended with {process.returncode}:\n{self.text[-2000:]}")


def kernels(python: str, plan: Path) -> dict[str, dict[str, float]]:
    """Seconds per point by study."""
    asked = [python, str(Path(__file__)), "--serve", str(plan)]
    told = Spent(asked, FRICTIONLAB_COMPILE="always").text.splitlines()[-1]
    found: dict[str, dict[str, float]] = json.loads(told)
    return found


def command(python: str, *arguments: str, **environment: str) -> dict[str, dict[str, float]]:
    """Times of the program."""
    spent = Spent([str(Path(python).parent / "frictionlab"), *arguments], **environment)
    return {"": {"cpu": round(spent.cpu, 3), "wall": round(spent.wall, 3)}}


def grid(python: str) -> dict[str, dict[str, float]]:
    """A run of 100,000 points, from an empty folder."""
    with tempfile.TemporaryDirectory() as folder:
        study = Path(folder) / "grid.yaml"
        YAML(typ="safe").dump(GRID, study)
        return command(python, "run", str(study), "-o", str(Path(folder) / "out"))


def cold(python: str) -> dict[str, dict[str, float]]:
    """The study of the README with no kernel compiled."""
    text = (
        (HERE.parents[1] / "README.md").read_text().partition("<!-- study -->")[2].partition("```yaml\n")[2]
    )
    with tempfile.TemporaryDirectory() as folder:
        study = Path(folder) / "readme.yaml"
        study.write_text(text.partition("```")[0])
        kept = Path(folder) / "cache"
        return command(
            python, "run", str(study), "-o", str(Path(folder) / "out"), FRICTIONLAB_CACHE=str(kept)
        )


def measured(pythons: Sequence[str], parts: Sequence[str], repeats: int) -> dict[str, Any]:
    """All repeats of all measurements: by part and name, for each python its list of times."""
    with tempfile.TemporaryDirectory() as folder:
        plan = Path(folder) / "plan.json"
        plan.write_text(json.dumps(studies()))
        tasks: dict[str, Callable[[str], dict[str, dict[str, float]]]] = {
            "kernels": lambda python: kernels(python, plan),
            "grid": grid,
            "cold": cold,
            "help": lambda python: command(python, "--help"),
        }
        found: dict[str, Any] = {}
        for part in parts:
            for _ in range(min(repeats, 2) if part == "cold" else repeats):
                for place, python in enumerate(pythons):
                    print(f"{part}: {python}", file=sys.stderr, flush=True)
                    for name, times in tasks[part](python).items():
                        for unit, value in times.items():
                            key = "/".join(filter(None, (part, name, unit)))
                            found.setdefault(key, [[] for _ in pythons])[place].append(value)
        return found


def about(python: str) -> dict[str, str]:
    """Whose times these are."""
    asked = "import frictionlab, numba, numpy; print(frictionlab.__file__, frictionlab.__version__)"
    asked += "; print(numba.__version__, numpy.__version__)"
    file, own, *others = Spent([python, "-c", asked]).text.split()
    git = ["git", "-C", str(Path(file).parents[1]), "log", "-1", "--format=%H %s"]
    commit = subprocess.run(git, capture_output=True, text=True, check=False).stdout.strip()
    return {"version": own, "commit": commit, "numba": others[0], "numpy": others[1]}


def report(found: dict[str, Any], pythons: Sequence[str]) -> None:
    """Print the least of each, and how the others compare with the first."""
    for key, lists in found.items():
        least = [min(times) for times in lists]
        ratios = [f"{one / least[0]:.3f}" for one in least[1:] if least[0] > 0.0]
        print(
            f"{key:60s}",
            *(f"{one:11.3e}" for one in least),
            *ratios,
            f"spread {max(lists[0]) / min(lists[0]):.2f}",
        )


def main() -> None:
    """The command line."""
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("--python", action="append")
    parser.add_argument("--only", nargs="+", default=["kernels", "grid", "cold", "help"])
    parser.add_argument("--repeats", type=int, default=3)
    parser.add_argument("--out", type=Path)
    parser.add_argument("--serve", type=Path, help=argparse.SUPPRESS)
    given = parser.parse_args()
    if given.serve is not None:
        serve(given.serve)
        return
    pythons = given.python or [sys.executable]
    found = measured(pythons, given.only, given.repeats)
    report(found, pythons)
    if given.out is not None:
        times = {key: [{"least": min(one), "all": one} for one in lists] for key, lists in found.items()}
        machine = {
            "cores": os.cpu_count(),
            "load": [round(load, 1) for load in os.getloadavg()],
            "machine": platform.machine(),
            "python": platform.python_version(),
        }
        told = {"machine": machine, "of": [about(python) for python in pythons], "times": times}
        given.out.write_text(json.dumps(told, indent=1) + "\n")


if __name__ == "__main__":
    main()
