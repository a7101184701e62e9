"""Figures of a screening: how far every member uses its limits, and where its critical wind and its damping put it."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

from matplotlib.patheffects import withStroke

from frahm.plotting.style import (
    BLUE,
    GREEN,
    GREY,
    INK,
    ORANGE,
    SKY,
    VERMILLION,
    decade_axis,
    figure_style,
    legend_below,
    new_figure,
    save_figure,
)
from frahm.screening import FAIL, LOOK_CLOSER, PASS

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

Row = Mapping[str, Any]
LOOKS = {FAIL: (VERMILLION, "X"), LOOK_CLOSER: (ORANGE, "^"), PASS: (GREEN, "o")}
MOST_BARS = 30
_LEAST = 1e-3  # utilisation below which bars are as good as none
_USED = "largest utilisation of a limit [-]"
_LONGEST = 18  # characters of a name
_CRITERIA = ((16.0, "K$_s$ = 16: Brown & Root, DNV"), (18.0, "18: Moe & Arild"), (28.0, "28: seen at Statfjord A"))
_STYLES = ("-", "--", ":")


def save_member_figures(rows: Sequence[Row], folder: str | Path) -> list[Path]:
    """Draw both figures into an existing folder, as SVG and PNG; return the paths.

    Parameters
    ----------
    rows : sequence of mapping
        Members as the summary has them, the worst first.
    folder : str or Path
    """
    paths: list[Path] = []
    with figure_style():
        if any(row["largest_utilisation"] is not None for row in rows):
            paths += save_figure(utilisation_figure(rows), Path(folder) / "members-utilisation", narrow=True)
        if any(row["critical_wind"] is not None for row in rows):
            paths += save_figure(wind_figure(rows), Path(folder) / "members-wind", narrow=True)
    return paths


def utilisation_figure(rows: Sequence[Row]) -> Figure:
    """Largest utilisation of every member: bars with names for a few members, points in their order for many."""
    known = [row for row in rows if row["largest_utilisation"] is not None]
    return _bars(known) if len(known) <= MOST_BARS else _ranked(known)


def _bars(rows: Sequence[Row]) -> Figure:
    """A bar a member; who fails is solid, who is open hatched, who passes faint."""
    figure = new_figure(160, 26 + 5 * len(rows))
    axes = figure.subplots()
    drawn: set[str] = set()
    for place, row in enumerate(rows):
        colour, word, used = LOOKS[row["verdict"]][0], row["verdict"], row["largest_utilisation"]
        is_open, faint = word == LOOK_CLOSER, 0.55 if word == PASS else None
        looks: dict[str, Any] = {"facecolor": "white", "hatch": "////"} if is_open else {"facecolor": colour}
        label = "_" if word in drawn else word
        drawn.add(word)
        start, end = _LEAST / 2, max(used, _LEAST)
        axes.barh(place, end - start, 0.7, start, edgecolor=colour, label=label, alpha=faint, **looks)
        text = f"{used:.3g}" if used >= _LEAST else f"below {_LEAST:g}"
        axes.annotate(text, (end, place), (3, 0), textcoords="offset points", va="center", fontsize=7, color=INK,
                      path_effects=[withStroke(linewidth=2, foreground="white")], zorder=5)  # fmt: skip
    axes.axvline(1.0, color=INK, linewidth=1.0, label="limit")
    axes.set_yticks(range(len(rows)), [_short(row["name"]) for row in rows], fontsize=7.5)
    axes.set(xscale="log", xlim=(_LEAST / 2, _top(rows)), ylim=(len(rows) - 0.4, -0.6), xlabel=_USED)
    decade_axis(axes.xaxis)
    axes.grid(visible=False, axis="y")
    legend_below(figure, 4)
    return figure


def _ranked(rows: Sequence[Row]) -> Figure:
    """A point a member, the worst first; what is too small to matter lies on the lower edge."""
    figure = new_figure(160, 95)
    axes = figure.subplots()
    for word, (colour, marker) in LOOKS.items():
        own = [(place, max(row["largest_utilisation"], _LEAST)) for place, row in enumerate(rows, start=1)
               if row["verdict"] == word]  # fmt: skip
        if own:
            axes.plot(*zip(*own, strict=True), marker, color=colour, markersize=4, markeredgewidth=0, label=word)
    axes.axhline(1.0, color=INK, linewidth=1.0, label="limit")
    axes.set(yscale="log", ylim=(_LEAST / 2, _top(rows)), xlim=(0, len(rows) + 1), ylabel=_USED,
             xlabel="member, in the order of the table below")  # fmt: skip
    decade_axis(axes.yaxis)
    legend_below(figure, 4)
    return figure


def _top(rows: Sequence[Row]) -> float:
    return 4 * max(1.0, *(row["largest_utilisation"] for row in rows))


def wind_figure(rows: Sequence[Row]) -> Figure:
    """Mass damping over the critical wind of every member, with what criteria say, and the strongest wind."""
    known = [row for row in rows if row["critical_wind"] is not None and row["scruton_number"] is not None]
    figure = new_figure(160, 100)
    axes = figure.subplots()
    for word, (colour, marker) in LOOKS.items():
        own = [row for row in known if row["verdict"] == word]
        if own:
            axes.plot([row["critical_wind"] for row in own], [row["scruton_number"] for row in own], marker,
                      color=colour, markersize=6, markeredgecolor="white", markeredgewidth=0.5, label=word)  # fmt: skip
    for (K, text), style in zip(_CRITERIA, _STYLES, strict=True):
        axes.axhline(K, color=GREY, linewidth=0.9, linestyle=style, label=text)
    _shade_winds(axes, known)
    largest = max([row["scruton_number"] for row in known] + [_CRITERIA[-1][0]])
    axes.set(xlim=(0, 1.05 * max(row["critical_wind"] for row in known)), ylim=(0, 1.1 * largest),
             xlabel="critical wind of the first mode, v$_{crit}$ = f D / St [m/s]",
             ylabel="mass damping K$_s$ [-]")  # fmt: skip
    legend_below(figure, 3)
    return figure


def _shade_winds(axes: Axes, rows: Sequence[Row]) -> None:
    """The winds of the site, where all members stand in the same."""
    sites = {tuple(row["site_winds"]) for row in rows}
    if len(sites) != 1:
        return
    low, high = sites.pop()
    if high is not None and math.isfinite(high):
        axes.axvspan(low or 0.0, high, color=SKY, alpha=0.13, linewidth=0, label="winds of the site")
        axes.axvline(high, color=BLUE, linewidth=0.8)


def _short(name: str) -> str:
    """A name as a label: of a long one the middle is left out, as its end tells members apart.

    A blank stands in front, so that letters drawn a little wider than measured are not cut.
    """
    half = (_LONGEST - 1) // 2
    text = name if len(name) <= _LONGEST else name[:half] + "\N{HORIZONTAL ELLIPSIS}" + name[-half:]
    return "\N{EN SPACE}" + text.replace("$", r"\$")
