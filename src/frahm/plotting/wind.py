"""Figures of the pipe in gusts."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from frahm.arrays import Floats
from frahm.plotting.interactive import plot_layout, single
from frahm.plotting.plain import PlainFigure
from frahm.plotting.style import BARE, PIPE, SKY, legend_below, new_figure

if TYPE_CHECKING:
    import xarray as xr
    from matplotlib.figure import Figure

_BARE_LABEL, _SINK_LABEL, _STEADY_LABEL = "without absorbers", "with absorbers", "steady resonance, without absorbers"


def gusts_figure(motion: xr.Dataset) -> Figure:
    """Wind speed, and the envelopes of the pipe with and without absorbers.

    Parameters
    ----------
    motion : Dataset
        From `frahm.UnsteadyResponse.to_dataset`.
    """
    figure = new_figure(160, 110)
    wind, pipe = figure.subplots(2, 1, sharex=True, height_ratios=(1, 2))
    wind.plot(*_thin(motion), color=SKY, linewidth=0.8)
    wind.set(ylabel="wind [m/s]")
    for name, colour, label in _envelopes(motion):
        pipe.plot(*_envelope(motion, name), color=colour, linewidth=1.2, label=label)
    resonant = float(motion.attrs["resonant_amplitude"])
    if np.isfinite(resonant):
        pipe.axhline(resonant, color=BARE, linestyle=":", linewidth=1.0, label=_STEADY_LABEL)
    pipe.set(xlabel="time [s]", ylabel="envelope of the pipe [m]", ylim=(0, None))
    pipe.margins(x=0.01)
    legend_below(figure)
    return figure


def gusts_plot(motion: xr.Dataset) -> PlainFigure:
    """The same for the browser."""
    figure = PlainFigure((1.0, 2.0), gap=0.06, shared=True)
    time, speed = _thin(motion)
    look = {"color": SKY, "width": 1}
    figure.add_scatter(x=time, y=speed, mode="lines", line=look, showlegend=False, row=1)
    for name, colour, label in _envelopes(motion):
        time, size = _envelope(motion, name)
        figure.add_scatter(x=time, y=size, mode="lines", line={"color": colour, "width": 2}, name=label, row=2)
    resonant = float(motion.attrs["resonant_amplitude"])
    if np.isfinite(resonant):
        dotted = {"color": BARE, "dash": "dot", "width": 1.5}
        ends = {"x": [float(time[0]), float(time[-1])], "y": [resonant] * 2}
        figure.add_scatter(**ends, mode="lines", line=dotted, name=_STEADY_LABEL, row=2)
    figure.update_layout(**plot_layout(520))
    figure.update_axes("x", title={"text": "time [s]"}, row=2)
    figure.update_axes("y", title={"text": "wind [m/s]"}, row=1)
    figure.update_axes("y", title={"text": "envelope of the pipe [m]"}, rangemode="tozero", row=2)
    return figure


def _envelopes(motion: xr.Dataset) -> list[tuple[str, str, str]]:
    bare = ("bare_pipe_displacement", BARE, _BARE_LABEL)
    return [bare, ("pipe_displacement", PIPE, _SINK_LABEL)] if "relative_displacement" in motion else [bare]


def _envelope(motion: xr.Dataset, name: str) -> tuple[Floats, Floats]:
    """Largest |x| of every natural period, in its middle."""
    width = int(motion.attrs["samples_per_period"])
    count = motion["time"].size // width
    time = motion["time"].values[: count * width].reshape(count, width).mean(axis=1)
    size = np.abs(motion[name].values[: count * width]).reshape(count, width).max(axis=1)
    return single(time), single(size)


def _thin(motion: xr.Dataset) -> tuple[Floats, Floats]:
    """Wind speed at two samples a natural period: gusts are slower."""
    step = max(1, int(motion.attrs["samples_per_period"]) // 2)
    return single(motion["time"].values[::step]), single(motion["wind_speed"].values[::step])
