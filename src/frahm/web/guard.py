"""Only pages of this server, opened on this machine, are answered."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from typing import Any

ADDRESS = "127.0.0.1"
_POLICY = (
    "default-src 'self'; script-src 'self' 'unsafe-inline'; style-src 'self' 'unsafe-inline'; "
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
        """Answer, or refuse with 403."""
        host, origin = environ.get("HTTP_HOST", ""), environ.get("HTTP_ORIGIN")
        site = environ.get("HTTP_SEC_FETCH_SITE", "none")
        if host.lower() not in self._hosts:
            return _refused(start_response, "this server answers to 127.0.0.1 and localhost only")
        if origin is not None and origin.lower() not in self._origins:
            return _refused(start_response, "this server answers to its own page only")
        if site not in ("none", "same-origin") and environ.get("HTTP_SEC_FETCH_MODE") != "navigate":
            return _refused(start_response, "this server answers to its own page only")

        def start(status: str, headers: list[tuple[str, str]], *more: Any) -> Any:
            return start_response(status, [*headers, *HEADERS], *more)

        return self._app(environ, start)


def _refused(start_response: Callable[..., Any], reason: str) -> Iterable[bytes]:
    text = f"Refused: {reason}.\n".encode()
    head = [("Content-Type", "text/plain; charset=utf-8"), ("Content-Length", str(len(text)))]
    start_response("403 Forbidden", head)
    return [text]
