"""`frahm design --members`: the fewest kinds of absorber for all members of a table that fail alone."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Any

import typer

from frahm.cli.guarded import ExitCode, held_interrupts
from frahm.errors import ParameterError

if TYPE_CHECKING:
    from frahm.products import ProductStudy

_TAKEN = ("family", "force_margin")  # what of `frahm design CASE` is asked of products, too
_MASS_RATIO, _FORCE_MARGIN, _PRODUCTS = 0.02, 1.05, (1, 3)


def design_members(
    members: str, products: str | None, mass_ratio: float | None, out: Path | None, given: dict[str, Any], *,
    force: bool,
) -> None:  # fmt: skip
    """Products for the members of a table, on disk and in a few lines; `given` is what else the command was told."""
    from frahm.cli.folder import claim_members_folder, folder_called, products_summary
    from frahm.cli.progress import shown_progress

    for name, value in given.items():
        if value is not None and name not in _TAKEN:
            option = name if name == "CASE" else "--" + name.replace("_", "-")
            raise ParameterError(option, value, "left out where --members is given")
    asked: dict[str, Any] = {
        "family": given.get("family"),
        "mass_ratio": _MASS_RATIO if mass_ratio is None else mass_ratio,
        "force_margin": given.get("force_margin", _FORCE_MARGIN),
    }
    kinds = _PRODUCTS if products is None else number_or_range("--products", products)
    folder = folder_called(f"{Path(members).stem}-products") if out is None else out
    with shown_progress() as progress:
        progress("loading", 0, 1)
        with held_interrupts():
            from frahm.products import check_products, design_products, save_products
            from frahm.report import write_products_report
            from frahm.screening import read_members

        check_products(kinds, **asked)
        table = read_members(members)
        claim_members_folder(folder, table.digest, products_summary(folder), force=force)
        study = design_products(table, kinds, progress=progress, **asked)
        save_products(study, folder)
        write_products_report(study, folder)
    _conclude(study, folder)


def number_or_range(name: str, text: str) -> int | tuple[int, int]:
    """A number, or two of them with a hyphen between."""
    parts = text.replace(" ", "").split("-")
    if len(parts) in (1, 2) and all(part.isdecimal() for part in parts):
        numbers = tuple(int(part) for part in parts)
        return numbers[0] if len(numbers) == 1 else (numbers[0], numbers[1])
    raise ParameterError(name, text, "a whole number, or a range of them such as 1-3")


def _conclude(study: ProductStudy, folder: Path) -> None:
    """Say what came out and where it is; end with the exit code for it."""
    from frahm.cli.terminal import say

    say(study.sentence)
    for line in _product_lines([one.row() for one in study.products]):
        say(line)
    best = study.best
    for kind in best.kinds if best is not None else ():
        say(f"  kind {kind.number}: {kind.text}, for {', '.join(kind.members)}")
    typer.echo(f"Report: {folder / 'report.html'} (table: products.csv, numbers: summary.json, cases: cases/)")
    for name, verdict, why in study.not_served:
        say(f"frahm: note: nothing was designed for {name}, {verdict.lower()}: {why}", err=True)
    for doubt in study.unverified:
        say(f"frahm: {doubt}", err=True)
    if study.interrupted:
        raise typer.Exit(ExitCode.INTERRUPTED)
    if study.fails:
        raise typer.Exit(ExitCode.LIMIT_EXCEEDED)
    if not study.verified:
        raise typer.Exit(ExitCode.UNVERIFIED)


def _product_lines(rows: list[dict[str, Any]]) -> list[str]:
    """A line for every product."""
    from frahm.products import DEVICES
    from frahm.screening import share

    lines = []
    for row in rows:
        used = "not bounded" if row["worst_utilisation"] is None else share(row["worst_utilisation"])
        known = "verified" if row["verified"] else "not verified"
        count = len(row["kinds"])
        title = f"{count} kind{'s' * (count > 1)} of {DEVICES[row['family']]}"
        lines.append(f"  {title:<32} {used:>8}, {row['binds']} binds, {known}")
    return lines


def stored_products_text(folder: Path) -> str | None:
    """What `frahm design --members` left in a folder, as text; None if the folder holds something else."""
    from frahm.cli.folder import products_summary
    from frahm.errors import door

    summary = products_summary(folder)
    if summary is None:
        return None
    with door("DIR", str(folder), "a folder that `frahm design --members` wrote", "summary.json is damaged."):
        results = summary["results"]
        lines = [results["sentence"], *_product_lines(results["products"])]
        if summary["unverified"]:
            lines += ["", "Unverified", *(f"  {sentence}" for sentence in summary["unverified"])]
        return "\n".join(lines)
