"""Docstrings as Sphinx reads them: ours are plain text, in which ``|v|`` is a speed and a line begins a parameter."""

from __future__ import annotations

import re
from typing import Any

from sphinx.application import Sphinx

ENTRY = re.compile(
    r"(?:``)?[a-z_]\w*(?:``)?(?:(?:,| or) (?:``)?[a-z_]\w*(?:``)?)*(?: \[[^\]]*\])?[^.:;\"{]{0,80}: "
    r"|Sources?: |Raises "
)
"""How a line of its own begins: names, perhaps with unit and range, and a colon; a source; what is raised."""
CODE = re.compile(r"(``[^`]+``)")
MARKS = re.compile(r"([\\*|_`])")


def _plain(app: Sphinx, what: str, name: str, obj: Any, options: Any, lines: list[str]) -> None:
    """Every entry a paragraph, and nothing in it markup but code; an example, up to the next empty line, as it is."""
    found: list[str] = []
    example = False
    for line in lines:
        example = line.startswith(">>>") or (example and line != "")
        if example:
            found.append(line)
            continue
        if ENTRY.match(line) and found and found[-1]:
            found.append("")
        code_and_text = enumerate(CODE.split(line))
        found.append("".join(part if odd % 2 else MARKS.sub(r"\\\1", part) for odd, part in code_and_text))
    lines[:] = found


def setup(app: Sphinx) -> dict[str, Any]:
    """Change docstrings before they are read."""
    app.connect("autodoc-process-docstring", _plain)
    return {"parallel_read_safe": True, "parallel_write_safe": True}
