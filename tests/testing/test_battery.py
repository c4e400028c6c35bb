"""The conformance battery: what it says of good laws and bad ones, in Python and on the command line."""

from __future__ import annotations

import json
import math
import time
from typing import Any

import pytest
from hypothesis import strategies as st
from maxwell_slip import MaxwellSlip
from memory_laws import Ageing

from frictionlab.cli import main
from frictionlab.laws.base import FrictionLaw, Positive, SlidingLaw
from frictionlab.laws.coulomb import Coulomb
from frictionlab.laws.elasto_plastic import ElastoPlastic
from frictionlab.laws.lugre import LuGre
from frictionlab.testing import CHECKS, LawFailed, check_law
from frictionlab.testing.check import make_check
from frictionlab.testing.example import Given
from frictionlab.testing.running import run_check
from frictionlab.testing.strategies import fullest_laws, loaded_laws, numbers

QUICK = [each.name for each in CHECKS if each.patience == 1.0]
"""The checks that compile nothing."""


class Lopsided(SlidingLaw):
    """Friction that is larger one way than the other.

    mu [-], > 0: friction coefficient.

    Source: nobody (1900).
    """

    mu: Positive

    def sliding_friction(self, speed: float) -> float:
        """mu."""
        return self.mu

    def sliding_vector(self, v: Any) -> Any:
        """A tenth more forwards."""
        return (1.1 if v.real > 0.0 else 1.0) * self.mu * v / abs(v)


def test_coulomb_friction_passes_every_quick_check_and_is_told_what_ran() -> None:
    report = check_law(Coulomb, only=QUICK, examples=10)

    assert report.passed
    assert [outcome.check for outcome in report.outcomes] == QUICK
    assert report.outcome("oddness").examples == 10
    assert report.outcome("passivity").reason == "without memory"


def test_a_law_that_fails_raises_with_the_smallest_counterexample() -> None:
    with pytest.raises(
        LawFailed, match=r"oddness: slip turned round: friction: got .*Lopsided\(mu=1\)"
    ) as failed:
        check_law(Lopsided, only=["oddness", "static_friction"])
    assert not failed.value.report.passed
    assert failed.value.report.outcome("static_friction").result == "passed"


def test_an_expected_failure_needs_its_reason_and_fails_where_the_law_passes() -> None:
    why = {"oddness": "a ratchet"}
    report = check_law(Lopsided, only=["oddness"], expected_failures=why)

    assert report.passed
    assert report.outcome("oddness").result == "expected failure"
    assert report.outcome("oddness").reason == "a ratchet"
    with pytest.raises(LawFailed, match=r"expected to fail .a ratchet., but passed"):
        check_law(Coulomb, only=["oddness"], expected_failures=why)
    with pytest.raises(ValueError, match="no check 'odness'; did you mean 'oddness'"):
        check_law(Lopsided, expected_failures={"odness": "a ratchet"})
    with pytest.raises(ValueError, match="say why"):
        check_law(Lopsided, expected_failures={"oddness": " "})


def test_a_law_names_its_own_expected_failures() -> None:
    class Ratchet(Lopsided):
        """Friction that is larger one way than the other."""

        expected_failures = {"oddness": "a ratchet"}  # noqa: RUF012

    assert check_law(Ratchet, only=["oddness"]).passed


def test_a_check_that_ran_nothing_has_failed() -> None:
    @make_check("never")
    def never(one: Given) -> None:
        """What never comes up."""
        one.law(lambda law: False)

    assert run_check(never, Coulomb, 5, 10.0).counterexample == "the check ran no example: nothing was tested"


class Endless(Coulomb):
    """Coulomb friction that never answers."""

    def sliding_friction(self, speed: float) -> float:
        """Never."""
        while True:
            time.sleep(0.01)


def test_a_law_that_never_answers_is_told_within_the_time_limit_and_asked_no_more() -> None:
    report = check_law(Endless, only=["answers", "oddness"], seconds=0.5, on_failure="return")

    assert "no answer within 0.5 s" in report.outcome("answers").counterexample
    assert report.outcome("oddness").reason == "answers failed: the law cannot be asked"


@pytest.mark.parametrize("law", [LuGre, ElastoPlastic])
def test_laws_are_drawn_with_every_parameter_they_may_be_given(law: type[FrictionLaw]) -> None:
    seen: set[str] = set()

    @make_check("drawn")
    def drawn(one: Given) -> None:
        """What is given."""
        made = one.draw("law", fullest_laws(law))
        seen.update(name for name, value in made if value is not None)

    run_check(drawn, law, 60, 60.0)
    assert seen == set(law.model_fields)


def test_numbers_keep_within_their_limits() -> None:
    for low, high in ((0.0, math.inf), (1.0, math.inf), (0.0, 1.0), (-math.inf, math.inf), (-math.inf, 2.0)):

        @make_check("numbers")
        def drawn(one: Given, low: float = low, high: float = high) -> None:
            """Numbers."""
            assert low <= one.draw("number", numbers(low, high)) <= high

        assert run_check(drawn, Coulomb, 50, 60.0).result == "passed"
    assert isinstance(loaded_laws(Coulomb), st.SearchStrategy)


def test_the_command_prints_a_table_records_or_markdown(
    capsys: pytest.CaptureFixture[str], monkeypatch: Any
) -> None:
    monkeypatch.setattr("frictionlab.testing.battery.CHECKS", CHECKS[:3])

    assert main(["laws", "test", "coulomb", "--examples", "10"]) == 0
    assert "frozen                            passed                1" in capsys.readouterr().out
    assert main(["laws", "test", "coulomb", "--json", "--examples", "10"]) == 0
    records = json.loads(capsys.readouterr().out)
    assert [record["check"] for record in records] == ["loads_by_name", "documented", "frozen"]
    assert {record["name"] for record in records} == {"coulomb"}
    assert main(["laws", "test", "coulomb", "--markdown", "--examples", "10"]) == 0
    assert "| frozen | passed | 1 |  |" in capsys.readouterr().out
    assert main(["laws", "test", "coulom"]) == 2
    assert "no law 'coulom'; installed: " in capsys.readouterr().err


def test_the_command_ends_with_3_where_a_check_fails(monkeypatch: Any) -> None:
    @make_check("never")
    def never(one: Given) -> None:
        """What never comes up."""
        one.law(lambda law: False)

    monkeypatch.setattr("frictionlab.testing.battery.CHECKS", (never,))
    assert main(["laws", "test", "coulomb", "--examples", "2"]) == 3


class Leaking(MaxwellSlip):
    """Springs whose sliders hold back a little less than they should."""

    def rate(self, v: Any, memory: Any, k: int) -> Any:
        """A hundredth of the slip too much."""
        return super().rate(v, memory, k) + 0.01 * v


def test_a_slider_that_meets_its_limit_between_two_steps_keeps_within_it_and_one_that_leaks_does_not() -> (
    None
):
    kept = check_law(MaxwellSlip, only=["invariant_set"], on_failure="return")
    left = check_law(Leaking, only=["invariant_set"], on_failure="return")

    assert kept.passed
    assert "leads the memory out of its set" in (left.outcomes[0].counterexample or "")


def test_memories_that_know_no_direction_are_never_asked_turned_round() -> None:
    assert check_law(Ageing, only=["instances_apart", "largest_rate"], on_failure="return").passed
