"""Malformed and out-of-range requests are answered with 400 and one line; no traceback reaches the terminal."""

import copy
import json
import random
import socket
import threading
from urllib import request

import pytest

import frahm
from frahm.web.app import build_app
from frahm.web.controls import field_texts
from frahm.web.presets import PRESETS
from frahm.web.server import page_server
from frahm.web.sessions import Sessions

CASE = frahm.load_case("jacket-pipe")
SESSION = 32 * "0"
QUESTION = {
    "case": json.dumps(CASE.to_dict()), "values": field_texts(CASE, 0.1), "session": SESSION, "tuned": True,
    "plane": "kappa", "drawn": "",
}  # fmt: skip
ODD = (None, True, -1, 1e308, "", "\ud800", "x" * 500, [], [[]], {}, {"a": {}}, "1e29", "1e-300", "nan", "-1e400")


@pytest.fixture(scope="module")
def app():
    sessions = Sessions()
    yield build_app(CASE, sessions)
    sessions.close_all()


@pytest.fixture
def client(app):
    return app.server.test_client()


def places(data, path=()):
    """Paths of everything inside plain data."""
    yield path
    entries = data.items() if isinstance(data, dict) else enumerate(data) if isinstance(data, list) else ()
    for key, entry in entries:
        yield from places(entry, (*path, key))


def spoilt(data, path, value):
    """The data with something else in one place."""
    if not path:
        return value
    data = copy.deepcopy(data)
    inside = data
    for key in path[:-1]:
        inside = inside[key]
    inside[path[-1]] = value
    return data


def refused_in_one_line(answer):
    text = answer.get_data(as_text=True)
    return answer.status_code == 400 and text.count("\n") == 1 and text.endswith("\n") and "Traceback" not in text


def callback(client, triggered):
    """A request for a callback as the browser makes it."""
    name = "{" if triggered.startswith("{") else triggered.split(".")[0]
    known = [one for one in client.get("/_dash-dependencies").get_json() if not one["clientside_function"]]
    (found,) = [
        one for one in known
        if any(given["id"] == name or (name == "{" and given["id"].startswith(name)) for given in one["inputs"])
    ]  # fmt: skip
    values = {
        "case.data": CASE.to_dict(), "session.data": SESSION, "values.data": QUESTION["values"], "history.data": "a b",
        "load.contents": "data:;base64,YQ==", "load.filename": "a.yaml",
        "clicked.data": {"place": 0.0, "near": [0.01, None]},
    }  # fmt: skip

    def value(one):
        if one["id"].startswith("{"):
            return [{"id": {"preset": p.figure}, "property": one["property"], "value": 0} for p in PRESETS]
        return {**one, "value": values.get(f"{one['id']}.{one['property']}", 1)}

    parts = found["output"].strip(".").split("...")
    outputs = [dict(zip(("id", "property"), part.rsplit(".", 1), strict=True)) for part in parts]
    return {
        "output": found["output"], "outputs": outputs, "changedPropIds": [triggered],
        "inputs": [value(one) for one in found["inputs"]], "state": [value(one) for one in found["state"]],
    }  # fmt: skip


@pytest.mark.parametrize(
    "body", [b"", b"{", b"[]", b"null", b"\xff\xfe", b"[" * 100_000, b'{"case": 1}', b'"' + b"x" * 99]
)
@pytest.mark.parametrize("path", ["/drawn/response", "/drawn/beside", "/drawn/exact", "/_dash-update-component"])
def test_what_is_no_question_is_refused(client, path, body):
    assert refused_in_one_line(client.post(path, data=body, content_type="application/json"))


