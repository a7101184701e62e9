"""Figures of several panels named (a), (b), ... as journals do."""

from __future__ import annotations

from typing import Any

import numpy as np
from matplotlib.figure import Figure

from frahm.plotting.style import new_figure


def panels(rows: int, columns: int, width: float, height: float, **shared: Any) -> tuple[Figure, np.ndarray]:
    """Figure of `width` x `height` [mm] and its axes, shape (rows, columns)."""
    figure = new_figure(width, height)
    return figure, figure.subplots(rows, columns, squeeze=False, **shared)


def name_panels(axes: np.ndarray, titles: tuple[str, ...]) -> None:
    """Title the panels (a), (b), ... in reading order."""
    for letter, panel, title in zip("abcdefgh", axes.flat, titles, strict=False):
        panel.set_title(f"({letter})  {title}")
