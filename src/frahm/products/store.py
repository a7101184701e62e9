"""A design of products on disk: summary.json, products.csv, and every served member with its device as a case."""

from __future__ import annotations

import csv
import io
import json
from collections.abc import Callable
from pathlib import Path
from typing import Any

from frahm.analysis import plain
from frahm.errors import ParameterError
from frahm.files import write_text
from frahm.products.study import ProductStudy
from frahm.screening import cell, file_names

SCHEMA = "frahm-products-1"
SUMMARY_FILE, TABLE_FILE, CASES = "summary.json", "products.csv", "cases"
_MM, _MPA = 1e3, 1e-6
Row = dict[str, Any]


def _scaled(name: str, factor: float) -> Callable[[Row], Any]:
    return lambda row: None if row[name] is None else factor * row[name]


CSV_COLUMNS: tuple[tuple[str, Callable[[Row], Any]], ...] = (
    ("product", lambda row: row["product"]),
    ("recommended", lambda row: "yes" if row["recommended"] else "no"),
    ("member", lambda row: row["member"]),
    ("kind", _scaled("kind", 1)),
    ("utilisation", _scaled("utilisation", 1.0)),
    ("utilisation without", _scaled("utilisation_without", 1.0)),
    ("utilisation by the closed form", _scaled("expected", 1.0)),
    ("peak [mm]", _scaled("pipe_peak", _MM)),
    ("stroke [mm]", _scaled("stroke", _MM)),
    ("stress range [MPa]", _scaled("stress_range", _MPA)),
    ("fatigue damage", _scaled("damage", 1.0)),
    ("verdict", lambda row: row["verdict"]),
    ("unverified", lambda row: " ".join(row["unverified"])),
)


def products_summary(study: ProductStudy) -> Row:
    """Everything as plain data for strict JSON; numbers that are not finite become None."""
    checks = [
        {
            "name": f"{product.title}: every member against all attractors",
            "status": "pass" if product.verified else "unverified",
            "detail": f"{sum(one.verified for one in product.members)} of {len(product.members)} members are verified.",
        }
        for product in study.products
    ]
    found: Row = plain({
        "schema": SCHEMA,
        "frahm": study.version,
        "results": study.results(),
        "checks": checks,
        "unverified": list(study.unverified),
    })  # fmt: skip
    return found


def products_csv(study: ProductStudy) -> str:
    """A line for every member of every product, the recommended product first; units in the head."""
    stream = io.StringIO()
    writer = csv.writer(stream, lineterminator="\n")
    writer.writerow([head for head, _ in CSV_COLUMNS])
    for product in sorted(study.products, key=lambda one: one is not study.best):
        for one in product.members:
            row = plain(one.row() | {"product": product.title, "recommended": product is study.best})
            writer.writerow([cell(value(row)) for _, value in CSV_COLUMNS])
    return stream.getvalue()


def save_products(study: ProductStudy, folder: str | Path) -> list[Path]:
    """Write summary and table into an existing folder, and the members of the recommended product below it.

    Returns
    -------
    list of Path
        Summary, table, and the cases, named after the members.

    Raises
    ------
    ParameterError
        If a file cannot be written.
    """
    folder = Path(folder)
    summary = json.dumps(products_summary(study), indent=2, allow_nan=False, ensure_ascii=False) + "\n"
    write_text(folder / SUMMARY_FILE, summary)
    write_text(folder / TABLE_FILE, products_csv(study))
    return [folder / SUMMARY_FILE, folder / TABLE_FILE, *_save_cases(study, folder / CASES)]


def _save_cases(study: ProductStudy, folder: Path) -> list[Path]:
    if study.best is None:
        return []
    try:
        folder.mkdir(exist_ok=True)
    except OSError as error:
        raise ParameterError("--out", str(folder), "a folder that can be written", hint=f"{error.strerror}.") from None
    members = study.best.members
    paths = [folder / name for name in file_names([one.name for one in members])]
    for path, one in zip(paths, members, strict=True):
        one.case.to_yaml(path)
    return paths
