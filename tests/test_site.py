"""The site is built without the network, without warnings, and needs no network where it is read."""

from __future__ import annotations

import builtins
import importlib.util
import inspect
import re
import subprocess
import sys
from pathlib import Path

import pytest

import frictionlab as fl

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
    assert written - set(pages) == {"architecture", "tests", "equivalence"}  # no pages
    assert {name: FETCHED.findall(text) for name, text in pages.items()} == {name: [] for name in pages}


def test_there_are_twenty_pages_at_most_besides_the_gallery(pages: dict[str, str]) -> None:
    gallery = (PROJECT / "docs" / "gallery" / "index.md").read_text()
    found = set(re.findall(r"^\.\./(\w+)$", gallery, re.MULTILINE))  # by many studies together
    listed = {page for page in pages if not page.startswith("gallery/")} - {"index", "search"} - found

    assert len(listed | {"gallery/index"}) <= 20, "say it on a page that there is"


def test_what_scrolls_is_reached_by_keyboard(pages: dict[str, str]) -> None:
    for text in pages.values():
        scrolling = re.findall(r'<(?:pre|div [^>]*class="(?:table-wrapper|math )[^>]*)[^>]*>', text)
        assert [each for each in scrolling if 'tabindex="0"' not in each] == []


def test_python_s_pages_tell_the_type_of_every_parameter(pages: dict[str, str]) -> None:
    text = pages["api"] + pages["api_scenes"] + pages["write_a_law"]
    entries = dict(re.findall(r'id="frictionlab\.(\w+)">(.*?)(?=<dt class="sig|</section>)', text, re.DOTALL))
    functions = {name for name in fl.__all__ if inspect.isfunction(getattr(fl, name))}

    assert set(entries) >= functions | {"Scene", "Study", "SteadyState", "LuGre", "March"}
    for name, entry in entries.items():
        told = {each for each, text in _entries(entry) if re.match(r"\(.+?\) \N{EN DASH} \S", text)}
        taken = set(inspect.signature(getattr(fl, name)).parameters) - {"label"}
        assert sorted(taken - told) == [], name


def _entries(field: str) -> list[tuple[str, str]]:
    """Names that a list of parameters or errors tells of, each with the text behind it."""
    found = re.findall(r"<p><strong>\**(\w+)</strong>(.*?)</p>", field, re.DOTALL)
    return [(name, re.sub(r"<[^>]+>", "", text).strip()) for name, text in found]


def test_what_is_raised_has_a_reason_and_a_row_in_the_table(pages: dict[str, str]) -> None:
    listed = set(
        re.findall(r"<code[^>]*><span[^>]*>(\w+)<", pages["api"].partition('id="what-is-raised"')[2])
    )
    for name in ("api", "api_scenes"):
        fields = re.findall(r">Raises<.*?</dd>", pages[name], re.DOTALL)
        found = [_entries(each) for each in fields]
        assert found
        assert all(found)
        assert [error for each in found for error, reason in each if not re.search(r"\w", reason)] == []
        assert {error for each in found for error, _ in each} - listed - set(vars(builtins)) == set()
