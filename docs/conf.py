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
    "sphinx.ext.autodoc",
    "sphinx.ext.napoleon",
    "sphinx.ext.mathjax",
    "finished_pages",
]
# the first two are for developers, read in the repository, the last is a part of a page
exclude_patterns = ["architecture.md", "tests.md", "equivalence.md"]

myst_enable_extensions = ["dollarmath", "deflist", "attrs_block"]
myst_heading_anchors = 4
smartquotes_action = "De"  # no quotes: strings of Python are to be copied

autodoc_typehints = "none"  # docstrings have them
autodoc_member_order = "bysource"
add_module_names = False
napoleon_google_docstring = False
napoleon_custom_sections = [("Attributes", "params_style")]
napoleon_preprocess_types = True  # classes of frictionlab lead to their entry
napoleon_type_aliases = {
    name: f":class:`~frictionlab.{module}.{name}`"
    for name, module in {
        "DriftSpeed": "runner.steady_state",
        "Equivalent": "analysis.fit.equivalent",
        "FittedLaws": "analysis.fit.result",
        "Needs": "analysis.needs.needs",
        "Run": "report.run",
    }.items()
}

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


def _show_absolute_values(app: Any, what: str, name: str, obj: Any, options: Any, lines: list[str]) -> None:
    """Escape the bars of ``|v|`` in a docstring, which would be a substitution."""
    lines[:] = [re.sub(r"\|(\w+)\|", r"\|\1\|", line) for line in lines]


def setup(app: Any) -> None:
    """Change docstrings before they are read."""
    app.connect("autodoc-process-docstring", _show_absolute_values)
