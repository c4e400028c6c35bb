"""Work against precision: what each method and each peer pays for its error, measured in one run."""

from __future__ import annotations

from frictionlab.bench.measure import Interrupted, Measured, measure
from frictionlab.bench.reader import load_bench
from frictionlab.bench.record import Bench, UnknownCurve
from frictionlab.bench.report import summary, write

__all__ = ["Bench", "Interrupted", "Measured", "UnknownCurve", "load_bench", "measure", "summary", "write"]
