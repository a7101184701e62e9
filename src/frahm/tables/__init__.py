"""The one reader of tables: text of other programs, workbooks, MAT and netCDF files, as columns or as cells."""

from frahm.tables.cells import Cells, read_cells
from frahm.tables.table import LARGEST, Table, read_table_file
from frahm.tables.text import are_units, name_and_unit, number_of

__all__ = ["LARGEST", "Cells", "Table", "are_units", "name_and_unit", "number_of", "read_cells", "read_table_file"]
