"""All figures of an analysis, by file name, in the order a report shows them."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Any

from frahm.exchange import write_data
from frahm.plotting.basins import basin_map_figure
from frahm.plotting.decision import decision_figure, marks_of
from frahm.plotting.fatigue import fatigue_figure
from frahm.plotting.figure_data import figure_data
from frahm.plotting.over_wind import over_wind_figure
from frahm.plotting.static import manifold_figure, motion_figure, response_figure
from frahm.plotting.style import figure_style, save_figure
from frahm.plotting.views import motion_views, trajectory_to_show
from frahm.plotting.wind import gusts_figure

if TYPE_CHECKING:
    import xarray as xr
    from matplotlib.figure import Figure

Drawing = tuple[str, Callable[[], "Figure"]]


def save_figures(results: dict[str, Any], data: dict[str, xr.Dataset], folder: str | Path) -> list[Path]:
    """Draw every figure the results allow into an existing folder, as SVG and PNG, with CSV; return the paths."""
    paths = []
    with figure_style():
        for name, draw in drawings(results, data):
            paths += save_figure(draw(), Path(folder) / name, narrow=name == "decision")
    for name, dataset in figure_data(results, data):
        paths += write_data(dataset, Path(folder) / f"{name}.csv")
    return paths


def stands_over_wind(data: dict[str, xr.Dataset]) -> bool:
    """Whether the response itself is over the wind, so that a figure over the wind would show it again."""
    return "response" in data and "wind_speed" in data["response"]


def bare_beside(results: dict[str, Any], data: dict[str, xr.Dataset]) -> xr.Dataset | None:
    """The response without absorbers, to stand beside that of a case; nothing where the case has none either."""
    return data.get("without_absorber") if results["has_absorber"] else None


def drawings(results: dict[str, Any], data: dict[str, xr.Dataset]) -> Iterator[Drawing]:
    """Name and drawing of every figure the results allow."""
    views = motion_views(results, data)
    if "decision" in data:
        yield "decision", partial(decision_figure, data["decision"], marks_of(results))
    curve, bare = data.get("response"), bare_beside(results, data)
    if curve is not None:
        for quantity, name in (("pipe_peak", "response-pipe"), ("relative_peak", "response-absorber")):
            if quantity in curve:
                yield (
                    name,
                    partial(
                        response_figure, curve, quantity, views, bare, data.get("slow_flow"), data.get("modulated")
                    ),
                )
    for view in views:
        yield f"motion-{view.key}", partial(motion_figure, view)
    if "response_over_wind" in data and not stands_over_wind(data):
        yield (
            "response-over-wind",
            partial(over_wind_figure, data["response_over_wind"], data["without_absorber_over_wind"]),
        )
    if "unsteady_wind" in data:
        yield "unsteady-wind", partial(gusts_figure, data["unsteady_wind"])
    if "slow_manifold" in data:
        folds = results["slow_manifold"]["folds"]
        yield "slow-manifold", partial(manifold_figure, data["slow_manifold"], trajectory_to_show(views), folds)
    if "basin_map" in data:
        yield "basin-map", partial(basin_map_figure, data["basin_map"])
    if "fatigue" in data:
        yield "fatigue", partial(fatigue_figure, data["fatigue"])
