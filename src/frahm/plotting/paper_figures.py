"""Figures 5 to 7 and 9 to 12 of doi 10.3390/app12147272: response curves, with settled exact motions beside them."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.lines import Line2D

from frahm.arrays import Floats
from frahm.plotting.lines import response_lines
from frahm.plotting.panels import name_panels, panels
from frahm.plotting.style import BLUE, GREEN, GREY, INK, ORANGE, PURPLE, figure_style, legend_below
from frahm.response import ResponseCurve

DETUNING_LABEL = r"detuning $\sigma$ [rad/s]"
PIPE_LABEL, RELATIVE_LABEL = r"amplitude of $x_1$ [m]", r"amplitude of $z$ [m]"
_QUANTITIES = ("pipe_peak", "relative_peak")
UNSTABLE_DASHES = (0, (3.2, 1.6))


@dataclass(frozen=True)
class Motions:
    """Peaks of settled exact motions at several detunings, as points beside a response curve.

    Parameters
    ----------
    detuning : ndarray
        [rad/s].
    pipe_peak, relative_peak : ndarray
        Largest |x1| and |z| [m].
    modulated : ndarray of bool
        Whether the peaks vary from period to period.
    """

    detuning: Floats
    pipe_peak: Floats
    relative_peak: Floats
    modulated: np.ndarray


def response_figure(
    paper: ResponseCurve,
    averaged: ResponseCurve,
    exact: ResponseCurve,
    motions: Motions,
    window: tuple[float, float],
    title: str,
) -> Figure:
    """Amplitudes of pipe and sink over detuning (Figs. 5, 6, 7, 10, 11).

    Parameters
    ----------
    paper, averaged : ResponseCurve
        Both forms of the slow flow.
    exact : ResponseCurve
        Harmonic balance of the exact equations.
    motions : Motions
        Settled exact motions.
    window : tuple of float
        Detunings shown [rad/s].
    title : str
        Parameters of the sink.
    """
    with figure_style():
        figure, axes = panels(1, 2, 230, 108)
        for panel, quantity, label in zip(axes.flat, _QUANTITIES, (PIPE_LABEL, RELATIVE_LABEL), strict=True):
            _draw_halo(panel, averaged, quantity)
            _draw_motions(panel, motions, quantity)
            _draw_curve(panel, paper, quantity, color=BLUE, linewidth=1.8, zorder=3)
            _draw_curve(panel, exact, quantity, **_EXACT_LOOK)
            _mark_special_points(panel, paper, quantity)
            panel.set(xlim=window, xlabel=DETUNING_LABEL, ylabel=label)
            panel.set_ylim(bottom=0)
        name_panels(axes, (f"pipe, {title}", "relative to the pipe"))
        legend_below(figure, 4, handles=_response_handles(paper, motions), columnspacing=1.4)
        return figure


def _draw_curve(panel: Axes, curve: ResponseCurve, quantity: str, **look: Any) -> None:
    """Stable stretches solid, unstable ones dashed."""
    for line in response_lines(curve.to_dataset(), quantity):
        dashes = "-" if line.stable else UNSTABLE_DASHES
        panel.plot(line.x, line.y, linestyle=dashes, dash_capstyle="butt", solid_capstyle="butt", **look)


def _draw_halo(panel: Axes, curve: ResponseCurve, quantity: str) -> None:
    """A pale band behind the curve it is compared with: where the two part, it comes out."""
    for line in response_lines(curve.to_dataset(), quantity):
        panel.plot(line.x, line.y, zorder=2, **_HALO_LOOK)


def _draw_motions(panel: Axes, motions: Motions, quantity: str) -> None:
    peaks = getattr(motions, quantity)
    for modulated, look in ((False, _PERIODIC_LOOK), (True, _MODULATED_LOOK)):
        chosen = np.flatnonzero(motions.modulated == modulated)
        places = np.stack([motions.detuning / np.ptp(motions.detuning), peaks / np.nanmax(peaks)], axis=1)[chosen]
        shown = chosen[_spaced(places)]
        panel.plot(motions.detuning[shown], peaks[shown], linestyle="none", zorder=4, **look)


def _spaced(places: Floats) -> list[int]:
    """Which of the places (N, 2) to keep so that none is nearer than `_APART` to another."""
    kept: list[int] = []
    for index, place in enumerate(places):
        if not kept or np.min(np.hypot(*(places[kept] - place).T)) >= _APART:
            kept.append(index)
    return kept


_APART = 0.025  # of a panel's width or height, at least, between motions drawn: lines under them stay seen
_HALO_LOOK: dict[str, Any] = {"color": "#F3B98F", "linewidth": 4.5, "solid_capstyle": "butt"}
_PERIODIC_LOOK: dict[str, Any] = {"marker": "o", "markersize": 2.8, "color": GREEN, "markeredgewidth": 0}
_MODULATED_LOOK: dict[str, Any] = {
    "marker": "^",
    "markersize": 4.2,
    "markerfacecolor": "none",
    "markeredgecolor": PURPLE,
}
_EXACT_LOOK: dict[str, Any] = {"color": INK, "linewidth": 0.7, "zorder": 3.5}
_HOPF_LOOK: dict[str, Any] = {"marker": "s", "markersize": 5.6, "color": INK}
_FOLD_LOOK: dict[str, Any] = {
    "marker": "D",
    "markersize": 5.0,
    "color": ORANGE,
    "markeredgecolor": INK,
    "markeredgewidth": 0.7,
}


_MARKED = (("saddle-node", "saddle-node", _FOLD_LOOK), ("hopf", "Hopf point", _HOPF_LOOK))


def _mark_special_points(panel: Axes, curve: ResponseCurve, quantity: str) -> None:
    for kind, _, look in _MARKED:
        points = [p for p in curve.special_points if p.kind == kind]
        peaks = [getattr(p, quantity) for p in points]
        panel.plot([p.detuning for p in points], peaks, linestyle="none", zorder=5, **look)


def _response_handles(paper: ResponseCurve, motions: Motions) -> list[Line2D]:
    kinds = {point.kind for point in paper.special_points}
    handles = [_line("slow flow of the paper, stable", color=BLUE)]
    if not np.all(paper.stable):
        handles.append(_line("unstable", color=BLUE, linestyle=UNSTABLE_DASHES))
    handles.append(_line("slow flow with the exact frequency", **_HALO_LOOK))
    handles.append(_line("exact, harmonic balance: largest value", **_EXACT_LOOK))
    handles += [_point(name, look) for kind, name, look in _MARKED if kind in kinds]
    if not np.all(motions.modulated):
        handles.append(_point("exact, periodic: largest value", _PERIODIC_LOOK))
    if np.any(motions.modulated):
        handles.append(_point("exact, modulated: largest value", _MODULATED_LOOK))
    return handles


def _line(label: str, **look: Any) -> Line2D:
    return Line2D([], [], label=label, **look)


def _point(label: str, look: dict[str, Any]) -> Line2D:
    return _line(label, linestyle="none", **look)


def comparison_figure(bare: tuple[Floats, Floats], curves: Sequence[tuple[str, ResponseCurve]]) -> Figure:
    """Pipe amplitude without a sink and with several (Fig. 9).

    Parameters
    ----------
    bare : tuple of ndarray
        Detuning [rad/s] and amplitude [m] without a sink.
    curves : sequence of (str, ResponseCurve)
        Label and curve of each sink.
    """
    with figure_style():
        figure, axes = panels(1, 1, 160, 112)
        panel = axes[0, 0]
        panel.plot(*bare, color=INK, label="no sink")
        _draw_family(panel, curves)
        panel.set(xlim=(-0.2, 0.2), ylim=(0, None), xlabel=DETUNING_LABEL, ylabel=PIPE_LABEL)
        _family_legend(panel, curves, [_line("no sink", color=INK)])
        return figure


def damping_figure(
    left: Sequence[tuple[str, ResponseCurve]], right: Sequence[tuple[str, ResponseCurve]], titles: tuple[str, str]
) -> Figure:
    """Pipe amplitude for several dampings of the sink at two stiffnesses (Fig. 12)."""
    with figure_style():
        figure, axes = panels(1, 2, 230, 102)
        for panel, curves, window in zip(axes.flat, (left, right), ((-0.4, 0.4), (-0.2, 0.2)), strict=True):
            _draw_family(panel, curves)
            panel.set(xlim=window, ylim=(0, None), xlabel=DETUNING_LABEL, ylabel=PIPE_LABEL)
            _family_legend(panel, curves, [])
        name_panels(axes, titles)
        return figure


_FAMILY_COLOURS = (BLUE, ORANGE, GREEN)


def _draw_family(panel: Axes, curves: Sequence[tuple[str, ResponseCurve]]) -> None:
    for (_, curve), colour in zip(curves, _FAMILY_COLOURS, strict=True):
        _draw_curve(panel, curve, "pipe_peak", color=colour, zorder=3)
        _mark_special_points(panel, curve, "pipe_peak")


def _family_legend(panel: Axes, curves: Sequence[tuple[str, ResponseCurve]], first: list[Line2D]) -> None:
    handles = [*first, *(_line(label, color=c) for (label, _), c in zip(curves, _FAMILY_COLOURS, strict=True))]
    if any(not np.all(curve.stable) for _, curve in curves):
        handles.append(_line("unstable", color=GREY, linestyle=UNSTABLE_DASHES))
    kinds = {point.kind for _, curve in curves for point in curve.special_points}
    handles += [_point(name, look) for kind, name, look in _MARKED if kind in kinds]
    panel.legend(handles=handles, loc="upper right")
