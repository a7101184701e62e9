"""Cells of a table as they stand in a file, text beside numbers, such as a list of members has them."""

from __future__ import annotations

import os
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path

from frahm.errors import ParameterError
from frahm.files import existing_file

Cell = str | float
LARGEST_CELLS = 20_000_000  # bytes
_TEXT = (".csv", ".txt", ".tsv", ".tab", ".dat", ".asc")


@dataclass(frozen=True)
class Cells:
    """Rows of cells.

    Attributes
    ----------
    source : str
        Name of the file in messages.
    lines : tuple of int
        Line of each row in the file, or its row in the sheet, from 1.
    rows : tuple of tuple
        Text, or numbers where the file knows them as such; empty text for nothing. Rows may differ in length.
    comma_is_decimal : bool
        Whether a comma in a cell can only be a decimal sign.
    sheet : str
        Sheet of a workbook that was read; empty for a text file.
    """

    source: str
    lines: tuple[int, ...]
    rows: tuple[tuple[Cell, ...], ...]
    comma_is_decimal: bool
    sheet: str = ""

    def place(self, row: int) -> str:
        """File and line of a row."""
        return f"{self.source}:{self.lines[row]}"


def read_cells(
    path: str | os.PathLike[str], *, label: str | None = None, allowed: str = "a file that exists",
    largest: int = LARGEST_CELLS,
) -> Cells:  # fmt: skip
    """Cells of a text file or of the first sheet of an XLSX workbook that holds any.

    Parameters
    ----------
    path : str or Path
        Text (.csv, .txt, .tsv, .tab, .dat, .asc) or a workbook (.xlsx, .xlsm), whose formulas count as what they came
        to when it was last saved.
    label : str, optional
        Name of the file in messages; by default its path.
    allowed : str
        What may be given, as the end of the sentence "allowed: ...".
    largest : int
        Size of the file, and of a workbook once unpacked [bytes].

    Raises
    ------
    ParameterError
        If there is no such file, or it is damaged, too large or no table.
    """
    from frahm.tables.text import text_cells
    from frahm.tables.xlsx import xlsx_cells

    readers: dict[str, Callable[[Path, str, int], Cells]] = {
        **dict.fromkeys(_TEXT, text_cells), **dict.fromkeys((".xlsx", ".xlsm"), xlsx_cells),
    }  # fmt: skip
    label, ending = label or str(path), Path(path).suffix.lower()
    found = existing_file(path, allowed, largest=largest)
    if ending not in readers:
        hint = "Save it as .xlsx." if ending in (".xls", ".xlsb", ".ods") else None
        raise ParameterError("file", label, "a name that ends in " + ", ".join(readers), hint=hint)
    return readers[ending](found, label, largest)
