"""Runs of a study: its pieces, their store, workers, progress, tables and the folder of results."""
