"""Two runs into one folder: the second is told, and a killed one is in nobody's way."""

from __future__ import annotations

import os
import signal
import subprocess
import sys
import threading
from collections.abc import Iterator
from contextlib import contextmanager
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


@contextmanager
def at_work_elsewhere(folder: Path) -> Iterator[None]:
    """Another thread works in the folder."""
    began, ends = threading.Event(), threading.Event()

    def work() -> None:
        with alone_in(folder):
            began.set()
            ends.wait()

    thread = threading.Thread(target=work)
    thread.start()
    began.wait()
    try:
        yield
    finally:
        ends.set()
        thread.join()


def test_the_second_is_told_who_is_at_work_and_may_come_back_later(tmp_path: Path) -> None:
    told = rf"{tmp_path} is in use by another run \(process {os.getpid()}, since [0-9:]{{8}}\); wait until it has"
    with at_work_elsewhere(tmp_path):
        with pytest.raises(FolderError, match=told), alone_in(tmp_path):
            pass
        with pytest.raises(FolderError, match=told):
            check_free(tmp_path)

    check_free(tmp_path)
    with alone_in(tmp_path), alone_in(tmp_path):  # what a run calls asks again
        (tmp_path / "result").touch()
    assert [path.name for path in tmp_path.iterdir()] == ["result"]


def test_a_folder_in_which_nothing_was_put_is_not_made(tmp_path: Path) -> None:
    with alone_in(tmp_path / "runs" / "one"):
        assert (tmp_path / "runs" / "one" / MARK_FILE).exists()

    assert list(tmp_path.iterdir()) == []


@pytest.mark.skipif(sys.platform == "win32", reason="signals of POSIX")
def test_a_killed_run_is_in_nobodys_way(tmp_path: Path) -> None:
    command = [sys.executable, "-c", HOLD, str(tmp_path)]
    with subprocess.Popen(command, stdout=subprocess.PIPE) as holder:
        assert holder.stdout is not None
        holder.stdout.readline()
        with pytest.raises(FolderError, match=f"process {holder.pid}"):
            check_free(tmp_path)
        holder.send_signal(signal.SIGKILL)

    assert (tmp_path / MARK_FILE).exists()
    check_free(tmp_path)
    assert not (tmp_path / MARK_FILE).exists()
