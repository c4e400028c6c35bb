"""Speed against accuracy over models: what laws, simpler scenes and methods cost, and how far they are off."""

from __future__ import annotations

from frictionlab.bench.models.reader import read_models

__all__ = ["read_models"]
