"""What every command does when something goes wrong: one message and an exit code, never a traceback."""

from __future__ import annotations

import enum
from typing import Any

import typer
from typer.core import TyperGroup

from frahm.errors import ParameterError


class ExitCode(enum.IntEnum):
    """Exit codes of the command line."""

    DONE = 0
    BAD_INPUT = 2
    UNVERIFIED = 3
    INTERRUPTED = 130


class GuardedGroup(TyperGroup):
    """Commands whose bad input and interruption end in one message and the exit code for it."""

    def invoke(self, ctx: Any) -> Any:
        """Run the command asked for."""
        try:
            return super().invoke(ctx)
        except ParameterError as error:
            typer.echo(f"frahm: {error}", err=True)
            raise typer.Exit(ExitCode.BAD_INPUT) from None
        except KeyboardInterrupt:
            typer.echo("frahm: interrupted; what was finished is kept", err=True)
            raise typer.Exit(ExitCode.INTERRUPTED) from None
