"""``HYPOTHESIS_PROFILE=deep`` also runs the tests that take minutes, most of them for compiling."""

from __future__ import annotations

import os

import pytest

DEEP = os.environ.get("HYPOTHESIS_PROFILE") == "deep"


def deep(why: str) -> pytest.MarkDecorator:
    """The mark of a test, or of a case of one, that only the deep profile runs."""
    return pytest.mark.skipif(not DEEP, reason=f"{why}: in the deep profile")
