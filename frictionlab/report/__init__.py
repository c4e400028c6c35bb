"""Reports: the page of a run, and the page of a folder of runs."""

from frictionlab.report.citing import bibtex
from frictionlab.report.index import write_index
from frictionlab.report.page import write_report

__all__ = ["bibtex", "write_index", "write_report"]
