"""Runs that are killed at any moment are gone on with as if nothing had been."""

from __future__ import annotations

import subprocess
import sys
from pathlib import Path

from profiles import DEEP, deep

KILLS = 50 if DEEP else 1


@deep("processes that are killed")
def test_a_killed_run_is_gone_on_with_to_the_same_files_and_none_besides() -> None:
    script = Path(__file__).parents[1] / "killed_runs.py"
    done = subprocess.run([sys.executable, str(script), str(KILLS)], capture_output=True, text=True)

    assert done.returncode == 0, done.stdout + done.stderr
    assert f"{KILLS} kills, 0 came out differently" in done.stdout
