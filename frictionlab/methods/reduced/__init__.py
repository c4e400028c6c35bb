"""Reduced models: direct separation of motion and one-harmonic balance, with bounds on their error."""
