"""Period of a steady state: its record, calculus on its panels, the columns read from it."""
