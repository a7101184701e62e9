"""Commands around the analysis of one case: run, report, show, warmup."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from frahm.cli.ahead import compiled_ahead
from frahm.cli.cases import CaseArgument
from frahm.cli.folder import holds_design, members_summary, products_summary
from frahm.cli.guarded import ExitCode, held_interrupts
from frahm.cli.notes import say_notes
from frahm.cli.terminal import say

if TYPE_CHECKING:
    from frahm.analysis import CaseAnalysis

FolderArgument = Annotated[Path, typer.Argument(metavar="DIR", help="Folder that `frahm run` wrote.")]


def run(
    case: CaseArgument,
    out: Annotated[Path | None, typer.Option("--out", help="Folder to write to; by default out/<name>.")] = None,
    force: Annotated[bool, typer.Option("--force", help="Write even if the folder holds another case.")] = False,
) -> None:
    """Analyse a case and write report.html, summary.json, results.nc and figures."""
    from frahm.case import load_case
    from frahm.cli.folder import claim_folder, default_folder
    from frahm.cli.progress import shown_progress

    loaded = load_case(case)
    folder = default_folder(loaded) if out is None else out
    claim_folder(folder, loaded, force=force)
    say_notes(loaded)
    with shown_progress() as progress, compiled_ahead():
        progress("loading", 0, 1)
        with held_interrupts():
            import xarray  # noqa: F401 - the steps need it: imported here, where nothing can stop it half-way

            from frahm.analysis import analyse, save_analysis, step_weights
            from frahm.report import write_report

        progress.weigh(step_weights(loaded))
        analysis = analyse(loaded, progress=progress)
        save_analysis(analysis, folder)
        if not analysis.interrupted:
            progress("figures and report", 0, 1)
            write_report(analysis, folder)
    _conclude(analysis, folder)


def report(
    folder: FolderArgument,
    pdf: Annotated[bool, typer.Option("--pdf", help="Write report.pdf too; needs the extra pdf.")] = False,
) -> None:
    """Build the figures and the report again from the stored results."""
    from frahm.analysis import load_analysis
    from frahm.report import REPORT_FILE, write_pdf, write_report

    kept = holds_design(folder) or members_summary(folder) or products_summary(folder)
    if pdf and kept:  # the report stays as it was written
        path = folder / REPORT_FILE
    else:
        path = write_report(load_analysis(folder), folder)
        typer.echo(f"{path} written.")
    if pdf:
        typer.echo(f"{write_pdf(path)} written.")


def show(folder: FolderArgument) -> None:
    """Print what a folder of results, or the store of a sweep, says."""
    from frahm.cli.design import stored_design_text
    from frahm.cli.products import stored_products_text
    from frahm.cli.screen import stored_screen_text
    from frahm.cli.sweep import stored_sweep_text

    stored = (stored_design_text, stored_screen_text, stored_products_text, stored_sweep_text)
    text = next((found for found in (read(folder) for read in stored) if found), None)
    if text is not None:
        say(text)
        return
    from frahm.analysis import load_analysis, missing_arrays
    from frahm.cli.results import results_text
    from frahm.errors import door

    problem = missing_arrays(folder)
    analysis = load_analysis(folder, arrays=not problem)
    with door("DIR", str(folder), "a folder that `frahm run` wrote", "summary.json is damaged."):
        text = results_text(analysis)
    say(text)
    if problem:
        say(f"frahm: {problem} What is said here is complete without them.", err=True)


def warmup() -> None:
    """Compile the numerical kernels, so that the first analysis does not have to."""
    import time

    from frahm.analysis import analyse
    from frahm.design import DesignSettings, verified_designs
    from frahm.time_integration import unsteady_response

    start = time.perf_counter()
    with compiled_ahead():
        analyse("jacket-pipe")
    unsteady_response("jacket-pipe", record=([0.0, 1.0], [2.7, 2.7]))
    verified_designs("jacket-pipe", DesignSettings(samples=2), ("tuned", "sink"))
    typer.echo(f"The kernels are compiled and stored; this took {time.perf_counter() - start:.1f} s.")


def _conclude(analysis: CaseAnalysis, folder: Path) -> None:
    """Say what came out, where it is, what is doubtful; end with the exit code for it."""
    typer.echo(analysis.verdict)
    if analysis.interrupted:
        typer.echo(
            f"Interrupted; what was finished is in {folder}. frahm report {folder} makes a report of it.", err=True
        )
        raise typer.Exit(ExitCode.INTERRUPTED)
    typer.echo(f"Report: {folder / 'report.html'} (numbers: summary.json, arrays: results.nc, figures: figures/)")
    doubts = [f"{check.name}: {check.status}. {check.detail}" for check in analysis.checks if check.status != "pass"]
    for doubt in (*doubts, *analysis.unverified):
        typer.echo(f"frahm: {doubt}", err=True)
    if not analysis.verified:
        raise typer.Exit(ExitCode.UNVERIFIED)
    if not analysis.accepted:
        raise typer.Exit(ExitCode.LIMIT_EXCEEDED)
