"""The conformance battery: what it says of good laws and bad ones, in Python and on the command line."""

from __future__ import annotations

import json
import math
import time
from pathlib import Path
from typing import Annotated, Any

import pytest
from maxwell_slip import MaxwellSlip
from profiles import deep
from pydantic import Field

from frictionlab.cli import main
from frictionlab.laws.base import FrictionLaw, NonNegative, Positive, SlidingLaw, Speed
from frictionlab.laws.compliant import Length
from frictionlab.laws.coulomb import Coulomb
from frictionlab.laws.elasto_plastic import ElastoPlastic
from frictionlab.laws.lugre import LuGre
from frictionlab.laws.memory import BristleLaw
from frictionlab.testing import CHECKS, LawFailed, check_law
from frictionlab.testing.example import Given, law_check
from frictionlab.testing.running import run_check
from frictionlab.testing.strategies import fullest_laws

QUICK = [each.name for each in CHECKS if each.patience == 1.0]
"""The checks that compile nothing."""


class Lopsided(SlidingLaw):
    """Friction that is larger one way than the other.

    mu [-], > 0: friction coefficient.

    Source: nobody (1900).
    """

    mu: Positive

    def sliding_friction(self, speed: float) -> float:
        return self.mu

    def sliding_vector(self, v: Any) -> Any:
        """A tenth more forwards."""
        return (1.1 if v.real > 0.0 else 1.0) * self.mu * v / abs(v)


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


@deep("seconds of a battery")
def test_a_check_that_ran_nothing_has_failed() -> None:
    @law_check()
    def never(one: Given) -> None:
        """What never comes up."""
        one.law(lambda law: False)

    said = run_check(never, Coulomb, 5, 100.0).counterexample
    assert (
        said == "the check ran no example: nothing was tested; to change: widen the bounds of the parameters"
    )


class Endless(Coulomb):
    """Coulomb friction that never answers."""

    def sliding_friction(self, speed: float) -> float:
        while True:
            time.sleep(0.01)


def test_a_law_that_never_answers_is_told_within_the_time_limit_and_asked_no_more() -> None:
    report = check_law(Endless, only=["answers", "oddness"], seconds=0.5, on_failure="return")

    assert "no answer within 0.5 s" in report.outcome("answers").counterexample
    assert report.outcome("oddness").reason == "answers failed: the law cannot be asked"


@deep("hundreds of draws")
@pytest.mark.parametrize("law", [LuGre, ElastoPlastic])
def test_laws_are_drawn_with_every_parameter_they_may_be_given(law: type[FrictionLaw]) -> None:
    seen: set[str] = set()

    @law_check()
    def drawn(one: Given) -> None:
        """What is given."""
        made = one.draw("law", fullest_laws(law))
        seen.update(name for name, value in made if value is not None)

    run_check(drawn, law, 60, 60.0)
    assert seen == set(law.model_fields)


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
    assert "unknown law 'coulom'; installed: " in capsys.readouterr().err


class Leaking(MaxwellSlip):
    """Springs whose sliders hold back a little less than they should."""

    def rate(self, v: Any, memory: Any, k: int) -> Any:
        """A hundredth of the slip too much."""
        return super().rate(v, memory, k) + 0.01 * v


@deep("seconds of a battery")
def test_a_slider_that_meets_its_limit_between_two_steps_keeps_within_it_and_one_that_leaks_does_not() -> (
    None
):
    kept = check_law(MaxwellSlip, only=["invariant_set"], on_failure="return")
    left = check_law(Leaking, only=["invariant_set"], on_failure="return")

    assert kept.passed
    assert "leads the memory out of its set" in (left.outcomes[0].counterexample or "")


class Plain(SlidingLaw):
    """A law as an author begins it: nothing is declared.

    mu [-], > 0: friction coefficient.
    Source: nobody (1900).
    """

    mu: Positive

    def sliding_friction(self, speed: float) -> float:
        return self.mu


class Spring(BristleLaw):
    """A bristle of which nothing is declared, not even how far it bends.

    mu [-], > 0: friction coefficient.
    limit [scene length], > 0: deflection in steady sliding.
    Source: nobody (1900).
    """

    mu: Positive
    limit: Length

    def sliding_friction(self, speed: float) -> float:
        return self.mu

    def rate(self, v: Any, z: Any) -> Any:
        return v - abs(v) * z / self.limit

    def friction(self, v: Any, z: Any, dz: Any) -> Any:
        return self.mu * z / self.limit


@deep("a battery each")
@pytest.mark.parametrize("law", [Plain, Spring])
def test_what_a_law_does_not_declare_is_skipped_with_the_name_of_the_declaration(
    law: type[FrictionLaw],
) -> None:
    about = [check.name for check in CHECKS if check.declares] + ["steepest_fall", "steady_sliding"]
    report = check_law(law, only=set(about) & set(QUICK), examples=20, on_failure="return")

    assert report.passed, str(report)
    assert "steepest_fall() is not declared" in report.outcome("steepest_fall").reason
    if law is Spring:
        assert report.outcome("passivity").reason == "passive() is not declared"
        assert report.outcome("not_passive").reason == "passive() is not declared"
        assert report.outcome("steady_sliding").result == "passed"


class Steep(Plain):
    """Friction that rises steeply from a positive value at rest: by half within 1e-12 of a speed.

    mu [-], > 0: friction coefficient.
    Source: nobody (1900).
    """

    def sliding_friction(self, speed: float) -> float:
        """A power of the speed."""
        return self.mu * (1.0 + 1e3 * speed**0.2)


