"""A figure for the browser as the plain tree that plotly.js reads.

The objects of plotly's Python library check every value as it is set, which takes longer than to draw the figure; the
tests let them check these trees instead.
"""

from __future__ import annotations

import base64
import json
import math
from typing import Any

import numpy as np

_TYPES = {"float32": "f4", "float64": "f8", "int8": "i1", "int16": "i2", "int32": "i4", "uint8": "u1"}


class PlainFigure:
    """Traces and layout of a figure of one panel, or of several panels one below the other.

    Parameters
    ----------
    shares : tuple of float
        Heights of the panels from the top, relative to each other.
    gap : float
        Between panels, as a share of the height of the plot.
    shared : bool
        Whether the panels have one horizontal axis, whose numbers stand below the last.

    Attributes
    ----------
    data : list of dict
        Traces, as plotly.js calls them.
    layout : dict
        Everything else.
    """

    def __init__(self, shares: tuple[float, ...] = (1.0,), gap: float = 0.0, shared: bool = False) -> None:
        self.data: list[dict[str, Any]] = []
        self.layout: dict[str, Any] = {}
        self._rows = len(shares)
        free, top = 1.0 - gap * (len(shares) - 1), 1.0
        for row, share in enumerate(shares, 1):
            bottom = top - free * share / sum(shares)
            number = _number(row)
            self.layout[f"xaxis{number}"] = {"anchor": f"y{number}"}
            self.layout[f"yaxis{number}"] = {"anchor": f"x{number}", "domain": [max(0.0, bottom), top]}
            if shared and row < len(shares):
                self.layout[f"xaxis{number}"] |= {"matches": f"x{_number(len(shares))}", "showticklabels": False}
            top = bottom - gap

    def add_trace(self, kind: str, row: int = 1, **trace: Any) -> None:
        """Add a trace of a kind that plotly.js knows to the panel `row`, counted from the top."""
        number = _number(row)
        self.data.append({"type": kind, "xaxis": f"x{number}", "yaxis": f"y{number}", **trace})

    def add_scatter(self, row: int = 1, **trace: Any) -> None:
        """Add a line or markers."""
        self.add_trace("scatter", row, **trace)

    def add_annotation(self, **annotation: Any) -> None:
        """Add a text in the figure."""
        self.layout.setdefault("annotations", []).append(annotation)

    def update_layout(self, **changes: Any) -> None:
        """Set parts of the layout; None takes one away."""
        _merge(self.layout, changes)

    def update_axes(self, letter: str, row: int | None = None, **changes: Any) -> None:
        """Set parts of the axis "x" or "y" of one panel, or of all."""
        for one in range(1, self._rows + 1) if row is None else (row,):
            _merge(self.layout[f"{letter}axis{_number(one)}"], changes)

    def to_dict(self) -> dict[str, Any]:
        """The tree of the figure, its arrays as they are."""
        return {"data": self.data, "layout": self.layout}

    def to_json(self) -> str:
        """The figure as plotly.js reads it: arrays in binary, in lists null for what is not a number."""
        return json.dumps(_packed(self.to_dict()), allow_nan=False, separators=(",", ":"))


def _number(row: int) -> str:
    return "" if row == 1 else str(row)


def _merge(tree: dict[str, Any], changes: dict[str, Any]) -> None:
    for name, value in changes.items():
        if value is None:
            tree.pop(name, None)
        elif isinstance(value, dict) and isinstance(tree.get(name), dict):
            tree[name] = dict(tree[name])
            _merge(tree[name], value)
        else:
            tree[name] = value


def _packed(value: Any) -> Any:
    if isinstance(value, dict):
        return {name: _packed(entry) for name, entry in value.items()}
    if isinstance(value, np.ndarray):
        return _packed_array(value)
    if isinstance(value, (list, tuple)):
        return [_packed(entry) for entry in value]
    if isinstance(value, np.generic):
        value = value.item()
    return None if isinstance(value, float) and not math.isfinite(value) else value


def _packed_array(values: np.ndarray) -> Any:
    kind = _TYPES.get(values.dtype.name)
    if kind is None or not values.size:
        return _packed(values.tolist())
    little = np.ascontiguousarray(values, dtype=values.dtype.newbyteorder("<"))
    packed = {"dtype": kind, "bdata": base64.b64encode(little.tobytes()).decode()}
    return packed if values.ndim == 1 else packed | {"shape": ", ".join(map(str, values.shape))}
