"""Foreign Host and Origin headers are refused; everything else is answered with headers that keep the page at home."""

import base64
import hashlib

import pytest

from frahm.web.guard import RENDERER, LocalOnly


def answer(**headers):
    said = {}

    def start_response(status, head, *more):
        said["status"], said["head"] = status, dict(head)

    def inside(environ, start):
        start("200 OK", [("Content-Type", "text/html")])
        return [b"inside"]

    environ = {"HTTP_HOST": "127.0.0.1:8050"} | headers
    body = b"".join(LocalOnly(inside, 8050)(environ, start_response))
    return said["status"], said["head"], body


@pytest.mark.parametrize(
    "headers",
    [
        {},
        {"HTTP_HOST": "localhost:8050"},
        {"HTTP_ORIGIN": "http://127.0.0.1:8050"},
        {"HTTP_ORIGIN": "http://localhost:8050", "HTTP_HOST": "localhost:8050"},
        {"HTTP_SEC_FETCH_SITE": "same-origin"},
        {"HTTP_SEC_FETCH_SITE": "cross-site", "HTTP_SEC_FETCH_MODE": "navigate"},
    ],
)
def test_the_own_page_is_answered(headers):
    status, head, body = answer(**headers)
    assert status == "200 OK"
    assert body == b"inside"
    assert "default-src 'self'" in head["Content-Security-Policy"]
    assert "frame-ancestors 'none'" in head["Content-Security-Policy"]


@pytest.mark.parametrize(
    "headers",
    [
        {"HTTP_HOST": "frahm.example:8050"},
        {"HTTP_HOST": "127.0.0.1:8051"},
        {"HTTP_HOST": "127.0.0.1"},
        {"HTTP_HOST": ""},
        {"HTTP_HOST": "127.0.0.1:8050.example"},
        {"HTTP_ORIGIN": "http://evil.example"},
        {"HTTP_ORIGIN": "null"},
        {"HTTP_ORIGIN": "https://127.0.0.1:8050"},
        {"HTTP_ORIGIN": "http://127.0.0.1:8051"},
        {"HTTP_SEC_FETCH_SITE": "cross-site", "HTTP_SEC_FETCH_MODE": "no-cors"},
    ],
)
def test_everybody_else_is_refused(headers):
    status, _, body = answer(**headers)
    assert status == "403 Forbidden"
    assert b"inside" not in body
    assert b"Refused" in body


@pytest.mark.parametrize(
    ("headers", "code"),
    [
        ({"CONTENT_LENGTH": str(100 << 20)}, "413"),
        ({"CONTENT_LENGTH": 5000 * "9"}, "413"),
        ({"CONTENT_LENGTH": "-1"}, "400"),
        ({"CONTENT_LENGTH": "many"}, "400"),
        ({"HTTP_TRANSFER_ENCODING": "chunked"}, "411"),
        ({"CONTENT_LENGTH": "20000"}, "200"),
    ],
)
def test_a_body_is_read_up_to_a_limit(headers, code):
    status, _, body = answer(**headers)
    assert status.startswith(code)
    assert (b"inside" in body) == (code == "200")


def test_no_script_written_into_the_page_is_run_but_the_one_known():
    _, head, _ = answer()
    scripts = head["Content-Security-Policy"].split("script-src ")[1].split(";")[0]
    assert "unsafe" not in scripts
    digest = base64.b64encode(hashlib.sha256(RENDERER.encode()).digest()).decode()
    assert scripts == f"'self' 'sha256-{digest}'"
