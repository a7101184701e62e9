"""Only pages of this server, opened on this machine, are answered."""

from __future__ import annotations

import base64
import hashlib
from collections.abc import Callable, Iterable
from typing import Any

ADDRESS = "127.0.0.1"
MOST_BYTES = 8 << 20  # of a request: a time history to be saved is the largest there is
RENDERER = "var renderer = new DashRenderer();"  # the one script that Dash writes into the page itself
_HASH = base64.b64encode(hashlib.sha256(RENDERER.encode()).digest()).decode()
_POLICY = (
    f"default-src 'self'; script-src 'self' 'sha256-{_HASH}'; style-src 'self' 'unsafe-inline'; "
    "img-src 'self' data: blob:; font-src 'self' data:; connect-src 'self'; frame-ancestors 'none'; "
    "form-action 'none'; base-uri 'none'; object-src 'none'"
)
HEADERS = (
    ("Content-Security-Policy", _POLICY),
    ("X-Content-Type-Options", "nosniff"),
    ("Referrer-Policy", "no-referrer"),
    ("Cross-Origin-Resource-Policy", "same-origin"),
)
WsgiApp = Callable[[dict[str, Any], Callable[..., Any]], Iterable[bytes]]


class LocalOnly:
    """WSGI middleware that refuses foreign Host and Origin headers.

    A page elsewhere can make a browser send requests here, and a foreign name can be made to resolve to this machine;
    both show in these headers. The headers it adds keep the page itself from loading anything from elsewhere.

    Parameters
    ----------
    app : callable
        The WSGI application behind it.
    port : int
        Port of the server.
    """

    def __init__(self, app: WsgiApp, port: int):
        self._app = app
        names = [f"{name}:{port}" for name in (ADDRESS, "localhost")]
        self._hosts = {*names, *((ADDRESS, "localhost") if port == 80 else ())}
        self._origins = {f"http://{host}" for host in self._hosts}

    def __call__(self, environ: dict[str, Any], start_response: Callable[..., Any]) -> Iterable[bytes]:
        """Answer, or refuse with 403; with 400, 411 or 413 a body that is not read."""
        host, origin = environ.get("HTTP_HOST", ""), environ.get("HTTP_ORIGIN")
        site = environ.get("HTTP_SEC_FETCH_SITE", "none")
        if host.lower() not in self._hosts:
            return _refused(start_response, "this server answers to 127.0.0.1 and localhost only")
        if origin is not None and origin.lower() not in self._origins:
            return _refused(start_response, "this server answers to its own page only")
        if site not in ("none", "same-origin") and environ.get("HTTP_SEC_FETCH_MODE") != "navigate":
            return _refused(start_response, "this server answers to its own page only")

        refusal = _too_much(environ)
        if refusal is not None:
            return _refused(start_response, *refusal)

        def start(status: str, headers: list[tuple[str, str]], *more: Any) -> Any:
            return start_response(status, [*headers, *HEADERS], *more)

        return self._app(environ, start)


def _too_much(environ: dict[str, Any]) -> tuple[str, str] | None:
    """Why the body of a request is not read, and the status that says so."""
    length = environ.get("CONTENT_LENGTH") or "0"
    if environ.get("HTTP_TRANSFER_ENCODING"):
        return "a body whose length is not said", "411 Length Required"
    if not (length.isascii() and length.isdigit()):
        return "a length that is no number", "400 Bad Request"
    if len(length) > len(str(MOST_BYTES)) or int(length) > MOST_BYTES:
        return f"more than {MOST_BYTES >> 20} MB at once", "413 Content Too Large"
    return None


def _refused(start_response: Callable[..., Any], reason: str, status: str = "403 Forbidden") -> Iterable[bytes]:
    text = f"Refused: {reason}.\n".encode()
    head = [("Content-Type", "text/plain; charset=utf-8"), ("Content-Length", str(len(text)))]
    start_response(status, head)
    return [text]
