"""The command app: the interactive page."""

from __future__ import annotations

from typing import Annotated

import typer

from frahm.cli.guarded import ExitCode
from frahm.cli.notes import say_notes


def page(
    case: Annotated[
        str, typer.Argument(metavar="CASE", help="Name of a built-in case, or a YAML or TOML file.")
    ] = "jacket-pipe",
    port: Annotated[int, typer.Option("--port", min=0, max=65535, help="Port on 127.0.0.1; 0: any free one.")] = 8050,
    browse: Annotated[bool, typer.Option("--open", help="Open the page in the browser.")] = False,
) -> None:
    """Serve the interactive page, to this machine only, until it is interrupted."""
    from importlib.util import find_spec

    from frahm.case import load_case
    from frahm.errors import ParameterError

    loaded = load_case(case)
    if find_spec("dash") is None:  # it takes half a second to load: the page is announced before
        hint = 'Install it: pip install "frahm[app]".'
        raise ParameterError("app", "dash is not installed", "an installation with the page", hint=hint)
    say_notes(loaded)
    from frahm.web.server import page_server

    with page_server(loaded, port) as server:
        address = f"http://127.0.0.1:{server.port}/"
        typer.echo(f"frahm: the page is at {address} (Ctrl+C ends it)")
        if browse:
            import webbrowser

            webbrowser.open(address)
        server.serve_forever()  # it takes an interruption as its end
    typer.echo("frahm: the page has ended", err=True)
    raise typer.Exit(ExitCode.INTERRUPTED)
