"""Configuration of the documentation."""

project = "frahm"
author = "the frahm authors"
extensions = ["myst_parser"]
myst_enable_extensions = ["dollarmath", "amsmath"]
myst_heading_anchors = 3
html_theme = "furo"
html_title = "frahm"
html_static_path: list[str] = []
exclude_patterns = ["_build"]
