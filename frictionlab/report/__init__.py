"""Reports: the page of a run, and the page of a folder of runs."""

from __future__ import annotations
