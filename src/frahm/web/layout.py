"""What stands on the page."""

from __future__ import annotations

import uuid
from typing import Any

from dash import dcc, html

from frahm.case import Case
from frahm.plotting.style import BARE, GREEN, INK, PIPE, SINK
from frahm.web import keys, words
from frahm.web.controls import CONTROLS, DETUNING, STEPS, Span, detuning_span, shown
from frahm.web.figures import (
    CONFIG,
    HEIGHTS,
    applied,
    draw_manifold,
    draw_map,
    draw_response,
    manifold_figure,
    map_figure,
    mark_map,
)
from frahm.web.figures import response_figure as empty_response_figure
from frahm.web.live import PLANES, shedding_detuning
from frahm.web.presets import PRESETS

_HINTS = {
    "wind.speed": "sets the lift; the dotted line is where it sheds vortices",
    "pipe.frequency": "or text with a unit, such as 0.78 Hz",
    DETUNING: "where the motion is looked at",
}


def start_detuning(case: Case) -> float:
    """Detuning the page starts with: that of the wind, if it lies in the window."""
    lo, hi = case.analysis.detuning
    return min(hi, max(lo, shedding_detuning(case)))


def field_texts(case: Case, detuning: float) -> dict[str, str]:
    """Texts of all fields."""
    return {control.name: shown(control.value(case)) for control in CONTROLS} | {DETUNING: shown(detuning)}


def spans(case: Case) -> dict[str, Span]:
    """Ranges of all sliders."""
    return {control.name: control.span(case) for control in CONTROLS} | {DETUNING: detuning_span(case)}


def slider_facts(case: Case) -> list[dict[str, Any]]:
    """What the script in the browser must know to turn positions of sliders into numbers."""
    return [
        {
            "name": name, "key": name.replace(".", "-"), "low": span.low, "high": span.high,
            "logarithmic": span.logarithmic, "steps": STEPS,
        }
        for name, span in spans(case).items()
    ]  # fmt: skip


def page(case: Case) -> html.Div:
    """The page of one visitor."""
    detuning = start_detuning(case)
    texts, ranges = field_texts(case, detuning), spans(case)
    head = {control.name: (control.title, control.symbol, control.unit) for control in CONTROLS}
    head[DETUNING] = ("Detuning", "σ", "rad/s")
    fields = [_field(name, *head[name], texts[name], ranges[name].position(float(texts[name]))) for name in texts]
    return html.Div(
        [
            *_stores(case),
            html.Div(id="lost", className="lost", role="alert", hidden=True),
            _header(case),
            html.Main([_response_part(case, detuning), _parameters(fields), _below(case, detuning), _on_demand()]),
        ],
        className="page",
    )


def _stores(case: Case) -> list[Any]:
    return [
        dcc.Store(id="session", data=uuid.uuid4().hex),
        dcc.Store(id="case", data=case.to_dict()),
        dcc.Store(id="sliders", data=slider_facts(case)),
        dcc.Store(id="texts"),
        dcc.Store(id="plane", data="kappa"),
        dcc.Store(id="wanted"),
        dcc.Store(id="beside"),
        dcc.Store(id="beside-drawn"),
        dcc.Store(id="drawn"),
        dcc.Store(id="settled"),
        dcc.Store(id="clicked"),
        dcc.Store(id="history"),
        dcc.Interval(id="tick", interval=400, disabled=True),
        dcc.Download(id="download"),
    ]


def _header(case: Case) -> html.Header:
    presets = [html.Button(f"Fig. {preset.figure}", id={"preset": preset.figure}, n_clicks=0) for preset in PRESETS]
    files = [
        dcc.Upload(html.Button("Load case", id="load-button"), id="load", accept=".yaml,.yml,.toml", multiple=False),
        html.Button("Save case", id="save", n_clicks=0),
        html.Button("Save curve", id="save-curve", n_clicks=0),
    ]
    group: dict[str, Any] = {"role": "group", "aria-labelledby": "presets-label"}
    label = html.Span("Yang et al. 2022:", id="presets-label")
    return html.Header(
        [
            html.H1("frahm"),
            html.P(heading(case), id="case-name", className="case-name"),
            html.Div([label, *presets], className="buttons", **group),
            html.Div(files, className="buttons"),
            html.P(id="notice", className="notice", role="status"),
        ]
    )


def heading(case: Case) -> str:
    """Name and title of a case."""
    return f"{case.name}: {case.title}" if case.title else case.name


