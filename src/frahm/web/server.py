"""The server of the page: on this machine only."""

from __future__ import annotations

import contextlib
import socket
import threading
from collections.abc import Iterator
from typing import Any

from werkzeug.serving import BaseWSGIServer, WSGIRequestHandler, make_server

from frahm.case import Case
from frahm.errors import ParameterError
from frahm.web.app import build_app
from frahm.web.guard import ADDRESS, LocalOnly
from frahm.web.sessions import Sessions

DEFAULT_PORT = 8050


class _Quiet(WSGIRequestHandler):
    """Keeps connections open between requests, and says nothing about them."""

    protocol_version = "HTTP/1.1"
    disable_nagle_algorithm = True  # head and body are sent one after the other: neither may wait for the other

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
        If the port is taken, or the page cannot show the case.
    """
    sessions = Sessions()
    try:
        app = build_app(case, sessions)
        server = make_server(ADDRESS, _free_port(port), app.server, threaded=True, request_handler=_Quiet)
        server.app = LocalOnly(app.server, server.port)
        threading.Thread(target=_first_look, args=(app.server,), daemon=True).start()
        yield server
    finally:
        sessions.close_all()


def _first_look(app: Any) -> None:
    """Ask for the page once, so that the first visitor finds everything loaded."""
    # Only a head start: whatever is wrong shows to the visitor.
    with contextlib.suppress(Exception), app.test_client() as client:
        for path in ("/", "/_dash-layout", "/_dash-dependencies"):
            client.get(path)


def _free_port(port: int) -> int:
    """The port, if nobody listens there: a web server library would end the program otherwise."""
    with socket.socket(socket.AF_INET, socket.SOCK_STREAM) as probe:
        probe.setsockopt(socket.SOL_SOCKET, socket.SO_REUSEADDR, 1)
        try:
            probe.bind((ADDRESS, port))
        except OSError as error:
            hint = f"{error.strerror or error}. --port 0 takes any that is free."
            raise ParameterError("--port", port, "a free port of this machine", hint=hint) from None
        return int(probe.getsockname()[1])
