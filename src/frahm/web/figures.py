"""The figures of the page: their traces stand in a fixed order, so that an update sends arrays only."""

from __future__ import annotations

from collections.abc import Iterable
from typing import Any

import numpy as np
import plotly.graph_objects as go
from plotly.subplots import make_subplots

from frahm.case import Case
from frahm.plotting.interactive import CONFIG as REPORT_CONFIG
from frahm.plotting.lines import DETUNING_LABEL
from frahm.plotting.style import BARE, GREEN, INK, ORANGE, SINK, SKY
from frahm.response import ResponseCurve
from frahm.web.drawing import EXACT_KINDS, KINDS, QUANTITIES, SLOW_KINDS, curve_lines, heights, special_points, typed
from frahm.web.live import (
    MAP_CLASSES,
    ManifoldLines,
    StabilityMap,
    manifold_lines,
    responses_at,
    shedding_detuning,
    slow_curve,
    stability_map,
)
from frahm.web.tuned import bare_response, tuned_mass_damper_response

HEIGHTS = {"response": 520, "map": 380, "manifold": 380, "motion": 720}  # [px]
CONFIG = REPORT_CONFIG
_SYMBOLS = {
    "saddle-node": "triangle-up", "hopf": "square", "neimark-sacker": "diamond",
    "period-doubling": "triangle-down", "branch-point": "cross",
}  # fmt: skip
MAP_COLOURS = ("#eef3f7", SKY, "#0b5c8f", "#a33c00", ORANGE)

# Traces of one row of the response figure, drawn from first to last.
BARE_LINE = "without sink"
TUNED_LINE = "tuned mass damper of the same mass"
_EXACT = [("exact", key) for key in EXACT_KINDS]
_SLOW = [("slow", key) for key in SLOW_KINDS]
TRACES = [("bare", None), *_EXACT, *_SLOW, ("tuned", None), ("attractors", None), ("special", None), ("here", None)]
ROWS = len(QUANTITIES)


def trace_number(what: str, key: Any = None, row: int = 0) -> int:
    """Position of a trace in the response figure; row 0 is the pipe, row 1 the sink."""
    return row * len(TRACES) + TRACES.index((what, key))


def response_figure() -> go.Figure:
    """Empty response figure: the pipe above, the sink relative to it below."""
    figure = make_subplots(rows=ROWS, cols=1, shared_xaxes=True, vertical_spacing=0.06, row_heights=[0.6, 0.4])
    for row in range(ROWS):
        for what, key in TRACES:
            figure.add_trace(_empty_trace(what, key), row=row + 1, col=1)
    figure.update_layout(**_layout(HEIGHTS["response"]), uirevision="kept", hovermode="closest", clickmode="event")
    figure.update_xaxes(title_text=DETUNING_LABEL, row=ROWS, col=1)
    figure.update_yaxes(title_text="pipe x₁ [m]", row=1, col=1)
    figure.update_yaxes(title_text="sink z [m]", row=2, col=1)
    return figure


def _empty_trace(what: str, key: Any) -> go.Scatter:
    common: dict[str, Any] = {"x": [], "y": [], "mode": "lines", "visible": False}
    common["hovertemplate"] = "σ %{x:.4f} rad/s<br>%{y:.4g} m"
    if what == "bare":
        return go.Scatter(**common, name=BARE_LINE, line={"color": BARE, "dash": "dot", "width": 1.5})
    if what == "tuned":
        return go.Scatter(**common, name=TUNED_LINE, line={"color": GREEN, "dash": "dashdot", "width": 1.8})
    if what in ("exact", "slow"):
        kind = KINDS[key]
        colour = INK if what == "slow" and not key[0] else kind.colour
        name = f"{'slow flow' if what == 'slow' else 'exact'}, {kind.name}"
        line = {"color": colour, "dash": "solid" if kind.stable else "dash", "width": 1.3 if what == "slow" else 3.2}
        return go.Scatter(**common, name=name, line=line)
    marked = common | {"mode": "markers"}
    if what == "special":
        marked |= {"mode": "markers+text", "hovertemplate": "%{text}<br>" + common["hovertemplate"]}
        return go.Scatter(**marked, name="special point", marker={"color": INK, "size": 8}, cliponaxis=False)
    if what == "attractors":
        marked["hovertemplate"] = "%{text}<br>" + common["hovertemplate"]
        mark: dict[str, Any] = {"color": GREEN, "size": 16, "symbol": "star", "line": {"color": INK, "width": 1}}
        return go.Scatter(**marked, name="attractor found", marker=mark)
    return go.Scatter(
        **marked, name="at the detuning set",
        marker={"size": 11, "color": "white", "symbol": "circle", "line": {"color": SINK, "width": 3}},
    )  # fmt: skip


