"""Cells of a workbook."""

from __future__ import annotations

from pathlib import Path

from frahm.tables.cells import Cells
from frahm.untrusted import binary_content


def xlsx_cells(path: Path, label: str, largest: int) -> Cells:
    """Rows of the first visible sheet of a workbook that holds any, empty ones and remarks (``# ...``) left out."""
    content = binary_content("xlsx", path, most_bytes=largest)
    lines, rows = [], []
    for line, row in zip(content["lines"], content["rows"], strict=True):
        if not (isinstance(row[0], str) and (row[0] == "#" or row[0].startswith("# "))):
            lines.append(int(line))
            rows.append(tuple(row))
    return Cells(label, tuple(lines), tuple(rows), comma_is_decimal=True, sheet=content["sheet"])
