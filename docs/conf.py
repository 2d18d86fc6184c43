"""How Sphinx builds the documentation: `make docs`."""

from __future__ import annotations

import re
from typing import Any

from voronoi_tiles import __version__

project = "voronoi_tiles"
author = "voronoi_tiles contributors"
project_copyright = author
release = __version__

extensions = ["myst_parser", "sphinx.ext.autodoc"]
exclude_patterns = ["_build", "generate", "**/README.md"]
myst_heading_anchors = 3
myst_enable_extensions = ["deflist", "attrs_inline"]

# Docstrings are plain text with `names` in single backticks.
default_role = "code"
autodoc_member_order = "bysource"
autodoc_typehints_format = "short"
autodoc_preserve_defaults = True
add_module_names = False
python_display_short_literal_types = True

html_theme = "furo"
html_title = f"voronoi_tiles {__version__}"
html_static_path: list[str] = []
html_copy_source = False
html_show_sourcelink = False
html_theme_options: dict[str, Any] = {"navigation_with_keys": True}
smartquotes = False

_MARKUP = re.compile(r"(`[^`]*`)|([\\*|]|\b_(?=\W))")


def _plain_text(*arguments: Any) -> None:
    """Escape what reStructuredText would take for markup in a docstring: stars, bars, underscores at the end."""
    lines: list[str] = arguments[5]
    lines[:] = [_MARKUP.sub(lambda found: found[1] or "\\" + found[2], line) for line in lines]


def setup(app: Any) -> None:
    """Have docstrings escaped before any other extension reads them."""
    app.connect("autodoc-process-docstring", _plain_text, priority=100)
