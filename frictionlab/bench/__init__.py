"""Work against precision: what each method and each peer pays for its error, measured in one run."""

from __future__ import annotations

from frictionlab.bench.measure import WorkloadResult, measure
from frictionlab.bench.reader import load_bench
from frictionlab.bench.record import Bench, UnknownCurve
from frictionlab.bench.report import bench_summary, write
from frictionlab.bench.sections import BenchPicture, Section, SectionResult, SectionSource

__all__ = [
    "Bench",
    "BenchPicture",
    "Section",
    "SectionResult",
    "SectionSource",
    "UnknownCurve",
    "WorkloadResult",
    "bench_summary",
    "load_bench",
    "measure",
    "write",
]
