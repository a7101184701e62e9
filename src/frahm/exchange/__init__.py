"""Room `exchange`: datasets to netCDF, CSV, MAT and JSON and back, time histories and tables of other programs."""

from frahm.exchange.files import read_data, write_data
from frahm.exchange.foreign import read_table, read_time_series
from frahm.exchange.histories import time_history_text, write_time_history
from frahm.exchange.tables import csv_text

__all__ = [
    "csv_text",
    "read_data",
    "read_table",
    "read_time_series",
    "time_history_text",
    "write_data",
    "write_time_history",
]