def draw_response(target: Any, case: Case, detuning: float, *, tuned: bool, keep_exact: bool = False) -> ResponseCurve:
    """Draw the slow flow of a case into a figure or a patch of one, and return it.

    Parameters
    ----------
    target : dict or Patch
        A response figure.
    case : Case
    detuning : float
        Where the responses are marked [rad/s].
    tuned : bool
        Whether the tuned mass damper of the same mass is drawn.
    keep_exact : bool
        Whether the exact response in the figure is that of this very case; it is removed otherwise.
    """
    curve = slow_curve(case)
    for key, line in zip(SLOW_KINDS, curve_lines(curve, SLOW_KINDS), strict=True):
        _set_lines(target, "slow", key, line)
    _hide(target, "attractors")
    if not keep_exact:
        for key in EXACT_KINDS:
            _hide(target, "exact", key)
        _draw_special(target, special_points(curve.special_points))
        _scale(target, heights(curve))
    pipe, relative, _ = responses_at(case, detuning)
    for row, values in enumerate((pipe, relative)):
        _set(target, "here", None, row, x=typed(np.full(values.size, detuning)), y=typed(values), visible=True)
    bare = bare_response(case)
    _set(target, "bare", None, 0, x=typed(bare.detuning), y=typed(bare.pipe), visible=True)
    _draw_tuned(target, case, shown=tuned)
    lines = [_vertical(detuning, SINK, "solid"), _vertical(shedding_detuning(case), BARE, "dot")]
    target["layout"]["shapes"] = [shape for shape in lines if shape]
    return curve


def _draw_tuned(target: Any, case: Case, *, shown: bool) -> None:
    if not shown:
        _hide(target, "tuned")
        return
    found = tuned_mass_damper_response(case)
    for row, values in enumerate((found.pipe, found.relative)):
        _set(target, "tuned", None, row, x=typed(found.detuning), y=typed(values), visible=True)


def draw_exact(target: Any, found: dict[str, Any]) -> None:
    """Draw the exact curve of `frahm.web.jobs.exact_response` into a patch of the response figure."""
    for key, line in zip(EXACT_KINDS, found["lines"], strict=True):
        _set_lines(target, "exact", key, line)
    _draw_special(target, found["special"])
    _scale(target, found["heights"])


def draw_attractors(target: Any, found: dict[str, Any]) -> None:
    """Mark the attractors of `frahm.web.jobs.attractors` in a patch of the response figure."""
    settled = [entry for entry in found["attractors"] if entry["pipe_peak"] is not None]
    for row, name in enumerate(QUANTITIES):
        _set(
            target, "attractors", None, row, x=[found["detuning"]] * len(settled),
            y=[entry[name] for entry in settled], text=[entry["kind"] for entry in settled], visible=bool(settled),
        )  # fmt: skip


def _set_lines(target: Any, what: str, key: Any, line: dict[str, Any]) -> None:
    x = np.asarray(line["detuning"], dtype=float)
    for row, name in enumerate(QUANTITIES):
        _set(target, what, key, row, x=typed(x), y=typed(np.asarray(line[name], dtype=float)), visible=bool(x.size))


def _draw_special(target: Any, points: list[dict[str, Any]]) -> None:
    for row, name in enumerate(QUANTITIES):
        heights_above = ["bottom" if point["kind"] == "saddle-node" else "top" for point in points]
        sides = ["right" if point["detuning"] > 0 else "left" for point in points]
        _set(
            target, "special", None, row, x=[point["detuning"] for point in points],
            y=[point[name] for point in points], visible=bool(points),
            text=[point["label"] + ("" if point["located"] else "?") for point in points],
            textposition=[f"{height} {side}" for height, side in zip(heights_above, sides, strict=True)],
        )  # fmt: skip
        target["data"][trace_number("special", None, row)]["marker"]["symbol"] = [_SYMBOLS[p["kind"]] for p in points]


def _set(target: Any, what: str, key: Any, row: int, **values: Any) -> None:
    trace = target["data"][trace_number(what, key, row)]
    for name, value in values.items():
        trace[name] = value


def _hide(target: Any, what: str, key: Any = None) -> None:
    for row in range(ROWS):
        _set(target, what, key, row, x=[], y=[], visible=False)


def _scale(target: Any, tops: dict[str, float]) -> None:
    for axis, name in zip(("yaxis", "yaxis2"), QUANTITIES, strict=True):
        target["layout"][axis]["range"] = [0, 1.15 * tops[name] or 1.0]


def _vertical(x: float, colour: str, dash: str) -> dict[str, Any] | None:
    if not np.isfinite(x):
        return None
    line = {"color": colour, "width": 1, "dash": dash}
    return {"type": "line", "xref": "x", "yref": "paper", "x0": x, "x1": x, "y0": 0, "y1": 1, "line": line,
            "layer": "below"}  # fmt: skip


