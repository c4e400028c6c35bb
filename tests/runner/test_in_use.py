"""Two runs into one folder: the second is told, and a killed one is in nobody's way."""

from __future__ import annotations

import signal
import subprocess
import sys
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

import pytest

from frictionlab.runner.files import MARK_FILE, FolderError, alone_in, check_free

HOLD = """
import sys, time
from pathlib import Path
from frictionlab.runner.files import alone_in
with alone_in(Path(sys.argv[1])):
    print("at work", flush=True)
    time.sleep(60.0)
"""


def told(folder: Path, make: bool = True) -> str:
    """What somebody else is told who wants to work in the folder."""
    try:
        with alone_in(folder, make):
            return "free"
    except FolderError as problem:
        return str(problem)


def test_a_second_thread_is_told_and_may_come_back_later(tmp_path: Path) -> None:
    in_use = f"{tmp_path} is in use by another run; wait until it has ended"
    with ThreadPoolExecutor(1) as elsewhere:
        with alone_in(tmp_path):
            with alone_in(tmp_path):  # what a run calls asks again
                (tmp_path / "result").touch()
            assert elsewhere.submit(told, tmp_path, make=False).result() == in_use
            assert elsewhere.submit(told, tmp_path).result() == f"{in_use}, or choose another folder with -o"
        assert elsewhere.submit(told, tmp_path).result() == "free"
    assert [path.name for path in tmp_path.iterdir()] == ["result"]


def test_a_folder_in_which_nothing_was_put_is_not_made(tmp_path: Path) -> None:
    with alone_in(tmp_path / "runs" / "one"):
        assert (tmp_path / "runs" / "one" / MARK_FILE).exists()
    with alone_in(tmp_path / "two", make=False):
        pass

    assert list(tmp_path.iterdir()) == []


def test_a_folder_that_cannot_be_locked_keeps_no_run_from_going(tmp_path: Path) -> None:
    (tmp_path / "file").touch()
    (tmp_path / MARK_FILE).mkdir()
    with alone_in(tmp_path), alone_in(tmp_path / "file" / "below"):
        pass

    assert sorted(path.name for path in tmp_path.iterdir()) == [MARK_FILE, "file"]


@pytest.mark.skipif(sys.platform == "win32", reason="signals of POSIX")
def test_a_killed_run_is_in_nobodys_way(tmp_path: Path) -> None:
    command = [sys.executable, "-c", HOLD, str(tmp_path)]
    with subprocess.Popen(command, stdout=subprocess.PIPE) as holder:
        assert holder.stdout is not None
        holder.stdout.readline()
        with pytest.raises(FolderError, match="in use by another run"):
            check_free(tmp_path)
        holder.send_signal(signal.SIGKILL)

    assert (tmp_path / MARK_FILE).exists()
    check_free(tmp_path)
    assert not (tmp_path / MARK_FILE).exists()
