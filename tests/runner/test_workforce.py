"""Processes, clusters and job arrays give the table of threads, whoever of them is killed meanwhile."""

from __future__ import annotations

import os
import re
import stat
import subprocess
import sys
from concurrent.futures import BrokenExecutor, Future, ThreadPoolExecutor
from pathlib import Path
from typing import Any

import pytest
from fig_4b import COULOMB, over_speeds
from pandas.testing import assert_frame_equal
from profiles import deep

import frictionlab as fl
from frictionlab import cli
from frictionlab.runner import workforce
from frictionlab.runner.solving import run_share
from frictionlab.runner.store import Store
from frictionlab.runner.workforce import Workforce
from frictionlab.study.load import parse_study
from frictionlab.study.written import yaml_text

pytestmark = deep("processes")

LAWS = [COULOMB, {"kind": "coulomb", "mu": 0.3, "label": "weak"}]
SPEEDS = {"start": 0.5, "stop": 12, "num": 500}
STUDY = over_speeds(SPEEDS, laws=LAWS)
SCRIPT = Path(__file__).parents[1] / "killed_workers.py"
DOCS = Path(__file__).parents[2] / "docs"


@pytest.mark.parametrize("way", ["processes", "cluster", "parts"])
def test_workers_that_are_killed_change_nothing(way: str) -> None:
    if way == "cluster":
        pytest.importorskip("distributed")
    done = subprocess.run([sys.executable, str(SCRIPT), way, "1", "6000"], capture_output=True, text=True)

    assert done.returncode == 0, done.stdout + done.stderr
    assert "tables equal" in done.stdout


class LosesWorkers(ThreadPoolExecutor):
    """Threads, some of whose chunks come back as if a worker had died: the first so many, or of every three two."""

    def __init__(self, losses: int | None, problem: type[Exception] = BrokenExecutor) -> None:
        super().__init__(1)
        self.losses, self.problem, self.sent = losses, problem, 0

    def submit(self, *given: Any, **named: Any) -> Future[Any]:
        self.sent += 1
        if self.sent % 3 == 0 if self.losses is None else self.sent > self.losses:
            return super().submit(*given, **named)
        lost: Future[Any] = Future()
        lost.set_exception(self.problem("gone"))
        return lost


def test_a_pool_that_breaks_again_and_again_is_made_anew_while_something_comes_back() -> None:
    pool = LosesWorkers(None)
    many = over_speeds(SPEEDS | {"num": 2000}, laws=LAWS)

    assert fl.run(many, executor=Workforce(pool, lambda: pool)).counts == {"ok": 4000}
    assert pool.sent > 60


@pytest.mark.parametrize("problem", [OSError, BrokenExecutor])
def test_a_chunk_whose_worker_is_lost_is_sent_again(problem: type[Exception]) -> None:
    pool = LosesWorkers(4, problem)
    done = fl.run(STUDY, executor=Workforce(pool, lambda: pool))

    assert done.counts == {"ok": 1000}
    assert pool.sent > 4


def test_where_workers_are_lost_for_good_the_rest_is_killed_and_what_is_solved_kept(tmp_path: Path) -> None:
    done_before = fl.run(STUDY | {"laws": LAWS[:1]}, out=tmp_path / "one")
    stopped = fl.run(STUDY, out=tmp_path / "both", executor=LosesWorkers(1000, OSError))

    assert done_before.computed == 500
    assert stopped.counts == {"ok": 500, "killed": 500}
    assert set(stopped.table.loc[500:, "reason"]) == {"a worker died: gone"}
    again = fl.run(STUDY, out=tmp_path / "both")
    assert (again.computed, again.counts) == (500, {"ok": 1000})


def test_a_pool_that_breaks_without_another_ends_the_run() -> None:
    done = fl.run(STUDY, executor=LosesWorkers(1))

    assert done.counts.get("ok", 0) < 1000
    assert set(done.table.loc[done.table["status"] == "killed", "reason"]) == {"a worker died: gone"}


