"""Checks every law must pass, by subject."""
