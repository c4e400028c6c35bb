"""What a user is told while a run goes on: when, in which words, and that it never wraps."""

from __future__ import annotations

import io
import os
import struct
import sys
import threading
import time
from collections.abc import Iterator
from concurrent.futures import ThreadPoolExecutor
from contextlib import contextmanager
from types import ModuleType, SimpleNamespace
from typing import Any, TextIO

import pytest

import frictionlab as fl
from frictionlab.compile.notice import mark_cache_miss, named_while_it_compiles
from frictionlab.runner.progress import Meter, progress_told, silent, spoken

fcntl, termios = pytest.importorskip("fcntl"), pytest.importorskip("termios")


class Screen(io.StringIO):
    """A stream that says it is a terminal."""

    def isatty(self) -> bool:
        return True


@pytest.fixture
def now(monkeypatch: Any) -> list[float]:
    time_told = [100.0]
    monkeypatch.setattr("frictionlab.runner.progress.time.monotonic", lambda: time_told[0])
    return time_told


@pytest.mark.parametrize("stream", [io.StringIO, Screen])
def test_progress_is_told_after_two_seconds_and_not_before(
    stream: type[io.StringIO], now: list[float]
) -> None:
    told = stream()
    meter = Meter(told)
    meter(100, 400)
    now[0] = 101.9
    meter(200, 400)
    assert told.getvalue() == ""

    now[0] = 104.0
    meter(200, 400)
    line = "solving: 200 of 400 points, about 8 s left, 4 s so far"
    assert told.getvalue() == (f"\r{line}" if stream is Screen else f"{line}\n")

    meter.close()
    now[0] = 120.0
    meter(300, 400)
    assert told.getvalue().endswith(f"\r{' ' * len(line)}\r" if stream is Screen else f"{line}\n")


def test_time_spent_compiling_is_named_and_not_held_against_the_points(now: list[float]) -> None:
    from numba.core.compiler_lock import global_compiler_lock

    told = io.StringIO()
    meter = Meter(told)
    meter(0, 400)
    with (
        ThreadPoolExecutor(1) as elsewhere,
        named_while_it_compiles("a kernel"),
    ):
        elsewhere.submit(global_compiler_lock.acquire).result()
        now[0] = 124.0
        meter(100, 400)
        mark_cache_miss()
        now[0] = 130.0
        meter(100, 400)
        elsewhere.submit(global_compiler_lock.release).result()
    now[0] = 136.0
    meter(200, 400)
    meter.begins("drawing", "figures")
    now[0] = 142.0
    meter(0, 3)

    assert told.getvalue().splitlines() == [
        "solving: 100 of 400 points, 24 s so far",  # machine code that is kept is read
        "compiling a kernel, solving: 100 of 400 points, 30 s so far",
        "solving: 200 of 400 points, about 6 s left, 36 s so far",
        "drawing: 0 of 3 figures, 42 s so far",
    ]


@contextmanager
def terminal(columns: int) -> Iterator[tuple[TextIO, list[str]]]:
    """A stream that leads to a terminal so wide, and what has reached it."""
    ours, theirs = os.openpty()
    fcntl.ioctl(theirs, termios.TIOCSWINSZ, struct.pack("HHHH", 24, columns, 0, 0))
    seen: list[str] = []

    def read() -> None:
        while not "".join(seen).endswith("end"):
            seen.append(os.read(ours, 4096).decode())

    reader = threading.Thread(target=read)
    reader.start()
    with open(theirs, "w") as stream:
        yield stream, seen
        stream.write("end")
        stream.flush()
        reader.join()
    os.close(ours)


def until_written(seen: list[str], times: int) -> None:
    """Wait until the line has been written so often."""
    while "".join(seen).count("\r") < times:
        time.sleep(0.01)


@pytest.mark.parametrize("columns", [20, 50, 120])
def test_the_line_goes_on_by_itself_never_wraps_and_is_gone_at_the_end(
    columns: int, monkeypatch: Any
) -> None:
    monkeypatch.setattr("frictionlab.runner.progress.QUIET", 0.0)
    monkeypatch.setattr("frictionlab.runner.progress.OFTEN", 0.01)
    with terminal(columns) as (stream, seen), Meter(stream, "study 2 of 15: ") as meter:
        meter.begins("finding the onsets of curves that are known by now")
        until_written(seen, 3)
        meter.begins("drawing", "figures")
        meter(1, 3)
        until_written(seen, 6)
        meter.close()

    states = "".join(seen).removesuffix("end").split("\r")
    assert len(states) > 5
    assert max(map(len, states)) < columns
    assert any(state.startswith("study 2 of 15: find") for state in states)
    assert states[-2:] == [" " * len(states[-2]), ""]


def test_python_calls_tell_progress_where_it_is_seen_or_asked_for(capsys: Any, monkeypatch: Any) -> None:
    monkeypatch.setattr("frictionlab.runner.progress.QUIET", 0.0)
    with progress_told(None) as nobody:
        assert nobody is silent  # a test has neither terminal nor notebook
    scene = fl.Scene(
        damping_ratio=0.1, normal_load=10, belt_speed=5, drive=fl.Drive(unbalance=10, frequency=1)
    )
    for progress, lines in ((None, 0), (False, 0), (True, 1)):
        fl.curve(scene, fl.Coulomb(mu=0.4), [5, 25], progress=progress)
        assert capsys.readouterr().err.startswith("solving: ") == lines


def test_a_notebook_draws_a_bar(monkeypatch: Any) -> None:
    bars: list[Any] = []

    class Bar:
        def __init__(self, total: int, **_: Any) -> None:
            self.total, self.n, self.said, self.closed = total, 0, "", False
            bars.append(self)

        def set_description_str(self, said: str) -> None:
            self.said = said

        def close(self) -> None:
            self.closed = True

    monkeypatch.setattr("frictionlab.runner.progress.QUIET", 0.0)
    monkeypatch.setitem(sys.modules, "ipykernel", ModuleType("ipykernel"))
    monkeypatch.setitem(sys.modules, "tqdm.auto", SimpleNamespace(tqdm=Bar))
    with progress_told(None) as tell:
        tell(7, 40, 12.0)

    (bar,) = bars
    assert (bar.total, bar.n, bar.closed) == (40, 7, True)
    assert bar.said.startswith("solving: 7 of 40 points, about 12 s left")


@pytest.mark.parametrize(
    ("seconds", "words"),
    [
        (0.04, "0.04 s"),
        (3.2, "3 s"),
        (9.6, "10 s"),
        (99.0, "99 s"),
        (100.0, "1 min 40 s"),
        (7500.0, "2 h 05 min"),
    ],
)
def test_times_are_spoken_as_they_are_used(seconds: float, words: str) -> None:
    assert spoken(seconds) == words
