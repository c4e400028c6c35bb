"""Figures drawn from the result table."""
