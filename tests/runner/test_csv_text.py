"""Tables as text are those that pandas writes, but for the shortest form of some numbers."""

from __future__ import annotations

import io

import numpy as np
import pandas as pd
from hypothesis import given
from hypothesis import strategies as st
from pandas.testing import assert_frame_equal

from frictionlab.runner.csv_text import as_csv

NUMBERS = st.floats() | st.integers(-(10**17), 10**17).map(float)
WORDS = st.none() | st.text(st.sampled_from('ab ,"\né'), min_size=1, max_size=4)


@given(st.lists(st.tuples(NUMBERS, WORDS, st.integers(-9, 9)), max_size=5))
def test_a_table_reads_back_to_the_same_numbers_and_words(rows: list[tuple[float, str | None, int]]) -> None:
    table = pd.DataFrame(rows, columns=["number", "word, with a comma", "count"])
    ours, theirs = as_csv(table), table.to_csv(None, index=False, lineterminator="\n").encode()
    assert_frame_equal(*(pd.read_csv(io.BytesIO(text)) for text in (ours, theirs)), check_exact=True)
    assert as_csv(table, header=False) == ours.partition(b"\n")[2]


def test_whole_numbers_stay_numbers_with_a_point() -> None:
    table = pd.DataFrame({"x": [10.0, np.nan, 0.1 + 0.2, 1e-8], "y": [None, "ok", "a,b", 'say "no"']})
    assert as_csv(table) == b'x,y\n10.0,\n,ok\n0.30000000000000004,"a,b"\n1e-8,"say ""no"""\n'
