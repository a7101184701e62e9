"""The server of the page: on this machine only."""

from __future__ import annotations

import contextlib
import socket
import sys
import threading
from collections.abc import Iterator
from typing import Any

from werkzeug.serving import BaseWSGIServer, WSGIRequestHandler, make_server

from frahm.case import Case
from frahm.errors import ParameterError
from frahm.web.front import Front
from frahm.web.guard import ADDRESS, LocalOnly, WsgiApp
from frahm.web.scope import Axis
from frahm.web.sessions import Sessions

_PATIENCE = 10.0  # [s] until more of a body must have come, or more of an answer been taken


class _Quiet(WSGIRequestHandler):
    """Keeps connections open between requests, and says nothing about them."""

    protocol_version = "HTTP/1.1"
    disable_nagle_algorithm = True  # head and body are sent one after the other: neither may wait for the other

    def run_wsgi(self) -> None:
        """Answer one request; a body that is not sent is waited for only so long."""
        self.connection.settimeout(_PATIENCE)
        super().run_wsgi()
        self.connection.settimeout(None)  # between requests a page may be quiet for as long as it likes

    def log_request(self, *arguments: Any) -> None:
        """Say nothing."""


@contextlib.contextmanager
def page_server(case: Case, port: int) -> Iterator[BaseWSGIServer]:
    """Server of the page on 127.0.0.1, not yet serving; everything it started ends with the block.

    Parameters
    ----------
    case : Case
        What the page opens with.
    port : int
        Port; 0 for any that is free.

    Raises
    ------
    ParameterError
        If the port is taken.
    """
    sessions, failures = Sessions(), []

    def failed(error: BaseException) -> None:
        failures.append(error)
        server.shutdown()

    front = Front(lambda: _built(case, sessions), failed)
    try:
        server = make_server(ADDRESS, _free_port(port), front, threaded=True, request_handler=_Quiet)
        server.app = LocalOnly(front, server.port)
        front.start()
        yield server
    finally:
        sessions.close_all()
    if failures:
        raise failures[0]


def _built(case: Case, sessions: Sessions) -> WsgiApp:
    """The application of the page; what draws is loaded while the browser reads the page."""
    from frahm.web.app import build_app

    app: Any = build_app(case, sessions).server
    threading.Thread(target=_warm_up, args=(case,), daemon=True).start()
    return app


def _warm_up(case: Case) -> None:
    """Draw once, so that the first visitor finds everything loaded."""
    # Only a head start: whatever is wrong shows to the visitor.
    with contextlib.suppress(Exception):
        from frahm.web.answers import warm_up

        warm_up(case, Axis(case).start)


def _free_port(port: int) -> int:
    """The port, if nobody listens there: a web server library would end the program otherwise."""
    with socket.socket(socket.AF_INET, socket.SOCK_STREAM) as probe:
        if sys.platform != "win32":  # where it would let two programs have one port
            probe.setsockopt(socket.SOL_SOCKET, socket.SO_REUSEADDR, 1)
        try:
            probe.bind((ADDRESS, port))
        except OSError as error:
            hint = f"{error.strerror or error}. --port 0 takes any that is free."
            raise ParameterError("--port", port, "a free port of this machine", hint=hint) from None
        return int(probe.getsockname()[1])
