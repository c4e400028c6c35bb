"""Running a check on drawn examples under a time limit, with the smallest counterexample of a failure.

A block of Python that is stopped where it takes too long.

The results of a battery, one per check: as a text table, as records and as a Markdown table.
"""

from __future__ import annotations

import ctypes
import sys
import threading
import time
import warnings
from collections import Counter
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from dataclasses import asdict, dataclass
from typing import Any, Literal

from hypothesis import Phase, given
from hypothesis import strategies as st
from hypothesis.errors import Unsatisfiable

from frictionlab.laws.base import FrictionLaw
from frictionlab.laws.faults import call_of, describe_error
from frictionlab.testing.example import Check, Given, Violation
from frictionlab.testing.strategies import NoParameters, quietly


class TimeLimitExceeded(BaseException):
    """Raised at the time limit; not an Exception, so that a law cannot catch it by ``except Exception``."""


@contextmanager
def time_limit(seconds: float) -> Iterator[None]:
    """Raise TimeLimitExceeded in this thread if the block takes longer; compiled code is not interrupted."""
    thread, done, turn = threading.get_ident(), threading.Event(), threading.Lock()

    def watch() -> None:
        wait = seconds
        while not done.wait(wait):
            wait = 0.5  # again: what is raised inside a callback of the collector is lost
            with turn:
                if not done.is_set():
                    ctypes.pythonapi.PyThreadState_SetAsyncExc(
                        ctypes.c_ulong(thread), ctypes.py_object(TimeLimitExceeded)
                    )

    watcher = threading.Thread(target=watch, daemon=True)
    watcher.start()
    try:
        yield
    finally:
        with turn:
            done.set()


Result = Literal["passed", "failed", "skipped", "expected failure"]


@dataclass(frozen=True)
class Outcome:
    """Result of one check.

    examples: how many were run. reason: of a skip or of an expected failure. counterexample: the smallest one of a
    failure: what is wrong, with its numbers. seconds: compilation included.
    """

    check: str
    result: Result
    examples: int
    reason: str = ""
    counterexample: str = ""
    seconds: float = 0.0

    @property
    def good(self) -> bool:
        """Check whether it did not fail, expected failures apart."""
        return self.result != "failed"

    @property
    def remark(self) -> str:
        """Reason and counterexample."""
        return "; ".join(part for part in (self.reason, self.counterexample) if part)

    def line(self, remark: str | None = None) -> str:
        """One line of a table, with its own remark or this one."""
        told = self.remark if remark is None else remark
        return f"{self.check:32}  {self.result:16}  {self.examples:5}  {told}".rstrip()


@dataclass(frozen=True)
class Report:
    """All checks of one law, in the order they ran."""

    law: str
    outcomes: tuple[Outcome, ...]

    @property
    def passed(self) -> bool:
        """Check whether no check failed, expected failures apart."""
        return all(outcome.good for outcome in self.outcomes)

    @property
    def failures(self) -> list[Outcome]:
        """Return the checks that failed and were not expected to."""
        return [outcome for outcome in self.outcomes if not outcome.good]

    def outcome(self, check: str) -> Outcome:
        """Return the outcome of one check. Raises KeyError."""
        return {outcome.check: outcome for outcome in self.outcomes}[check]

    def count(self, result: Result) -> int:
        """Return the number of checks with this result."""
        return sum(outcome.result == result for outcome in self.outcomes)

    def skips(self) -> list[str]:
        """A line on what does not apply, reason by reason; none where everything ran."""
        reasons = Counter(outcome.reason for outcome in self.outcomes if outcome.result == "skipped")
        told = "; ".join(f"{count} {reason}" for reason, count in reasons.most_common())
        return [f"checks that do not apply: {told}"] if told else []

    def records(self) -> list[dict[str, Any]]:
        """One record a check, the class of the law first."""
        return [{"law": self.law, **asdict(outcome)} for outcome in self.outcomes]

    def summary(self, name: str = "") -> str:
        """One line: the number of checks with each result, and of examples."""
        ends: Sequence[Result] = "passed", "failed", "skipped", "expected failure"
        counts = [f"{self.count(end)} {end}" for end in ends if self.count(end)]
        seconds = sum(outcome.seconds for outcome in self.outcomes)
        ran = sum(outcome.examples for outcome in self.outcomes)
        return f"{name or self.law}: {', '.join(counts)}; {ran} examples in {seconds:.0f} s"

    def __str__(self) -> str:
        return "\n".join([*(outcome.line() for outcome in self.outcomes), self.summary()])

    def markdown(self, name: str = "") -> str:
        """A table to publish beside the law."""
        head = ["| check | result | examples | remark |", "| --- | --- | ---: | --- |"]
        rows = [
            f"| {outcome.check} | {outcome.result} | {outcome.examples} | {_table_cell(outcome.remark)} |"
            for outcome in self.outcomes
        ]
        return "\n".join([f"### {name or self.law}", "", *head, *rows, "", self.summary(name)])


