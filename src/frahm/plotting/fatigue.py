"""Figure of the fatigue damage over the wind speed, from the dataset of `FatigueDamage.to_dataset`."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from frahm import readable
from frahm.arrays import Floats
from frahm.plotting.panels import name_panels, panels
from frahm.plotting.plain import PlainFigure
from frahm.plotting.style import BARE, PIPE, SINK, UNSTABLE_DASHES, decade_axis
from frahm.units import MPA

if TYPE_CHECKING:
    import xarray as xr
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

SPEED_LABEL = "wind speed [m/s]"
DECADES = 7.0  # of damage that are shown: what lies lower adds nothing
_BARE_LOOK: dict[str, Any] = {"color": BARE, "linestyle": ":", "linewidth": 1.6}
_MARKS = {"periodic": "o", "quasi-periodic": "D", "chaotic": "s", "unsettled": "x", "linear": ""}


def fatigue_figure(damage: xr.Dataset) -> Figure:
    """Damage per wind speed, so that bins of different width compare, and largest stress range, with and without."""
    figure, axes = panels(2, 1, 160, 130, sharex=True)
    (upper,), (lower,) = axes
    edges = bin_edges(damage)
    for name, label, look in _lines(damage):
        upper.stairs(per_speed(damage, name), edges, baseline=None, label=label, **look)
    upper.set(yscale="log", ylabel="damage per wind speed [s/m]", ylim=damage_range(damage))
    decade_axis(upper.yaxis)
    without = damage["stress_range_without"].values / MPA
    lower.stairs(
        np.where(np.isfinite(without), without, np.nan), edges, baseline=None, label="without absorbers", **_BARE_LOOK
    )
    if has_absorber(damage):
        _draw_worst(lower, damage)
    lower.set(xlabel=SPEED_LABEL, ylabel="hot-spot stress range [MPa]", ylim=(0, None))
    name_panels(axes, ("Fatigue damage over the wind", "Largest stress range"))
    upper.legend(loc="best")
    lower.legend(loc="best")
    return figure


def fatigue_plot(damage: xr.Dataset) -> PlainFigure:
    """The same for the browser."""
    from frahm.plotting.interactive import plot_layout

    figure = PlainFigure((1.0, 1.0), gap=0.08, shared=True)
    edges = bin_edges(damage)
    dashes = {"damage_without": "dot", "damage_with_weighted": "dash", "damage_with": "solid"}
    for name, label, look in _lines(damage):
        line = {"color": look["color"], "dash": dashes[name], "shape": "hv"}
        values = per_speed(damage, name)
        figure.add_scatter(x=edges, y=np.append(values, values[-1:]), mode="lines", line=line, name=label, row=1)
    ranges = damage["stress_range_without"].values / MPA
    line = {"color": BARE, "dash": "dot", "shape": "hv"}
    figure.add_scatter(
        x=edges, y=np.append(ranges, ranges[-1:]), mode="lines", line=line, showlegend=False, row=2,
        name="without absorbers",
    )  # fmt: skip
    if has_absorber(damage):
        kinds = damage["kind"].attrs["kinds"].split(", ")
        figure.add_scatter(
            x=damage["speed"].values, y=damage["stress_range_with"].values / MPA, mode="lines+markers",
            line={"color": PIPE, "width": 1}, showlegend=False, name="worst motion", row=2,
            text=[readable.motion(kinds[code]) for code in damage["kind"].values],
            hovertemplate="%{x:.3f} m/s<br>%{y:.3g} MPa<br>%{text}",
        )  # fmt: skip
    decades = [float(np.log10(value)) for value in damage_range(damage)]
    figure.update_layout(**plot_layout(620))
    figure.update_layout(legend={"yanchor": "bottom", "y": 1.02})
    figure.update_axes(
        "y", title={"text": "damage per wind speed [s/m]"}, type="log", range=decades, exponentformat="power",
        dtick=1, row=1,
    )  # fmt: skip
    figure.update_axes("y", title={"text": "hot-spot stress range [MPa]"}, rangemode="tozero", row=2)
    figure.update_axes("x", title={"text": SPEED_LABEL}, row=2)
    return figure


def has_absorber(damage: xr.Dataset) -> bool:
    """Whether the pipe with absorbers differs from the pipe without."""
    return not np.array_equal(damage["damage_with"].values, damage["damage_without"].values)


def bin_edges(damage: xr.Dataset) -> Floats:
    """Ends of the wind bins [m/s], shape (b + 1,)."""
    return np.append(damage["speed_lower"].values, damage["speed_upper"].values[-1])


def per_speed(damage: xr.Dataset, name: str) -> Floats:
    """Damage of each bin over its width [s/m]; NaN where there is none."""
    values = damage[name].values / np.diff(bin_edges(damage))
    return np.where(np.isfinite(values) & (values > 0), values, np.nan)


def damage_range(damage: xr.Dataset) -> tuple[float, float]:
    """Range of the axis of `per_speed` that is worth a look."""
    values = np.concatenate([per_speed(damage, name) for name in ("damage_with", "damage_without")])
    if not np.any(np.isfinite(values)):
        return 1e-12, 1.0
    top, bottom = float(np.nanmax(values)), float(np.nanmin(values))
    return max(0.5 * bottom, top * 10**-DECADES), 3 * top


def _lines(damage: xr.Dataset) -> list[tuple[str, str, dict[str, Any]]]:
    lines: list[tuple[str, str, dict[str, Any]]] = [
        ("damage_without", "without absorbers", _BARE_LOOK),
    ]
    if has_absorber(damage):
        lines += [
            ("damage_with_weighted", "weighted by basins", {"color": SINK, "linestyle": UNSTABLE_DASHES}),
            ("damage_with", "worst motion at every wind", {"color": PIPE}),
        ]
    return lines


def _draw_worst(axes: Axes, damage: xr.Dataset) -> None:
    """Stress range of the worst attractor, its kind marked."""
    speeds, ranges = damage["speed"].values, damage["stress_range_with"].values / MPA
    ranges = np.where(np.isfinite(ranges), ranges, np.nan)
    axes.plot(speeds, ranges, "-", color=PIPE, linewidth=0.8, label="with absorbers, worst motion")
    kinds = damage["kind"].attrs["kinds"].split(", ")
    codes = damage["kind"].values
    for code, kind in enumerate(kinds):
        here = codes == code
        if here.any() and _MARKS[kind]:
            axes.plot(
                speeds[here], ranges[here], _MARKS[kind], color=PIPE, markersize=3.5,
                markerfacecolor="none" if kind == "periodic" else PIPE, label=readable.motion(kind),
            )  # fmt: skip
