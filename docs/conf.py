"""Configuration of Sphinx for the site: `python3 run.py docs`."""

from __future__ import annotations

import logging
import re
import sys
from importlib.metadata import version as installed
from importlib.util import find_spec
from pathlib import Path

from pygments.lexers.special import TextLexer
from sphinx.application import Sphinx

HERE = Path(__file__).parent
sys.path.insert(0, str(HERE / "_ext"))

project = "pindrive"
author = copyright = "the pindrive founders"
release = installed("pindrive")
extensions = [
    "mathml",
    "myst_nb",
    "offline",
    "sphinx.ext.autodoc",
    "sphinx.ext.napoleon",
]
myst_enable_extensions = ["dollarmath"]
myst_heading_anchors = 4
exclude_patterns = ["_build"]
logging.getLogger("traitlets").setLevel(logging.WARNING)  # a line for each notebook
nb_execution_mode = "force"
nb_execution_in_temp = True
nb_execution_raise_on_error = True
nb_execution_timeout = 120
nitpicky = False  # Python's own documentation is not asked over the network
html_theme = "furo"
html_math_renderer = "mathml"
html_title = f"pindrive {release}"
html_copy_source = False
# The studio, where it has been built: `_static/studio.html`, which docs/studio.md then links to.
STUDIO = Path(str(find_spec("pindrive").origin)).with_name("studio.html")
SHOWN = {
    "studio": '<p><a href="_static/studio.html">Open the studio</a></p>',
    "index": '<iframe class="studio" src="_static/studio.html#read" loading="lazy" '
    'title="The studio: read a page with your own hand"></iframe>',
}
"""The studio on a page: a link to it, or itself."""
html_static_path = ["_static", *([str(STUDIO)] if STUDIO.exists() else [])]
html_css_files = ["site.css"]
autodoc_typehints = "description"
autodoc_member_order = "bysource"
autodoc_preserve_defaults = True

default_role = "code"  # docstrings set code between single backticks


def read(app: Sphinx, docname: str, source: list[str]) -> None:
    """Replace links to CONTRIBUTING.md by links to its page, and links to folders by their text.

    The guides of the first page have, after those that it names, all other pages of this folder;
    that of the studio has a link to it, and the first page the studio itself.
    """
    text = source[0].replace("](../CONTRIBUTING.md", "](contributing.md")
    text = re.sub(r"\[([^]]+)\]\(\.\./[\w/]+\)", r"\1", text)
    if docname == "index":
        listed = text.splitlines()
        pages = sorted(path.stem for path in HERE.glob("*.md") if path.stem != "index")
        text = text.replace("% other pages", "\n".join(p for p in pages if p not in listed))
    if docname in SHOWN and STUDIO.exists():
        text = text.replace("% the page", SHOWN[docname])
    source[0] = text


def escape(
    app: Sphinx, kind: str, name: str, obj: object, options: object, lines: list[str]
) -> None:
    """Keep the bars of absolute values in docstrings from being substitutions."""
    lines[:] = [line.replace("|", "\\|") for line in lines]


def setup(app: Sphinx) -> None:
    """Called by Sphinx."""
    app.add_lexer("csv", TextLexer)
    app.connect("source-read", read)
    app.connect("autodoc-process-docstring", escape)
