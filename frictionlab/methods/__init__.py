"""Ways to find a steady state, one per file."""
