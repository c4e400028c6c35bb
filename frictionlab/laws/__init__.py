"""Laws of friction, one per file."""