class Film(Plain):
    """A film of fluid.

    mu [-], > 0: friction coefficient at unit speed.
    Source: Newton (1687).
    """

    def sliding_friction(self, speed: float) -> float:
        return self.mu * speed


class ToldFilm(Film):
    """A film of fluid that says so."""

    def vanishes_at_rest(self) -> bool:
        return True


def test_a_steep_rise_is_no_smoothing_and_a_film_of_fluid_says_that_friction_vanishes() -> None:
    for law in (Steep, ToldFilm):
        assert check_law(law, only=["not_smoothed"], examples=20).passed
    with pytest.raises(LawFailed, match=r"to change: .* let vanishes_at_rest\(\) be true"):
        check_law(Film, only=["not_smoothed"], examples=20)


class NotForNumba(Plain):
    """Friction from a table that numba cannot read.

    mu [-], > 0: friction coefficient.
    Source: nobody (1900).
    """

    def sliding_friction(self, speed: float) -> float:
        """By a method of its own."""
        return self.half()

    def half(self) -> float:
        return 0.5 * self.mu


class NotAtRest(Plain):
    """Friction that rises with the logarithm of speed, which has no value at rest.

    mu [-], > 0: friction coefficient.
    Source: nobody (1900).
    """

    def sliding_friction(self, speed: float) -> float:
        return self.mu * (1.0 + 0.01 * math.log10(speed))


def test_an_error_is_told_once_with_the_number_that_raised_it() -> None:
    report = check_law(NotAtRest, only=["extremes", "static_friction"], examples=2, on_failure="return")
    first, other = (outcome.counterexample for outcome in report.outcomes)

    assert first.startswith("ValueError: math domain error in sliding_friction(speed=0)\n")
    assert first.endswith("to change: let that line hold at 0, too: a body that sticks does not slip")
    assert other == "the same error as in extremes"


def test_a_law_that_cannot_be_compiled_is_told_once() -> None:
    only = ["compiled_on_the_line", "compiled_in_the_plane", "two_methods"]
    report = check_law(NotForNumba, only=only, examples=2, on_failure="return")

    assert [outcome.result for outcome in report.outcomes] == ["failed", "skipped", "skipped"]
    assert "cannot be compiled by numba" in report.outcomes[0].counterexample
    assert report.outcomes[1].reason == "compiled_on_the_line failed: the law cannot be compiled"


class Bounded(Plain):
    """A law whose parameters have bounds of their own.

    mu [-], 0.1 < mu <= 0.3: friction coefficient.
    share [-], 0 <= share < 1: of it at quick slip.
    many [-], >= 1000: a large number.
    fading_speed [scene velocity], <= 2: where the rest has faded.
    Source: nobody (1900).
    """

    mu: Annotated[Positive, Field(gt=0.1, le=0.3)]
    share: Annotated[NonNegative, Field(lt=1.0)] = 0.5
    many: Annotated[Positive, Field(ge=1e3)] = 1e3
    fading_speed: Annotated[Speed, Field(le=2.0)] = 1.0

    def sliding_friction(self, speed: float) -> float:
        """Falls to a share."""
        fading = math.exp(-speed / self.fading_speed)
        return self.mu * (self.share + (1.0 - self.share) * fading) * (1.0 + 1.0 / self.many)


def test_laws_are_drawn_and_scaled_within_the_bounds_of_their_parameters() -> None:
    seen: list[Bounded] = []

    @law_check()
    def drawn(one: Given) -> None:
        """Any."""
        seen.append(one.law())

    assert run_check(drawn, Bounded, 60, 60.0).examples == 60
    assert all(0.1 < law.mu <= 0.3 and law.many >= 1e3 and law.fading_speed <= 2.0 for law in seen)
    assert max(law.mu for law in seen) > 0.25
    assert min(law.share for law in seen) < 0.2 < 0.8 < max(law.share for law in seen) < 1.0
    assert check_law(Bounded, only=["limits_kept", "unit_scaling", "monotone"], examples=20).passed


LAWS = '''import frictionlab as fl

HALF = 0.5


class One(fl.SlidingLaw):
    """A law. Source: nobody (1900).

    mu [-]: friction coefficient.
    """

    mu: fl.Positive

    def sliding_friction(self, speed):
        return self.mu


class Two(fl.SlidingLaw):
    """A law that is broken.

    mu [-]: friction coefficient.
    """

    mu: fl.Positive

    def sliding_friction(self, speed):
        return None
'''


def test_every_law_of_a_file_is_tested_and_a_broken_one_is_told(
    tmp_path: Path, capsys: pytest.CaptureFixture[str], monkeypatch: Any
) -> None:
    monkeypatch.setattr("frictionlab.testing.battery.CHECKS", CHECKS[1:3])
    both, broken, sound = (tmp_path / f"{name}.py" for name in ("both", "broken", "sound"))
    both.write_text(LAWS)
    broken.write_text(LAWS.replace("class One(fl.SlidingLaw)", "class One(object)"))
    sound.write_text(LAWS.replace("return None", "return HALF * self.mu"))

    assert main(["laws", "test", "--law", str(both), "--examples", "2"]) == 4
    said = capsys.readouterr()
    assert "\none\n" in said.out
    assert said.err.startswith(
        f"law 'two' (class Two) of file {both}: sliding_friction(speed=1.0) returns None"
    )
    assert main(["laws", "test", "--law", str(broken)]) == 4
    assert "law 'two' (class Two)" in capsys.readouterr().err
    assert main(["laws", "test", "--law", str(sound), "--markdown", "--examples", "2"]) == 3
    said = capsys.readouterr()
    assert "### one" in said.out
    assert "### two" in said.out
    assert (said.out + said.err).count("the docstring names no source") == 1
