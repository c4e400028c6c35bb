"""How Sphinx builds the site; CONTRIBUTING.md has the command."""

from __future__ import annotations

import sys
from importlib.metadata import distribution
from importlib.metadata import version as version_of
from pathlib import Path

sys.path.insert(0, str(Path(__file__).parent / "sphinx_extensions"))

project = "frictionlab"
author = project_copyright = "The frictionlab authors"
version = release = version_of("frictionlab")

extensions = ["myst_parser", "sphinx.ext.autodoc", "sphinx.ext.mathjax", "docstrings", "finished_pages"]
# the first two are for developers, read in the repository, the last is a part of a page
exclude_patterns = ["architecture.md", "tests.md", "equivalence.md"]

myst_enable_extensions = ["dollarmath", "deflist", "attrs_block"]
myst_heading_anchors = 4

autodoc_typehints = "none"
autodoc_member_order = "bysource"
add_module_names = False

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
