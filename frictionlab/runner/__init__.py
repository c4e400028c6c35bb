"""Runs a study: chunks of scenes, workers, progress, and the folder of results."""
