"""How long the rest of a measurement will take, from what was measured so far."""

from __future__ import annotations

import time
from collections.abc import Callable, Iterable
from typing import NamedTuple


class Expected(NamedTuple):
    """One step of a measurement: the group of steps that cost alike, and what it is guessed to cost [s]."""

    group: str
    seconds: float


class Forecast:
    """Steps in their order, with the time each took and an estimate for those left.

    A step left is taken to cost its guess times what the steps of its group took over their guesses; while none of
    the group is done, that ratio over all groups.
    """

    def __init__(self, steps: Iterable[Expected], clock: Callable[[], float] = time.monotonic) -> None:
        self._steps, self._clock = list(steps), clock
        self._taken: list[float] = []
        self._start = self._last = clock()

    def done(self) -> None:
        """The next step is done."""
        now = self._clock()
        self._taken.append(now - self._last)
        self._last = now

    def left(self) -> float:
        """Seconds that the steps left are expected to take."""
        done = list(zip(self._steps, self._taken, strict=False))
        overall = _ratio_of(done) or 1.0
        ratios = {
            group: _ratio_of([each for each in done if each[0].group == group]) or overall
            for group in {step.group for step in self._steps}
        }
        return sum(step.seconds * ratios[step.group] for step in self._steps[len(self._taken) :])

    def __str__(self) -> str:
        """``3 of 57, 12 s gone, about 4 min to go``."""
        place = min(len(self._taken) + 1, len(self._steps))
        gone = duration(self._clock() - self._start)
        return f"{place} of {len(self._steps)}, {gone} gone, about {duration(self.left())} to go"


def _ratio_of(done: list[tuple[Expected, float]]) -> float:
    """Time taken over time guessed; 0 where nothing is done."""
    guessed = sum(step.seconds for step, _ in done)
    return sum(taken for _, taken in done) / guessed if guessed > 0.0 else 0.0


def duration(seconds: float) -> str:
    """A time to the digits that matter: ``8 s``, ``3 min 20 s``, ``2 h 5 min``."""
    whole = round(seconds)
    if whole < 60:
        return f"{whole} s"
    if whole < 3600:
        return f"{whole // 60} min {whole % 60} s"
    return f"{whole // 3600} h {whole % 3600 // 60} min"
