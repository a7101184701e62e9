"""The basin map: which attractor an initial state leads to."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from frahm import readable
from frahm.plotting.lines import MM
from frahm.plotting.style import BLUE, GREEN, INK, ORANGE, PURPLE, SKY, VERMILLION, legend_below, new_figure

if TYPE_CHECKING:
    import xarray as xr
    from matplotlib.figure import Figure

_YELLOW = "#F0E442"
_COLOURS = (ORANGE, BLUE, _YELLOW, GREEN, PURPLE, SKY, VERMILLION, "#999999")  # the first apart in grey, too
_LOST = {
    -1: ("not settled", "#d0d0d0"), -2: ("escaped", INK), -3: ("too stiff to follow", "#8a8a8a"),
    -4: ("not computed", "#ffffff"),
}  # fmt: skip
BASIN_AXES = {
    "x1": "initial displacement of the pipe x₁ [mm]", "v1": "initial velocity of the pipe [mm/s]",
    "z": "initial displacement of the absorber z [mm]", "w": "initial velocity of the absorber [mm/s]",
}  # fmt: skip


class Entry(NamedTuple):
    """One colour of the map: its label in the dataset, and what the legend says."""

    label: int
    text: str
    colour: str


def basin_map_figure(data: xr.Dataset) -> Figure:
    """Map of the attractors reached over a plane of initial states, with a legend that names each.

    Parameters
    ----------
    data : Dataset
        From `frahm.basin_map`.

    Returns
    -------
    matplotlib.figure.Figure
        Save it with `.savefig`.
    """
    from matplotlib.colors import ListedColormap
    from matplotlib.patches import Patch

    across, up = data["label"].dims
    entries, index = basin_entries(data), basin_indices(data)
    colours = ListedColormap([entry.colour for entry in entries])
    figure = new_figure(160, 120)
    axes = figure.subplots()
    axes.pcolormesh(
        MM * data[across].values, MM * data[up].values, index.T, cmap=colours,
        vmin=-0.5, vmax=len(entries) - 0.5, shading="nearest", rasterized=True,
    )  # fmt: skip
    axes.plot(0, 0, "+", color=INK, markersize=9, markeredgewidth=1.2, label="rest")
    axes.grid(visible=False)
    axes.set(xlabel=BASIN_AXES[str(across)], ylabel=BASIN_AXES[str(up)])
    handles: list[Any] = [Patch(facecolor=e.colour, edgecolor=INK, linewidth=0.5, label=e.text) for e in entries]
    handles += axes.get_legend_handles_labels()[0]
    legend_below(figure, 1, handles=handles)
    return figure


def basin_entries(data: xr.Dataset) -> list[Entry]:
    """Everything that is on the map, attractors first."""
    kinds = data["kind"].attrs["kinds"].split(", ")
    present = set(np.unique(data["label"].values).tolist())
    entries = [
        Entry(i, _name(kinds[int(attractor["kind"])], attractor), _COLOURS[i % len(_COLOURS)])
        for i, attractor in ((i, data.isel(attractor=i)) for i in range(data.sizes["attractor"])) if i in present
    ]  # fmt: skip
    return entries + [Entry(code, text, colour) for code, (text, colour) in _LOST.items() if code in present]


def _name(kind: str, attractor: xr.Dataset) -> str:
    share = 100 * float(attractor["basin_fraction"])
    return f"{readable.motion(kind)}, pipe {readable.length(float(attractor['pipe_peak']))} ({share:.3g} % of the map)"


def basin_indices(data: xr.Dataset) -> np.ndarray:
    """Position in `basin_entries` of every label, in the order of the dimensions."""
    labels = data["label"].values
    index = np.zeros(labels.shape, dtype=int)
    for position, entry in enumerate(basin_entries(data)):
        index[labels == entry.label] = position
    return index
