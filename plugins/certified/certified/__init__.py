"""Proof, in interval arithmetic, of the mean friction of an orbit that was found in floating-point numbers."""
