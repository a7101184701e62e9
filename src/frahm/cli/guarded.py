"""What every command does when something goes wrong: one message and an exit code, never a traceback."""

from __future__ import annotations

import contextlib
import enum
import errno
import os
import signal
import sys
import threading
from collections.abc import Iterator
from typing import Any

import typer
from typer.core import TyperGroup

from frahm.errors import ParameterError


class ExitCode(enum.IntEnum):
    """Exit codes of the command line."""

    DONE = 0
    BAD_INPUT = 2
    UNVERIFIED = 3
    LIMIT_EXCEEDED = 4
    INTERRUPTED = 130


@contextlib.contextmanager
def held_interrupts() -> Iterator[None]:
    """An interruption inside this block comes at its end: libraries stopped half imported raise errors of their own."""
    if threading.current_thread() is not threading.main_thread():
        yield
        return
    asked = threading.Event()
    before = signal.signal(signal.SIGINT, lambda *_: asked.set())
    try:
        yield
    finally:
        signal.signal(signal.SIGINT, before)
    if asked.is_set():
        raise KeyboardInterrupt


_FULL = (errno.ENOSPC, errno.EDQUOT, errno.EFBIG, errno.EIO)


@contextlib.contextmanager
def told_if_full() -> Iterator[None]:
    """Output that cannot be written for want of room ends in one message and the exit code for it."""
    try:
        try:
            yield
        finally:
            if sys.stdout is not None:  # closed by the one who started the command
                sys.stdout.flush()
    except OSError as error:
        if error.errno not in _FULL:
            raise
        _discard_output()
        with contextlib.suppress(OSError):  # the messages may go to the same place
            typer.echo(f"frahm: standard output: {error.strerror}.", err=True)
        sys.exit(ExitCode.BAD_INPUT)


def _discard_output() -> None:
    """Python writes what is left in its buffer at its end, and would complain once more."""
    nowhere = os.open(os.devnull, os.O_WRONLY)
    os.dup2(nowhere, sys.stdout.fileno())
    os.close(nowhere)


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
