"""Reports: the page of a run, and the page of a folder of runs."""

from __future__ import annotations

from frictionlab.report.page import write_index, write_report
from frictionlab.report.sources import bibtex

__all__ = ["bibtex", "write_index", "write_report"]
