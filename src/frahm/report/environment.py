"""Templates of the reports, and the filters that they all know."""

from __future__ import annotations

import re

import jinja2
from markupsafe import Markup

from frahm import readable
from frahm.report.numbers import number
from frahm.report.tables import with_indices

_SIGNS = re.compile(r" (\u2026|\.\.\.|(?<=\u03c3 )=) ")
_UNITS = re.compile(r"(?<=\d) (?=(?:m/s|mm|m|MPa|Hz|rad/s|h|years|%|times)(?![A-Za-z0-9]))")


def template(name: str) -> jinja2.Template:
    """A template of this room by its name."""
    environment = jinja2.Environment(
        loader=jinja2.PackageLoader("frahm.report", "."), autoescape=True, trim_blocks=True, lstrip_blocks=True,
        keep_trailing_newline=True, undefined=jinja2.StrictUndefined,
    )  # fmt: skip
    environment.filters["number"] = number
    environment.filters["length_text"] = readable.length
    environment.filters["with_indices"] = with_indices
    environment.filters["kept_together"] = kept_together
    return environment.get_template(name)


def kept_together(text: str) -> str:
    """The text with spaces that do not break inside ranges, and between a number and its unit."""
    kept = _UNITS.sub("\u00a0", _SIGNS.sub("\u00a0\\1\u00a0", str(text)))
    return Markup(kept) if isinstance(text, Markup) else kept
