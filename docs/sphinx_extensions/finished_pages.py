"""What the theme leaves to do on a page: code that scrolls is reached by keyboard, pictures load when seen."""

from __future__ import annotations

from typing import Any

from sphinx.application import Sphinx

CHANGED = {"<pre>": '<pre tabindex="0">', "<img ": '<img loading="lazy" '}


def _finish(app: Sphinx, page: str, template: str, context: dict[str, Any], doctree: Any) -> None:
    for written, wanted in CHANGED.items():
        context["body"] = context.get("body", "").replace(written, wanted)


def setup(app: Sphinx) -> dict[str, Any]:
    """Change pages before they are written."""
    app.connect("html-page-context", _finish)
    return {"parallel_read_safe": True, "parallel_write_safe": True}
