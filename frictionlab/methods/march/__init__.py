"""Time stepping until the motion repeats, with an error estimate."""
