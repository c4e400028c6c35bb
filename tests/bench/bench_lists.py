"""Lists of a bench: their text measured, or refused."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import pandas as pd
import pytest

from frictionlab import bench
from frictionlab.bench.result import SectionResult
from frictionlab.values.notes import Mistake, StudyError


def loaded(text: str, folder: Path = Path()) -> bench.Bench:
    """A list of this text, read."""
    (folder / "list.yaml").write_text(text)
    return bench.load_bench(folder / "list.yaml")


def measured(text: str, folder: Path = Path(), **asked: Any) -> list[SectionResult]:
    """What the sections of a list of this text come to."""
    return list(bench.measure(loaded(text, folder), lambda line: None, **asked))


def changed(text: str, old: str, new: str) -> str:
    """A list with a part of its text replaced, which it has."""
    assert old in text
    return text.replace(old, new)


def mistake(text: str, folder: Path = Path()) -> Mistake:
    """The one mistake in a list of this text."""
    with pytest.raises(StudyError) as caught:
        loaded(text, folder)
    (found,) = caught.value.mistakes
    return found


def texts(file: Path) -> pd.DataFrame:
    """The table of a file as it is written."""
    return pd.read_csv(file, dtype=str, keep_default_na=False)
