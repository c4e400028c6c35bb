"""A bench list: its sections, chosen and measured."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, replace

from frictionlab.bench.curve import BenchCurve
from frictionlab.bench.peers.base import Peer
from frictionlab.bench.peers.equations import ScipyBristle, ScipySteps
from frictionlab.bench.peers.heyoka_taylor import Heyoka
from frictionlab.bench.peers.scipy_events import ScipyEvents
from frictionlab.bench.record import Section, SectionResult
from frictionlab.bench.report import left_out
from frictionlab.compile.call import compiling_at_once


class UnknownCurve(Exception):
    """A curve asked for by a name that is not in the list."""


@dataclass(frozen=True)
class Bench:
    """The sections of a list, curves first."""

    name: str
    title: str
    sections: tuple[Section, ...]

    @property
    def names(self) -> list[str]:
        """Of all that is measured."""
        return [section.name for section in self.sections]

    @property
    def curves(self) -> list[BenchCurve]:
        """The curves among them."""
        return [section for section in self.sections if isinstance(section, BenchCurve)]

    @property
    def parts(self) -> str:
        """What its sections are called."""
        return "curves" if len(self.curves) == len(self.sections) else "curves and sections"

    def only(self, names: Sequence[str]) -> Bench:
        """The curves and sections of these names alone; all where none is named. Raises UnknownCurve."""
        if unknown := [name for name in names if name not in self.names]:
            part = "curve" if self.parts == "curves" else "curve or section"
            raise UnknownCurve(f"no {part} '{unknown[0]}' in the list; there are {', '.join(self.names)}")
        return replace(
            self, sections=tuple(each for each in self.sections if not names or each.name in names)
        )


def measure(bench: Bench, tell: Callable[[str], None], first_runs: bool = False) -> Iterator[SectionResult]:
    """Measure the sections of a list, and hand each out as soon as it is finished.

    first_runs: of curves the first setting of each method without kernels, too.
    """
    with compiling_at_once():  # what is timed is machine code
        for section in bench.sections:
            timed = (
                replace(section, first_runs=True)
                if first_runs and isinstance(section, BenchCurve)
                else section
            )
            yield timed.measure(tell)


def bench_summary(done: Sequence[SectionResult]) -> str:
    """What every curve and section came to, and in one line the peers that are not installed."""
    missing = {
        label: told for each in done if each.kind == "curve" for label, told in (each.left_out or {}).items()
    }
    told = [each.summary() for each in done]
    return "\n\n".join([*told, left_out(missing)] if missing else told)


PEERS: dict[str, type[Peer]] = {peer.name: peer for peer in (ScipySteps, ScipyEvents, ScipyBristle, Heyoka)}
"""Other libraries by the names that a list gives them."""
