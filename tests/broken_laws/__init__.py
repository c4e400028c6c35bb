"""Seeded bugs: laws with one mistake each, and the check of the conformance battery that is meant to catch it."""

from broken_laws import claims, compiled, memories, paths, records, symmetries

QUICK = (*records.CASES, *symmetries.CASES, *claims.CASES, *paths.CASES, *memories.CASES)
"""Caught without compiling anything."""
COMPILED = compiled.CASES