def test_questions_with_anything_odd_in_any_place_never_fail(client, capfd):
    chance, count = random.Random(1), 0
    for path in [path for path in places(QUESTION) if path] * 2:
        for address in ("/drawn/response", "/drawn/beside"):
            asked = spoilt(QUESTION, path, chance.choice(ODD))
            answer = client.post(address, data=json.dumps(asked), content_type="application/json")
            assert answer.status_code == 200 or refused_in_one_line(answer), (path, asked, answer.data)
            count += answer.status_code == 400
    case = CASE.to_dict()
    for path in places(case):
        asked = QUESTION | {"case": json.dumps(spoilt(case, path, chance.choice(ODD)))}
        answer = client.post("/drawn/response", data=json.dumps(asked), content_type="application/json")
        assert answer.status_code == 200 or refused_in_one_line(answer), (path, asked["case"], answer.data)
        count += answer.status_code == 400
    assert count > 30
    assert "Traceback" not in capfd.readouterr().err


@pytest.mark.parametrize(
    "triggered",
    ["load.contents", '{"preset":6}.n_clicks', "to-wind.n_clicks", "save.n_clicks", "tick.n_intervals"],
)
def test_callbacks_with_anything_odd_in_any_place_never_fail(client, triggered, capfd):
    whole, chance, count = callback(client, triggered), random.Random(2), 0
    good = client.post("/_dash-update-component", data=json.dumps(whole), content_type="application/json")
    assert good.status_code in (200, 204), good.data
    for path in [path for path in places(whole) if path and len(path) < 6]:
        asked = spoilt(whole, path, chance.choice(ODD))
        answer = client.post("/_dash-update-component", data=json.dumps(asked), content_type="application/json")
        assert answer.status_code in (200, 204) or refused_in_one_line(answer), (path, answer.data)
        count += answer.status_code == 400
    assert count > 10
    assert "Traceback" not in capfd.readouterr().err


@pytest.mark.parametrize("tuned", [True, False])
@pytest.mark.parametrize("text", ["1e29", "1e-29", "1e15"])
def test_a_pipe_beyond_all_measure_is_explained_or_drawn(client, tuned, text):
    asked = QUESTION | {"tuned": tuned, "values": QUESTION["values"] | {"pipe.frequency": text}}
    answer = client.post("/drawn/response", data=json.dumps(asked), content_type="application/json")
    assert answer.status_code == 200
    found = answer.get_json()
    assert found["problems"] or found["part"]["lines"]


@pytest.mark.parametrize("name", ["x", "0" * 31, "0" * 33, "%00", "g" * 32])
def test_only_identifiers_of_pages_are_listened_to(client, name):
    for path in ("alive", "closed"):
        assert refused_in_one_line(client.post(f"/{path}/{name}"))


@pytest.mark.parametrize("path", ["nope/x.js", "dash/x.js", "dash/deps/nope.css", "dash/../x.js", "%00/x"])
def test_a_script_of_the_page_that_there_is_not_is_not_found(client, capfd, path):
    for answer in (client.get(f"/_dash-component-suites/{path}"), client.head(f"/_dash-component-suites/{path}")):
        assert answer.status_code == 404
    line = client.get(f"/_dash-component-suites/{path}").get_data(as_text=True)
    assert line.count("\n") == 1
    assert line.endswith("Not Found\n")
    assert capfd.readouterr() == ("", "")


def test_a_body_shorter_than_its_length_is_not_waited_for_without_end(monkeypatch, capfd):
    monkeypatch.setattr("frahm.web.server._PATIENCE", 1.0)
    with page_server(CASE, 0) as server:
        threading.Thread(target=server.serve_forever, daemon=True).start()
        request.urlopen(f"http://127.0.0.1:{server.port}/_dash-layout", timeout=60).read()  # until it is built
        head = f"POST /drawn/response HTTP/1.1\r\nHost: 127.0.0.1:{server.port}\r\nContent-Length: 100\r\n\r\n{{"
        with socket.create_connection(("127.0.0.1", server.port), timeout=15) as connection:
            connection.sendall(head.encode())
            answer = b"".join(iter(lambda: connection.recv(4096), b""))
        server.shutdown()
    assert answer.startswith(b"HTTP/1.1 400 ")
    assert answer.endswith(b"\r\n\r\nPOST /drawn/response: Bad Request\n")
    assert "Traceback" not in "".join(capfd.readouterr())
