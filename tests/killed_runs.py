"""Runs that are killed (SIGKILL) at random moments, from the first file to the last, and gone on with.

``python tests/killed_runs.py 100 [SEED]`` kills as many and says what was there each time and what came of it. A run
is a copy of this process, made when everything is imported.
"""

from __future__ import annotations

import os
import random
import signal
import sys
import tempfile
import time
from collections import Counter
from pathlib import Path

import pandas as pd
from pandas.testing import assert_frame_equal

from frictionlab import cli
from frictionlab.charts import figures  # noqa: F401  # imported once, before the copies
from frictionlab.methods.exact import method  # noqa: F401  # the same
from frictionlab.report.page import write_report  # noqa: F401  # the same
from frictionlab.runner import api  # noqa: F401  # the same
from frictionlab.runner.files import FolderError
from frictionlab.runner.saved import read_run as read_saved

STUDY = """schema: 1
title: A sweep that is killed
scene: {damping_ratio: 0.1, normal_load: 10, drive: {unbalance: 10, frequency: 1}}
laws: [{kind: coulomb, mu: 0.4}]
methods: [exact]
sweep:
  scene.belt_speed: {start: 0.5, stop: 40, num: 150}
  laws.coulomb.mu: [0.1, 0.2]
keep: {orbit: 4}
columns: [mean_friction]
expect: [{column: mean_friction, below: 1}]
"""
TABLES = {"results.parquet": pd.read_parquet, "results.csv": pd.read_csv, "orbits.parquet": pd.read_parquet}
TABLES |= {"curves.csv": pd.read_csv}


def started(study: Path, out: Path) -> int:
    """A run in a process of its own, without a word."""
    process = os.fork()
    if process == 0:
        null = os.open(os.devnull, os.O_RDWR)
        for stream in (0, 1, 2):
            os.dup2(null, stream)
        os._exit(cli.main(["run", str(study), "-o", str(out), "--cache", f"{out}.kept", "-j", "2"]))
    return process


def finished(study: Path, out: Path) -> int:
    """The exit code of a run that is left alone."""
    return os.waitstatus_to_exitcode(os.waitpid(started(study, out), 0)[1])


def killed(study: Path, out: Path, after: float) -> bool:
    """Whether a run was killed so many seconds after its start, before its end."""
    process = started(study, out)
    time.sleep(after)
    os.kill(process, signal.SIGKILL)
    return os.WIFSIGNALED(os.waitpid(process, 0)[1])


def files(folder: Path) -> set[str]:
    """Every file under a folder."""
    return {path.relative_to(folder).as_posix() for path in folder.rglob("*") if path.is_file()}


def stage(out: Path) -> str:
    """How far a run had come when it was killed, and whether it was writing."""
    found = files(out) if out.exists() else set()
    names = ("report.html", "figures/mean_friction.svg", "results.csv", "results.parquet", "provenance.json")
    last = next((name for name in names if name in found), "nothing")
    writing = [name.rpartition(".")[0][1:] for name in found if Path(name).name.startswith(".")]
    return f"{last} there" + (f", writing {writing[0]}" if writing else "")


def different(out: Path, whole: Path) -> str:
    """What is different in the folder of a run that was killed from that of one in one piece; '' for nothing."""
    if stray := files(out) ^ files(whole):
        return f"stray or missing files: {', '.join(sorted(stray))}"
    for name, read in TABLES.items():
        try:
            assert_frame_equal(*(read(at / name).drop(columns="seconds", errors="ignore") for at in (out, whole)),
                               check_exact=True)  # fmt: skip
        except AssertionError as problem:
            return f"{name} is another one: {problem}"
    try:
        return "; ".join(read_saved(out).damaged)
    except FolderError as problem:
        return str(problem)


def main(kills: int, seed: int) -> int:
    """Kill runs, go on with each, and tell; how many came out differently."""
    draw, stages, wrong = random.Random(seed), Counter[str](), 0
    with tempfile.TemporaryDirectory() as folder:
        study, whole = Path(folder) / "study.yaml", Path(folder) / "whole"
        study.write_text(STUDY)
        before = time.perf_counter()
        assert finished(study, whole) == 0
        taken = time.perf_counter() - before
        for number in range(kills):
            out = Path(folder) / f"run{number}"
            while not killed(study, out, draw.uniform(0.0, 1.1 * taken)):
                for written in (out, Path(f"{out}.kept")):
                    for path in sorted(written.rglob("*"), reverse=True):
                        path.rmdir() if path.is_dir() else path.unlink()
            stages[stage(out)] += 1
            print(".", end="", flush=True)
            if draw.random() < 0.3:
                killed(study, out, draw.uniform(0.0, taken))
            code = finished(study, out)
            if told := f"exit code {code}" if code else different(out, whole):
                wrong += 1
                print(f"kill {number}: {told}", flush=True)
    print()
    for name, count in stages.most_common():
        print(f"{count:4d} killed with {name}")
    print(f"{kills} kills, {wrong} came out differently; a run takes {taken:.1f} s")
    return wrong


if __name__ == "__main__":
    sys.exit(min(1, main(int(sys.argv[1]), int(sys.argv[2]) if len(sys.argv) > 2 else 0)))
