"""Foreign Host and Origin headers are refused; everything else is answered with headers that keep the page at home."""

import pytest

from frahm.web.guard import LocalOnly


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
