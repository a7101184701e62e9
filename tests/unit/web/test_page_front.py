"""The head of the page is answered at once, the rest when it is built; a page that cannot be built ends the server."""

import threading

import pytest

import frahm
from frahm.web import app
from frahm.web.front import DRAWING, HEAD, LIBRARY_VERSION, Front
from frahm.web.server import page_server


def ask(front, path="/", method="GET"):
    said = []
    chunks = iter(front({"REQUEST_METHOD": method, "PATH_INFO": path}, lambda *answer: said.append(answer)))
    return said, chunks


def behind(environ, start_response):
    start_response("200 OK", [("Content-Type", "text/html")])
    return [HEAD.encode(), b"the rest of " + environ["PATH_INFO"].encode()]


@pytest.fixture
def building():
    go_on = threading.Event()

    def build():
        assert go_on.wait(30)
        return behind

    front = Front(build, lambda error: None)
    front.start()
    yield front, go_on
    go_on.set()


def test_the_head_and_the_drawing_library_do_not_wait_for_the_rest(building):
    front, go_on = building
    said, page = ask(front)
    assert next(page) == HEAD.encode()
    assert f'src="{DRAWING}?v=' in HEAD
    assert said[0][0] == "200 OK"
    said, library = ask(front, DRAWING)
    text = b"".join(library)
    assert f"plotly.js (cartesian - minified) v{LIBRARY_VERSION}".encode() in text[:200]
    assert dict(said[0][1])["Content-Length"] == str(len(text))
    go_on.set()
    assert b"".join(page) == b"the rest of /"
    assert b"".join(ask(front)[1]) == HEAD.encode() + b"the rest of /"


def test_every_other_request_waits_for_the_application(building):
    front, go_on = building
    answers = []
    thread = threading.Thread(target=lambda: answers.append(b"".join(ask(front, "/drawn/response", "POST")[1])))
    thread.start()
    thread.join(0.2)
    assert answers == []
    go_on.set()
    thread.join(30)
    assert answers[0].endswith(b"the rest of /drawn/response")


def test_a_page_that_cannot_be_built_ends_the_server_and_says_why(monkeypatch):
    def broken(case, sessions):
        raise LookupError("no such part")

    monkeypatch.setattr(app, "build_app", broken)
    with pytest.raises(LookupError, match="no such part"), page_server(frahm.load_case("jacket-pipe"), 0) as server:
        server.serve_forever()
    front = Front(lambda: broken(None, None), lambda error: None)
    front.start()
    with pytest.raises(RuntimeError, match="could not be built"):
        ask(front, "/assets/page.css")
