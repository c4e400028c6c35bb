"""The results of a battery, one per check: as a text table, as records and as a Markdown table."""

from __future__ import annotations

from collections import Counter
from collections.abc import Sequence
from dataclasses import asdict, dataclass
from typing import Any, Literal

Result = Literal["passed", "failed", "skipped", "expected failure"]


@dataclass(frozen=True)
class Outcome:
    """The result of one check.

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
        """Whether it did not fail, expected failures apart."""
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
        """Whether no check failed, expected failures apart."""
        return all(outcome.good for outcome in self.outcomes)

    @property
    def failures(self) -> list[Outcome]:
        """The checks that failed and were not expected to."""
        return [outcome for outcome in self.outcomes if not outcome.good]

    def outcome(self, check: str) -> Outcome:
        """That of one check. Raises KeyError."""
        return {outcome.check: outcome for outcome in self.outcomes}[check]

    def count(self, result: Result) -> int:
        """The number of checks with this result."""
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
    """The heading above the outcomes of a law."""
    return f"\n{name}\n{'check':32}  {'result':16}  {'ran':>5}"


def _table_cell(text: str) -> str:
    return " ".join(text.replace("|", "\\|").split())
