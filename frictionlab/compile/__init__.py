"""Everything that knows numba: decorators, dispatch by law and dimension, and the cache of compiled entries."""
