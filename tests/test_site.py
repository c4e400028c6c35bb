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


@pytest.mark.skipif(bool(MISSING), reason="the site needs: pip install '.[docs]'")
def test_the_site_is_built_and_every_link_in_it_leads_somewhere(tmp_path: Path) -> None:
    """Sphinx warns of pages without a place, links to nowhere, formulas it cannot read; a warning is an error."""
    options = ["-W", "--keep-going", "--quiet", "--doctree-dir", str(tmp_path / "doctrees")]
    command = [sys.executable, "-m", "sphinx", *options, str(PROJECT / "docs"), str(tmp_path / "site")]
    done = subprocess.run(command, capture_output=True, text=True)
    assert (done.returncode, done.stderr) == (0, "")

    pages = sorted((tmp_path / "site").rglob("*.html"))
    shown = {page.relative_to(tmp_path / "site").with_suffix("").as_posix() for page in pages} - {"search"}
    files = (PROJECT / "docs").rglob("*.md")
    written = {path.relative_to(PROJECT / "docs").with_suffix("").as_posix() for path in files}
    assert written - shown == {"architecture", "tests"}  # for developers, read in the repository
    listed = {page for page in shown - {"index"} if not page.startswith("gallery/")} | {"gallery/index"}
    assert len(listed) <= 20, "say it on a page that there is"
    assert {page.name: FETCHED.findall(page.read_text()) for page in pages} == {
        page.name: [] for page in pages
    }
