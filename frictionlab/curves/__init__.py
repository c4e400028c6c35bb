"""Curves of mean friction over belt speed: where they end, how they bend, where the motion changes its kind."""

from __future__ import annotations
