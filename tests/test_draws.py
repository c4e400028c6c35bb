"""The default profile draws the same examples whatever else is loaded."""

from __future__ import annotations

import importlib
from typing import Any

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from profiles import deep

DEFAULT = settings.get_profile("default")


def drawn() -> list[Any]:
    examples: list[Any] = []

    @settings(DEFAULT, max_examples=300)
    @given(st.tuples(st.floats(), st.integers(), st.text()))
    def keep(example: Any) -> None:
        examples.append(repr(example))

    keep()
    return examples


@deep("hundreds of draws")
def test_a_module_loaded_in_between_changes_no_draw(tmp_path, monkeypatch: pytest.MonkeyPatch):
    assert DEFAULT.derandomize
    before = drawn()
    (tmp_path / "odd_numbers.py").write_text("SPEED = 1234.56789\nCOUNT = 987654\nNAME = 'unheard of'\n")
    monkeypatch.syspath_prepend(tmp_path)
    importlib.import_module("odd_numbers")

    assert drawn() == before
