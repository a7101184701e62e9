"""The command screen: every member of a table, those that fail first."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from frahm.cli.folder import members_summary
from frahm.cli.guarded import ExitCode, held_interrupts

if TYPE_CHECKING:
    from collections.abc import Iterator
    from typing import Any

    from frahm.screening import MemberScreen

_SHOWN = 10


def screen(
    members: Annotated[
        str, typer.Argument(metavar="MEMBERS", help="Table of members, CSV or XLSX, or members-example.")
    ],
    out: Annotated[Path | None, typer.Option("--out", help="Folder to write to; by default out/<name>-screen.")] = None,
    cases: Annotated[
        Path | None,
        typer.Option("--cases", metavar="DIR", help="Write every member that does not pass as a case into DIR."),
    ] = None,
    case: Annotated[
        list[str] | None,
        typer.Option("--case", metavar="NAME", help="Write this member as a case, in place of those that do not pass."),
    ] = None,
    force: Annotated[bool, typer.Option("--force", help="Write even if the folder holds something else.")] = False,
) -> None:
    """Judge every member of a platform in its wind and write report.html, members.csv and summary.json."""
    from frahm.cli.folder import claim_members_folder, folder_called
    from frahm.cli.progress import shown_progress

    folder = folder_called(f"{Path(members).stem}-screen") if out is None else out
    with shown_progress() as progress:
        progress("loading", 0, 1)
        with held_interrupts():
            from frahm.report import write_members_report
            from frahm.screening import read_members, save_cases, save_screen, screen_members, wanted_members

        table = read_members(members)
        names = [row.name for row in table.rows]
        for name in case or ():
            _check_name(name, names)
        claim_members_folder(folder, table.digest, members_summary(folder), force=force)
        progress.weigh([1.0] * len(table.rows))
        found = screen_members(table, progress=progress)
        wanted = wanted_members(found, case or ()) if cases is not None or case else []
        save_screen(found, folder)
        written = save_cases(wanted, folder / "cases" if cases is None else cases) if wanted else []
        if not found.interrupted:
            progress("figures and report", 0, 1)
            write_members_report(found, folder)
    _conclude(found, folder, written)


def _check_name(name: str, names: list[str]) -> None:
    from frahm.errors import ParameterError, nearest

    if name not in names:
        near = nearest(name, names)
        hint = f"Did you mean {near!r}?" if near else None
        raise ParameterError("--case", name, "the name of a member of the table", hint=hint)


def _conclude(found: MemberScreen, folder: Path, written: list[Path]) -> None:
    """Say what came out and where it is; end with the exit code for it."""
    from frahm.cli.terminal import say

    say("\n".join(_lines(found.results())))
    if found.interrupted:
        typer.echo(f"Interrupted; what was finished is in {folder}.", err=True)
        raise typer.Exit(ExitCode.INTERRUPTED)
    typer.echo(f"Report: {folder / 'report.html'} (table: members.csv, numbers: summary.json)")
    if written:
        typer.echo(
            f"{len(written)} case{'s' * (len(written) > 1)} in {written[0].parent}; next: frahm run {written[0]}"
        )
    if found.table.ignored:
        say(f"frahm: note: columns that were not read: {', '.join(found.table.ignored)}", err=True)
    for member in found.members:
        if member.findings is None:
            say(f"frahm: {member.place}: {member.name or 'no name'}: not judged. {member.verdict.why}", err=True)
    if found.failed:
        raise typer.Exit(ExitCode.LIMIT_EXCEEDED)
    if found.unverified:
        raise typer.Exit(ExitCode.UNVERIFIED)


def _lines(results: dict[str, Any], most: int = _SHOWN) -> Iterator[str]:
    """The sentence on all members, and a line for each of the worst."""
    yield results["sentence"]
    rows = results["members"]
    for row in rows[:most]:
        yield f"  {row['name']:<12} {row['verdict']:<11} {row['why']}"
    if len(rows) > most:
        yield f"  and {len(rows) - most} more, in the report."


def stored_screen_text(folder: Path) -> str | None:
    """What `frahm screen` left in a folder, as text; None if the folder holds something else."""
    from frahm.errors import door

    summary = members_summary(folder)
    if summary is None:
        return None
    results = summary["results"]
    with door("DIR", str(folder), "a folder that `frahm screen` wrote", "summary.json is damaged."):
        lines = list(_lines(results, len(results["members"])))
        lines += [f"  {row['name']:<12} {row['verdict']:<11} {row['why']}" for row in results["not_judged"]]
    return "\n".join(lines)
