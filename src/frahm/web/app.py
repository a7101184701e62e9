"""The page as a Dash application: what a click, a file or a tick leads to; what follows the sliders is in `answers`."""

from __future__ import annotations

import base64
import binascii
import json
from collections.abc import Callable, Mapping
from typing import Any

from dash import ALL, ClientsideFunction, Dash, Input, Output, State, ctx, dcc, no_update
from flask import Response, request

from frahm.case import Case, case_from_text, load_case
from frahm.errors import ParameterError
from frahm.web import words
from frahm.web.asked import (
    answer_problems,
    check_callback,
    read_case,
    read_click,
    read_question,
    read_session,
    read_text,
    read_values,
)
from frahm.web.controls import Reading, field_facts, field_texts, reading, shown
from frahm.web.front import HEAD
from frahm.web.guard import RENDERER
from frahm.web.layout import STYLE, heading, page
from frahm.web.looks import figures
from frahm.web.presets import PRESETS
from frahm.web.scope import PLANES, Axis, has_slow_flow
from frahm.web.sessions import Job, Session, Sessions

_INDEX = """{%metas%}<title>{%title%}</title>{%favicon%}{%css%}STYLE
<script type="application/json" id="figures-at-rest">FIGURES</script></head>
<body>{%app_entry%}
<footer>{%config%}{%scripts%}{%renderer%}</footer></body>
</html>"""
_VALUES = (State("values", "data"), State("case", "data"), State("session", "data"))


def build_app(case: Case, sessions: Sessions) -> Dash:
    """The application that opens with `case`."""
    still = json.dumps(figures(), ensure_ascii=False).replace("</", "<\\/")
    app = Dash(
        "frahm.web", title="frahm", update_title="", serve_locally=True, add_log_handler=False,
        assets_folder="assets", index_string=HEAD + _INDEX.replace("STYLE", STYLE).replace("FIGURES", still),
        meta_tags=[{"name": "viewport", "content": "width=device-width, initial-scale=1"}], enable_mcp=False,
    )  # fmt: skip
    app.layout = lambda: page(case)
    app.renderer = RENDERER
    _add_script(app)
    _check_requests(app)
    _add_answers(app.server, sessions)
    _add_motion(app, sessions)
    _add_long_jobs(app, sessions)
    _add_files(app, sessions)
    _add_signs_of_life(app.server, sessions)
    return app


def _add_script(app: Dash) -> None:
    """What the script in the browser does, see assets/page.js."""

    def script(name: str, *arguments: Any, **options: Any) -> None:
        app.clientside_callback(ClientsideFunction("frahm", name), *arguments, **options)

    script("opened", Input("fields", "data"), State("case", "data"), State("session", "data"))
    script("placed", Input("texts", "data"), prevent_initial_call=True)
    planes = [Input(f"plane-{name}", "n_clicks") for name in PLANES]
    script("chosen", Output("plane", "data"), *planes, prevent_initial_call=True)
    script("again", Input("plane", "data"), Input("tuned", "n_clicks"))
    script("marked", Input("marks", "data"), prevent_initial_call=True)
    script("moved", Input("motion-drawn", "data"), prevent_initial_call=True)


def _check_requests(app: Dash) -> None:
    """Malformed requests are refused before Dash takes them for its own."""
    answer_problems(app.server)

    @app.server.before_request
    def check() -> None:
        if request.path == "/_dash-update-component":
            check_callback(request.get_data(), app.callback_map)


def _add_answers(server: Any, sessions: Sessions) -> None:
    """Questions of the script about the values in the fields: plain requests, because a drag asks many a second."""

    def answer(found: Callable[[Any], Mapping[str, Any]]) -> Response:
        text = json.dumps(found(read_question(request.get_data())), allow_nan=False, separators=(",", ":"))
        return Response(text, mimetype="application/json")

    @server.post("/drawn/response")
    def response() -> Response:
        from frahm.web import answers

        return answer(answers.response)

    @server.post("/drawn/beside")
    def beside() -> Response:
        from frahm.web import answers

        return answer(answers.beside)

    @server.post("/drawn/exact")
    def exact() -> Response:
        from frahm.web import answers

        return answer(lambda wanted: answers.exact(wanted, sessions))

    @server.post("/drawn/decision")
    def decision() -> Response:
        from frahm.web import answers

        return answer(lambda wanted: answers.decision(wanted, sessions))


