"""Pages of the site that are files outside of ``docs``, and links to these files."""

from __future__ import annotations

import os
import re
from pathlib import Path
from typing import Any

from sphinx.application import Sphinx

FILES = {"changelog": "CHANGELOG.md", "contributing": "CONTRIBUTING.md", "plugins": "plugins/README.md"}
"""Where the text of a page is, from the root of the repository."""
LINK = re.compile(r"\]\((?!\w+:|#)([^)#]+)")


def _read(app: Sphinx, page: str, text: list[str]) -> None:
    """The text of the file in place of the page's own, its links as seen from the page."""
    docs = Path(app.srcdir)
    folder = (docs / page).parent
    if page in FILES:
        file = docs.parent / FILES[page]
        app.env.note_dependency(str(file))
        text[0] = LINK.sub(
            lambda link: f"]({os.path.relpath(file.parent / link[1], folder)}", file.read_text()
        )
    for own, other in FILES.items():
        outside, inside = (
            os.path.relpath(path, folder) for path in (docs.parent / other, docs / f"{own}.md")
        )
        text[0] = text[0].replace(f"]({outside}", f"]({inside}")


def setup(app: Sphinx) -> dict[str, Any]:
    """Change the text before a page is read."""
    app.connect("source-read", _read)
    return {"parallel_read_safe": True, "parallel_write_safe": True}
