"""Reduced models: direct separation of motion and one-harmonic balance, with their distance to the full answer."""
