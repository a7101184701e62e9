"""Figure of the response over the wind speed, with and without absorbers, on paper and for the browser."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from frahm.plotting.interactive import plot_layout, single
from frahm.plotting.lines import (
    MM,
    SPEED_LABEL,
    largest_finite,
    line_colour,
    line_width,
    lines_by_name,
    response_lines,
)
from frahm.plotting.plain import PlainFigure
from frahm.plotting.style import BARE, UNSTABLE_DASHES, legend_below, new_figure

if TYPE_CHECKING:
    import xarray as xr
    from matplotlib.figure import Figure

_PEAK_LABEL = "largest displacement of the pipe [mm]"


def over_wind_figure(curve: xr.Dataset, bare: xr.Dataset) -> Figure:
    """Periodic responses over the wind speed: stable solid, unstable dashed, the pipe without absorbers dotted."""
    figure = new_figure(160, 95)
    axes = figure.subplots()
    for name, line in lines_by_name(response_lines(curve, "pipe_peak", "wind_speed")).items():
        style = "-" if line.stable else UNSTABLE_DASHES
        axes.plot(line.x, MM * line.y, linestyle=style, color=line_colour(line), linewidth=line_width(line), label=name)
    axes.plot(bare["wind_speed"].values, MM * bare["pipe_peak"].values, ":", color=BARE, label="without absorbers")
    top = max(largest_finite(data["pipe_peak"].values) for data in (curve, bare))
    axes.set(xlabel=SPEED_LABEL, ylabel=_PEAK_LABEL, ylim=(0, 1.08 * MM * top or 1.0))
    axes.margins(x=0)
    legend_below(figure)
    return figure


def over_wind_plot(curve: xr.Dataset, bare: xr.Dataset) -> PlainFigure:
    """The same for the browser."""
    figure = PlainFigure()
    hover = "U %{x:.4f} m/s<br>%{y:.4g} mm"
    for name, line in lines_by_name(response_lines(curve, "pipe_peak", "wind_speed")).items():
        look: dict[str, Any] = {"color": line_colour(line), "dash": "solid" if line.stable else "dash"}
        look["width"] = 1.3 * line_width(line)
        figure.add_scatter(
            x=single(line.x), y=single(MM * line.y), mode="lines", line=look, name=name, hovertemplate=hover
        )
    figure.add_scatter(
        x=single(bare["wind_speed"].values), y=single(MM * bare["pipe_peak"].values), mode="lines",
        name="without absorbers",
        line={"color": BARE, "dash": "dot", "width": 1.5}, hovertemplate=hover,
    )  # fmt: skip
    figure.update_layout(**plot_layout(430))
    figure.update_axes("x", title={"text": SPEED_LABEL})
    figure.update_axes("y", title={"text": _PEAK_LABEL}, rangemode="tozero", title_standoff=8)
    return figure
