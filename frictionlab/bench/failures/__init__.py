"""Failure maps: what a method says, and how far that is from the truth, over belt speed and one other quantity."""
