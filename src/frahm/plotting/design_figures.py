"""Figures of a design: the devices compared, over errors of the pipe's frequency, and what a force margin costs."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from frahm.exchange import write_data
from frahm.plotting.decision import DEVICE_LOOKS, DEVICES, Marks, decision_figure
from frahm.plotting.lines import MM
from frahm.plotting.static import response_figure
from frahm.plotting.style import GREY, INK, VERMILLION, figure_style, legend_below, new_figure, save_figure

if TYPE_CHECKING:
    import xarray as xr
    from matplotlib.figure import Figure


def save_design_figures(
    data: xr.Dataset, folder: str | Path, curve: xr.Dataset, lasting: xr.Dataset | None, marks: Marks
) -> list[Path]:
    """Draw what the dataset of a design study holds into an existing folder, as PNG and SVG, with CSV; return paths.

    `curve` is the exact response with the chosen design, `lasting` what lasts with every device; None where the
    work was interrupted before they were compared.
    """
    drawings: list[tuple[str, str, Callable[[], Figure]]] = [
        ("design-comparison", "rival", lambda: comparison_figure(data)),
        ("design-response", "point", lambda: response_figure(curve, "pipe_peak", [], None, None, None)),
    ]
    if data.sizes["device"]:
        drawings.append(("design-frequency-errors", "error_index", lambda: frequency_error_figure(data)))
    if data.sizes["margin_index"]:
        drawings.append(("design-margin", "margin_index", lambda: margin_figure(data)))
    paths = []
    with figure_style():
        if lasting is not None:
            paths += save_figure(decision_figure(lasting, marks), Path(folder) / "decision", narrow=True)
            paths += write_data(lasting, Path(folder) / "decision.csv")
        for name, _, draw in drawings:
            paths += save_figure(draw(), Path(folder) / name, narrow=True)
    for name, dimension, _ in drawings:
        paths += write_data(_shown(curve if dimension == "point" else data, dimension), Path(folder) / f"{name}.csv")
    return paths


def _shown(data: xr.Dataset, dimension: str) -> xr.Dataset:
    """The variables along one dimension; a device each where there are several."""
    kept = data[[name for name in data if data[name].dims == (dimension,)]]
    if dimension == "error_index":
        names = data["error_pipe_peak"].attrs["names"].split(", ")
        for row, name in enumerate(names):
            kept[name.replace(" ", "_").replace("-", "_")] = data["error_pipe_peak"][row].drop_attrs().assign_attrs(
                units="m", long_name=f"largest pipe peak with device: {DEVICES[name]}"
            )  # fmt: skip
    return kept


def comparison_figure(data: xr.Dataset) -> Figure:
    """Value of the objective of every device as bars; what is unverified is hatched."""
    names = data["comparison_pipe_peak"].attrs["names"].split(", ")
    peaks, sure = data["comparison_value"].values, data["comparison_verified"].values.astype(bool)
    title, unit, factor = _titled(data["comparison_value"])
    peaks = factor * peaks
    figure = new_figure(160, 22 + 11 * len(names))
    axes = figure.subplots()
    for row, (name, peak, verified) in enumerate(zip(names, peaks, sure, strict=True)):
        color = DEVICE_LOOKS[name][0]
        axes.barh(row, peak, color=color if verified else "white", edgecolor=color, hatch=None if verified else "///")
        words = f"{peak:#.3g} {unit}".rstrip() + ("" if verified else ", unverified")
        axes.annotate(words, (peak, row), (4, 0), textcoords="offset points", va="center", color=INK)
    axes.set(xlim=(0, 1.2 * np.max(peaks)), xlabel=f"{title} over all attractors [{unit or '-'}]")
    axes.set_yticks(range(len(names)), [DEVICES[name] for name in names])
    axes.invert_yaxis()
    axes.grid(visible=False, axis="y")
    return figure


def frequency_error_figure(data: xr.Dataset) -> Figure:
    """Worst pipe peak of every device over the error of the pipe's frequency; open marks are unverified."""
    names = data["error_pipe_peak"].attrs["names"].split(", ")
    errors = 100 * data["error"].values
    figure = new_figure(160, 100)
    axes = figure.subplots()
    for name, peaks, sure in zip(names, data["error_pipe_peak"].values, data["error_verified"].values, strict=True):
        color, style, marker = DEVICE_LOOKS[name]
        axes.plot(errors, MM * peaks, color=color, linestyle=style, label=DEVICES[name])
        for error, peak, verified in zip(errors, peaks, sure, strict=True):
            axes.plot(
                error, MM * peak, marker, color=color, markersize=5, markerfacecolor=color if verified else "white"
            )
    axes.set_yscale("log")
    axes.yaxis.set_major_formatter(lambda value, _: f"{value:g}")
    axes.set(xlabel="error of the pipe's natural frequency [%], devices not retuned", ylabel="worst pipe peak [mm]")
    legend_below(figure)
    return figure


def margin_figure(data: xr.Dataset) -> Figure:
    """Value of the objective of the best design under every force margin."""
    margin, peaks = data["force_margin"].values, data["margin_value"].values
    title, unit, factor = _titled(data["margin_value"])
    peaks = factor * peaks
    figure = new_figure(160, 85)
    axes = figure.subplots()
    axes.plot(margin, peaks, "-o", color=VERMILLION, markersize=5)
    columns = (data[f"margin_{name}"].values for name in ("linear", "kappa", "xi2"))
    for x, y, linear, kappa, xi2 in zip(margin, peaks, *columns, strict=True):
        words = ([f"k₁ {linear:.3f}"] if linear else []) + [f"κ {kappa:.0f}", f"ξ₂ {xi2:.3f}"]
        look: dict[str, Any] = {
            "textcoords": "offset points",
            "va": "top",
            "ha": "center",
            "fontsize": 7.5,
            "color": GREY,
        }
        axes.annotate("\n".join(words), (x, y), (0, -9), **look)
    spread = float(np.ptp(peaks)) or 0.1 * float(peaks[0])
    axes.set_ylim(float(np.min(peaks)) - 0.45 * spread, float(np.max(peaks)) + 0.15 * spread)
    axes.margins(x=0.12)
    axes.set(
        xlabel="force up to which no detached curve exists, over the force given", ylabel=f"{title} [{unit or '-'}]"
    )
    return figure


def _titled(variable: xr.DataArray) -> tuple[str, str, float]:
    """Long name, unit and factor to it of a variable: metres are shown as millimetres, a plain number as it is."""
    name, unit = variable.attrs["long_name"], variable.attrs["units"]
    return (name, "mm", MM) if unit == "m" else (name, "" if unit == "1" else unit, 1.0)
