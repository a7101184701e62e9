"""The page as a Dash application: what a change of a value, a click or a tick leads to."""

from __future__ import annotations

import base64
import binascii
from collections.abc import Mapping, Sequence
from typing import Any

from dash import ALL, ClientsideFunction, Dash, Input, Output, Patch, State, ctx, dcc, no_update
from flask import Response, request

from frahm.case import Case, case_from_text, load_case
from frahm.errors import ParameterError
from frahm.exchange import csv_text
from frahm.web import words
from frahm.web.controls import CONTROLS, DETUNING, Reading, reading, shown, with_sink
from frahm.web.figures import (
    MANIFOLD_MOTION,
    TRACES,
    draw_attractors,
    draw_exact,
    draw_manifold,
    draw_map,
    draw_response,
    mark_map,
    typed,
)
from frahm.web.layout import STYLE, field_texts, heading, page, slider_facts, spans, start_detuning
from frahm.web.live import PLANES, check_shown, slow_curve
from frahm.web.presets import PRESETS
from frahm.web.sessions import Job, Session, Sessions

NAMES = (*(control.name for control in CONTROLS), DETUNING)
_KEYS = tuple(name.replace(".", "-") for name in NAMES)
_FIELDS = tuple(State(f"field-{key}", "value") for key in _KEYS)
_INDEX = """<!DOCTYPE html>
<html lang="en">
<head>{%metas%}<title>{%title%}</title>{%favicon%}{%css%}STYLE</head>
<body>{%app_entry%}
<footer>{%config%}{%scripts%}<script>window.frahmTraces = TRACES;</script>{%renderer%}</footer></body>
</html>"""


def build_app(case: Case, sessions: Sessions) -> Dash:
    """The application that opens with `case`.

    Raises
    ------
    ParameterError
        If the page cannot show the case.
    """
    check_shown(case)
    app = Dash(
        "frahm.web", title="frahm", update_title="", serve_locally=True, add_log_handler=False,
        assets_folder="assets", index_string=_INDEX.replace("STYLE", STYLE).replace("TRACES", str(len(TRACES))),
        meta_tags=[{"name": "viewport", "content": "width=device-width, initial-scale=1"}], enable_mcp=False,
    )  # fmt: skip
    app.layout = lambda: page(case)
    _add_script(app)
    _add_live(app, sessions)
    _add_exact(app, sessions)
    _add_motion(app, sessions)
    _add_long_jobs(app, sessions)
    _add_files(app)
    _add_signs_of_life(app, sessions)
    return app


def _add_script(app: Dash) -> None:
    """What the script in the browser does, see assets/page.js."""

    def script(name: str, *arguments: Any, **options: Any) -> None:
        app.clientside_callback(ClientsideFunction("frahm", name), *arguments, **options)

    sliders, fields = ([Input(f"{kind}-{key}", "value") for key in _KEYS] for kind in ("slider", "field"))
    script("moved", *sliders, *fields, State("sliders", "data"))
    script("drawn", Input("drawn", "data"))
    script("drawnBeside", Input("beside-drawn", "data"))
    script("started", Input("session", "data"))
    script("loaded", Input("sliders", "data"), Input("texts", "data"))
    planes = [Input(f"plane-{name}", "n_clicks") for name in PLANES]
    script("chosen", Output("plane", "data"), *planes, prevent_initial_call=True)
    script("again", Input("plane", "data"), Input("tuned", "n_clicks"))
    script("clicked", Output("clicked", "data"), Input("response", "clickData"), prevent_initial_call=True)
    script("mapped", Input("map", "clickData"), State("plane", "data"), prevent_initial_call=True)


def _read(case: Mapping[str, Any], wanted: Mapping[str, Any]) -> Reading:
    """What the values sent by the script say."""
    return reading(load_case(dict(case)), wanted["values"])


def _read_fields(case: Mapping[str, Any], texts: Sequence[Any]) -> Reading:
    """What the fields say at this moment: an action must not take older values."""
    return reading(load_case(dict(case)), dict(zip(NAMES, ("" if t is None else t for t in texts), strict=True)))


