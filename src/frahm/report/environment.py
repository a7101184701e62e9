"""Templates of the reports, and the filters that they all know."""

from __future__ import annotations

import re

import jinja2
from markupsafe import Markup, escape

from frahm import readable
from frahm.report.numbers import number

_SIGNS = re.compile(r" (\u2026|\.\.\.|(?<=\u03c3 )=) ")
_INDEXED, _COMPARED = re.compile(r"\b([A-Za-z])_([A-Za-z]\w*)\b"), re.compile("[<>]=")
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


def with_indices(rows: list[tuple[str, ...]]) -> list[list[Markup]]:
    """Cells in which letters such as K_s and v_crit have their index below, and <= is one sign."""
    return [[_with_indices(cell) for cell in row] for row in rows]


def _with_indices(cell: str) -> Markup:
    signs = {"<=": "\N{LESS-THAN OR EQUAL TO}", ">=": "\N{GREATER-THAN OR EQUAL TO}"}
    compared = _COMPARED.sub(lambda match: signs[match[0]], cell)
    return Markup(_INDEXED.sub(r"\1<sub>\2</sub>", str(escape(compared))))