def test_parts_share_all_chunks_between_them(tmp_path: Path) -> None:
    plan, kept = parse_study(STUDY), Store(tmp_path / "kept")
    shares = [run_share(plan, (number, 3), kept) for number in (3, 1, 2)]
    again = run_share(plan, (1, 3), kept)
    gathered = fl.run(plan, out=tmp_path / "run", cache=tmp_path / "kept")

    assert sum(points for _, points in shares) == 1000
    assert [share.computed for share, _ in shares] == [points for _, points in shares]
    assert (again[0].computed, again[0].found) == (0, shares[1][1])
    assert gathered.computed == 0
    assert_frame_equal(gathered.table, fl.run(plan).table, check_exact=True)


PARTS = ["0/3", "4/3", "3", "a/b", "1/0", "-1/2", "1.5/2"]
REFUSED = [
    *((["--part", part], f"must be I/N with 1 <= I <= N, such as 3/16, got '{part}'") for part in PARTS),
    (["-j", "2", "--processes", "2"], "-j and --processes say who solves the points; give one of them"),
    (["--part", "1/2", "--json"], "--part and --json print different things; give one of them"),
    (["--scheduler", "tcp://127.0.0.1:9"], "scheduler"),
]


@pytest.mark.parametrize(("options", "said"), REFUSED)
def test_options_without_sense_are_refused(
    options: list[str], said: str, tmp_path: Path, capsys: Any, monkeypatch: Any
) -> None:
    monkeypatch.setattr(workforce, "ANSWERS_WITHIN", 1.0)
    (tmp_path / "study.yaml").write_text(yaml_text(STUDY))

    assert cli.main(["run", str(tmp_path / "study.yaml"), "-o", str(tmp_path / "out"), *options]) == 2
    assert said in capsys.readouterr().err


SBATCH = """#!{python}
import os, random, re, subprocess, sys

script = open(sys.argv[1]).read()
first, last = map(int, re.search(r"--array=(\\d+)-(\\d+)", script).groups())
tasks = list(range(first, last + 1))
random.Random(0).shuffle(tasks)
for task in tasks:
    environment = os.environ | {{"SLURM_ARRAY_TASK_ID": str(task), "SLURM_CPUS_PER_TASK": "1"}}
    subprocess.run(["bash", sys.argv[1]], check=True, env=environment)
"""


def test_the_job_array_of_the_docs_solves_the_study(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    text = (DOCS / "cost.md").read_text()
    (script,) = re.findall(r"<!-- slurm -->\n```sh\n(.*?)```", text, re.DOTALL)
    commands = {
        "sbatch": SBATCH.format(python=sys.executable),
        "frictionlab": f"#!{sys.executable}\nimport sys\nfrom frictionlab.cli import main\nsys.exit(main())\n",
    }
    (tmp_path / "bin").mkdir()
    for name, content in commands.items():
        (tmp_path / "bin" / name).write_text(content)
        (tmp_path / "bin" / name).chmod(stat.S_IRWXU)
    (tmp_path / "array.sh").write_text(script.replace("1-16", "1-2").replace("/16", "/2"))
    (tmp_path / "study.yaml").write_text(yaml_text(STUDY))
    monkeypatch.setenv("PATH", f"{tmp_path / 'bin'}{os.pathsep}{os.environ['PATH']}")
    done = subprocess.run(["sbatch", "array.sh"], cwd=tmp_path, capture_output=True, text=True)
    assert done.returncode == 0, done.stderr

    gathered = fl.run(tmp_path / "study.yaml", out=tmp_path / "results" / "study")

    assert len(re.findall(r"part \d of 2: \d+ points solved and 0 found of \d+", done.stdout)) == 2
    assert gathered.computed == 0
    assert gathered.counts == {"ok": 1000}
