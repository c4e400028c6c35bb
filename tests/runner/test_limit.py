"""A point over the limit of time is killed, its neighbours are answered; an interrupt is obeyed during a kernel."""

from __future__ import annotations

import signal
import threading
import time
from concurrent.futures import CancelledError, ThreadPoolExecutor
from pathlib import Path
from typing import Any

import pytest
from fake_methods import Fake, Trouble, faked
from fig_4b import LAW, SCENE

import frictionlab as fl
from frictionlab.runner import engine as limit
from frictionlab.runner.engine import OverLimit, within
from frictionlab.runner.pieces import Chunk
from frictionlab.runner.solving import run_share
from frictionlab.runner.store import Store
from frictionlab.study.load import parse_study
from frictionlab.values.notes import StudyError

STUDY = faked([4, 5, 6, 7, 8], limit={"seconds_per_point": 0.3})


def run_elsewhere(study: dict[str, Any], out: Path | None = None) -> Any:
    """Run by an executor of somebody's, which may be processes."""
    with ThreadPoolExecutor(1) as pool:
        return fl.run(study, out=out, executor=pool)


@pytest.fixture
def released(fakes: None, trouble: Trouble) -> Any:
    """The method takes for ever at a belt speed of 6, until the test is over."""
    event = threading.Event()
    trouble({6.0: lambda: event.wait(60.0)})
    yield event
    event.set()


@pytest.fixture
def allowed(released: Any, monkeypatch: pytest.MonkeyPatch) -> list[tuple[int, float]]:
    """Points that are solved together and the seconds they may take, which those with belt speed 6 exceed."""
    told = list[tuple[int, float]]()

    def by_the_clock(seconds: float, work: Any, given: Chunk, **_how: Any) -> Any:
        speeds = [scene.belt_speed for scene in given.scenes]
        told.append((len(speeds), seconds))
        if not released.is_set() and 6.0 in speeds:
            raise OverLimit
        return work(given)

    monkeypatch.setattr(limit, "within", by_the_clock)
    return told


def test_a_point_over_the_limit_is_killed_and_its_neighbours_are_answered(released, allowed, tmp_path):
    done = run_elsewhere(STUDY, out=tmp_path)

    assert allowed == [(5, 0.3), (2, 0.3), (3, 0.3), (1, 0.3), (2, 0.3)]
    assert done.table["status"].tolist() == ["ok", "ok", "killed", "ok", "ok"]
    reason = "over the limit of 0.3 s (limit: {seconds_per_point: 0.3} in the study)"
    assert done.table["reason"].tolist()[2] == reason
    released.set()
    again = run_elsewhere(STUDY, out=tmp_path)
    assert (again.computed, again.table["status"].tolist()) == (5, ["ok"] * 5)


def test_compilation_does_not_count(monkeypatch):
    monkeypatch.setattr("frictionlab.runner.engine.compiling", lambda: True)

    assert within(0.01, lambda: time.sleep(0.3) or "done") == "done"


def test_work_within_a_limit_gives_its_result_or_its_error():
    assert within(60.0, divmod, 7, 2) == (3, 1)
    with pytest.raises(ZeroDivisionError):
        within(60.0, divmod, 7, 0)
    with pytest.raises(OverLimit):
        within(0.05, time.sleep, 2.0)


def test_a_curve_is_allowed_the_time_of_a_tenth_of_its_points(allowed):
    run_elsewhere(STUDY | {"sweep": {"scene.belt_speed": [10.0 + 0.01 * k for k in range(50)]}})

    assert allowed == [(50, 0.3 * 50 / 10)]


def test_an_interrupt_is_obeyed_while_a_kernel_runs(released):
    threading.Timer(0.3, signal.raise_signal, [signal.SIGINT]).start()

    with pytest.raises(KeyboardInterrupt):
        fl.steady_state(SCENE.with_(belt_speed=6), LAW, method=Fake())


def test_work_that_is_given_up_holds_nobody_back(released):
    given_up = threading.Event()
    threading.Timer(0.2, given_up.set).start()

    with pytest.raises(CancelledError):
        within(60.0, released.wait, 60.0, given_up=given_up)


def test_a_limit_needs_processes(released, tmp_path):
    needs = r"limit\.seconds_per_point: needs processes: give --processes N"
    for run in (fl.run, lambda study: run_share(parse_study(study), (1, 2), Store(tmp_path))):
        with pytest.raises(StudyError, match=needs):
            run(STUDY)


@pytest.mark.parametrize("given", [0, -1, "long", True])
def test_a_limit_that_is_no_time_is_refused(given):
    with pytest.raises(StudyError, match=r"limit\.seconds_per_point: must be"):
        parse_study(STUDY | {"methods": ["auto"], "limit": {"seconds_per_point": given}})


def test_a_study_says_its_limit_only_where_it_is_not_the_usual_one():
    plain = {key: value for key, value in STUDY.items() if key != "limit"} | {"methods": ["auto"]}
    usual, short = parse_study(plain), parse_study(plain | {"limit": {"seconds_per_point": 2}})

    assert (usual.limit.seconds_per_point, short.limit.seconds_per_point) == (300.0, 2.0)
    assert "limit" not in usual.resolved()
    assert parse_study(short.resolved()) == short
    assert short.digest() == usual.digest()
