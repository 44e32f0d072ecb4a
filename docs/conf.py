"""Sphinx: the documentation as a static site (./run site)."""

import logging
import os
import pathlib
import re

project = "beltrami"
author = "the beltrami authors"
copyright = f"2026 {author}"
release = re.search(r"project\(beltrami VERSION ([0-9.]+)", pathlib.Path(os.environ["BELTRAMI_VERSION_FILE"]).read_text())[1]
extensions = ["myst_parser", "breathe", "sphinx.ext.autodoc", "sphinx.ext.napoleon"]
root_doc = "index"
source_suffix = {".md": "markdown", ".rst": "restructuredtext"}
exclude_patterns = ["conf.py"]
html_theme = "furo"
html_title = f"beltrami {release}"
html_theme_options = {"top_of_page_button": None}
html_copy_source = False
html_show_sphinx = False
myst_heading_anchors = 4
breathe_projects = {"beltrami": os.environ.get("BELTRAMI_DOXYGEN", "")}
breathe_default_project = "beltrami"
# Anchors are GitHub's, which tests/cli/test_docs.py checks; files beside the pages are no documents.
suppress_warnings = ["myst.xref_missing", "myst.header", "misc.highlighting_failure"]
pygments_style = "friendly"
pygments_dark_style = "monokai"


def plain(app, what, name, obj, options, lines):
    """Docstrings are plain text: their |μ| and a*b are no markup."""
    lines[:] = [re.sub(r"([|*])", r"\\\1", line) for line in lines]


def setup(app):
    """The library's one namespace is declared on the page of every room: no duplicate."""
    logging.getLogger("sphinx.sphinx.domains.cpp").addFilter(lambda record: "Duplicate" not in str(record.msg))
    app.connect("autodoc-process-docstring", plain)
