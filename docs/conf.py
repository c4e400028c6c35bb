"""How Sphinx builds the site; CONTRIBUTING.md has the command."""

from __future__ import annotations

import re
import sys
from importlib.metadata import distribution
from importlib.metadata import version as version_of
from pathlib import Path
from typing import Any

sys.path.insert(0, str(Path(__file__).parent / "sphinx_extensions"))

project = "frictionlab"
author = project_copyright = "The frictionlab authors"
version = release = version_of("frictionlab")

extensions = [
    "myst_parser",
    "sphinx.ext.mathjax",
    "finished_pages",
]
exclude_patterns = ["architecture.md", "tests.md"]  # for developers, read in the repository
CONTENTS = {
    "Start": ["start", "which", "ten_jobs", "gallery/index"],
    "Use": ["study", "results", "needs", "fit", "write_a_law", "cost", "when_wrong"],
    "Theory": ["theory/model", "theory/laws", "theory/means", "theory/theorems", "error_bounds", "stability"],
    "Reference": ["nomenclature", "api", "api_scenes"],
}
"""Pages of the navigation; those of the gallery are the links of its first page."""

myst_enable_extensions = ["dollarmath", "deflist", "attrs_block"]
myst_heading_anchors = 4
smartquotes_action = "De"  # no quotes: strings of Python are to be copied

html_theme = "furo"
html_title = f"frictionlab {version}"
# one file that draws formulas as SVG and loads nothing else, copied into the site
MATHJAX = distribution("sphinx-mathjax-offline").locate_file("sphinx-mathjax-offline/static/mathjax")
html_static_path = ["_static", f"{MATHJAX}/tex-svg-full.js"]
mathjax_path = "tex-svg-full.js"
html_favicon = "_static/favicon.svg"
html_css_files = ["site.css"]
html_use_index = False
html_show_sphinx = False
html_copy_source = False
html_theme_options = {"footer_icons": []}


def _add_contents(app: Any, page: str, source: list[str]) -> None:
    """Append the lists that the navigation is made from: a reader of the file has the links."""
    lists = CONTENTS if page == "index" else {}
    if page == "gallery/index":
        lists = {"Gallery": list(dict.fromkeys(re.findall(r"\]\(([\w./]+)\.md\)", source[0])))}
    for caption, names in lists.items():
        pages = "\n".join(names)
        source[0] += f"\n```{{toctree}}\n:caption: {caption}\n:hidden:\n\n{pages}\n```\n"


def setup(app: Any) -> None:
    """Change pages as they are read."""
    app.connect("source-read", _add_contents)
