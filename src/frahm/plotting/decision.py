"""The figure that decides: the largest lasting motion with every device over the wind, or over the detuning."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np

from frahm.plotting.lines import MM
from frahm.plotting.style import BLUE, GREEN, GREY, INK, ORANGE, SKY, VERMILLION, legend_below, new_figure
from frahm.tolerances import AS_LARGE

if TYPE_CHECKING:
    import xarray as xr
    from matplotlib.figure import Figure

DEVICES = {
    "none": "no absorber", "case": "the case's own", "sink": "best sink", "tuned mass damper": "tuned mass damper",
    "mixed": "linear and cubic",
}  # fmt: skip
DEVICE_LOOKS: dict[str, tuple[str, Any, str]] = {
    "none": (GREY, ":", "s"),
    "case": (ORANGE, "--", "v"),
    "sink": (VERMILLION, "-", "o"),
    "tuned mass damper": (BLUE, "-.", "^"),
    "mixed": (GREEN, (0, (5, 1.5)), "D"),
}
_DECADES = 3.5  # below the largest that are shown


@dataclass(frozen=True)
class Marks:
    """Design wind [m/s] and its detuning [rad/s], and the ends of the lock-in band in both, with its standing."""

    speed: float
    detuning: float
    band: tuple[float, float]
    detunings: tuple[float, float]
    standing: str


def marks_of(results: dict[str, Any]) -> Marks:
    """The marks of an analysis, from its results."""
    wind, omega = results["wind"], results["natural_frequency"]
    band = wind["lock_in_band"]
    lo, hi = (omega * (ratio - 1) for ratio in band["ratios"])
    return Marks(wind["speed"], results["design_detuning"], (band["low"], band["high"]), (lo, hi), band["standing"])


def decision_figure(lasting: xr.Dataset, marks: Marks) -> Figure:
    """Largest lasting motions over the wind speed, or over the detuning where the lift is fixed.

    Parameters
    ----------
    lasting : Dataset
        From `frahm.analysis.decision.together`.
    marks : Marks
        What is shaded and marked.
    """
    over_wind = "wind_speed" in lasting
    axis = "wind_speed" if over_wind else "detuning"
    band, here = (marks.band, marks.speed) if over_wind else (marks.detunings, marks.detuning)
    figure = new_figure(160, 105)
    axes = figure.subplots()
    x, device = lasting[axis].values, lasting["device"].values
    axes.set_xlim(float(x.min()), float(x.max()))
    lo, hi = max(band[0], float(x.min())), min(band[1], float(x.max()))
    if lo < hi:
        axes.axvspan(lo, hi, color=SKY, alpha=0.13, linewidth=0, label=f"lock-in band of codes ({marks.standing})")
    if x.min() <= here <= x.max():
        axes.axvline(here, color=INK, linewidth=0.8, linestyle=(0, (1, 1.5)), label="design wind")
    for number, name in enumerate(lasting["device"].attrs["names"].split(", ")):
        _draw_device(axes, lasting.isel(point=device == number), axis, name)
    top = MM * max(float(lasting["pipe_peak"].max()), float(np.nan_to_num(lasting["searched_pipe_peak"]).max()))
    lowest = MM * float(lasting["pipe_peak"].min())
    axes.set_yscale("log")
    axes.set_ylim(max(0.8 * lowest, top * 10**-_DECADES), 1.6 * top)
    axes.yaxis.set_major_formatter(lambda value, _: f"{value:g}")
    axes.set(
        xlabel="wind speed U [m/s]" if over_wind else "detuning σ = Ω − ω [rad/s]",
        ylabel="largest lasting pipe displacement [mm]",
    )
    legend_below(figure)
    return figure


def _draw_device(axes: Any, curve: xr.Dataset, axis: str, name: str) -> None:
    """The curve of one device, mode by mode, and marks of larger motions that last beside it."""
    color, style, marker = DEVICE_LOOKS[name]
    label = DEVICES[name]
    for part in np.unique(curve["part"].values):
        one = curve.isel(point=curve["part"].values == part)
        axes.plot(one[axis].values, MM * one["pipe_peak"].values, color=color, linestyle=style, label=label)
        label = "_"
    beside = curve["searched_pipe_peak"].values > AS_LARGE * curve["pipe_peak"].values
    if beside.any():
        axes.plot(
            curve[axis].values[beside], MM * curve["searched_pipe_peak"].values[beside], marker, color=color,
            markersize=4, linestyle="none", label=f"{DEVICES[name]}: another motion lasts",
        )  # fmt: skip
