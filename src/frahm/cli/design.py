"""The command design: the best absorber for a case, verified and compared."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from frahm.cli.ahead import compiled_ahead
from frahm.cli.guarded import ExitCode, held_interrupts
from frahm.cli.notes import say_notes
from frahm.cli.products import design_members, number_or_range
from frahm.errors import ParameterError

if TYPE_CHECKING:
    from frahm.design import DesignStudy


Range = tuple[float, float]


def design(
    case: Annotated[
        str | None, typer.Argument(metavar="CASE", help="Name of a built-in case, or a YAML or TOML file.")
    ] = None,
    members: Annotated[
        str | None,
        typer.Option(
            metavar="MEMBERS", help="In place of CASE: a table of members as for frahm screen, all that fail served."
        ),
    ] = None,
    products: Annotated[
        str | None, typer.Option(help="Kinds of absorber for the members: a number, or a range; 1-3.")
    ] = None,
    out: Annotated[Path | None, typer.Option("--out", help="Folder to write to; by default out/<name>-design.")] = None,
    objective: Annotated[
        str | None, typer.Option(help="peak (default), rms, expected or damage: what is made small.")
    ] = None,
    family: Annotated[
        str | None, typer.Option(help="sink (cubic spring, default), tuned (linear) or mixed; of --members all.")
    ] = None,
    mass_ratio: Annotated[
        float | None, typer.Option(help="Mass over that of the pipe; by default the case's absorber, or 0.02.")
    ] = None,
    scatter: Annotated[
        float | None, typer.Option(help="The pipe's frequency may be off by this fraction either way.")
    ] = None,
    quantile: Annotated[
        float | None, typer.Option(help="Of the objective over the scatter; by default the worst.")
    ] = None,
    force_margin: Annotated[
        float | None, typer.Option(help="Factor on the force up to which no detached curve may exist; 1.05.")
    ] = None,
    stroke: Annotated[float | None, typer.Option(help="Largest stroke allowed, in m.")] = None,
    spring_length: Annotated[float | None, typer.Option(help="Room for a transverse spring, in m.")] = None,
    spring_stress: Annotated[float | None, typer.Option(help="Shear stress allowed in coil springs, in Pa.")] = None,
    kappa: Annotated[Range | None, typer.Option(help="Range of the cubic stiffness per mass, 1/(m2 s2).")] = None,
    linear: Annotated[Range | None, typer.Option(help="Range of the linear stiffness per mass, 1/s2.")] = None,
    quintic: Annotated[Range | None, typer.Option(help="Range of the stiffness of the fifth power, 1/(m4 s2).")] = None,
    xi2: Annotated[Range | None, typer.Option(help="Range of the damping per mass, 1/s.")] = None,
    count: Annotated[
        str | None, typer.Option(help="Absorbers designed together: a number, or a range such as 1-3; 1.")
    ] = None,
    mass_shares: Annotated[
        str | None, typer.Option(help="Masses of several absorbers: equal (default), free, or shares such as 0.6,0.4.")
    ] = None,
    devices: Annotated[
        str | None, typer.Option(help="Several absorbers: any (default), or equal, one drawing for all.")
    ] = None,
    masses: Annotated[Range | None, typer.Option(help="Range of the mass ratio, instead of one.")] = None,
    position: Annotated[Range | None, typer.Option(help="Range of the place on an elastic pipe, in m.")] = None,
    wind: Annotated[Range | None, typer.Option(help="Winds in which the worst is looked for, in m/s.")] = None,
    samples: Annotated[int | None, typer.Option(help="Initial states per frequency in the verification; 200.")] = None,
    seed: Annotated[int | None, typer.Option(help="The same seed gives the same result.")] = None,
    force: Annotated[bool, typer.Option("--force", help="Write even if the folder holds another case.")] = False,
) -> None:
    """Design the best absorber for a case, verify it and compare it with the tuned mass damper.

    What is asked for stands in the section design of the case; options take its place. With --members: the fewest
    kinds of absorber with which every member of a table passes that fails alone.
    """
    if masses is not None and mass_ratio is not None:
        raise ParameterError("--masses", masses, "left out where --mass-ratio is given")
    given: dict[str, Any] = {
        "objective": objective, "family": family, "scatter": scatter, "quantile": quantile,
        "force_margin": force_margin, "stroke": stroke, "spring_length": spring_length,
        "spring_stress": spring_stress, "kappa": kappa, "linear": linear, "quintic": quintic, "xi2": xi2,
        "count": None if count is None else number_or_range("--count", count), "devices": devices,
        "mass_shares": None if mass_shares is None else _shares(mass_shares),
        "position": position, "wind": wind, "samples": samples, "seed": seed,
    }  # fmt: skip
    asked = {name: value for name, value in given.items() if value is not None}
    if members is not None:
        beside = {"CASE": case, "masses": masses, **asked}
        design_members(members, products, mass_ratio, out, beside, force=force)
        return
    if products is not None:
        raise ParameterError("--products", products, "left out where there is no --members")
    if case is None:
        raise ParameterError("CASE", "nothing", "a case, or a table of members as --members MEMBERS")
    _design_case(case, masses or mass_ratio, out, asked, force=force)


def _design_case(
    case: str, ratio: float | Range | None, out: Path | None, asked: dict[str, Any], *, force: bool
) -> None:
    """The best absorber for one case, on disk and in a few lines."""
    from frahm.case import load_case
    from frahm.cli.folder import claim_folder, default_folder
    from frahm.cli.progress import shown_progress

    loaded = load_case(case)
    own = default_folder(loaded)
    folder = own.with_name(f"{own.name}-design") if out is None else out
    say_notes(loaded)
    with shown_progress() as progress, compiled_ahead():
        progress("loading", 0, 1)
        with held_interrupts():
            import xarray  # noqa: F401 - imported here, where nothing can stop it half-way

            from frahm.design import check_design, design_absorber, save_design, step_weights
            from frahm.report import write_design_report

        check_design(loaded, ratio, **asked)  # before anything is written
        claim_folder(folder, loaded, force=force)
        progress.weigh(step_weights(loaded, ratio, **asked))
        study = design_absorber(loaded, ratio, progress=progress, **asked)
        save_design(study, folder)
        write_design_report(study, folder)
    _conclude(study, folder)


def _shares(text: str) -> str | tuple[float, ...]:
    """A word, or numbers with commas between."""
    if "," not in text:
        return text
    try:
        return tuple(float(part) for part in text.split(","))
    except ValueError:
        allowed = "equal, free, or shares with commas between, such as 0.6,0.4"
        raise ParameterError("--mass-shares", text, allowed) from None


def _conclude(study: DesignStudy, folder: Path) -> None:
    from frahm import readable
    from frahm.design import parameters_text

    best, objective = study.best, study.objective
    if best.design is not None:
        value = (
            ""
            if objective.name == "peak" and best.value == best.worst_pipe_peak
            else (f" {objective.title} {best.value:#.4g} {objective.unit_text}".rstrip() + ",")
        )
        typer.echo(
            f"Best {best.name}: {parameters_text(best.design)};{value}"
            f" worst pipe peak {readable.length(best.worst_pipe_peak)} {best.worst.place} over {best.worst.range},"
            f" {'verified' if best.verified else 'UNVERIFIED'}."
        )
    typer.echo(study.headline)
    typer.echo(study.acceptance["sentence"])
    typer.echo(study.verdict)
    if study.as_built_note:
        typer.echo(study.as_built_note)
    typer.echo(f"Report: {folder / 'report.html'} (numbers: summary.json, the design as a case: best.yaml)")
    for doubt in study.unverified:
        typer.echo(f"frahm: {doubt}", err=True)
    if study.interrupted:
        raise typer.Exit(ExitCode.INTERRUPTED)
    if not study.verified:
        raise typer.Exit(ExitCode.UNVERIFIED)
    if study.acceptance.get("verdict") == "fail":
        raise typer.Exit(ExitCode.LIMIT_EXCEEDED)


def stored_design_text(folder: Path) -> str | None:
    """What `frahm design` left in a folder, as text; None if the folder holds something else."""
    from frahm.cli.folder import holds_design
    from frahm.errors import door
    from frahm.files import json_or_nothing

    if not holds_design(folder):
        return None
    with door("DIR", str(folder), "a folder that `frahm design` wrote", "summary.json is damaged."):
        summary = json_or_nothing(folder / "summary.json")
        found = summary["results"]["design"]
        rows = [
            f"  {row['name']:<18} {_metres(row['worst_pipe_peak'])}, {'verified' if row['verified'] else 'unverified'}"
            for row in found["comparison"]
        ]
        lines = [f"{summary['case']['name']}: design of the family {found['family']}", "", found["verdict"]]
        lines += ["", "Worst pipe peak of every device", *rows]
        if summary["unverified"]:
            lines += ["", "Unverified", *(f"  {sentence}" for sentence in summary["unverified"])]
        return "\n".join(lines)


def _metres(value: float | None) -> str:
    """A peak; what is not finite stands as null in the summary."""
    return "not bounded" if value is None else f"{value:.5g} m"
