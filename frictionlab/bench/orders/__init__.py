"""Observed orders: how errors fall as a setting is refined, on every kind of motion, beside what theory says."""

from __future__ import annotations

from frictionlab.bench.orders.reader import read_orders

__all__ = ["read_orders"]
