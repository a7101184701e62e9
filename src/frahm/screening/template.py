"""A table of members to start from, as text or as a workbook."""

from __future__ import annotations

import csv
import io

from frahm.screening.columns import COLUMNS, MemberColumn

_OPTIONAL = (
    "added mass", "contained mass", "highest wind", "weibull scale", "weibull shape", "design life", "s-n curve",
    "stress concentration", "design fatigue factor",
)  # fmt: skip
_ROWS = (
    ("HB-101", 406.4, 12.7, 14.2, "fixed-pinned", 0.15, 6, 0, 25, 7.5, 2, 1, "F1", 1.5, 3),
    ("DB-201", 660, 19.1, 19.5, "fixed", 0.15, 10, 0, 25, 7.5, 2, 1, "F1", 2, 3),
    ("XB-302", 508, 12.7, 15.7, 0.8, 0.15, 8, 0, 25, 7.5, 2, 1, "F1", 2, 3),
)


def template_rows() -> list[tuple[str | float, ...]]:
    """Remarks, the head and three members; a remark is a row of one cell that begins with #."""
    there = [column for column in COLUMNS if column.required or column.name in _OPTIONAL]
    there.sort(key=lambda column: not column.required and _OPTIONAL.index(column.name) + 1)
    others = [column for column in COLUMNS if column not in there]
    remarks = [
        "Members of a platform, one a row; replace the three below. Units stand in the head, columns in any order.",
        "A cell left empty, or a column left out, takes the default. Numbers are an example: take those of your site.",
        *map(_remark, there), "Further columns there may be:", *map(_remark, others),
    ]  # fmt: skip
    return [*((f"# {text}",) for text in remarks), tuple(column.head for column in there), *_ROWS]


def template_csv() -> str:
    """The template as CSV text."""
    stream = io.StringIO()
    rows = template_rows()
    remarks = [str(row[0]) for row in rows if len(row) == 1]
    csv.writer(stream, lineterminator="\n").writerows(row for row in rows if len(row) > 1)
    return "\n".join(remarks) + "\n" + stream.getvalue()


def template_xlsx() -> bytes:
    """The template as a workbook."""
    import openpyxl

    book = openpyxl.Workbook()
    sheet = book.active
    sheet.title = "members"
    for row in template_rows():
        sheet.append(list(row))
    stream = io.BytesIO()
    book.save(stream)
    return stream.getvalue()


def _remark(column: MemberColumn) -> str:
    default = "required" if column.required else f"default {column.default}"
    return f"{column.head}: {column.description.rstrip('.')}; {default}."
