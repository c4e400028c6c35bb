"""What is pinned is compared once, and what moves is told."""

from __future__ import annotations

import importlib
from collections import Counter
from fnmatch import fnmatchcase
from pathlib import Path

from comparison import CHANGES, OLD, different, disagrees, golden_scenes

FILES = sorted(path.stem for path in Path(__file__).parent.glob("test_golden_*.py"))


def test_every_pinned_row_is_compared_once() -> None:
    tests = [importlib.import_module(name).test_every_number_is_what_it_was for name in FILES]
    compared = Counter(param.values[0] for test in tests for param in test.pytestmark[0].args[1])

    assert compared == Counter(group.name for group in golden_scenes.GROUPS)
    for rows in OLD.values():
        pinned = Counter(key.split("/")[0] for key in rows)
        assert sum(pinned[name] * times for name, times in compared.items()) == len(rows) > 0


def test_a_pinned_row_has_its_group_and_a_change_its_row() -> None:
    names = {group.name for group in golden_scenes.GROUPS}
    assert len(names) == len(golden_scenes.GROUPS)
    assert {key.split("/")[0] for key in OLD["results"]} == names
    assert [
        change["key"]
        for change in CHANGES
        if not any(fnmatchcase(key, change["key"]) for key in OLD["results"])
    ] == []
    assert all(change["reason"] for change in CHANGES)


def test_a_number_that_moves_is_told_and_one_that_was_changed_on_purpose_may_move_within_its_error() -> None:
    key, old = next(
        (key, row) for key, row in OLD["results"].items() if row["status"] == "ok" and row["error"] > 1e-11
    )
    near = {**old, "mean_friction": old["mean_friction"] + 1.5 * old["error"], "reason": "told otherwise"}
    far = {**old, "mean_friction": old["mean_friction"] + 2.5 * old["error"]}

    assert different(key, old, {**old, "model": "told otherwise", "a new column": 1.0}) == []
    assert [told.split(": ")[1] for told in different(key, old, near)] == ["mean_friction"]
    assert [told.split(": ")[1] for told in different(key, old, {**old, "status": "failed"})] == ["status"]
    assert disagrees(key, old, near, "") == []
    assert disagrees(key, old, far, "") != []
    assert disagrees(key, old, {**near, "error": 3.0 * old["error"]}, "") != []
    assert disagrees(key, old, {**near, "status": "not_unique"}, "") != []
    assert disagrees(key, old, {**near, "status": "not_unique"}, "not_unique") == []
