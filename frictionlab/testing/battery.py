"""Conformance battery: every check there is, and how a law is put through them."""

from __future__ import annotations

import difflib
from collections.abc import Callable, Collection, Mapping
from dataclasses import replace
from typing import Literal

from frictionlab.laws.base import FrictionLaw
from frictionlab.testing.checks import compiled, declared, limits, path, record, symmetry
from frictionlab.testing.example import Check
from frictionlab.testing.running import LawFailed, Outcome, Report, run_check

MODULES = record, symmetry, declared, path, compiled, limits
"""Modules of checks; first what a law must have before anything else can be asked of it."""
CHECKS = tuple(each for module in MODULES for each in vars(module).values() if isinstance(each, Check))
"""In the order they run."""

EXAMPLES = 100
SECONDS = 60.0
"""Most time a check may take, ten times that where it compiles; compiled code is waited for."""
NEEDED = "answers"
CANNOT_COMPILE = "cannot be compiled by numba"


def check_law(
    law: type[FrictionLaw],
    *,
    expected_failures: Mapping[str, str] | None = None,
    only: Collection[str] = (),
    examples: int = EXAMPLES,
    seconds: float = SECONDS,
    on_failure: Literal["raise", "return"] = "raise",
    tell: Callable[[Outcome], None] = lambda outcome: None,
) -> Report:
    """Put a law class through every check that is for it.

    expected_failures: check -> why the law fails it, beside those the law itself names; one that passes after all
    is a failure. only: names of the checks to run; all where left out. examples: per check,
    fewer where they are dear. seconds: the most a check may
    take, ten times that where it compiles. tell: called with each outcome as it comes.
    Raises LawFailed, an AssertionError, where a check fails, unless on_failure is ``return``; ValueError for the name
    of a check there is none of.
    """
    expected = {**law.expected_failures, **(expected_failures or {})}
    _known("only", only)
    _known("expected_failures", expected)
    for name in [name for name, reason in expected.items() if not reason.strip()]:
        raise ValueError(f"expected_failures: {name}: say why the law fails it")
    outcomes: list[Outcome] = []
    for check in [check for check in CHECKS if not only or check.name in only]:
        outcomes.append(_outcome(check, law, (examples, seconds), outcomes, expected.get(check.name)))
        tell(outcomes[-1])
    report = Report(law.__name__, tuple(outcomes))
    if on_failure == "raise" and not report.passed:
        raise LawFailed(report)
    return report


def _known(whose: str, names: Collection[str]) -> None:
    known = [check.name for check in CHECKS]
    for name in names:
        if name not in known:
            close = difflib.get_close_matches(name, known, 1)
            meant = f"; did you mean '{close[0]}'?" if close else ""
            raise ValueError(f"{whose}: no check '{name}'{meant} The checks are {', '.join(known)}")


def _outcome(
    check: Check,
    law: type[FrictionLaw],
    most: tuple[int, float],
    before: list[Outcome],
    expected: str | None,
) -> Outcome:
    if any(outcome.check == NEEDED and outcome.result == "failed" for outcome in before):
        return Outcome(check.name, "skipped", 0, f"{NEEDED} failed: the law cannot be asked")
    uncompiled = [outcome.check for outcome in before if CANNOT_COMPILE in outcome.counterexample]
    if uncompiled and check.patience > 1.0:
        return Outcome(check.name, "skipped", 0, f"{uncompiled[0]} failed: the law cannot be compiled")
    outcome = run_check(check, law, *most)
    same = [each.check for each in before if _cause(each) and _cause(each) == _cause(outcome)]
    if same:
        outcome = replace(outcome, counterexample=f"the same error as in {same[0]}")
    if expected is None:
        return outcome
    if outcome.result == "failed":
        return replace(outcome, result="expected failure", reason=expected)
    unmet = f"expected to fail ({expected}), but {outcome.result}: take it out of expected_failures"
    return replace(outcome, result="failed", counterexample=unmet)


def _cause(outcome: Outcome) -> str:
    """Return the line of a law that raised an error; '' of any other result."""
    line = outcome.counterexample.partition("; seen with")[0].partition("\n")[2]
    return line.strip()
