"""What stands on the page."""

from __future__ import annotations

import uuid
from typing import Any

from dash import dcc, html

from frahm.case import Case
from frahm.plotting.style import BARE, GREEN, INK, PIPE, SINK
from frahm.web import keys
from frahm.web.controls import field_facts
from frahm.web.deciding import DEVICES
from frahm.web.looks import HEIGHTS
from frahm.web.presets import PRESETS
from frahm.web.scope import PLANES, Axis, has_slow_flow


def page(case: Case) -> html.Div:
    """The page of one visitor."""
    slow = has_slow_flow(case)
    return html.Div(
        [
            *_stores(case),
            html.Div(id="lost", className="lost", role="alert", hidden=True),
            _header(case),
            html.Main([_decision(), _response_part(), _parameters(), _below(slow), _on_demand()]),
        ],
        className="page",
    )


def _stores(case: Case) -> list[Any]:
    return [
        dcc.Store(id="session", data=uuid.uuid4().hex),
        dcc.Store(id="case", data=case.to_dict()),
        dcc.Store(id="fields", data=field_facts(case, Axis(case).start)),
        dcc.Store(id="texts"),
        dcc.Store(id="values"),
        dcc.Store(id="plane", data="kappa"),
        dcc.Store(id="clicked"),
        dcc.Store(id="marks"),
        dcc.Store(id="motion-drawn"),
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


def _section(name: str, title: str, look: str, *content: Any) -> html.Section:
    named: dict[str, Any] = {"aria-labelledby": f"{name}-title"}
    return html.Section([html.H2(title, id=f"{name}-title"), *content], className=look, **named)


def _parameters() -> html.Section:
    off: dict[str, Any] = {"aria-pressed": "false"}
    return _section(
        "parameters", "Parameters", "parameters",
        html.Div(id="parameters", className="fields"),
        html.Button("Look at the wind of the case", id="to-wind", n_clicks=0),
        html.Button("Add a sink of 2 % of the mass", id="add-sink", n_clicks=0, className="bare-only"),
        html.Button("Compare with a tuned mass damper", id="tuned", n_clicks=0, className="toggle", **off),
    )  # fmt: skip


_ROWS = {"bare": "without absorber", "this": "this device", "tuned": "tuned damper of equal mass"}
_COLUMNS = {"peak": "worst motion", "ratio": "A/D", "place": "where", "used": "of the limits", "verdict": "verdict"}


def _decision() -> html.Section:
    """What the member comes to: filled in by the script when the sliders rest."""
    head = html.Tr([html.Th("device", scope="col"), *(html.Th(title, scope="col") for title in _COLUMNS.values())])
    rows = [
        html.Tr(
            [html.Th(_ROWS[device], scope="row"), *(html.Td(id=f"decision-{device}-{name}") for name in _COLUMNS)],
            id=f"decision-{device}", className=f"device-{device}",
        )
        for device in DEVICES
    ]  # fmt: skip
    named: dict[str, Any] = {"tabIndex": "0", "role": "region", "aria-label": "worst motion of every device"}
    table = html.Div(html.Table([html.Thead(head), html.Tbody(rows)]), className="table", **named)
    return _section(
        "decision", "Does it hold?", "decision", table, html.P(id="decision-status", className="status", role="status")
    )


def _response_part() -> html.Section:
    return _section(
        "response", "Response", "response",
        _graph("response"),
        keys.response_key(),
        html.P(id="slow-status", className="status"),
        html.P(id="exact-status", className="status"),
    )  # fmt: skip


def _below(slow: bool) -> html.Div:
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
                _graph("map"),
                keys.map_key(),
            ),
            _section(
                "manifold", "Slow manifold", "panel",
                _graph("manifold"),
                keys.manifold_key(),
                html.P(id="manifold-status", className="status"),
            ),
        ],
        id="beside", className="pair", hidden=not slow,
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


def _graph(name: str) -> html.Div:
    """Place of a figure, of a fixed height, so that nothing on the page moves when the script draws it."""
    return html.Div(html.Div(id=f"{name}-figure"), id=name, className="graph", style={"height": f"{HEIGHTS[name]}px"})


STYLE = f"<style>:root {{ --pipe: {PIPE}; --sink: {SINK}; --green: {GREEN}; --ink: {INK}; --grey: {BARE}; }}</style>"