def _add_live(app: Dash, sessions: Sessions) -> None:
    """What follows a slider: the response at every answer, manifold and map beside it as often as there is time."""

    @app.callback(
        Output("response", "figure"), Output("drawn", "data"),
        *(Output(f"problem-{key}", "children") for key in _KEYS),
        Output("slow-status", "children"), Output("exact-status", "children"),
        Output("motion-holder", "className"), Output("attractors", "className"),
        Input("wanted", "data"), State("case", "data"), State("tuned", "n_clicks"), State("session", "data"),
        prevent_initial_call=True,
    )  # fmt: skip
    def draw(wanted: Any, case: Any, tuned: Any, session_name: str) -> tuple[Any, ...]:
        session = sessions.of(session_name)
        session.newest = wanted["number"]
        read = _read(case, wanted)
        answer = {"number": wanted["number"], "values": wanted["values"], "problems": read.problems, "exact": False}
        if not read.problems:
            try:
                return _drawn(session, read, bool((tuned or 0) % 2), answer)
            except ParameterError as error:
                answer["problems"] = {error.name if error.name in NAMES else DETUNING: str(error)}
        problems = [answer["problems"].get(name, "") for name in NAMES]
        note = "Drawn for the last valid values: see the field marked."
        return (no_update, answer, *problems, note, *[no_update] * 3)

    @app.callback(
        Output("manifold", "figure"), Output("map", "figure"), Output("beside-drawn", "data"),
        Output("manifold-status", "children"),
        Input("beside", "data"), State("case", "data"), State("plane", "data"), State("beside-drawn", "data"),
        prevent_initial_call=True,
    )  # fmt: skip
    def draw_beside(wanted: Any, case: Any, plane: str, drawn: Any) -> tuple[Any, ...]:
        read = _read(case, wanted)
        if read.problems:
            return no_update, no_update, {"number": wanted["number"], "map": None}, no_update
        manifold, stability = Patch(), Patch()
        lines = draw_manifold(manifold, read.case, read.detuning)
        span = spans(read.case)[plane]
        key = f"{plane} {span.low} {span.high} {with_sink(read.case, plane, span.low).digest}"
        if not drawn or drawn["map"] != key:
            draw_map(stability, read.case, plane, (span.low, span.high))
        mark_map(stability, read.case, read.detuning, plane)
        answer = {"number": wanted["number"], "map": key}
        return manifold, stability, answer, words.manifold_status(lines)


def _drawn(session: Session, read: Reading, tuned: bool, answer: dict[str, Any]) -> tuple[Any, ...]:
    case, response = read.case, Patch()
    keep_exact = session.exact == case.digest
    curve = draw_response(response, case, read.detuning, tuned=tuned, keep_exact=keep_exact)
    if not keep_exact:
        session.exact = ""
    answer["exact"] = not keep_exact
    status = no_update if keep_exact else words.LATER
    return response, answer, *[""] * len(NAMES), words.slow_status(curve), status, "stale", "stale"


def _add_exact(app: Dash, sessions: Sessions) -> None:
    @app.callback(
        Output("response", "figure", allow_duplicate=True), Output("exact-status", "children", allow_duplicate=True),
        Input("settled", "data"), State("case", "data"), State("session", "data"), prevent_initial_call=True,
        running=[(Output("exact-status", "children"), words.COMPUTING, words.LATER)],
    )  # fmt: skip
    def exact(settled: Any, case: Any, session_name: str) -> tuple[Any, Any]:
        session = sessions.of(session_name)
        read = _read(case, settled)
        job = session.quick.ask("exact response", read.case.to_dict())
        if job is None or session.newest != settled["number"]:
            return no_update, no_update
        if job.result is None:
            return no_update, f"Exact response: unverified. {job.problem}"
        patch = Patch()
        draw_exact(patch, job.result)
        session.exact = read.case.digest
        return patch, words.exact_status(job.result)


def _add_motion(app: Dash, sessions: Sessions) -> None:
    @app.callback(
        Output("motion", "figure"), Output("motion-status", "children"), Output("motion-holder", "hidden"),
        Output("manifold", "figure", allow_duplicate=True), Output("history", "data"),
        Output("save-history", "disabled"), Output("motion-holder", "className", allow_duplicate=True),
        Input("clicked", "data"), Input("from-rest", "n_clicks"), State("case", "data"), State("session", "data"),
        *_FIELDS, prevent_initial_call=True,
        running=[(Output("motion-status", "children"), "Integrating the equations of motion …", "")],
    )  # fmt: skip
    def motion(clicked: Any, presses: Any, case: Any, session_name: str, *texts: Any) -> tuple[Any, ...]:
        read = _read_fields(case, texts)
        near, detuning = None, read.detuning
        if ctx.triggered_id == "clicked":
            near, detuning = clicked["near"], clicked["detuning"]
        elif read.problems:
            return no_update, "Not computed: see the field marked.", *[no_update] * 5
        job = sessions.of(session_name).quick.ask("motion", read.case.to_dict(), detuning=detuning, near=near)
        if job is None:
            return (no_update,) * 7
        if job.result is None:
            return no_update, f"No motion: {job.problem}", *[no_update] * 5
        manifold = Patch()
        Z, X = job.result["slow"]
        manifold["data"][MANIFOLD_MOTION]["x"], manifold["data"][MANIFOLD_MOTION]["y"] = typed(Z), typed(X)
        figure = job.result["figure"]
        return figure, words.motion_status(job.result), False, manifold, job.result["history"], False, ""


