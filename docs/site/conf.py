# SPDX-License-Identifier: GPL-3.0-or-later
"""How Sphinx makes the site of the staged documents; `build_tools/site_pages.py` says what is staged."""

import os
import re

project = "Discrete Fairing"
release = version = os.environ["DF_VERSION"]
html_title = f"{project} {release}"
copyright = "the authors of Discrete Fairing"  # noqa: A001

extensions = [
    "myst_parser",
    "sphinx.ext.autodoc",
    "sphinx.ext.napoleon",
]
myst_heading_anchors = 4  # as links between the Markdown files use them
myst_enable_extensions = ["dollarmath"]
source_suffix = {".md": "markdown"}
# Diagrams stay text: what draws them would come over the network, and the site works without one.
suppress_warnings = ["misc.highlighting_failure"]

autodoc_member_order = "alphabetical"
autodoc_typehints = "none"

html_theme = "furo"
html_show_sourcelink = False
html_copy_source = False

ATTRIBUTE = re.compile(r"[a-z_]\w*(?:, [a-z_]\w*)*: ")


def attributes_apart(app, what, name, obj, options, lines):
    """Gives each attribute that a docstring lists one a line a paragraph of its own."""
    apart = []
    for line in lines:
        if ATTRIBUTE.match(line) and apart and apart[-1]:
            apart.append("")
        apart.append(line)
    lines[:] = apart


def setup(app):
    """Sphinx calls this at its start."""
    app.connect("autodoc-process-docstring", attributes_apart)
