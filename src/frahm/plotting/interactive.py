"""Interactive figures for the browser, of the same data as those on paper. Nothing is fetched from anywhere."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from frahm.arrays import Floats
from frahm.plotting.basins import BASIN_AXES, basin_entries, basin_indices
from frahm.plotting.lines import (
    AXIS_LABELS,
    HEADROOM,
    KIND_NAMES,
    MM,
    MODULATED_NAMES,
    MOST_LABELS,
    QUANTITY_LABELS,
    Line,
    axis_of,
    beyond_the_top,
    envelopes,
    interesting_range,
    largest_finite,
    line_colour,
    line_width,
    lines_by_name,
    resonance_of,
    response_lines,
    special_marks,
    thinned,
)
from frahm.plotting.plain import PlainFigure
from frahm.plotting.style import BARE, GREEN, GRID, INK, PIPE, SINK
from frahm.plotting.views import LABELS, SHOWN_HARMONICS, MotionView, manifold_height

if TYPE_CHECKING:
    import xarray as xr

CONFIG = {
    "displaylogo": False,
    "showSendToCloud": False,
    "responsive": True,
    "modeBarButtonsToRemove": ["select2d", "lasso2d", "autoScale2d"],
}
_MOTION_SYMBOLS = {"periodic": "circle-open", "modulated": "diamond", "chaotic": "square", "unsettled": "x"}
_AXIS = {
    "showline": True, "ticks": "outside", "showgrid": False, "zeroline": False, "automargin": True,
    "linecolor": INK, "tickcolor": INK, "gridcolor": GRID, "title": {"standoff": 15},
}  # fmt: skip
# As much of a template as these figures need: plotly's own are long, and are copied into every figure.
_TEMPLATE = {
    "layout": {
        "xaxis": _AXIS, "yaxis": _AXIS, "paper_bgcolor": "white", "plot_bgcolor": "white", "hovermode": "closest",
        "autotypenumbers": "strict", "hoverlabel": {"align": "left"},
    }
}  # fmt: skip
_SYMBOLS = {
    "saddle-node": "triangle-up",
    "hopf": "square",
    "neimark-sacker": "diamond",
    "period-doubling": "triangle-down",
    "branch-point": "cross",
}
HOVER = "%{x:.4f}<br>%{y:.4g} mm"
_COLOURS = {"x1": PIPE, "z": SINK}
_MODULATED_FILL = "rgba(0, 158, 115, 0.18)"
_FILLS = {"x1": "rgba(0, 114, 178, 0.25)", "z": "rgba(213, 94, 0, 0.22)"}


def response_plot(
    curve: xr.Dataset,
    quantity: str,
    motions: list[MotionView],
    bare: xr.Dataset | None = None,
    slow: xr.Dataset | None = None,
    modulated: xr.Dataset | None = None,
) -> PlainFigure:
    """Response over the detuning; see `frahm.plotting.static.response_figure`."""
    figure = PlainFigure()
    tallest = 0.0 if modulated is None else _add_modulated(figure, modulated, quantity)
    for name, line in lines_by_name(response_lines(curve, quantity)).items():
        _add_line(figure, line, line_colour(line), 1.3 * line_width(line), name)
    if slow is not None:
        for i, line in enumerate(lines_by_name(response_lines(slow, quantity)).values()):
            _add_line(figure, line, INK, 0.8, "slow flow", legendgroup="slow flow", showlegend=i == 0)
    if bare is not None and quantity == "pipe_peak":
        x, y = single(bare[axis_of(bare)].values), single(MM * bare["pipe_peak"].values)
        dotted = {"color": BARE, "dash": "dot", "width": 1.5}
        figure.add_scatter(x=x, y=y, mode="lines", line=dotted, name="without absorber")
    top = max(
        [tallest, largest_finite(curve[quantity].values), *_add_motions(figure, motions, quantity, axis_of(curve))]
    )
    _add_special_points(figure, curve, quantity)
    figure.update_layout(**plot_layout(520))
    figure.update_axes("x", title={"text": AXIS_LABELS[axis_of(curve)]})
    figure.update_axes(
        "y", title={"text": QUANTITY_LABELS[quantity], "standoff": 8}, range=[0, MM * HEADROOM * top or 1.0]
    )
    if bare is not None and quantity == "pipe_peak":
        _name_what_leaves(figure, bare, HEADROOM * top)
    narrow = interesting_range(curve, modulated)
    if narrow is not None:
        figure.update_layout(meta={"narrow": list(narrow)})
    return figure


def _name_what_leaves(figure: PlainFigure, bare: xr.Dataset, top: float) -> None:
    """Say how far the response without absorbers rises where it leaves the figure."""
    beyond = beyond_the_top(bare, top)
    if beyond is not None:
        figure.add_annotation(
            x=beyond.x, y=1, yref="paper", text=beyond.text.replace("\n", "<br>"), showarrow=False, align="left",
            xanchor="left", yanchor="top", xshift=6, font={"size": 12, "color": BARE}, bgcolor="rgba(255,255,255,0.8)",
        )  # fmt: skip


def _add_line(figure: PlainFigure, line: Line, colour: str, width: float, name: str, **more: Any) -> None:
    look = {"color": colour, "dash": "solid" if line.stable else "dash", "width": width}
    hover = HOVER
    x, y = single(line.x), single(MM * line.y)
    figure.add_scatter(x=x, y=y, mode="lines", line=look, name=name, hovertemplate=hover, **more)


def _add_modulated(figure: PlainFigure, modulated: xr.Dataset, quantity: str) -> float:
    """Envelopes of modulated responses, the stable ones shaded; return the largest size drawn."""
    named, top = set(), 0.0
    for stretch in envelopes(modulated, quantity):
        name, hover = MODULATED_NAMES[stretch.stable], HOVER
        look = {"color": GREEN, "width": 1, "dash": "solid" if stretch.stable else "dash"}
        common: dict[str, Any] = {"x": single(stretch.x), "mode": "lines", "line": look, "legendgroup": name}
        common |= {"name": name, "hovertemplate": hover}
        figure.add_scatter(y=single(MM * stretch.low), showlegend=False, **common)
        fill: dict[str, Any] = {"fill": "tonexty", "fillcolor": _MODULATED_FILL} if stretch.stable else {}
        figure.add_scatter(y=single(MM * stretch.high), showlegend=stretch.stable not in named, **common, **fill)
        named.add(stretch.stable)
        top = max(top, float(np.max(stretch.high)) if stretch.stable else 0.0)
    return top


def basin_map_plot(data: xr.Dataset) -> PlainFigure:
    """Which attractor an initial state leads to; see `frahm.plotting.basins.basin_map_figure`."""
    across, up = (str(name) for name in data["label"].dims)
    entries, index = basin_entries(data), basin_indices(data)
    count = len(entries)
    scale = [[(i + side) / count, entry.colour] for i, entry in enumerate(entries) for side in (0, 1)]
    figure = PlainFigure()
    figure.add_trace(
        "heatmap",
        x=single(MM * data[across].values), y=single(MM * data[up].values), z=index.T.astype(np.int8),
        zmin=-0.5, zmax=count - 0.5, colorscale=scale, showscale=False,
        hovertemplate="%{x:.3g}, %{y:.3g}<extra></extra>",
    )  # fmt: skip
    for entry in entries:
        mark = {"symbol": "square", "size": 12, "color": entry.colour, "line": {"color": INK, "width": 1}}
        figure.add_scatter(x=[None], y=[None], mode="markers", name=entry.text, marker=mark)
    rest = {"symbol": "cross-thin", "size": 11, "line": {"color": INK, "width": 1.5}}
    figure.add_scatter(x=[0], y=[0], mode="markers", name="rest", marker=rest, hoverinfo="skip")
    figure.update_layout(**plot_layout(560))
    figure.update_axes("x", title={"text": BASIN_AXES[across]})
    figure.update_axes("y", title={"text": BASIN_AXES[up]})
    return figure


def motion_plot(motion: MotionView) -> PlainFigure:
    """Envelope of the whole run, last periods, spectrum of the tail."""
    figure = PlainFigure((1.0, 1.0, 1.0), gap=0.13)
    for name in reversed(motion.signals):
        look: dict[str, Any] = {"color": _COLOURS[name], "width": 1}
        common: dict[str, Any] = {"legendgroup": name, "name": LABELS[name], "mode": "lines"}
        time, low, high = motion.envelope[name]
        time, low, high = single(time), single(MM * low), single(MM * high)
        figure.add_scatter(x=time, y=low, line=look, showlegend=False, row=1, **common)
        figure.add_scatter(x=time, y=high, line=look, fill="tonexty", fillcolor=_FILLS[name], row=1, **common)
        for row, (x, y) in ((2, motion.last[name]), (3, thinned(*motion.spectrum[name]))):
            dashed = look | {"dash": "solid" if name == "x1" or row == 3 else "dash"}
            figure.add_scatter(x=single(x), y=single(MM * y), line=dashed, showlegend=False, row=row, **common)
    decades = [float(np.log10(MM * value)) for value in motion.spectrum_range]
    figure.update_layout(**plot_layout(760))
    figure.update_axes("x", title={"text": "time [s], whole run"}, row=1)
    figure.update_axes("x", title={"text": "time [s], last periods"}, row=2)
    figure.update_axes("x", title={"text": "frequency [Hz]"}, range=[0, SHOWN_HARMONICS * motion.frequency_hz], row=3)
    figure.update_axes("y", title={"text": "envelope [mm]"}, row=1)
    figure.update_axes("y", title={"text": "displacement [mm]"}, row=2)
    figure.update_axes(
        "y", title={"text": "amplitude [mm]"}, type="log", range=decades, exponentformat="power", dtick=1, row=3
    )
    return figure


def manifold_plot(manifold: xr.Dataset, motion: MotionView | None, folds: dict[str, Any] | None) -> PlainFigure:
    """Slow manifold with folds, jumps and the trajectory of a motion."""
    figure = PlainFigure()
    if motion is not None and motion.slow is not None:
        Z, X = (MM * size for size in motion.slow)
        figure.add_scatter(
            x=single(Z), y=single(X), mode="lines", line={"color": GREEN, "width": 1},
            name=f"motion at {motion.where}",
        )  # fmt: skip
    Z, X = MM * manifold["relative_amplitude"].values, MM * manifold["pipe_amplitude"].values
    attracting = manifold["attracting"].values > 0
    for holds, name, dash in ((attracting, "attracting", "solid"), (~attracting, "repelling", "dash")):
        if np.any(holds):
            y = single(np.where(holds, X, np.nan))
            look = {"color": INK, "dash": dash, "width": 2}
            figure.add_scatter(x=single(Z), y=y, mode="lines", line=look, name=f"slow manifold, {name}")
    if folds:
        _add_folds(figure, folds)
    figure.update_layout(**plot_layout(460))
    figure.update_axes("x", title={"text": "amplitude of the absorber |Z| [mm]"}, rangemode="tozero")
    figure.update_axes(
        "y", title={"text": "amplitude of the pipe |X| [mm]"}, range=[0, MM * manifold_height(manifold, motion, folds)]
    )
    return figure


def _add_folds(figure: PlainFigure, folds: dict[str, Any]) -> None:
    mark = {"color": INK, "size": 10, "symbol": "triangle-up"}
    starts, ends, heights = ([MM * size for size in folds[name]] for name in ("relative", "landing", "pipe"))
    figure.add_scatter(x=starts, y=heights, mode="markers", marker=mark, name="fold")
    for i, (start, end, height) in enumerate(zip(starts, ends, heights, strict=True)):
        figure.add_scatter(
            x=[start, end], y=[height, height], mode="lines+markers", name="jump", legendgroup="jump",
            showlegend=i == 0, line={"color": SINK, "dash": "dot"},
            marker={"symbol": "arrow", "size": [0, 12], "angle": 90 if end > start else -90, "color": SINK},
        )  # fmt: skip


def _add_motions(figure: PlainFigure, motions: list[MotionView], quantity: str, axis: str) -> list[float]:
    """Mark the integrated motions, a modulated one with the range of its peaks; return the heights."""
    heights: list[float] = []
    for kind, symbol in _MOTION_SYMBOLS.items():
        chosen = [m for m in motions if m.kind == kind and np.isfinite(m.peaks(quantity)[1])]
        if not chosen:
            continue
        ranges = [m.peaks(quantity) for m in chosen]
        high = [top for _, top in ranges]
        figure.add_scatter(
            x=[m.place(axis) for m in chosen], y=[MM * top for top in high], mode="markers",
            name=f"integrated from rest, {kind}",
            marker={"symbol": symbol, "size": 9, "color": GREEN},
            error_y={
                "type": "data", "symmetric": False, "array": [0.0] * len(chosen), "color": GREEN, "thickness": 1,
                "width": 0, "arrayminus": [MM * (top - low) for low, top in ranges], "visible": kind != "periodic",
            },
        )  # fmt: skip
        heights += high
    return heights


def _add_special_points(figure: PlainFigure, curve: xr.Dataset, quantity: str) -> None:
    marks, middle = special_marks(curve, quantity), resonance_of(curve)
    mode = "markers+text" if len(marks) <= MOST_LABELS else "markers"
    for kind in dict.fromkeys(mark.kind for mark in marks):
        chosen = [mark for mark in marks if mark.kind == kind]
        height = "bottom" if kind == "saddle-node" else "top"
        figure.add_scatter(
            x=[m.x for m in chosen], y=[MM * m.y for m in chosen], text=[m.label for m in chosen], mode=mode,
            textposition=[f"{height} {'right' if m.x > middle else 'left'}" for m in chosen], name=KIND_NAMES[kind],
            marker={"symbol": _SYMBOLS[kind], "size": 9, "color": INK}, cliponaxis=False,
        )  # fmt: skip


def plot_layout(height: int) -> dict[str, Any]:
    """What all figures for the browser have in common."""
    return {
        "template": _TEMPLATE,
        "height": height,
        "margin": {"l": 60, "r": 16, "t": 36, "b": 50},
        "legend": {"orientation": "h", "yanchor": "top", "y": -88 / height, "x": 0},
        "font": {"family": "system-ui, sans-serif", "size": 13, "color": INK},
        "hoverlabel": {"namelength": -1},
    }


def single(values: Floats) -> np.ndarray:
    """Single precision is more than a screen can show, and half the file."""
    return np.asarray(values, dtype=np.float32)
