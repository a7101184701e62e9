"""The command reproduce: the claims and figures of the paper, judged and redrawn."""

from __future__ import annotations

import itertools
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

if TYPE_CHECKING:
    from rich.console import Console

    from frahm.reproduction.reproducing import Reproduction


def reproduce(
    out: Annotated[Path, typer.Option("--out", metavar="DIR", help="Directory for the results.")] = Path(
        "out/reproduce"
    ),
    force: Annotated[bool, typer.Option("--force", help="Write into DIR even if it holds something else.")] = False,
) -> None:
    """Judge every claim of Yang et al. (2022) by computation and redraw their figures 3 to 12."""
    from rich.console import Console

    from frahm.cli.guarded import ExitCode

    result = _run_with_progress(out, force)
    _show(Console(), result)
    if result.unverified:
        for sentence in result.unverified:
            typer.echo(f"frahm: unverified: {sentence}", err=True)
        raise typer.Exit(ExitCode.UNVERIFIED)


def _run_with_progress(out: Path, force: bool) -> Reproduction:
    """Progress is shown on a terminal only."""
    from rich.console import Console
    from rich.progress import BarColumn, MofNCompleteColumn, Progress, TextColumn, TimeElapsedColumn

    from frahm.reproduction.reproducing import reproduce as run
    from frahm.reproduction.reproducing import step_count

    console = Console(stderr=True)
    columns = (TextColumn("{task.description:<20}"), BarColumn(), MofNCompleteColumn(), TimeElapsedColumn())
    with Progress(*columns, console=console, transient=True, disable=not console.is_terminal) as bar:
        task, done = bar.add_task("starting", total=step_count()), itertools.count()
        return run(out, force=force, progress=lambda words: bar.update(task, completed=next(done), description=words))


_COLOURS = {"reproduced": "green", "misprint": "yellow", "not-reproduced": "red"}


def _show(console: Console, result: Reproduction) -> None:
    from rich.table import Table

    from frahm.reproduction.tables import counts_text, split, value_text

    claims, equations = split(result.judgements)
    table = Table("#", "where", "quantity", "printed", "computed", "verdict", box=None, pad_edge=False)
    for judgement in claims:
        colour, first = _COLOURS[judgement.verdict.value], True
        for finding in judgement.findings:
            head = (str(judgement.id), judgement.figure) if first else ("", "")
            verdict = f"[{colour}]{judgement.verdict.value}[/]" if first else ""
            values = (value_text(value, finding.unit) for value in (finding.printed, finding.computed))
            table.add_row(*head, finding.name, *values, verdict)
            first = False
    console.print(table)
    console.print(f"\nClaims: {counts_text(claims)}. Equations: {counts_text(equations)}.", highlight=False)
    console.print(f"Tables and figures are in {result.directory}.", highlight=False, soft_wrap=True)
