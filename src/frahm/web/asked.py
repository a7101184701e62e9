"""What comes in from outside is read here: what is malformed is one `ParameterError`, answered with 400 and a line."""

from __future__ import annotations

import json
import re
import traceback
from collections.abc import Mapping
from typing import Any

from dash.exceptions import DependencyException
from flask import Flask, Response, request
from werkzeug.exceptions import HTTPException

from frahm.case import Case, load_case
from frahm.errors import ParameterError, check_number
from frahm.web.deciding import DEVICES
from frahm.web.scope import PLANES

_SESSION = re.compile(r"[0-9a-f]{32}")
_LONGEST = 200  # characters of an answer's line


def read_json(text: str | bytes, name: str) -> Any:
    """What JSON text says."""
    try:
        return json.loads(text)
    except (ValueError, RecursionError):
        raise ParameterError(name, "text that cannot be read", "JSON") from None


def read_case(given: Any) -> Case:
    """Case as plain data."""
    try:
        return load_case(_mapping(given, "case"))
    except RecursionError:
        raise ParameterError("case", "data nested too deeply", "a case") from None


def read_question(body: bytes) -> dict[str, Any]:
    """A question of the script: the case that was opened, the texts of its fields, and what is asked about them."""
    asked = _mapping(read_json(body, "question"), "question")
    read_text(asked.get("case"), "case")
    _texts(asked.get("values"))
    read_session(asked.get("session"))
    for name, allowed in (("plane", PLANES), ("device", DEVICES)):
        if name in asked and asked[name] not in allowed:
            raise ParameterError(name, _short(asked[name]), "one of " + ", ".join(allowed))
    for name in ("tuned", "drawn"):
        if name in asked and not isinstance(asked[name], bool | str):
            raise ParameterError(name, _short(asked[name]), "true, false or a text")
    return {"tuned": False, "drawn": "", "plane": PLANES[0], "device": DEVICES[0], **asked}


def read_session(name: Any) -> str:
    """Identifier of an open page."""
    if not isinstance(name, str) or not _SESSION.fullmatch(name):
        raise ParameterError("session", _short(name), "32 hexadecimal digits")
    return name


def read_values(values: Any) -> dict[str, str] | None:
    """Texts of the fields, or nothing yet."""
    return None if values is None else _texts(values)


def read_click(clicked: Any) -> tuple[float, tuple[float | None, float | None]]:
    """Place on the axis of a click, and the peaks [m] of pipe and absorber, one of them not known."""
    clicked = _mapping(clicked, "clicked")
    near = clicked.get("near")
    if not isinstance(near, list) or len(near) != 2:
        raise ParameterError("clicked.near", _short(near), "two peaks, one of them null")
    pipe, relative = (None if peak is None else check_number("clicked.near", peak, at_least=0) for peak in near)
    return check_number("clicked.place", clicked.get("place")), (pipe, relative)


def check_callback(body: bytes, known: Mapping[str, Any]) -> None:
    """Refuse a request for a callback of Dash that does not have the shape of one it knows."""
    asked = _mapping(read_json(body, "callback"), "callback")
    output = asked.get("output")
    if not isinstance(output, str) or output not in known:
        raise ParameterError("output", _short(output), "an output of the page")
    for name, wanted in (("inputs", known[output]["inputs"]), ("state", known[output]["state"])):
        given = asked.get(name, [])
        if not isinstance(given, list) or len(given) != len(wanted):
            raise ParameterError(name, _short(given), f"a list of {len(wanted)}")
        for one, what in zip(given, wanted, strict=True):
            _check_value(one, what, name)
    changed = asked.get("changedPropIds", [])
    places = {f"{one['id']}.{one['property']}" for one in known[output]["inputs"] if not one["id"].startswith("{")}
    presets = re.compile(r'\{"preset":\d{1,3}\}\.n_clicks')
    if not isinstance(changed, list) or not all(
        isinstance(one, str) and (one in places or presets.fullmatch(one)) for one in changed
    ):
        raise ParameterError("changedPropIds", _short(changed), "a list of inputs of this output")
    outputs = asked.get("outputs", [])
    listed = outputs if isinstance(outputs, list) else [outputs]
    names = [f"{one.get('id')}.{one.get('property')}" if isinstance(one, dict) else "" for one in listed]
    if output != (f"..{'...'.join(names)}.." if isinstance(outputs, list) else names[0]):
        raise ParameterError("outputs", _short(outputs), f"those of {_short(output)}")


def _check_value(one: Any, what: Mapping[str, Any], name: str) -> None:
    if what["id"].startswith("{"):  # one button of several
        entries = one if isinstance(one, list) else [None]
        good = all(
            isinstance(entry, dict)
            and isinstance(entry.get("id"), dict)
            and set(entry["id"]) == {"preset"}
            and isinstance(entry["id"]["preset"], int)
            and entry.get("property") == what["property"]
            for entry in entries
        )
    else:
        good = isinstance(one, dict) and one.get("id") == what["id"] and one.get("property") == what["property"]
    if not good:
        raise ParameterError(name, _short(one), f"the value of {what['id']}.{what['property']}")


def answer_problems(server: Flask) -> None:
    """Answer what is wrong in one line; a fault of the program shows its traceback in the terminal, too."""

    @server.errorhandler(Exception)
    def wrong(error: Exception) -> Response:
        if isinstance(error, ParameterError):
            return _line(str(error), 400)
        if isinstance(error, DependencyException):  # a script or style of the page that there is not
            return _line(f"{request.method} {request.path}: Not Found", 404)
        if isinstance(error, HTTPException):
            return _line(f"{request.method} {request.path}: {error.name}", error.code or 400)
        traceback.print_exception(error)
        return _line(f"This failed: {type(error).__name__}. The terminal that runs the page says where.", 500)


def _line(text: str, status: int) -> Response:
    line = " ".join(text.split())
    return Response(line[: 10 * _LONGEST] + "\n", status=status, mimetype="text/plain")


def _mapping(given: Any, name: str) -> dict[str, Any]:
    if not isinstance(given, dict):
        raise ParameterError(name, _short(given), "names and values")
    return given


def read_text(given: Any, name: str) -> str:
    """Text such as that of a file."""
    if not isinstance(given, str):
        raise ParameterError(name, _short(given), "a text")
    return given


def _texts(given: Any) -> dict[str, str]:
    for name, text in _mapping(given, "values").items():
        if not isinstance(text, str) or len(text) > _LONGEST:
            raise ParameterError(f"values.{_short(name)}", _short(text), f"a text of at most {_LONGEST} characters")
    return given


def _short(given: Any) -> str:
    text = repr(given) if not isinstance(given, str) else given
    return text if len(text) <= 60 else text[:59] + "…"
