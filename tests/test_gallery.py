"""Pictures of the gallery say what the program draws today."""

from __future__ import annotations

import re
from html import unescape

import pytest
from gallery.make import GALLERY, Exhibit, drawn, exhibits
from profiles import deep

TEXT, TAG = re.compile(r"<text\b.*?</text>", re.DOTALL), re.compile(r"<[^>]*>|\s")


def words(svg: str) -> set[str]:
    """Return the texts of a figure that have two letters side by side; numbers along its axes have none."""
    texts = {unescape(TAG.sub("", text)) for text in TEXT.findall(svg)}
    return {text for text in texts if re.search(r"[^\W\d_]{2}", text)}


@deep("minutes, of all studies together")
@pytest.mark.parametrize("exhibit", exhibits(), ids=lambda exhibit: exhibit.name)
def test_a_kept_picture_has_the_words_of_a_fresh_one(exhibit: Exhibit) -> None:
    kept = (GALLERY / "figures" / f"{exhibit.name}.svg").read_text("utf-8")

    assert words(kept)
    assert words(drawn(exhibit)) == words(kept)
