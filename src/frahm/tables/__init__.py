"""The one reader of tables: text of other programs, MAT and netCDF files, as columns of numbers with units."""

from frahm.tables.table import LARGEST, Table, read_table_file

__all__ = ["LARGEST", "Table", "read_table_file"]
