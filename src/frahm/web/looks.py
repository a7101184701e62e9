"""How the figures of the page look: sent once with the page, so that a drawing carries nothing but numbers."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

from frahm.plotting.lines import DETUNING_LABEL
from frahm.plotting.style import BARE, GREEN, INK, ORANGE, PAIR, PIPE, SINK, SKY

HEIGHTS = {"response": 520, "map": 380, "manifold": 380, "motion": 720}  # [px]
CONFIG = {
    "displaylogo": False, "showSendToCloud": False, "responsive": True,
    "modeBarButtonsToRemove": ["select2d", "lasso2d", "autoScale2d"],
}  # fmt: skip
QUANTITIES = ("pipe_peak", "relative_peak")


@dataclass(frozen=True)
class Kind:
    """Lines of one look.

    Attributes
    ----------
    name : str
        What the legend says.
    colour : str
    stable : bool
        Drawn solid; dashed otherwise.
    """

    name: str
    colour: str
    stable: bool


KINDS = {  # detached, asymmetric, stable
    (False, False, True): Kind("stable", PIPE, True),
    (False, False, False): Kind("unstable", PIPE, False),
    (True, False, True): Kind("detached, stable", SINK, True),
    (True, False, False): Kind("detached, unstable", SINK, False),
    (False, True, True): Kind("asymmetric, stable", PAIR, True),
    (False, True, False): Kind("asymmetric, unstable", PAIR, False),
}
SLOW_KINDS = tuple(key for key in KINDS if not key[1])  # one harmonic has no asymmetric response
EXACT_KINDS = tuple(KINDS)

# Classes of the stability map, by number of responses and of stable ones.
MAP_CLASSES = (
    "one response, stable",
    "three responses, two stable",
    "three responses, one stable",
    "three responses, none stable",
    "one response, unstable",
)
MAP_COLOURS = ("#eef3f7", SKY, "#0b5c8f", "#a33c00", ORANGE)
SYMBOLS = {
    "saddle-node": "triangle-up", "hopf": "square", "neimark-sacker": "diamond",
    "period-doubling": "triangle-down", "branch-point": "cross",
}  # fmt: skip
BARE_LINE = "without absorber"
TUNED_LINE = "tuned mass damper of the same mass"
MARK = {"color": INK, "size": 8}  # of a special point
WIND_LABEL = "wind speed U [m/s]"
_AT_DETUNING, _AT_WIND = "σ %{x:.4f} rad/s", "U %{x:.4g} m/s, sheds at %{customdata:.4g} Hz"
_HOVER = _AT_DETUNING + "<br>%{y:.4g} m"


def kind_look(method: str, key: tuple[bool, bool, bool]) -> str:
    """Name of the look of the lines of a kind, "exact" or "slow"."""
    return f"{method} {EXACT_KINDS.index(key)}"


def _line(name: str, colour: str, dash: str, width: float) -> dict[str, Any]:
    line = {"color": colour, "dash": dash, "width": width}
    return {"type": "scatter", "mode": "lines", "name": name, "line": line, "hovertemplate": _HOVER}


def _kind_line(method: str, key: tuple[bool, bool, bool]) -> dict[str, Any]:
    kind, slow = KINDS[key], method == "slow"
    colour = INK if slow and not key[0] else kind.colour
    name = f"{'slow flow' if slow else 'exact'}, {kind.name}"
    look = _line(name, colour, "solid" if kind.stable else "dash", 1.3 if slow else 3.2)
    look["line"]["simplify"] = slow  # what is drawn once need not leave out points to be quick
    return look


def _marks(name: str, marker: dict[str, Any], mode: str = "markers", hover: str = "") -> dict[str, Any]:
    look = {"type": "scatter", "mode": mode, "name": name, "marker": marker, "cliponaxis": False}
    return look | {"hovertemplate": hover + _HOVER}


_RING = {"size": 11, "color": "white", "symbol": "circle", "line": {"color": SINK, "width": 3}}
_STAR = {"color": GREEN, "size": 16, "symbol": "star", "line": {"color": INK, "width": 1}}

# Looks of the lines of the response, drawn from first to last.
RESPONSE_LOOKS: dict[str, dict[str, Any]] = {
    "bare": _line(BARE_LINE, BARE, "dot", 1.5),
    **{kind_look("exact", key): _kind_line("exact", key) for key in EXACT_KINDS},
    **{kind_look("slow", key): _kind_line("slow", key) for key in SLOW_KINDS},
    "tuned": _line(TUNED_LINE, GREEN, "dashdot", 1.8),
    "attractors": _marks("attractor found", _STAR, hover="%{text}<br>"),
    "special": _marks("special point", MARK, "markers+text", hover="%{text}<br>"),
    "here": _marks("at the detuning set", _RING),
}
MANIFOLD_LOOKS: dict[str, dict[str, Any]] = {
    "attracting": {"mode": "lines", "name": "attracting", "line": {"color": INK, "dash": "solid", "width": 2}},
    "repelling": {"mode": "lines", "name": "repelling", "line": {"color": INK, "dash": "dash", "width": 2}},
    "motion": {"mode": "lines", "name": "motion", "line": {"color": GREEN, "width": 1}},
    "fold": {"mode": "markers", "name": "fold", "marker": {"color": INK, "size": 10, "symbol": "triangle-up"}},
    "response": {"mode": "markers", "name": "response", "marker": _RING},
}


def _map_looks() -> dict[str, dict[str, Any]]:
    count = len(MAP_COLOURS)
    scale = [[(at + up) / count, colour] for at, colour in enumerate(MAP_COLOURS) for up in (0, 1)]
    cross = {"symbol": "cross", "size": 13, "color": "white", "line": {"color": INK, "width": 2}}
    return {
        "classes": {
            "type": "heatmap", "zmin": -0.5, "zmax": count - 0.5, "colorscale": scale, "showscale": False,
            "hoverinfo": "x+y", "name": "",
        },
        "now": {"type": "scatter", "mode": "markers", "name": "set now", "marker": cross},
    }  # fmt: skip


def _axis(title: str = "", **more: Any) -> dict[str, Any]:
    """An axis; margin and labels are fixed, because measuring what fits would be paid for at every drawing."""
    return {
        "title": {"text": title}, "showline": True, "linecolor": INK, "ticks": "outside", "tickcolor": INK,
        "showgrid": False, "zeroline": False, "tickangle": 0, "ticklabeloverflow": "allow", **more,
    }  # fmt: skip


def _layout(height: int, **axes: dict[str, Any]) -> dict[str, Any]:
    return {
        "height": height, "margin": {"l": 78, "r": 14, "t": 30, "b": 48}, "uirevision": "kept",
        "showlegend": False,  # the keys stand on the page
        "font": {"family": "system-ui, sans-serif", "size": 13, "color": INK}, "hoverlabel": {"namelength": -1},
        **axes,
    }  # fmt: skip


def figures() -> dict[str, Any]:
    """Everything about the figures that stands still, as the script of the page takes it."""
    return {
        "config": CONFIG,
        "looks": {"response": RESPONSE_LOOKS, "manifold": MANIFOLD_LOOKS, "map": _map_looks()},
        "layouts": {
            "response": _layout(
                HEIGHTS["response"],
                xaxis=_axis(domain=[0, 1], anchor="y", matches="x2", showticklabels=False),
                xaxis2=_axis(DETUNING_LABEL, domain=[0, 1], anchor="y2"),
                yaxis=_axis("pipe x₁ [m]", domain=[0.436, 1], anchor="x"),
                yaxis2=_axis("absorber z [m]", domain=[0, 0.376], anchor="x2"),
            ) | {"hovermode": "closest", "clickmode": "event"},
            "manifold": _layout(
                HEIGHTS["manifold"],
                xaxis=_axis("sink |Z| [m]", rangemode="tozero"), yaxis=_axis("pipe |X| [m]", rangemode="tozero"),
            ),
            "map": _layout(
                HEIGHTS["map"],
                xaxis=_axis(DETUNING_LABEL), yaxis=_axis(type="log", exponentformat="power", dtick=1),
            ),
        },
        "beside": {"color": SINK, "wind": BARE, "band": "#eef3f7"},
        "axes": {"detuning": [DETUNING_LABEL, _AT_DETUNING], "place": [WIND_LABEL, _AT_WIND]},
    }  # fmt: skip
