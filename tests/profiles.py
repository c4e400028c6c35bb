"""Two profiles of the tests: the default run, and ``HYPOTHESIS_PROFILE=deep``, which runs all of them.

The default run has what a stranger must see: each law, method, command, figure and claim, one example at least of
every kind of scene. Tests marked ``deep``, and most cases of tests marked ``some``, are left to the other.
"""

from __future__ import annotations

import os
from collections import defaultdict
from collections.abc import Sequence

import pytest

DEEP = os.environ.get("HYPOTHESIS_PROFILE") == "deep"


def deep(why: str) -> pytest.MarkDecorator:
    """Return the mark of a test, or of a case of one, that only the deep profile runs."""
    return pytest.mark.deep(why)


def some(count: int, why: str) -> pytest.MarkDecorator:
    """Return the mark of a test of whose cases the default run has only so many, spread over their order."""
    return pytest.mark.some(count, why)


def by_default(items: Sequence[pytest.Item]) -> list[pytest.Item]:
    """Return the tests that the default run has, in their order."""
    cases: dict[str, list[pytest.Item]] = defaultdict(list)
    for item in items:
        if item.get_closest_marker("deep") is None:
            cases[item.nodeid.partition("[")[0]].append(item)
    kept = {item for alike in cases.values() for item in _spread(alike)}
    return [item for item in items if item in kept]


def _spread(cases: list[pytest.Item]) -> list[pytest.Item]:
    mark = cases[0].get_closest_marker("some")
    count = len(cases) if mark is None else min(mark.args[0], len(cases))
    return [cases[(2 * k + 1) * len(cases) // (2 * count)] for k in range(count)]
