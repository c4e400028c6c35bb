"""Study file: what a person writes, checked as a whole, and the frozen study it becomes."""

from __future__ import annotations