def _field(name: str, title: str, symbol: str, unit: str, text: str, position: int) -> html.Div:
    key, sign = name.replace(".", "-"), html.I(_GREEK.get(symbol, symbol))
    number = dcc.Input(id=f"field-{key}", type="text", value=text, debounce=0.5, className="number", maxLength=60)
    slider = dcc.Input(id=f"slider-{key}", type="range", min=0, max=STEPS, step=1, value=position, className="slider")
    return html.Div(
        [
            html.Label([f"{title} ", sign, f" [{_pretty(unit)}]"], htmlFor=f"field-{key}"),
            number,
            html.Label(f"{title}, slider", htmlFor=f"slider-{key}", className="unseen"),
            slider,
            html.P(_HINTS.get(name, ""), className="hint", id=f"hint-{key}"),
            html.P(id=f"problem-{key}", className="problem", role="alert"),
        ],
        className="field",
    )


def _section(name: str, title: str, look: str, *content: Any) -> html.Section:
    named: dict[str, Any] = {"aria-labelledby": f"{name}-title"}
    return html.Section([html.H2(title, id=f"{name}-title"), *content], className=look, **named)


def _parameters(fields: list[html.Div]) -> html.Section:
    off: dict[str, Any] = {"aria-pressed": "false"}
    return _section(
        "parameters", "Parameters", "parameters",
        html.Div(fields, className="fields"),
        html.Button("Detuning of the wind", id="to-wind", n_clicks=0),
        html.Button("Compare with a tuned mass damper", id="tuned", n_clicks=0, className="toggle", **off),
    )  # fmt: skip


def _response_part(case: Case, detuning: float) -> html.Section:
    figure = applied(empty_response_figure(), [(draw_response, (case, detuning), {"tuned": False})])
    return _section(
        "response", "Response", "response",
        _graph("response", figure),
        keys.response_key(),
        html.P(id="slow-status", className="status"),
        html.P(words.LATER, id="exact-status", className="status"),
    )  # fmt: skip


def _below(case: Case, detuning: float) -> html.Div:
    manifold = applied(manifold_figure(), [(draw_manifold, (case, detuning), {})])
    span = spans(case)["kappa"]
    cells: Any = (draw_map, (case, "kappa", (span.low, span.high)), {})
    stability = applied(map_figure(), [cells, (mark_map, (case, detuning, "kappa"), {})])
    group: dict[str, Any] = {"role": "group", "aria-label": "upward on the map"}
    planes = html.Div(
        [
            html.Button(text, id=f"plane-{name}", n_clicks=0, className="toggle")
            for name, text in zip(PLANES, ("stiffness κ", "damping ξ₂"), strict=True)
        ],
        className="buttons", **group,
    )  # fmt: skip
    return html.Div(
        [
            _section(
                "map", "Stability map", "panel",
                planes,
                _graph("map", stability),
                keys.map_key(),
            ),
            _section(
                "manifold", "Slow manifold", "panel",
                _graph("manifold", manifold),
                keys.manifold_key(),
                html.P(id="manifold-status", className="status"),
            ),
        ],
        className="pair",
    )  # fmt: skip


def _on_demand() -> html.Div:
    return html.Div([_motion_part(), _search_part()], className="pair")


def _motion_part() -> html.Section:
    buttons = [
        html.Button("Motion from rest", id="from-rest", n_clicks=0),
        html.Button("Save time history", id="save-history", n_clicks=0, disabled=True),
    ]
    return _section(
        "motion", "Motion", "panel",
        html.P("Click a point of the response to start there, or start from rest.", className="hint"),
        html.Div(buttons, className="buttons"),
        html.P(id="motion-status", className="status", role="status"),
        html.Div(_graph("motion"), id="motion-holder", hidden=True),
    )  # fmt: skip


def _search_part() -> html.Section:
    buttons = [
        html.Button("Find attractors", id="find", n_clicks=0),
        html.Button("Full report", id="report", n_clicks=0),
        html.Button("Cancel", id="cancel", n_clicks=0, disabled=True),
    ]
    named: dict[str, Any] = {"aria-label": "progress"}
    progress = [html.Progress(id="bar", max="1", value="0", **named), html.Span(id="progress", role="status")]
    return _section(
        "attractors", "Everything that can last", "panel",
        html.P(
            "Stable lines are not all there is: modulated and chaotic motions are found by a search.", className="hint"
        ),
        html.Div(buttons, className="buttons"),
        html.Div(progress, id="progress-holder", className="progress", hidden=True),
        html.P(id="job-status", className="status", role="status"),
        html.Div(id="attractors"),
    )  # fmt: skip


def _graph(name: str, figure: Any = None) -> dcc.Graph:
    """Graph of a fixed height, so that nothing on the page moves when it is drawn."""
    given: dict[str, Any] = {"config": CONFIG} | ({} if figure is None else {"figure": figure})
    return dcc.Graph(id=name, className="graph", style={"height": f"{HEIGHTS[name]}px"}, **given)


_GREEK = {"omega": "ω", "zeta": "ζ"}


def _pretty(unit: str) -> str:
    return unit.replace("^2", "²").replace("^3", "³") or "-"


STYLE = f"<style>:root {{ --pipe: {PIPE}; --sink: {SINK}; --green: {GREEN}; --ink: {INK}; --grey: {BARE}; }}</style>"