def _read(values: Any, case: Any) -> Reading:
    """What the fields say at this moment: the script hands them over before an action is taken."""
    opened = read_case(case)
    return reading(opened, read_values(values) or field_texts(opened, Axis(opened).start))


def _add_motion(app: Dash, sessions: Sessions) -> None:
    @app.callback(
        Output("motion-drawn", "data"), Output("motion-status", "children"), Output("motion-holder", "hidden"),
        Output("history", "data"), Output("save-history", "disabled"), Output("motion-holder", "className"),
        Input("clicked", "data"), Input("from-rest", "n_clicks"), *_VALUES, prevent_initial_call=True,
        running=[(Output("motion-status", "children"), "Integrating the equations of motion …", "")],
    )  # fmt: skip
    def motion(clicked: Any, presses: Any, values: Any, case: Any, session_name: str) -> tuple[Any, ...]:
        read = _read(values, case)
        near, at = None, read.at
        if ctx.triggered_id == "clicked":
            at, near = read_click(clicked)
        elif read.problems:
            return no_update, "Not computed: see the field marked.", *[no_update] * 4
        job = sessions.of(read_session(session_name)).quick.ask("motion", read.case.to_dict(), at=at, near=near)
        if job is None:
            return (no_update,) * 6
        if job.result is None:
            return no_update, f"No motion: {job.problem}", *[no_update] * 4
        drawn = {"figure": job.result["figure"], "slow": job.result["slow"] if has_slow_flow(read.case) else None}
        return drawn, words.motion_status(read.case, job.result), False, job.result["history"], False, ""


def _add_long_jobs(app: Dash, sessions: Sessions) -> None:
    @app.callback(
        Output("tick", "disabled"), Output("job-status", "children"),
        Input("find", "n_clicks"), Input("report", "n_clicks"), *_VALUES, prevent_initial_call=True,
    )  # fmt: skip
    def start(find: Any, report: Any, values: Any, case: Any, session_name: str) -> tuple[Any, Any]:
        read = _read(values, case)
        if read.problems:
            return no_update, "Not started: see the field marked."
        session = sessions.of(read_session(session_name))
        session.deciding.cancel()  # what is asked for does not wait for what is not
        worker = session.long
        if ctx.triggered_id == "report":
            worker.start("report", read.case.to_dict())
        else:
            worker.start("attractors", read.case.to_dict(), at=read.at)
        return False, ""

    @app.callback(
        Output("progress", "children"), Output("bar", "value"), Output("progress-holder", "hidden"),
        Output("cancel", "disabled"), Output("tick", "disabled", allow_duplicate=True),
        Output("job-status", "children", allow_duplicate=True), Output("attractors", "children"),
        Output("attractors", "className"), Output("marks", "data"), Output("download", "data"),
        Input("tick", "n_intervals"), Input("cancel", "n_clicks"), *_VALUES, prevent_initial_call=True,
    )  # fmt: skip
    def look(ticks: Any, presses: Any, values: Any, case: Any, session_name: str) -> tuple[Any, ...]:
        worker = sessions.of(read_session(session_name)).long
        if ctx.triggered_id == "cancel":
            worker.cancel()
        job = worker.job
        if job is None:
            return "", "0", True, True, True, *[no_update] * 5
        if not job.done.is_set():
            text, share = words.job_progress(job)
            return text, share, False, False, no_update, *[no_update] * 5
        return "", "0", True, True, True, *_finished(job, _read(values, case))


def _finished(job: Job, now: Reading) -> tuple[Any, ...]:
    """Status, table, its look, marks on the response and a download of a long job that has ended."""
    if job.result is None:
        return f"{job.name}: {job.problem}", *[no_update] * 4
    if job.name == "report":
        status = "The report was saved by the browser. " + job.result["verdict"]
        return status, no_update, no_update, no_update, dcc.send_string(job.result["html"], "report.html")
    from frahm.web.figures import attractor_lines

    found, case = job.result, load_case(job.case)
    table = words.attractor_table(case, found)
    fresh = case.digest == now.case.digest and found["at"] == now.at
    marks = attractor_lines(found) if fresh else no_update
    return words.attractors_status(found), table, "" if fresh else "stale", marks, no_update