def _add_long_jobs(app: Dash, sessions: Sessions) -> None:
    @app.callback(
        Output("tick", "disabled"), Output("job-status", "children"),
        Input("find", "n_clicks"), Input("report", "n_clicks"), State("case", "data"), State("session", "data"),
        *_FIELDS, prevent_initial_call=True,
    )  # fmt: skip
    def start(find: Any, report: Any, case: Any, session_name: str, *texts: Any) -> tuple[Any, Any]:
        read = _read_fields(case, texts)
        if read.problems:
            return no_update, "Not started: see the field marked."
        worker = sessions.of(session_name).long
        if ctx.triggered_id == "report":
            worker.start("report", read.case.to_dict())
        else:
            worker.start("attractors", read.case.to_dict(), detuning=read.detuning)
        return False, ""

    @app.callback(
        Output("progress", "children"), Output("bar", "value"), Output("progress-holder", "hidden"),
        Output("cancel", "disabled"), Output("tick", "disabled", allow_duplicate=True),
        Output("job-status", "children", allow_duplicate=True), Output("attractors", "children"),
        Output("attractors", "className", allow_duplicate=True), Output("response", "figure", allow_duplicate=True),
        Output("download", "data"),
        Input("tick", "n_intervals"), Input("cancel", "n_clicks"), State("case", "data"), State("session", "data"),
        *_FIELDS, prevent_initial_call=True,
    )  # fmt: skip
    def look(ticks: Any, presses: Any, case: Any, session_name: str, *texts: Any) -> tuple[Any, ...]:
        worker = sessions.of(session_name).long
        if ctx.triggered_id == "cancel":
            worker.cancel()
        job = worker.job
        if job is None:
            return "", "0", True, True, True, *[no_update] * 5
        if not job.done.is_set():
            text, share = words.job_progress(job)
            return text, share, False, False, no_update, *[no_update] * 5
        return "", "0", True, True, True, *_finished(job, _read_fields(case, texts))


def _finished(job: Job, now: Reading) -> tuple[Any, ...]:
    """Status, table, its look, marks on the response and a download of a long job that has ended."""
    if job.result is None:
        return f"{job.name}: {job.problem}", *[no_update] * 4
    if job.name == "report":
        status = "The report was saved by the browser. " + job.result["verdict"]
        return status, no_update, no_update, no_update, dcc.send_string(job.result["html"], "report.html")
    found, case = job.result, load_case(job.case)
    table = words.attractor_table(case, found)
    fresh = case.digest == now.case.digest and found["detuning"] == now.detuning
    marks: Any = no_update
    if fresh:
        marks = Patch()
        draw_attractors(marks, found)
    return words.attractors_status(found), table, "" if fresh else "stale", marks, no_update


def _add_files(app: Dash) -> None:
    @app.callback(
        Output("case", "data"), Output("sliders", "data"), Output("texts", "data"), Output("case-name", "children"),
        Output("notice", "children"),
        Input({"preset": ALL}, "n_clicks"), Input("load", "contents"), Input("to-wind", "n_clicks"),
        State("load", "filename"), State("case", "data"), *_FIELDS, prevent_initial_call=True,
    )  # fmt: skip
    def other(presses: Any, contents: Any, wind: Any, filename: Any, case: Any, *fields: Any) -> tuple[Any, ...]:
        try:
            if ctx.triggered_id == "load":
                chosen = _uploaded(contents, filename)
            elif ctx.triggered_id == "to-wind":
                at = start_detuning(_read_fields(case, fields).case)
                texts = dict(zip(NAMES, fields, strict=True)) | {DETUNING: shown(at)}
                return no_update, no_update, texts, no_update, ""
            else:
                preset = next(one for one in PRESETS if one.figure == ctx.triggered_id["preset"])
                chosen = preset.case()
            check_shown(chosen)
        except ParameterError as error:
            return (*[no_update] * 4, str(error))
        texts = field_texts(chosen, start_detuning(chosen))
        return chosen.to_dict(), slider_facts(chosen), texts, heading(chosen), ""

    @app.callback(
        Output("download", "data", allow_duplicate=True), Output("notice", "children", allow_duplicate=True),
        Input("save", "n_clicks"), Input("save-curve", "n_clicks"), Input("save-history", "n_clicks"),
        State("case", "data"), State("history", "data"), *_FIELDS, prevent_initial_call=True,
    )  # fmt: skip
    def save(save: Any, curve: Any, motion: Any, case: Any, history: Any, *texts: Any) -> tuple[Any, Any]:
        read = _read_fields(case, texts)
        if ctx.triggered_id == "save-history":
            return dcc.send_string(history, "time-history.txt"), ""
        if read.problems:
            return no_update, "Not saved: see the field marked."
        stem = "".join(c if c.isalnum() or c in "-_" else "-" for c in read.case.name)
        if ctx.triggered_id == "save":
            return dcc.send_string(read.case.to_yaml(), f"{stem}.yaml"), ""
        return dcc.send_string(csv_text(slow_curve(read.case).to_dataset()), f"{stem}-slow-flow.csv"), ""


def _uploaded(contents: str, filename: str) -> Case:
    try:
        text = base64.b64decode(contents.split(",", 1)[1], validate=True).decode("utf-8-sig")
    except (binascii.Error, IndexError, ValueError):
        raise ParameterError("case", filename, "a text file in UTF-8") from None
    return case_from_text(text, filename)


def _add_signs_of_life(app: Dash, sessions: Sessions) -> None:
    server: Any = app.server

    @server.post("/alive/<name>")
    def alive(name: str) -> Response:
        sessions.of(name)
        return Response(status=204)

    @server.post("/closed/<name>")
    def closed(name: str) -> Response:
        request.get_data()
        sessions.close(name)
        return Response(status=204)
