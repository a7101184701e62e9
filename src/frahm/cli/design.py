"""The command design: the best absorber for a case, verified and compared."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from frahm.cli.cases import CaseArgument
from frahm.cli.guarded import ExitCode, held_interrupts

if TYPE_CHECKING:
    from frahm.design import DesignStudy


def design(
    case: CaseArgument,
    out: Annotated[Path | None, typer.Option("--out", help="Folder to write to; by default out/<name>-design.")] = None,
    family: Annotated[str, typer.Option(help="sink (cubic spring), tuned (linear) or mixed (both).")] = "sink",
    mass_ratio: Annotated[
        float | None, typer.Option(help="Mass over that of the pipe; by default the case's absorber, or 0.02.")
    ] = None,
    scatter: Annotated[float, typer.Option(help="The pipe's frequency may be off by this fraction either way.")] = 0.0,
    force_margin: Annotated[
        float, typer.Option(help="Factor on the force up to which no detached curve may exist.")
    ] = 1.05,
    stroke: Annotated[float | None, typer.Option(help="Largest stroke allowed, in m.")] = None,
    samples: Annotated[int, typer.Option(help="Initial states per frequency in the verification.")] = 200,
    seed: Annotated[int, typer.Option(help="The same seed gives the same result.")] = 1,
    force: Annotated[bool, typer.Option("--force", help="Write even if the folder holds another case.")] = False,
) -> None:
    """Design the best absorber for a case, verify it and compare it with the tuned mass damper."""
    from frahm.case import load_case
    from frahm.cli.folder import claim_folder, default_folder
    from frahm.cli.progress import shown_progress

    loaded = load_case(case)
    folder = default_folder(loaded) if out is None else out
    if out is None:
        folder = folder.with_name(f"{folder.name}-design")
    asked: dict[str, Any] = {
        "family": family, "scatter": scatter, "force_margin": force_margin, "stroke": stroke, "samples": samples,
        "seed": seed,
    }  # fmt: skip
    with shown_progress() as progress:
        progress("loading", 0, 1)
        with held_interrupts():
            import xarray  # noqa: F401 - imported here, where nothing can stop it half-way

            from frahm.design import design_absorber, save_design
            from frahm.report import write_design_report

        claim_folder(folder, loaded, force=force)
        study = design_absorber(loaded, mass_ratio, progress=progress, **asked)
        save_design(study, folder)
        write_design_report(study, folder)
    _conclude(study, folder)


def _conclude(study: DesignStudy, folder: Path) -> None:
    best = study.best
    d = best.design
    if d is not None:
        spring = " and ".join(
            text
            for text, there in (
                (f"linear {d.linear:.5g} 1/s^2", d.linear),
                (f"kappa {d.kappa:.6g} 1/(m^2 s^2)", d.kappa),
            )
            if there
        )
        typer.echo(
            f"Best {best.name}: {spring}, xi2 {d.xi2:.5g} 1/s, rho2 {d.rho2:.4g};"
            f" worst pipe peak {best.worst_pipe_peak:#.4g} m, {'verified' if best.verified else 'UNVERIFIED'}."
        )
    typer.echo(study.verdict)
    typer.echo(f"Report: {folder / 'report.html'} (numbers: summary.json, the design as a case: best.yaml)")
    for doubt in study.unverified:
        typer.echo(f"frahm: {doubt}", err=True)
    if study.interrupted:
        raise typer.Exit(ExitCode.INTERRUPTED)
    if not study.verified:
        raise typer.Exit(ExitCode.UNVERIFIED)


def stored_design_text(folder: Path) -> str | None:
    """What `frahm design` left in a folder, as text; None if the folder holds something else."""
    import json

    try:
        summary = json.loads((folder / "summary.json").read_text(encoding="utf-8"))
        if summary["schema"] != "frahm-design-1":
            return None
        found = summary["results"]["design"]
    except (OSError, ValueError, KeyError, TypeError):
        return None
    rows = [
        f"  {row['name']:<18} {row['worst_pipe_peak']:.5g} m, {'verified' if row['verified'] else 'unverified'}"
        for row in found["comparison"]
    ]
    lines = [f"{summary['case']['name']}: design of the family {found['family']}", "", found["verdict"]]
    lines += ["", "Worst pipe peak of every device", *rows]
    if summary["unverified"]:
        lines += ["", "Unverified", *(f"  {sentence}" for sentence in summary["unverified"])]
    return "\n".join(lines)
