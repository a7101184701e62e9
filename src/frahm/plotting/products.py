"""Figure of a design of products: utilisation of the members over their frequency, with and without a device."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import TYPE_CHECKING, Any

from frahm.plotting.style import (
    BLUE,
    GREEN,
    GREY,
    INK,
    ORANGE,
    PURPLE,
    SKY,
    VERMILLION,
    decade_axis,
    figure_style,
    legend_below,
    new_figure,
    save_figure,
)

if TYPE_CHECKING:
    from matplotlib.figure import Figure

_LOOKS = (
    (BLUE, "o"), (VERMILLION, "s"), (GREEN, "^"), (ORANGE, "D"), (PURPLE, "v"), (SKY, "P"), (INK, "X"), (BLUE, "*"),
    (VERMILLION, "<"), (GREEN, ">"), (ORANGE, "p"), (PURPLE, "h"),
)  # fmt: skip
_LEAST = 1e-3  # utilisation below which a member is as good as still


def save_products_figure(product: Mapping[str, Any], folder: str | Path) -> list[Path]:
    """Draw the members of a product, a row of `results.products`, as SVG and PNG; return the paths."""
    with figure_style():
        return save_figure(products_figure(product), Path(folder) / "products-utilisation", narrow=True)


def products_figure(product: Mapping[str, Any]) -> Figure:
    """Largest utilisation of every member over its natural frequency; hollow where it is not verified."""
    figure = new_figure(160, 100)
    axes = figure.subplots()
    rows = [row for row in product["members"] if row["utilisation"] is not None]
    bare = [(row["natural_frequency_hz"], row["utilisation_without"]) for row in product["members"]]
    axes.plot(*zip(*bare, strict=True), "x", color=GREY, markersize=5, label="without an absorber")
    for row in rows:
        ends = row["utilisation_without"], max(row["utilisation"], _LEAST)
        axes.plot([row["natural_frequency_hz"]] * 2, ends, color=GREY, linewidth=0.5, alpha=0.5)
    for kind, (colour, marker) in zip(product["kinds"], _LOOKS, strict=False):
        own = [row for row in rows if row["kind"] == kind["kind"]]
        for verified in (True, False):
            part = [(row["natural_frequency_hz"], max(row["utilisation"], _LEAST)) for row in own
                    if row["verified"] == verified]  # fmt: skip
            if part:
                label = f"with kind {kind['kind']}, {kind['mass']:.3g} kg" + ("" if verified else ", not verified")
                axes.plot(*zip(*part, strict=True), marker, color=colour, markersize=6, label=label,
                          markerfacecolor=colour if verified else "white")  # fmt: skip
    axes.axhline(1.0, color=INK, linewidth=1.0, label="limit")
    axes.set(xscale="log", yscale="log", xlabel="natural frequency [Hz]", ylabel="largest utilisation of a limit [-]")
    _label_frequencies(axes.xaxis, [row["natural_frequency_hz"] for row in product["members"]])
    decade_axis(axes.yaxis)
    legend_below(figure, 3)
    return figure


def _label_frequencies(axis: Any, frequencies: list[float]) -> None:
    """Round frequencies over the range of the members as plain numbers."""
    from matplotlib.ticker import FixedLocator, FuncFormatter, NullLocator

    low, high = 0.9 * min(frequencies), 1.1 * max(frequencies)
    steps = [digit * 10.0**power for power in range(-4, 5) for digit in (1, 1.5, 2, 3, 5, 7)]
    axis.set_major_locator(FixedLocator([step for step in steps if low <= step <= high]))
    axis.set_minor_locator(NullLocator())
    axis.set_major_formatter(FuncFormatter(lambda value, _: f"{value:g}"))
    axis.axes.set_xlim(low, high)
