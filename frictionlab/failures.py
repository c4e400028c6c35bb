"""What can go wrong with the folder of a run."""

from __future__ import annotations


class FolderError(Exception):
    """The folder cannot take this run; the message says why and what to do. Nothing was written."""


class SaveError(Exception):
    """The results could not be written, for want of room or of a working disk."""
