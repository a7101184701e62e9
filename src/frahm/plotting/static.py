"""Figures on paper: response, motion, spectrum and slow manifold, drawn from the datasets of an analysis."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np
from matplotlib.patheffects import withStroke

from frahm.plotting.lines import (
    AXIS_LABELS,
    HEADROOM,
    KIND_NAMES,
    MM,
    MODULATED_NAMES,
    MOST_LABELS,
    QUANTITY_LABELS,
    axis_of,
    beyond_the_top,
    envelopes,
    largest_finite,
    line_colour,
    line_width,
    lines_by_name,
    resonance_of,
    response_lines,
    special_marks,
    thinned,
)
from frahm.plotting.style import BARE, GREEN, INK, PIPE, SINK, UNSTABLE_DASHES, decade_axis, legend_below, new_figure
from frahm.plotting.views import LABELS, SHOWN_HARMONICS, MotionView, manifold_height

if TYPE_CHECKING:
    import xarray as xr
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

_SIGNAL_LOOKS: dict[str, tuple[str, Any, float]] = {"x1": (PIPE, "-", 1.4), "z": (SINK, (0, (3.0, 1.2)), 1.1)}
_SLOW_LOOK: dict[str, Any] = {"color": INK, "linewidth": 0.6, "alpha": 0.8}
MARKERS = {"saddle-node": "^", "hopf": "s", "neimark-sacker": "D", "period-doubling": "v", "branch-point": "P"}


def response_figure(
    curve: xr.Dataset,
    quantity: str,
    motions: list[MotionView] | None = None,
    bare: xr.Dataset | None = None,
    slow: xr.Dataset | None = None,
    modulated: xr.Dataset | None = None,
) -> Figure:
    """Response over the wind, or over the detuning where the lift is fixed.

    Stable responses are solid, unstable ones dashed, with special points and motions that were integrated.

    Parameters
    ----------
    curve : Dataset
        From `frahm.ResponseCurve.to_dataset`.
    quantity : str
        "pipe_peak" or "relative_peak".
    motions : list of MotionView, optional
        Integrated motions, marked at their peak; a modulated one with the range of its peaks.
    bare : Dataset, optional
        Response without absorbers, drawn dotted; the axis is scaled for the rest.
    slow : Dataset, optional
        Response by the slow flow, a thin line.
    modulated : Dataset, optional
        From `frahm.ModulatedCurve.to_dataset`: the range of a stable modulated response shaded, unstable ones dashed.
    """
    figure = new_figure(160, 105)
    axes = figure.subplots()
    top = largest_finite(curve[quantity].values)
    if modulated is not None:
        top = max(top, _draw_modulated(axes, modulated, quantity))
    _draw_branches(axes, curve, quantity)
    if slow is not None:
        for i, line in enumerate(lines_by_name(response_lines(slow, quantity)).values()):
            dashes = "-" if line.stable else UNSTABLE_DASHES
            axes.plot(line.x, MM * line.y, linestyle=dashes, label="_" if i else "slow flow", **_SLOW_LOOK)
    _draw_special_points(axes, curve, quantity)
    for motion in motions or []:
        top = max(top, _draw_motion(axes, motion, quantity, axis_of(curve)))
    if bare is not None and quantity == "pipe_peak":
        x, y = bare[axis_of(bare)].values, MM * bare["pipe_peak"].values
        axes.plot(x, y, ":", color=BARE, label="without absorber")
        beyond = beyond_the_top(bare, HEADROOM * top)
        if beyond is not None:
            axes.annotate(
                beyond.text, (beyond.x, MM * HEADROOM * top), (6, -3), textcoords="offset points", va="top", fontsize=8,
                color=BARE, path_effects=[withStroke(linewidth=1.5, foreground="white")],
            )  # fmt: skip
    axes.set(xlabel=AXIS_LABELS[axis_of(curve)], ylabel=QUANTITY_LABELS[quantity], ylim=(0, MM * HEADROOM * top or 1.0))
    legend_below(figure)
    return figure


def motion_figure(motion: MotionView) -> Figure:
    """Pipe and absorber in time and frequency: envelope of the whole run, last periods, spectrum of the tail."""
    figure = new_figure(160, 125)
    figure.set_layout_engine(None)  # the same for every motion: to arrange it anew takes as long as to draw it
    figure.subplots_adjust(left=0.125, right=0.985, top=0.945, bottom=0.15, hspace=0.62)
    whole, last, lines = figure.subplots(3, 1)
    for name in reversed(motion.signals):
        color, style, width = _SIGNAL_LOOKS[name]
        time, low, high = motion.envelope[name]
        low, high = MM * low, MM * high
        whole.fill_between(time, low, high, facecolor=color, alpha=0.25, linewidth=0, label=LABELS[name])
        for edge in (low, high):
            whole.plot(time, edge, color=color, linewidth=0.5)
        moment, displacement = motion.last[name]
        last.plot(moment, MM * displacement, color=color, linestyle=style, linewidth=width)
        frequency, amplitude = thinned(*motion.spectrum[name], 700)
        lines.plot(frequency, MM * amplitude, color=color, linestyle=style, linewidth=0.7)
    if motion.moves:
        lines.set_yscale("log")
        decade_axis(lines.yaxis)
    lines.axvline(motion.frequency_hz, color=INK, linestyle=":", linewidth=0.8, label="excitation")
    whole.set_title(motion.title, y=1.02)  # a place given need not be looked for
    whole.set(xlabel="time [s], whole run", ylabel="envelope [mm]")
    last.set(xlabel="time [s], last periods", ylabel="displacement [mm]")
    lines.set(xlabel="frequency [Hz]", ylabel="amplitude [mm]", ylim=[MM * edge for edge in motion.spectrum_range])
    lines.set_xlim(0, SHOWN_HARMONICS * motion.frequency_hz)
    for axes in (whole, last):
        axes.margins(x=0.01)
    for axes in (whole, last, lines):  # to find these places from the numbers beside them takes long
        axes.xaxis.set_label_coords(0.5, -0.29)
        axes.yaxis.set_label_coords(-0.1, 0.5)
    handles = [*whole.get_legend_handles_labels()[0], *lines.get_legend_handles_labels()[0]]
    legend_below(figure, loc="lower center", handles=handles)
    return figure


def manifold_figure(manifold: xr.Dataset, motion: MotionView | None = None, folds: dict | None = None) -> Figure:
    """Slow invariant manifold with its folds, and the trajectory of a motion on it."""
    figure = new_figure(160, 100)
    axes = figure.subplots()
    if motion is not None and motion.slow is not None:
        axes.plot(*(MM * size for size in motion.slow), color=GREEN, linewidth=0.7, label=f"motion at {motion.where}")
    Z, X = MM * manifold["relative_amplitude"].values, MM * manifold["pipe_amplitude"].values
    attracting = manifold["attracting"].values > 0
    axes.plot(Z, np.where(attracting, X, np.nan), color=INK, label="slow manifold, attracting")
    if not attracting.all():
        axes.plot(
            Z, np.where(attracting, np.nan, X), linestyle=UNSTABLE_DASHES, color=INK, label="slow manifold, repelling"
        )
    if folds:
        starts, ends, heights = ([MM * size for size in folds[name]] for name in ("relative", "landing", "pipe"))
        axes.plot(starts, heights, "^", color=INK, markersize=6, label="fold")
        for start, end, height in zip(starts, ends, heights, strict=True):
            axes.annotate("", (end, height), (start, height), arrowprops={"arrowstyle": "->", "color": SINK})
        axes.axhline(MM * folds["pipe_ceiling"], color=SINK, linestyle=":", linewidth=1.0, label="ceiling of the pipe")
    axes.set(xlabel="amplitude of the absorber relative to the pipe |Z| [mm]", ylabel="amplitude of the pipe |X| [mm]")
    axes.set(xlim=(0, None), ylim=(0, MM * manifold_height(manifold, motion, folds)))
    axes.legend(loc="upper left")
    return figure


def _draw_branches(axes: Axes, curve: xr.Dataset, quantity: str) -> None:
    for name, line in lines_by_name(response_lines(curve, quantity)).items():
        dashes = "-" if line.stable else UNSTABLE_DASHES
        axes.plot(
            line.x, MM * line.y, linestyle=dashes, color=line_colour(line), linewidth=line_width(line), label=name
        )


def _draw_modulated(axes: Axes, modulated: xr.Dataset, quantity: str) -> float:
    """Envelopes of modulated responses, the stable ones shaded; return the largest size drawn."""
    named, top = set(), 0.0
    for stretch in envelopes(modulated, quantity):
        label = "_" if stretch.stable in named else MODULATED_NAMES[stretch.stable]
        named.add(stretch.stable)
        if stretch.stable:
            axes.fill_between(
                stretch.x, MM * stretch.low, MM * stretch.high, facecolor=GREEN, edgecolor=GREEN, alpha=0.2,
                linewidth=0.8,                label=label,
            )  # fmt: skip
            top = max(top, float(np.max(stretch.high)))
        else:
            for y in (stretch.low, stretch.high):
                axes.plot(stretch.x, MM * y, linestyle=UNSTABLE_DASHES, color=GREEN, linewidth=0.7, label=label)
                label = "_"
    return top


def _draw_special_points(axes: Axes, curve: xr.Dataset, quantity: str) -> None:
    """Special points with their labels, unless there are so many that labels would hide what they name."""
    marks, named = special_marks(curve, quantity), set()
    middle = resonance_of(curve)
    for mark in marks:
        label = "_" if mark.kind in named else KIND_NAMES[mark.kind]
        named.add(mark.kind)
        axes.plot(mark.x, MM * mark.y, MARKERS[mark.kind], color=INK, markersize=5, linestyle="none", label=label)
        if len(marks) > MOST_LABELS:
            continue
        right = mark.x > middle  # labels stand outside, the motions at resonance inside
        offset = (7 if right else -6, -3 if mark.kind == "saddle-node" else 6)
        axes.annotate(
            mark.label, (mark.x, MM * mark.y), offset, textcoords="offset points", va="center", fontsize=8,
            ha="left" if right else "right", path_effects=[withStroke(linewidth=1.5, foreground="white")],
        )  # fmt: skip


def _draw_motion(axes: Axes, motion: MotionView, quantity: str, axis: str) -> float:
    """Mark a motion; return the height of the mark."""
    low, high = motion.peaks(quantity)
    x = motion.place(axis)
    if not np.isfinite(high):
        return 0.0
    known = axes.get_legend_handles_labels()[1]
    label = f"integrated from rest, {motion.kind}"
    shown = "_" if label in known else label
    if motion.kind == "periodic":
        axes.plot(x, MM * high, "o", markersize=5, markerfacecolor="none", color=GREEN, label=shown)
    else:
        axes.plot([x] * 2, [MM * low, MM * high], "-", color=GREEN, linewidth=1.0)
        marker = {"modulated": "D", "chaotic": "s"}.get(motion.kind, "x")
        axes.plot(x, MM * high, marker, markersize=4, color=GREEN, linestyle="none", label=shown)
    return high
