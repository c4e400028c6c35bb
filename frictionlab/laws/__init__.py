"""Laws of friction, one per file."""

from __future__ import annotations
