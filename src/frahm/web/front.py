"""What is answered before the page is complete: its head, and with it the library that draws, which takes long to load.

The browser reads that library while Python still loads what makes the rest of the page.
"""

from __future__ import annotations

import threading
from collections.abc import Callable, Iterable, Iterator
from pathlib import Path
from typing import Any

from frahm.web.guard import WsgiApp

DRAWING = "/drawing-library.js"
LIBRARY_VERSION = "4.1.1"
LIBRARY = Path(__file__).parent / "library" / "plotly-cartesian.min.js"
HEAD = f"""<!DOCTYPE html>
<html lang="en">
<head><script async id="drawing-library" src="{DRAWING}?v={LIBRARY_VERSION}"></script>
"""
_CHUNK = 1 << 18


class Front:
    """WSGI application that stands before one that is still being built; every other request waits for it.

    Parameters
    ----------
    build : callable
        Makes the application behind; called in a thread of its own by `start`.
    failed : callable
        Called with the exception if that goes wrong.
    """

    def __init__(self, build: Callable[[], WsgiApp], failed: Callable[[BaseException], None]):
        self._build, self._failed = build, failed
        self._ready = threading.Event()
        self._app: WsgiApp | None = None

    def start(self) -> None:
        """Begin to build the application."""
        threading.Thread(target=self._run, daemon=True).start()

    def _run(self) -> None:
        try:
            self._app = self._build()
        except BaseException as error:  # the thread that serves has to end, and to say why
            self._failed(error)
        finally:
            self._ready.set()

    def __call__(self, environ: dict[str, Any], start_response: Callable[..., Any]) -> Iterable[bytes]:
        """Answer at once what can be, everything else when the application is built."""
        if environ["REQUEST_METHOD"] == "GET":
            if environ["PATH_INFO"] == DRAWING:
                return _library(start_response)
            if environ["PATH_INFO"] == "/" and not self._ready.is_set():
                start_response("200 OK", [("Content-Type", "text/html; charset=utf-8")])
                return self._page(environ)
        return self._behind()(environ, start_response)

    def _page(self, environ: dict[str, Any]) -> Iterator[bytes]:
        """The head of the page, and the rest of it when it is known."""
        yield HEAD.encode()
        text = b"".join(self._behind()(environ, lambda *answer: None))
        yield text.removeprefix(HEAD.encode())

    def _behind(self) -> WsgiApp:
        self._ready.wait()
        if self._app is None:
            raise RuntimeError("The page could not be built.")
        return self._app


def _library(start_response: Callable[..., Any]) -> Iterator[bytes]:
    head = [
        ("Content-Type", "text/javascript; charset=utf-8"),
        ("Content-Length", str(LIBRARY.stat().st_size)),
        ("Cache-Control", "max-age=31536000, immutable"),
    ]
    start_response("200 OK", head)
    return _chunks(LIBRARY)


def _chunks(path: Path) -> Iterator[bytes]:
    with path.open("rb") as file:
        while chunk := file.read(_CHUNK):
            yield chunk
