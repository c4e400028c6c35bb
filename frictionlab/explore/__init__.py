"""The page to explore friction curves with: sliders, an exact solver in the page, the table of a run."""

from __future__ import annotations

from frictionlab.explore.page import write_explorer

__all__ = ["write_explorer"]
