"""A price told beforehand, and the time left while a run goes on, against what it takes, by methods that wait."""

from __future__ import annotations

import math
from typing import Any, ClassVar

import numpy as np
import pytest
from fake_methods import Another, Fake, faked, register

from frictionlab.compile.call import KernelCall, NotKept
from frictionlab.methods.base import Answers
from frictionlab.methods.under_way import UnderWay
from frictionlab.runner.pieces import Chunk, task_of
from frictionlab.runner.price import Forecast, Price, prices, solving_seconds
from frictionlab.study.load import parse_study


class Slow(Fake):
    """Takes longest at low belt speeds."""

    name: ClassVar[str] = "slow"


class Unknown(Another):
    """Needs kernels that are not kept."""

    name: ClassVar[str] = "unknown"

    def solve(self, *_: Any) -> Answers:
        raise NotKept(frozenset({"frictionlab_answer_curve_12ab"}))


STUDY = faked({"start": 1, "stop": 10, "num": 30}, methods=["fake", "slow"])


@pytest.fixture(autouse=True)
def _known(monkeypatch: pytest.MonkeyPatch) -> None:
    register(monkeypatch, fake=Fake, slow=Slow, unknown=Unknown)


def priced(**changes: Any) -> list[Price]:
    study = parse_study(STUDY | changes)
    return list(prices(list(study.curves()), task_of(study)).values())


def told(chunk: Chunk) -> float:
    """The seconds of a clock that is made up."""
    slow = np.where(chunk.scenes.belt_speeds > 4.0, 0.01, 0.06)
    return float(slow.sum()) if chunk.method.name == "slow" else 1e-4 * len(chunk)


def test_a_few_points_of_every_kind_tell_what_all_will_take(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("frictionlab.runner.price._time", told)
    quick, slow = priced()

    assert 2 < slow.measured < 30
    assert quick.seconds == pytest.approx(30 * 1e-4)
    assert 0.8 / 1.5 < slow.seconds == slow.longest < 0.8 * 1.5
    assert solving_seconds([quick, slow]) >= quick.start + slow.longest


def test_what_would_have_to_be_compiled_is_told_and_not_compiled(monkeypatch: pytest.MonkeyPatch) -> None:
    (price,) = priced(methods=["unknown"])

    assert (price.measured, price.to_compile) == (0, {"frictionlab_answer_curve_12ab"})
    assert price.record()["seconds"] is None

    monkeypatch.setattr(KernelCall, "_prepare", lambda *_: pytest.fail("compiled"))
    monkeypatch.setattr(KernelCall, "not_kept", lambda *_: frozenset({"frictionlab_anything_12ab"}))
    monkeypatch.setattr("frictionlab.compile.call._ready", set())
    monkeypatch.setattr("frictionlab.compile.call.PYTHON_IN_A_TRIAL", 0.0)
    (price,) = priced(methods=["auto"], laws=[{"kind": "lugre", "mu_kinetic": 0.4, "stiffness": 40}])
    assert (price.measured, price.to_compile) == (0, {"frictionlab_anything_12ab"})


class Sent:
    """A piece of so many points of a kind, one chunk."""

    def __init__(self, kind: tuple[str, str], size: int) -> None:
        self.kind, self.chunks = kind, [range(size)]

    def __len__(self) -> int:
        return len(self.chunks[0])


@pytest.mark.parametrize("slow_first", [True, False])
def test_the_time_left_is_within_a_factor_of_three_from_a_tenth_on(
    slow_first: bool, monkeypatch: Any
) -> None:
    """Of two workers with pieces of two kinds, each slowest at first."""
    now, running = [0.0], dict[int, UnderWay]()
    for clock in ("monotonic", "perf_counter"):
        monkeypatch.setattr(f"frictionlab.runner.price.time.{clock}", lambda: now[0])
    monkeypatch.setattr("frictionlab.runner.price.under_way", running)
    seconds = {("quick", ""): [0.2] * 5 + [0.05] * 20, ("slow", ""): [3.0] * 5 + [0.5] * 20}
    waiting: list[Any] = [Sent(kind, 25) for kind in seconds for _ in range(3)]
    forecast = Forecast(waiting)
    waiting, busy, told = waiting[:: -1 if slow_first else 1], list[Any](), list[tuple[float, float]]()
    while waiting or busy:
        while waiting and len(busy) < 2:
            busy.append(waiting.pop(0))
            forecast.sent(busy[-1], busy[-1].chunks)
            running[id(busy[-1].chunks[0])] = UnderWay(now[0], now[0])
        now[0] += 0.1
        for piece in list(busy):
            one, ends = running[id(piece.chunks[0])], np.cumsum(seconds[piece.kind])
            one.points = int((ends <= now[0] - one.begun).sum())
            one.seconds = float(ends[one.points - 1]) if one.points else 0.0
            one.told_at = one.begun + one.seconds
            if one.points == 25:
                busy.remove(piece)
                del running[id(piece.chunks[0])]
                forecast.came_back(piece, one.seconds)
        told.append((now[0], forecast.seconds_left()))

    known = [(since, left) for since, left in told if 0.1 * now[0] < since < 0.9 * now[0] and left == left]
    assert known
    for since, left in known:
        assert (now[0] - since) / 3.0 < left < 3.0 * (now[0] - since), (since, now[0])


def test_no_time_is_told_while_a_kind_that_is_left_is_unknown(monkeypatch: pytest.MonkeyPatch) -> None:
    now = [0.0]
    monkeypatch.setattr("frictionlab.runner.price.time.monotonic", lambda: now[0])
    pieces: list[Any] = [Sent(kind, 120) for kind in (("quick", ""), ("slow", "")) for _ in range(2)]
    forecast = Forecast(pieces)
    forecast.came_back(pieces[0], 1.2)
    before = forecast.seconds_left()
    forecast.came_back(pieces[2], 120.0)
    now[0] = 121.2

    assert math.isnan(before)
    assert forecast.seconds_left() == pytest.approx(120 * 0.01 + 120 * 1.0)
