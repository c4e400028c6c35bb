"""Stability maps: step or tolerance against local rate, true error, and whether a wrong answer says so."""
