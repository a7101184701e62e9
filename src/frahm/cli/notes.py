"""What is implausible about a case, said before the work begins; it never changes the exit code."""

from __future__ import annotations

from typing import TYPE_CHECKING

import typer

from frahm.cli.guarded import held_interrupts

if TYPE_CHECKING:
    from frahm.case import Case


def say_notes(case: Case) -> None:
    """Say every implausible value of a case on the error stream, a line each."""
    with held_interrupts():
        from frahm.plausibility import plausibility
    for one in plausibility(case):
        typer.echo(f"frahm: note: {one}", err=True)
