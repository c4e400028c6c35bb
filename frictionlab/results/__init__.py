"""What a run returns: rows, curves, verdicts and their summary."""
