"""What the figures of the page draw, as plain data: lines that name their look, and the ends of the axes."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from typing import Any

import numpy as np

from frahm.arrays import Floats
from frahm.case import Case
from frahm.response import ResponseCurve
from frahm.web.drawing import curve_lines, heights, numbers, special_points
from frahm.web.live import ManifoldLines, manifold_lines, responses_at, slow_curve, stability_map
from frahm.web.looks import MARK, QUANTITIES, SLOW_KINDS, SYMBOLS, kind_look
from frahm.web.scope import Axis
from frahm.web.tuned import LinearResponse

Line = dict[str, Any]
_TITLES = {"kappa": "cubic stiffness κ [1/(m² s²)]", "xi2": "damping ξ₂ [1/s]"}


def line(look: str, row: int, x: Any, y: Any, hz: Any = (), **more: Any) -> Line:
    """A line of the response figure; row 0 is the pipe, row 1 the absorber; `hz` is said when pointed at."""
    return {"look": look, "row": row, "x": numbers(x), "y": numbers(y), "hz": numbers(hz), "more": more}


def kind_lines(
    method: str, kinds: Iterable[tuple[bool, bool, bool]], drawn: Iterable[Mapping[str, Floats]], over_wind: bool
) -> list[Line]:
    """Lines of a curve in both rows, those without a point left out."""
    return [
        line(kind_look(method, key), row, lines["x"], lines[name], lines["hz"] if over_wind else ())
        for key, lines in zip(kinds, drawn, strict=True)
        if len(lines["x"])
        for row, name in enumerate(QUANTITIES)
    ]


def special_lines(points: list[dict[str, Any]], middle: float) -> list[Line]:
    """Special points with their labels, in both rows; the labels point away from the middle."""
    if not points:
        return []
    upward = ["bottom" if point["kind"] == "saddle-node" else "top" for point in points]
    sideward = ["right" if point["x"] > middle else "left" for point in points]
    more = {
        "text": [point["label"] + ("" if point["located"] else "?") for point in points],
        "textposition": [f"{height} {side}" for height, side in zip(upward, sideward, strict=True)],
        "marker": MARK | {"symbol": [SYMBOLS[point["kind"]] for point in points]},
    }
    x, hz = ([point[name] for point in points] for name in ("x", "hz"))
    return [
        line("special", row, x, [point[name] for point in points], hz, **more) for row, name in enumerate(QUANTITIES)
    ]


def curve_part(method: str, kinds: tuple[tuple[bool, bool, bool], ...], curve: ResponseCurve) -> dict[str, Any]:
    """A response curve: its lines, its special points, and how high the axes must reach [m]."""
    tops, over_wind = heights(curve), curve.wind_speed is not None
    x = curve.detuning if curve.wind_speed is None else curve.wind_speed
    middle = 0.5 * float(np.min(x) + np.max(x)) if over_wind and x.size else 0.0
    return {
        "lines": kind_lines(method, kinds, curve_lines(curve, kinds), over_wind),
        "points": special_lines(special_points(curve.special_points), middle),
        "tops": [1.15 * tops[name] or 1.0 for name in QUANTITIES],
    }


def slow_part(case: Case, detuning: float) -> tuple[dict[str, Any], ResponseCurve]:
    """The slow flow's curve of a case, with its responses at one detuning marked."""
    curve = slow_curve(case)
    part = curve_part("slow", SLOW_KINDS, curve)
    pipe, relative, _ = responses_at(case, detuning)
    for row, values in enumerate((pipe, relative)):
        part["lines"].append(line("here", row, np.full(values.size, detuning), values))
    return part, curve


def linear_lines(look: str, found: LinearResponse) -> list[Line]:
    """Response in closed form; without an absorber there is only the pipe."""
    rows = [values for values in (found.pipe, found.relative) if values.size]
    hz = () if found.wind_speed is None else found.frequency / (2 * np.pi)
    return [line(look, row, found.x, values, hz) for row, values in enumerate(rows)]


def attractor_lines(found: dict[str, Any]) -> list[Line]:
    """Marks of the attractors of `frahm.web.jobs.attractors`."""
    settled = [entry for entry in found["attractors"] if entry["pipe_peak"] is not None]
    if not settled:
        return []
    x, text = [found["at"]] * len(settled), [entry["kind"] for entry in settled]
    return [
        line("attractors", row, x, [np.nan if entry[name] is None else entry[name] for entry in settled], text=text)
        for row, name in enumerate(QUANTITIES)
    ]


def manifold_part(case: Case, detuning: float) -> tuple[dict[str, Any], ManifoldLines]:
    """The slow manifold at one detuning, with the responses on it."""
    lines = manifold_lines(case, detuning)
    pipe, relative, _ = responses_at(case, detuning)
    fold_z, fold_x = (lines.folds.relative, lines.folds.pipe) if lines.folds else ((), ())
    top = 1.7 * lines.folds.pipe_ceiling if lines.folds else float(np.nanmax(lines.attracting))
    drawn = {
        "attracting": (lines.relative, lines.attracting), "repelling": (lines.relative, lines.repelling),
        "fold": (fold_z, fold_x), "response": (relative, pipe),
    }  # fmt: skip
    arrays = {look: {"x": numbers(x), "y": numbers(y)} for look, (x, y) in drawn.items()}
    return {"lines": arrays, "top": max(top, 1.1 * float(np.max(pipe, initial=0.0)))}, lines


def map_part(case: Case, plane: str, span: tuple[float, float]) -> dict[str, Any]:
    """The stability map of a case over detuning and `plane`."""
    found = stability_map(case, plane, span)
    return {
        "x": numbers(found.detuning), "y": numbers(found.parameter), "z": found.classes.tolist(),
        "title": _TITLES[plane], "range": [float(np.log10(end)) for end in span],
        "window": list(Axis(case).ends),
    }  # fmt: skip
