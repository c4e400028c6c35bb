"""The site is built without the network, without warnings, and needs no network where it is read."""

from __future__ import annotations

import importlib.util
import re
import subprocess
import sys
from pathlib import Path

import pytest

PROJECT = Path(__file__).parent.parent
MISSING = [name for name in ("sphinx", "furo", "myst_parser") if importlib.util.find_spec(name) is None]
FETCHED = re.compile(r"<(?:script|link|img|iframe|object)\b[^>]*?\b(?:src|href|data)=\"https?://[^\"]*\"")
pytestmark = pytest.mark.skipif(bool(MISSING), reason="the site needs: pip install '.[docs]'")


@pytest.fixture(scope="module")
def pages(tmp_path_factory: pytest.TempPathFactory) -> dict[str, str]:
    """The text of every page by its name.

    Sphinx warns of pages without a place, links to nowhere, formulas it cannot read; a warning is an error.
    """
    site = tmp_path_factory.mktemp("site")
    options = ["-W", "--keep-going", "--quiet", "--doctree-dir", str(site / "doctrees")]
    command = [sys.executable, "-m", "sphinx", *options, str(PROJECT / "docs"), str(site / "pages")]
    done = subprocess.run(command, capture_output=True, text=True)
    assert (done.returncode, done.stderr) == (0, "")
    found = sorted((site / "pages").rglob("*.html"))
    return {page.relative_to(site / "pages").with_suffix("").as_posix(): page.read_text() for page in found}


def test_every_document_is_a_page_and_no_page_needs_the_network(pages: dict[str, str]) -> None:
    files = (PROJECT / "docs").rglob("*.md")
    written = {path.relative_to(PROJECT / "docs").with_suffix("").as_posix() for path in files}
    assert written - set(pages) == {"architecture", "tests"}  # no pages
    assert {name: FETCHED.findall(text) for name, text in pages.items()} == {name: [] for name in pages}


def test_there_are_twenty_pages_at_most_besides_the_gallery(pages: dict[str, str]) -> None:
    gallery = (PROJECT / "docs" / "gallery" / "index.md").read_text()
    found = set(re.findall(r"\]\(\.\./(\w+)\.md\)", gallery))  # by many studies together
    listed = {page for page in pages if not page.startswith("gallery/")} - {"index", "search"} - found

    assert len(listed | {"gallery/index"}) <= 20, "say it on a page that there is"


def test_what_scrolls_is_reached_by_keyboard(pages: dict[str, str]) -> None:
    for text in pages.values():
        scrolling = re.findall(r'<(?:pre|div [^>]*class="(?:table-wrapper|math )[^>]*)[^>]*>', text)
        assert [each for each in scrolling if 'tabindex="0"' not in each] == []
