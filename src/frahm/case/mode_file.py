"""A table of modes from a CSV file, as a spreadsheet writes it."""

from __future__ import annotations

import re
from typing import Any

from frahm.case.quantities import refusal
from frahm.case.table_files import Column, table_names, table_rows

_PLAIN = (Column("mass", "kg"), Column("frequency", "rad/s", say_unit=True), Column("damping_ratio", ""),
          Column("lift_length", "m"))  # fmt: skip
_AT = re.compile(r"(displacement|stress) at ([0-9.eE+-]+)(?: ?m)?")


def read_modes(name: str) -> dict[str, Any]:
    """Fields `sections` and `modes` of a CSV file with a line for each mode.

    Its first line names the columns: mass, frequency [Hz] or [rad/s], damping_ratio, lift_length, "displacement at
    31.2" for every section [m] and, if stresses are known, "stress at 31.2"; units may follow in brackets.
    """
    at = {
        title: (found[1], _position(title, found[2])) for title in table_names(name) if (found := _AT.fullmatch(title))
    }
    sections = [where for what, where in at.values() if what == "displacement"]
    stresses = {where: title for title, (what, where) in at.items() if what == "stress"}
    if not sections or (stresses and set(stresses) != set(sections)):
        allowed = "columns 'displacement at ...' for every section, and 'stress at ...' for the same ones or none"
        raise refusal(allowed, path="pipe.modes", value=name)
    shapes = {where: title for title, (what, where) in at.items() if what == "displacement"}
    columns = [Column(title, "Pa/m" if title in stresses.values() else "") for title in at]
    modes = []
    for row in table_rows(name, [*_PLAIN, *columns]):
        mode: dict[str, Any] = {column.name: row[column.name] for column in _PLAIN}
        mode["displacements"] = [row[shapes[where]] for where in sections]
        modes.append(mode | ({"stresses": [row[stresses[where]] for where in sections]} if stresses else {}))
    return {"sections": sections, "modes": modes}


def _position(title: str, text: str) -> float:
    try:
        return float(text)
    except ValueError:
        raise refusal("a position in metres behind 'at'", path="pipe.modes", value=title) from None