def _add_files(app: Dash, sessions: Sessions) -> None:
    @app.callback(
        Output("case", "data"), Output("fields", "data"), Output("texts", "data"), Output("case-name", "children"),
        Output("notice", "children"),
        Input({"preset": ALL}, "n_clicks"), Input("load", "contents"), Input("to-wind", "n_clicks"),
        Input("add-sink", "n_clicks"),
        State("load", "filename"), *_VALUES, prevent_initial_call=True,
    )  # fmt: skip
    def other(
        presses: Any, contents: Any, wind: Any, adds: Any, filename: Any, values: Any, case: Any, session_name: str
    ) -> tuple[Any, ...]:
        try:
            if ctx.triggered_id == "load":
                chosen = _uploaded(read_text(contents, "contents"), read_text(filename, "filename"))
            elif ctx.triggered_id == "add-sink":
                chosen = _with_sink(_read(values, case), sessions.of(read_session(session_name)))
            elif ctx.triggered_id == "to-wind":
                texts, notice = _to_wind(_read(values, case).case)
                return no_update, no_update, texts, no_update, notice
            else:
                chosen = _preset(ctx.triggered_id)
        except ParameterError as error:
            return (*[no_update] * 4, str(error))
        return chosen.to_dict(), field_facts(chosen, Axis(chosen).start), no_update, heading(chosen), ""

    @app.callback(
        Output("download", "data", allow_duplicate=True), Output("notice", "children", allow_duplicate=True),
        Input("save", "n_clicks"), Input("save-curve", "n_clicks"), Input("save-history", "n_clicks"),
        State("history", "data"), *_VALUES, prevent_initial_call=True,
    )  # fmt: skip
    def save(
        save: Any, curve: Any, motion: Any, history: Any, values: Any, case: Any, session_name: str
    ) -> tuple[Any, Any]:
        if ctx.triggered_id == "save-history":
            return dcc.send_string(read_text(history, "history"), "time-history.txt"), ""
        read = _read(values, case)
        if read.problems:
            return no_update, "Not saved: see the field marked."
        stem = "".join(c if c.isalnum() or c in "-_" else "-" for c in read.case.name)
        if ctx.triggered_id == "save":
            return dcc.send_string(read.case.to_yaml(), f"{stem}.yaml"), ""
        return _saved_curve(read.case, stem, sessions.of(read_session(session_name)))


def _preset(pressed: Any) -> Case:
    figure = pressed["preset"] if isinstance(pressed, dict) else pressed
    for preset in PRESETS:
        if preset.figure == figure:
            return preset.case()
    raise ParameterError("preset", figure, "one of " + ", ".join(str(preset.figure) for preset in PRESETS))


def _to_wind(case: Case) -> tuple[Any, str]:
    """Text of the field of the place; or none and a notice, if the wind of the case is outside the range."""
    axis = Axis(case)
    if axis.ends[0] <= axis.wind <= axis.ends[1]:
        return {axis.name: shown(axis.start)}, ""
    return no_update, words.wind_outside(axis)


def _with_sink(read: Reading, session: Session) -> Case:
    """The case with a sink of 2 % of its pipe's mass."""
    if read.problems:
        raise ParameterError("absorbers", "a field marked", "values that are valid")
    job = session.quick.ask("first sink", read.case.to_dict())
    if job is None or job.result is None:
        why = "another was asked for" if job is None else job.problem
        raise ParameterError("absorbers", "none", "a sink that can be found", hint=why)
    return load_case(job.result["case"])


def _saved_curve(case: Case, stem: str, session: Session) -> tuple[Any, str]:
    """The curve that follows the sliders as CSV: of the slow flow, or else the exact one."""
    if has_slow_flow(case):
        from frahm.exchange import csv_text
        from frahm.web.live import slow_curve

        return dcc.send_string(csv_text(slow_curve(case).to_dataset()), f"{stem}-slow-flow.csv"), ""
    job = session.quick.ask("exact table", case.to_dict())
    if job is None or job.result is None:
        return no_update, f"Not saved: {'another was asked for' if job is None else job.problem}"
    return dcc.send_string(job.result["csv"], f"{stem}-exact.csv"), ""


def _uploaded(contents: str, filename: str) -> Case:
    try:
        text = base64.b64decode(contents.split(",", 1)[1], validate=True).decode("utf-8-sig")
    except (binascii.Error, IndexError, ValueError):
        raise ParameterError("case", filename, "a text file in UTF-8") from None
    return case_from_text(text, filename)


def _add_signs_of_life(server: Any, sessions: Sessions) -> None:
    @server.post("/alive/<name>")
    def alive(name: str) -> Response:
        sessions.of(read_session(name))
        return Response(status=204)

    @server.post("/closed/<name>")
    def closed(name: str) -> Response:
        request.get_data()
        sessions.close(read_session(name))
        return Response(status=204)