class LawFailed(AssertionError):
    """A law that does not conform; ``report`` has every check, the message the failed ones."""

    def __init__(self, report: Report) -> None:
        self.report = report
        lines = [f"{outcome.check}: {outcome.counterexample}" for outcome in report.failures]
        super().__init__("\n".join([report.summary(), *lines]))


def heading(name: str) -> str:
    """Return the heading above the outcomes of a law."""
    return f"\n{name}\n{'check':32}  {'result':16}  {'ran':>5}"


def _table_cell(text: str) -> str:
    return " ".join(text.replace("|", "\\|").split())


class ExampleCount:
    """Number of examples of a check, the last one, and their notes."""

    def __init__(self) -> None:
        self.examples = 0
        self.last: Given | None = None
        self.notes: set[str] = set()


def run_check(check: Check, law: type[FrictionLaw], examples: int, seconds: float) -> Outcome:
    """Run one check of one law. Without any example it has failed, unless ``seldom`` gives a reason."""
    if reason := check.needless(law):
        return Outcome(check.name, "skipped", 0, reason)
    counted, start = ExampleCount(), time.perf_counter()
    problem = _problem(check, law, counted, max(1, round(check.share * examples)), seconds * check.patience)
    spent = time.perf_counter() - start
    if problem is None and counted.examples == 0:
        if check.seldom:
            return Outcome(check.name, "skipped", 0, check.seldom, seconds=spent)
        problem = (
            "the check ran no example: nothing was tested; to change: widen the bounds of the parameters"
        )
    if problem is None:
        return Outcome(check.name, "passed", counted.examples, seconds=spent)
    return Outcome(check.name, "failed", counted.examples, counterexample=problem, seconds=spent)


def _problem(
    check: Check, law: type[FrictionLaw], counted: ExampleCount, examples: int, seconds: float
) -> str | None:
    """Return the failure with its smallest counterexample; None if there is none."""
    try:
        with time_limit(seconds), warnings.catch_warnings():
            warnings.simplefilter("ignore")
            _examples(check, law, counted, examples)()
            if check.after is not None and counted.last is not None:
                check.after(counted.last)
    except Unsatisfiable:
        return None
    except TimeLimitExceeded:
        what = f"no answer within {seconds:g} s; does a method of the law never return?"
        return _described(what, counted, "let every loop of its methods end")
    except Exception as problem:
        return _described(_describe_failure(problem, law), counted, _change(check, problem, law))
    return None


def _change(check: Check, problem: Exception, law: type[FrictionLaw]) -> str:
    if isinstance(problem, Violation):
        return check.change
    if isinstance(problem, NoParameters):
        return "widen the bounds of the parameters, or take fewer together for a mistake"
    _, numbers = call_of(problem, _files(law))
    if isinstance(problem, ArithmeticError | ValueError) and [*numbers.values()][-1:] == [0.0]:
        return "let that line hold at 0, too: a body that sticks does not slip"
    return "correct that line, or bound the parameters: Annotated[fl.Positive, Field(le=10)]"


def _examples(
    check: Check, law: type[FrictionLaw], counted: ExampleCount, examples: int
) -> Callable[[], None]:
    """Return the check on ``examples`` drawn examples; Hypothesis ends with the smallest failing one."""

    def body(data: Any) -> None:
        counted.last = one = Given(law, data.draw, counted.notes)
        check.body(one)
        counted.examples += 1

    body.__name__ = check.name  # part of what a derandomized run is seeded by
    return quietly(examples, Phase.shrink)(given(st.data())(body))


def _described(what: str, counted: ExampleCount, change: str) -> str:
    """Return what is wrong, with which numbers, and what to change."""
    drawn = counted.last.told() if counted.last is not None else ""
    return "; ".join([what, *([f"seen with {drawn}"] if drawn else []), f"to change: {change}"])


def _describe_failure(problem: Exception, law: type[FrictionLaw]) -> str:
    """Return the message of a violation; of any other exception also the line of the law that raised it."""
    if isinstance(problem, AssertionError):
        return str(problem)
    return describe_error(problem, _files(law), asked=True)


def _files(law: type[FrictionLaw]) -> set[str]:
    files = {getattr(sys.modules.get(kind.__module__), "__file__", None) for kind in law.__mro__[:-1]}
    return {file for file in files if file is not None and "pydantic" not in file}
