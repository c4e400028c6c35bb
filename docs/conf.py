"""How Sphinx builds the site; docs/tests.md has the command."""

from __future__ import annotations

import sys
from importlib.metadata import version as version_of
from pathlib import Path

sys.path.insert(0, str(Path(__file__).parent / "sphinx_extensions"))

project = "frictionlab"
author = project_copyright = "The frictionlab authors"
version = release = version_of("frictionlab")

extensions = ["myst_parser", "mathml", "outside_pages"]

myst_enable_extensions = ["dollarmath", "deflist"]
myst_heading_anchors = 4

html_theme = "furo"
html_title = f"frictionlab {version}"
html_static_path = ["_static"]
html_css_files = ["site.css"]
html_math_renderer = "mathml"
html_show_sphinx = False
html_copy_source = False
html_theme_options = {"footer_icons": []}
