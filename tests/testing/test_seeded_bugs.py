"""Each seeded bug fails the check meant for it, with a counterexample; the same law without the bug passes it."""

from __future__ import annotations

import pytest
from broken_laws import COMPILED, QUICK
from broken_laws.case import OF_EVERY_LAW, Case
from profiles import deep, some

from frictionlab.laws.base import FrictionLaw
from frictionlab.testing import CHECKS, check_law, running
from frictionlab.testing.strategies import quietly

deep_alone = deep("compiles a kernel for each")
TWINS = {
    (case.twin, case.check): case
    for case in QUICK
    if case.check not in OF_EVERY_LAW or not case.twin.__module__.startswith("frictionlab.")
}.values()


@pytest.fixture(autouse=True)
def first_counterexample(monkeypatch: pytest.MonkeyPatch) -> None:
    """The first counterexample will do: looking for the smallest takes most of the time."""
    monkeypatch.setattr(running, "quietly", lambda examples, *phases: quietly(examples))


def caught(law: type[FrictionLaw], case: Case, examples: int | None = None) -> str:
    """What the check says against the law; '' where it passes."""
    report = check_law(law, only=[case.check], examples=examples or case.examples, on_failure="return")
    outcome = report.outcome(case.check)
    assert outcome.result in ("passed", "failed"), outcome.line()
    return outcome.counterexample


@some(13, "a check each")
@pytest.mark.parametrize("case", QUICK, ids=str)
def test_a_seeded_bug_is_caught_by_the_check_meant_for_it(case: Case) -> None:
    assert caught(case.law, case)


@some(4, "a check each")
@pytest.mark.parametrize("case", TWINS, ids=lambda case: f"{case.twin.__name__}-{case.check}")
def test_the_law_without_the_bug_passes_that_check(case: Case) -> None:
    assert caught(case.twin, case, 12) == ""


@deep_alone
@pytest.mark.parametrize("case", COMPILED, ids=str)
def test_a_bug_that_shows_when_compiled_is_caught_and_the_law_without_it_passes(case: Case) -> None:
    assert caught(case.law, case)
    assert caught(case.twin, case) == ""


def test_every_check_has_a_seeded_bug() -> None:
    """But loading by name, which has none to go wrong: registered laws are walked through the doors."""
    without = {check.name for check in CHECKS} - {case.check for case in (*QUICK, *COMPILED)}
    assert without == {"loads_by_name"}
