"""What the theme leaves to do on written pages, for those who use a keyboard or a screen reader."""

from __future__ import annotations

from pathlib import Path
from typing import Any

from sphinx.application import Sphinx

CHANGED = {
    "<pre>": '<pre tabindex="0">',  # what scrolls is reached by keyboard
    '<div class="table-wrapper': '<div tabindex="0" class="table-wrapper',
    '<div class="math ': '<div tabindex="0" class="math ',
    '<p class="caption" role="heading">': '<p class="caption">',
    '<aside class="sidebar-drawer">': '<aside class="sidebar-drawer" aria-label="Pages">',
    '<aside class="toc-drawer': '<aside aria-label="Parts of this page" class="toc-drawer',
    '<div id="search-results">': '<h1>Search</h1>\n<div id="search-results">',
}


def _finish(app: Sphinx, problem: Exception | None) -> None:
    for page in Path(app.outdir).rglob("*.html"):
        text = changed = page.read_text(encoding="utf-8")
        for written, wanted in CHANGED.items():
            if wanted not in changed:
                changed = changed.replace(written, wanted)
        if changed != text:
            page.write_text(changed, encoding="utf-8")


def setup(app: Sphinx) -> dict[str, Any]:
    """Change pages once all are written."""
    app.connect("build-finished", _finish)
    return {"parallel_read_safe": True, "parallel_write_safe": True}
