"""Work against precision: what each method and each peer pays for its error, measured in one run."""

from __future__ import annotations

from frictionlab.bench.listed import Bench, UnknownCurve, bench_summary, load_bench, measure
from frictionlab.bench.result import Section, SectionResult

__all__ = [
    "Bench",
    "Section",
    "SectionResult",
    "UnknownCurve",
    "bench_summary",
    "load_bench",
    "measure",
]
