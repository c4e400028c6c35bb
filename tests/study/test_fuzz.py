"""Studies as nobody would write them are read or refused: no traceback, no endless reading, nothing lost."""

from __future__ import annotations

from pathlib import Path

import pytest
from profiles import DEEP
from study_fuzzer import complaint

PART = 50
STUDIES = 10_000 if DEEP else 50


@pytest.mark.parametrize("first", range(0, STUDIES, PART))
def test_a_study_is_read_and_survives_being_saved_or_is_refused_in_words(first: int, tmp_path: Path) -> None:
    told = {seed: complaint(seed, tmp_path) for seed in range(first, first + PART)}

    assert {seed: wrong for seed, wrong in told.items() if wrong not in ("", "refused")} == {}
