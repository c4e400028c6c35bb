"""Derivatives of the mean friction by the numbers of a scene and of a law."""
