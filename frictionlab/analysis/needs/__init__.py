"""Needs of a scene: its parts taken away one at a time, and the smallest model within a tolerance."""