def manifold_figure() -> go.Figure:
    """Empty figure of the slow manifold."""
    figure = go.Figure()
    for name, dash in (("attracting", "solid"), ("repelling", "dash")):
        figure.add_scatter(x=[], y=[], mode="lines", name=name, line={"color": INK, "dash": dash, "width": 2})
    figure.add_scatter(x=[], y=[], mode="lines", name="motion", line={"color": GREEN, "width": 1})
    fold = {"color": INK, "size": 10, "symbol": "triangle-up"}
    figure.add_scatter(x=[], y=[], mode="markers", name="fold", marker=fold)
    rings: dict[str, Any] = {"size": 11, "color": "white", "line": {"color": SINK, "width": 3}}
    figure.add_scatter(x=[], y=[], mode="markers", name="response", marker=rings)
    figure.update_layout(**_layout(HEIGHTS["manifold"]), uirevision="kept")
    figure.update_xaxes(title_text="sink |Z| [m]", rangemode="tozero")
    figure.update_yaxes(title_text="pipe |X| [m]", rangemode="tozero")
    return figure


MANIFOLD_MOTION = 2


def draw_manifold(target: Any, case: Case, detuning: float) -> ManifoldLines:
    """Draw the slow manifold of a case at one detuning."""
    lines = manifold_lines(case, detuning)
    pipe, relative, _ = responses_at(case, detuning)
    fold_z, fold_x = (lines.folds.relative, lines.folds.pipe) if lines.folds else ((), ())
    top = 1.7 * lines.folds.pipe_ceiling if lines.folds else float(np.nanmax(lines.attracting))
    arrays = (
        (lines.relative, lines.attracting), (lines.relative, lines.repelling), ((), ()), (fold_z, fold_x),
        (relative, pipe),
    )  # fmt: skip
    for number, (x, y) in enumerate(arrays):
        target["data"][number]["x"], target["data"][number]["y"] = typed(x), typed(y)
    target["layout"]["yaxis"]["range"] = [0, max(top, 1.1 * float(np.max(pipe, initial=0.0)))]
    return lines


def map_figure() -> go.Figure:
    """Empty map of the stability over detuning and a parameter of the sink."""
    last = len(MAP_CLASSES) - 1
    scale = [[at / (last + 1), colour] for at in range(last + 1) for colour in (MAP_COLOURS[at],)]
    steps = [[(at + up) / (last + 1), colour] for at, (_, colour) in enumerate(scale) for up in (0, 1)]
    figure = go.Figure()
    figure.add_heatmap(
        x=[], y=[], z=[[]], zmin=-0.5, zmax=last + 0.5, colorscale=steps, showscale=False, hoverinfo="x+y", name=""
    )
    cross: dict[str, Any] = {"symbol": "cross", "size": 13, "color": "white", "line": {"color": INK, "width": 2}}
    figure.add_scatter(x=[], y=[], mode="markers", name="set now", marker=cross)
    figure.update_layout(**_layout(HEIGHTS["map"]), uirevision="kept")
    figure.update_xaxes(title_text=DETUNING_LABEL)
    figure.update_yaxes(type="log", exponentformat="power", dtick=1, title_text="kappa")
    return figure


def draw_map(target: Any, case: Case, plane: str, span: tuple[float, float]) -> StabilityMap:
    """Draw the stability map of a case over detuning and `plane`."""
    found = stability_map(case, plane, span)
    cells = target["data"][0]
    cells["x"], cells["y"] = typed(found.detuning), typed(found.parameter)
    cells["z"] = found.classes.tolist()
    title = {"kappa": "cubic stiffness κ [1/(m² s²)]", "xi2": "damping ξ₂ [1/s]"}[plane]
    target["layout"]["yaxis"]["title"]["text"] = title
    target["layout"]["yaxis"]["range"] = [float(np.log10(end)) for end in span]
    target["layout"]["xaxis"]["range"] = list(case.analysis.detuning)
    return found


def mark_map(target: Any, case: Case, detuning: float, plane: str) -> None:
    """Mark where the case stands on its stability map."""
    mark = target["data"][1]
    mark["x"], mark["y"] = [detuning], [case.absorbers[0].normalised(case.pipe.mass)[plane]]


def applied(figure: go.Figure, draw: Iterable[Any]) -> dict[str, Any]:
    """Figure as plain data with drawings applied: the same functions that write into a patch."""
    plain = figure.to_plotly_json()
    for function, arguments, options in draw:
        function(plain, *arguments, **options)
    return plain


def _layout(height: int) -> dict[str, Any]:
    return {
        "template": "simple_white",
        "height": height,
        "margin": {"l": 62, "r": 12, "t": 30, "b": 48},
        "showlegend": False,  # the keys stand on the page: drawn anew every time, they would cost half of the time
        "font": {"family": "system-ui, sans-serif", "size": 13, "color": INK},
        "hoverlabel": {"namelength": -1},
    }
