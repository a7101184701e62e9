"""Time histories as tab-delimited text, as most programs for structures and signals read it."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from frahm.files import write_text

if TYPE_CHECKING:
    from frahm.time_integration import TimeHistory


def time_history_text(history: TimeHistory) -> str:
    """Tab-delimited text: one line with the names and units of the columns, then a line for every sample.

    Of a run that failed, a line before these says how, after a #.

    The columns are the time, the displacement of the pipe, that of the first absorber relative to it with its
    velocity, and displacement and velocity of every coordinate.
    """
    columns = {"time [s]": history.time, "pipe [m]": history.pipe}
    if history.system.elements:
        columns |= {"z [m]": history.z, "z velocity [m/s]": history.w}
    for i in range(history.system.size):
        columns |= {f"x{i + 1} [m]": history.x[:, i], f"x{i + 1} velocity [m/s]": history.v[:, i]}
    rows = np.column_stack(list(columns.values())).tolist()
    lines = ["\t".join(columns), *("\t".join(map(repr, row)) for row in rows)]
    failed = [] if history.outcome.ok else [f"# {history.outcome.name}: {history.outcome.value}"]
    return "\n".join([*failed, *lines]) + "\n"


def write_time_history(history: TimeHistory, path: str | Path) -> None:
    """Write a time history as tab-delimited text for other programs; the file appears complete or not at all.

    One line with names and units, then a line for every sample: time [s], displacement of the pipe and of the first
    absorber relative to it [m] with its velocity [m/s], then displacement and velocity of every coordinate. A line
    before these, after a #, says how a run failed.

    Parameters
    ----------
    history : TimeHistory
        The motion.
    path : str or Path
        File to write.

    Returns
    -------
    None

    Raises
    ------
    ParameterError
        If the file cannot be written.
    """
    write_text(path, time_history_text(history))
