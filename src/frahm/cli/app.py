"""The command `frahm`: its commands live in modules of their own and are registered here."""

from __future__ import annotations

from typing import Annotated

import typer

import frahm
from frahm.cli import cases, run
from frahm.cli.design import design
from frahm.cli.guarded import GuardedGroup, told_if_full
from frahm.cli.page import page
from frahm.cli.reproduce import reproduce
from frahm.cli.screen import screen
from frahm.cli.sweep import sweep
from frahm.cli.terminal import printable_streams

app = typer.Typer(
    name="frahm",
    cls=GuardedGroup,
    help="Design nonlinear energy sinks against vortex-induced vibration of pipes.",
    no_args_is_help=True,
    add_completion=False,
    pretty_exceptions_enable=False,
    context_settings={"help_option_names": ["-h", "--help"]},
)

# A command is a function in a module beside this one; what it needs beyond typer it imports when it is called.
for command in (
    cases.check,
    cases.new,
    cases.cases,
    cases.schema,
    run.run,
    run.report,
    run.show,
    run.warmup,
    design,
    screen,
    sweep,
    reproduce,
):
    app.command()(command)
app.command("app")(page)


def _version(wanted: bool) -> None:
    if wanted:
        typer.echo(f"frahm {frahm.__version__}")
        raise typer.Exit


@app.callback()
def _root(
    version: Annotated[
        bool, typer.Option("--version", callback=_version, is_eager=True, help="Print the version and end.")
    ] = False,
) -> None:
    """Design nonlinear energy sinks against vortex-induced vibration of pipes."""


def main() -> None:
    """Run the command line. A mistake of the program itself ends with its traceback and exit code 1."""
    printable_streams()
    with told_if_full():
        app()
