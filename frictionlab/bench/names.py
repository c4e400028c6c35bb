"""Names of files: those of curves and sections without spaces."""

from __future__ import annotations

import re


def file_stem(name: str) -> str:
    """A name as a file may have it: runs of all but letters, digits, points, - and _ become one _.

    >>> file_stem("W4 soft lugre")
    'W4_soft_lugre'
    """
    return re.sub(r"[^\w.-]+", "_", name)
