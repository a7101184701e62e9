"""Commands that deal with case files: check, new, cases, schema."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

CaseArgument = Annotated[str, typer.Argument(metavar="CASE", help="Name of a built-in case, or a YAML or TOML file.")]


def check(case: CaseArgument) -> None:
    """Check a case and show what it says, in SI units."""
    from frahm.case import load_case
    from frahm.cli.summary import case_summary

    typer.echo(case_summary(load_case(case)))


def new(
    file: Annotated[
        Path,
        typer.Argument(metavar="FILE", help="File to write, ending in .yaml or .yml; of members in .csv or .xlsx."),
    ],
    kind: Annotated[
        str | None,
        typer.Option(
            metavar="KIND", help="What is known of the pipe: mode (one mode, default), tube or table (of modes)."
        ),
    ] = None,
    study: Annotated[
        bool, typer.Option("--study", help="Write a small study for frahm sweep; it runs within a minute.")
    ] = False,
    members: Annotated[
        bool, typer.Option("--members", help="Write a table of members for frahm screen, as CSV or XLSX.")
    ] = False,
    force: Annotated[bool, typer.Option("--force", help="Replace FILE if it exists.")] = False,
) -> None:
    """Write a commented case file, a study, or a table of members, to start from."""
    from frahm.errors import ParameterError, check_choice
    from frahm.files import write_text

    if members:
        _new_members(file, study or kind is not None, force)
        return
    if study and kind is not None:
        raise ParameterError("--kind", kind, "nothing beside --study, whose case is a built-in one or a file")
    if file.suffix.lower() not in (".yaml", ".yml"):
        raise ParameterError("FILE", str(file), "a file that ends in .yaml or .yml")
    from frahm.case import TEMPLATE_KINDS, template_text

    template = check_choice("--kind", "mode" if kind is None else kind, TEMPLATE_KINDS)
    _check_new(file, force)
    if study:
        from frahm.sweep.study_file import study_template

        write_text(file, study_template(file.stem))
        typer.echo(f"{file} written. Edit it, then: frahm sweep {file} --store {file.with_suffix('.zarr')}")
        return
    write_text(file, template_text(file.stem, template))
    typer.echo(f"{file} written. Edit it, then: frahm check {file}")


def _check_new(file: Path, force: bool) -> None:
    from frahm.errors import ParameterError

    if file.exists() and (file.is_dir() or not force):
        hint = "It is a directory." if file.is_dir() else "It exists; --force replaces it."
        raise ParameterError("FILE", str(file), "a file that does not exist yet", hint=hint)


def _new_members(file: Path, others: bool, force: bool) -> None:
    from frahm.errors import ParameterError
    from frahm.files import write_bytes

    if others:
        raise ParameterError("--members", True, "alone, without --study and --kind")
    if file.suffix.lower() not in (".csv", ".xlsx"):
        raise ParameterError("FILE", str(file), "a file that ends in .csv or .xlsx")
    _check_new(file, force)
    from frahm.screening import template_csv, template_xlsx

    write_bytes(file, template_xlsx() if file.suffix.lower() == ".xlsx" else template_csv().encode())
    typer.echo(f"{file} written. Edit it, then: frahm screen {file}")


def cases() -> None:
    """List the built-in cases."""
    from frahm.case import builtin_names, load_case

    width = max(map(len, builtin_names()))
    for name in builtin_names():
        typer.echo(f"{name:<{width}}  {load_case(name).title}")


def schema(study: Annotated[bool, typer.Option("--study", help="Of a study instead.")] = False) -> None:
    """Print the JSON schema of a case file, or of a study."""
    import json

    if study:
        from frahm.sweep import study_schema

        typer.echo(json.dumps(study_schema(), indent=2))
        return
    from frahm.case import case_schema

    typer.echo(json.dumps(case_schema(), indent=2))
