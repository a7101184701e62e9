"""Configuration of the documentation."""

import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).parent))

project = "frahm"
author = "the frahm authors"
extensions = ["myst_nb", "sphinx.ext.autodoc", "sphinx.ext.napoleon", "mathml"]
html_math_renderer = "mathml"  # no script from elsewhere: formulas show without a network
myst_enable_extensions = ["dollarmath", "amsmath"]
myst_heading_anchors = 3
nb_execution_mode = "auto"  # a notebook without results is run
nb_execution_raise_on_error = True
nb_execution_timeout = 600  # the first run compiles
nb_merge_streams = True
napoleon_google_docstring = False
napoleon_use_ivar = True
napoleon_use_rtype = False
autodoc_typehints = "none"
autodoc_member_order = "bysource"
html_theme = "furo"
html_title = "frahm"
html_show_copyright = False
html_static_path = ["_static"]
html_css_files = ["tables.css"]
exclude_patterns = ["_build", "_generated"]


def _escaped_bars(app, what, name, obj, options, lines):
    """|x| is a modulus, not a substitution."""
    lines[:] = [line if "``" in line or line.lstrip().startswith(">>>") else line.replace("|", "\\|") for line in lines]


def setup(app):
    from generated import write_pages

    app.connect("builder-inited", lambda _: write_pages())
    app.connect("autodoc-process-docstring", _escaped_bars)
