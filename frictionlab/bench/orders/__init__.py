"""Observed orders: how errors fall as a setting is refined, on every kind of motion, beside what theory says."""
