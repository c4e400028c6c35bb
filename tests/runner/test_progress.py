"""Progress of a run: when it is told, in which words, that its line never wraps and is gone at the end."""

from __future__ import annotations

import io
import os
import re
import struct
import sys
import threading
import time
from collections.abc import Callable, Iterator
from concurrent.futures import ThreadPoolExecutor
from contextlib import contextmanager
from types import ModuleType, SimpleNamespace
from typing import Any, TextIO

import pytest
from fig_4b import LAW, SCENE
from tqdm.std import tqdm
from tqdm.utils import disp_len

import frictionlab as fl
from frictionlab.compile.notice import mark_cache_miss, named_while_it_compiles
from frictionlab.runner.progress import Meter, progress_told, silent, spoken

fcntl, termios = pytest.importorskip("fcntl"), pytest.importorskip("termios")


@pytest.fixture(autouse=True)
def _is_told_at_once(monkeypatch: pytest.MonkeyPatch) -> None:
    for pause in ("QUIET", "OFTEN", "NOW_AND_THEN"):
        monkeypatch.setattr(f"frictionlab.runner.progress.{pause}", 0.01)


def until(comes: Callable[[], object]) -> None:
    """Wait until it has come, on however busy a machine."""
    while not comes():
        time.sleep(0.01)


def test_a_log_gets_lines_that_say_what_is_under_way_and_what_is_left() -> None:
    from numba.core.compiler_lock import global_compiler_lock

    log = io.StringIO()
    with Meter(log, "study 2 of 15: ") as meter, ThreadPoolExecutor(1) as elsewhere:
        meter(40, 100, 2.0, "lugre at belt speed 0.3")
        until(lambda: "left" in log.getvalue())
        with named_while_it_compiles("a kernel"):
            mark_cache_miss()
            elsewhere.submit(global_compiler_lock.acquire).result()
            until(lambda: "a kernel" in log.getvalue())
            elsewhere.submit(global_compiler_lock.release).result()
        meter.begins("drawing", "figures")
        meter(1, 3)
        until(lambda: "drawing: " in log.getvalue())
        meter.begins("stopping")
        until(lambda: "stopping" in log.getvalue())

    told = [re.sub(r"\S+ s so far", "so far", line) for line in log.getvalue().splitlines()]
    assert set(told) - {"study 2 of 15: drawing, so far"} == {
        "study 2 of 15: solving: 40 of 100 points, lugre at belt speed 0.3, about 2 s left, so far",
        "study 2 of 15: compiling a kernel, solving: 40 of 100 points, lugre at belt speed 0.3, so far",
        "study 2 of 15: drawing: 1 of 3 figures, so far",
        "study 2 of 15: stopping, so far",
    }


def test_a_short_run_tells_nothing(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("frictionlab.runner.progress.QUIET", 600.0)
    log = io.StringIO()
    with Meter(log) as meter:
        meter(1, 2)

    assert log.getvalue() == ""


@pytest.mark.parametrize("is_terminal", [False, True])
@pytest.mark.parametrize("problem", [BlockingIOError(), ValueError("I/O operation on closed file")])
def test_a_stream_that_takes_no_words_is_no_error(is_terminal: bool, problem: Exception) -> None:
    asked: list[str] = []

    def refuse(text: str) -> None:
        asked.append(text)
        raise problem

    with Meter(SimpleNamespace(isatty=lambda: is_terminal, write=refuse, fileno=lambda: -1)) as meter:  # type: ignore[arg-type]
        until(lambda: len(asked) > 3)
        meter.clear()


@contextmanager
def terminal(columns: int) -> Iterator[tuple[TextIO, Callable[[], str]]]:
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
        yield stream, lambda: "".join(seen).removesuffix("end")
        stream.write("end")
        stream.flush()
        reader.join()
    os.close(ours)


@pytest.mark.parametrize("columns", [0, 20, 50, 120])  # 0: a terminal that does not say
def test_the_line_goes_on_by_itself_never_wraps_and_is_gone_at_the_end(columns: int) -> None:
    with terminal(columns) as (stream, seen), Meter(stream, "study 2 of 15: ") as meter:
        meter.begins("finding the onsets of curves that are known by now")
        until(lambda: seen().count("\rstudy") > 2)
        meter.clear()
        meter.begins("drawing", "figures of 摩擦, whose letters are wide")
        meter(1, 3)
        until(lambda: seen().count("\rstudy") > 5)
        meter.__exit__()

    states = seen().split("\r")
    assert max(map(disp_len, states)) < (columns or 80)
    assert any(state.startswith("study 2 of 15: find") for state in states)
    assert states[-2:] == [" " * len(states[-2]), ""]


def test_python_calls_tell_progress_where_it_is_seen_or_asked_for(capsys: Any, monkeypatch: Any) -> None:
    said = ""
    with progress_told(None) as nobody:
        assert nobody is silent  # a test has neither terminal nor notebook
    with progress_told(True, "following starts", ""):
        while not said.startswith("following starts, "):
            said += capsys.readouterr().err
    told: list[int] = []
    monkeypatch.setattr(Meter, "__call__", lambda _, done, *more: told.append(done))
    for progress, last in ((None, []), (False, []), (True, [2])):
        fl.curve(SCENE, LAW, [5, 25], progress=progress)
        assert told[-1:] == last


def test_a_notebook_draws_a_bar(monkeypatch: pytest.MonkeyPatch) -> None:
    bars: list[Any] = []
    monkeypatch.setitem(sys.modules, "ipykernel", ModuleType("ipykernel"))
    monkeypatch.setattr("tqdm.auto.tqdm", lambda **given: bars.append(tqdm(**given)) or bars[-1])
    with progress_told(None) as tell:
        tell(7, 40, 12.0, "")
        until(lambda: bars and bars[0].desc.startswith("solving: 7 of 40 points, about 12 s left"))
        assert [(bar.n, bar.total, bar.disable) for bar in bars] == [(7, 40, False)]
    assert [bar.disable for bar in bars] == [True]


def test_times_are_spoken_as_they_are_used() -> None:
    words = ["0.04 s", "3 s", "10 s", "99 s", "1 min 40 s", "2 h 05 min"]

    assert list(map(spoken, [0.04, 3.2, 9.6, 99.0, 100.0, 7500.0])) == words
