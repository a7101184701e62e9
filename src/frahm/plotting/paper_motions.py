"""Figures 3, 4 and 8 of doi 10.3390/app12147272: motions in time and their spectra."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

from matplotlib.axes import Axes
from matplotlib.figure import Figure

from frahm.arrays import Floats
from frahm.plotting.panels import name_panels, panels
from frahm.plotting.style import BLUE, INK, VERMILLION, figure_style, legend_below

_TIME_LABEL, _FREQUENCY_LABEL = "time [s]", "frequency [Hz]"
_PIPE_LABEL, _RELATIVE_LABEL = "$x_1$ [m]", "$z$ [m]"
_DENSE: dict[str, Any] = {"linewidth": 0.35, "rasterized": True}


@dataclass(frozen=True)
class Trace:
    """One motion in time.

    Parameters
    ----------
    time : ndarray
        [s].
    x1, z : ndarray
        Displacement of the pipe and relative displacement [m].
    """

    time: Floats
    x1: Floats
    z: Floats


@dataclass(frozen=True)
class Spectrum:
    """One-sided amplitudes over frequency.

    Parameters
    ----------
    frequency_hz : ndarray
        [Hz].
    x1, z : ndarray
        [m].
    """

    frequency_hz: Floats
    x1: Floats
    z: Floats


def histories_figure(slow: Trace, exact: Trace, end: float) -> Figure:
    """Pipe and relative displacement in time: slow flow above, integration below (Fig. 3).

    Parameters
    ----------
    slow, exact : Trace
        The same motion by both methods.
    end : float
        Last time shown [s].
    """
    with figure_style():
        figure, axes = panels(2, 2, 230, 130, sharex=True, sharey="col")
        for row, trace, colour in zip(axes, (slow, exact), (BLUE, VERMILLION), strict=True):
            shown = trace.time <= end
            row[0].plot(trace.time[shown], trace.x1[shown], color=colour, **_DENSE)
            row[1].plot(trace.time[shown], trace.z[shown], color=colour, **_DENSE)
            row[0].set(ylabel=_PIPE_LABEL, xlim=(0, end))
            row[1].set(ylabel=_RELATIVE_LABEL)
        for panel in axes[1]:
            panel.set_xlabel(_TIME_LABEL)
        names = ("slow flow of the paper", "exact equations, integrated")
        name_panels(axes, tuple(f"{what}, {how}" for how in names for what in ("pipe", "relative")))
        return figure


def spectra_figure(slow: Spectrum, exact: Spectrum, natural_hz: float, window: tuple[float, float]) -> Figure:
    """Displacement spectra of pipe and relative motion by both methods (Fig. 4).

    Parameters
    ----------
    slow, exact : Spectrum
        The same motion by both methods.
    natural_hz : float
        Natural frequency of the pipe [Hz].
    window : tuple of float
        Frequencies shown [Hz].
    """
    with figure_style():
        figure, axes = panels(1, 2, 230, 100)
        for panel, name in zip(axes.flat, ("x1", "z"), strict=True):
            for spectrum, look in ((slow, {"color": BLUE, "linewidth": 2.4}), (exact, {"color": VERMILLION})):
                shown = (spectrum.frequency_hz >= window[0]) & (spectrum.frequency_hz <= window[1])
                panel.plot(spectrum.frequency_hz[shown], getattr(spectrum, name)[shown], **{"linewidth": 1.0, **look})
            panel.axvline(natural_hz, color=INK, linestyle=":", linewidth=1.0, zorder=1)
            panel.set(xlim=window, ylim=(0, None), xlabel=_FREQUENCY_LABEL)
        axes[0, 0].set_ylabel("amplitude of $x_1$ [m]")
        axes[0, 1].set_ylabel("amplitude of $z$ [m]")
        name_panels(axes, ("pipe", "relative"))
        lines = axes[0, 0].get_lines()
        labels = ("slow flow of the paper", "exact equations, integrated", f"{natural_hz:g} Hz, natural frequency")
        legend_below(figure, handles=lines, labels=labels)
        return figure


def two_starts_figure(
    rest: Trace, pushed: Trace, largest: tuple[float, float], final: tuple[float, float], end: float
) -> Figure:
    """Pipe above, relative displacement below; from rest on the left, from a large state on the right (Fig. 8).

    Parameters
    ----------
    rest, pushed : Trace
        The two motions.
    largest, final : tuple of float
        Largest |x1| and |z| of the second motion, and those it settles to [m]: its transient leaves the panels, which
        are scaled for what remains.
    end : float
        Last time shown [s].
    """
    with figure_style():
        figure, axes = panels(2, 2, 230, 130, sharex=True)
        for column, trace, colour in ((0, rest, BLUE), (1, pushed, VERMILLION)):
            shown = trace.time <= end
            axes[0, column].plot(trace.time[shown], trace.x1[shown], color=colour, **_DENSE)
            axes[1, column].plot(trace.time[shown], trace.z[shown], color=colour, **_DENSE)
        for panel, label in zip(axes.flat, (_PIPE_LABEL, _PIPE_LABEL, _RELATIVE_LABEL, _RELATIVE_LABEL), strict=True):
            panel.set(ylabel=label, xlim=(0, end))
        for panel, first, last in zip(axes[:, 1], largest, final, strict=True):
            _scale_for_the_end(panel, first, last)
        for panel in axes[1]:
            panel.set_xlabel(_TIME_LABEL)
        starts = ("from rest", "from (3, 3, 3, 3)")
        name_panels(axes, tuple(f"{what}, {start}" for what in ("pipe", "relative") for start in starts))
        return figure


def _scale_for_the_end(panel: Axes, largest: float, amplitude: float) -> None:
    panel.set_ylim(-3 * amplitude, 3 * amplitude)
    text = f"reaches {largest:.2g} m at first,\nsettles at {amplitude:.2g} m"
    panel.text(
        0.98, 0.95, text, transform=panel.transAxes, ha="right", va="top", fontsize=8.5,
        bbox={"facecolor": "white", "edgecolor": "none", "pad": 2},
    )  # fmt: skip
