"""Numerical methods that know nothing of friction: steppers, roots, small matrices, extrapolation."""
