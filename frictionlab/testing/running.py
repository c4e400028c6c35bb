"""Running a check on drawn examples under a time limit, with the smallest counterexample of a failure."""

from __future__ import annotations

import sys
import time
import warnings
from collections.abc import Callable
from typing import Any

from hypothesis import Phase, given
from hypothesis import strategies as st
from hypothesis.errors import Unsatisfiable

from frictionlab.faults import describe_error
from frictionlab.laws.base import FrictionLaw
from frictionlab.testing.check import Check
from frictionlab.testing.example import Given, Violation
from frictionlab.testing.outcome import Outcome
from frictionlab.testing.strategies import NoParameters, quietly
from frictionlab.testing.time_limit import TimeLimitExceeded, time_limit


class ExampleCount:
    """The number of examples of a check, the last one, and their notes."""

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
    """The failure with its smallest counterexample; None if there is none."""
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
        return _described(_describe_failure(problem, law), counted, _change(check, problem))
    return None


def _change(check: Check, problem: Exception) -> str:
    if isinstance(problem, Violation):
        return check.change
    if isinstance(problem, NoParameters):
        return "widen the bounds of the parameters, or take fewer together for a mistake"
    return "correct that line, or bound the parameters: Annotated[fl.Positive, Field(le=10)]"


def _examples(
    check: Check, law: type[FrictionLaw], counted: ExampleCount, examples: int
) -> Callable[[], None]:
    """The check on ``examples`` drawn examples; Hypothesis ends with the smallest failing one."""

    def body(data: Any) -> None:
        counted.last = one = Given(law, data.draw, counted.notes)
        check.body(one)
        counted.examples += 1

    body.__name__ = check.name  # part of what a derandomized run is seeded by
    return quietly(examples, Phase.shrink)(given(st.data())(body))


def _described(what: str, counted: ExampleCount, change: str) -> str:
    """What is wrong, with which numbers, and what to change."""
    drawn = counted.last.told() if counted.last is not None else ""
    return "; ".join([what, *([f"seen with {drawn}"] if drawn else []), f"to change: {change}"])


def _describe_failure(problem: Exception, law: type[FrictionLaw]) -> str:
    """The message of a violation; of any other exception also the line of the law that raised it."""
    if isinstance(problem, AssertionError):
        return str(problem)
    files = {getattr(sys.modules.get(kind.__module__), "__file__", None) for kind in law.__mro__[:-1]}
    return describe_error(problem, {file for file in files if file is not None and "pydantic" not in file})
