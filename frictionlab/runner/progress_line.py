"""The words of progress, and how they fit on a line."""

from __future__ import annotations

from collections.abc import Sequence

LONGEST_BAR, BAR_STEP = 30, 10
"""Letters between the brackets, and what their number is a multiple of."""


class RunStage:
    """A part of a run, such as ``solving`` so many ``points``: how far it is, and the time it took so far [s]."""

    def __init__(self, doing: str, things: str, now: float) -> None:
        self.doing, self.things = doing, things
        self.done, self.total = 0, 0
        self._at_first: int | None = None
        self._working, self._last = 0.0, now

    def reaches(self, done: int, total: int) -> None:
        """So many of all are done."""
        self.done, self.total = done, total
        self._at_first = done if self._at_first is None else self._at_first

    def passes(self, now: float, waiting: bool) -> None:
        """Time until now. waiting: for kernels to be compiled, which does not come again."""
        self._working += 0.0 if waiting else now - self._last
        self._last = now

    @property
    def share(self) -> float | None:
        """What is done of it, from 0 to 1; None where that is not counted."""
        return self.done / self.total if self.total else None

    @property
    def each(self) -> float:
        """Time that one took so far, compiling not counted; 0 where that is not known."""
        fresh = self.done - (self._at_first or 0)
        return self._working / fresh if fresh > 0 else 0.0

    @property
    def left(self) -> float:
        """Time that the rest takes at that speed; 0 where that is not known."""
        return self.each * (self.total - self.done)


def stage_words(stage: RunStage, passed: float, kernel: str) -> list[str]:
    """What to tell, the most important first. kernel: what is said of the one being compiled, if any."""
    count = f": {stage.done} of {stage.total} {stage.things}" if stage.total else ""
    at, so_far = f"{stage.doing}{count}", f"{spoken(passed)} so far"
    if kernel:
        return [kernel, at, so_far, "once per machine"]
    left = [f"about {spoken(stage.left)} left"] if stage.left > 0.5 else []
    return [at, *left, so_far, *_speed(stage)]


def _speed(stage: RunStage) -> list[str]:
    if not stage.each:
        return []
    rate = f"{1.0 / stage.each:.0f}/s" if stage.each < 0.1 else f"{1.0 / stage.each:.2g}/s"
    return [rate if stage.each < 1.0 else f"{spoken(stage.each)} each"]


def spoken(seconds: float) -> str:
    """A time in words, to about a hundredth."""
    if seconds < 99.5:
        return f"{seconds:.0f} s" if seconds > 9.5 else f"{seconds:.1g} s"
    minutes, rest = divmod(round(seconds), 60)
    if minutes < 10:
        return f"{minutes} min {rest:02} s"
    return f"{minutes} min" if minutes < 100 else f"{minutes // 60} h {minutes % 60:02} min"


def fitted(facts: Sequence[str], share: float | None, room: int) -> str:
    """Of the facts as many as the room takes, the first ones; before them a bar where there is room for one."""
    number = len(facts)
    while number > 1 and len(", ".join(facts[:number])) > room:
        number -= 1
    text = ", ".join(facts[:number])[: max(room, 0)]
    length = min(LONGEST_BAR, room - len(text) - 3)
    length -= length % BAR_STEP  # a letter more or less in the text does not move it
    if share is None or length <= 0:
        return text
    full = int(share * length)
    return f"[{'#' * full}{'.' * (length - full)}] {text}"
