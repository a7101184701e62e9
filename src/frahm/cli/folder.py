"""The folder a command writes to: whose it is, and whether it may be written."""

from __future__ import annotations

import re
from pathlib import Path
from typing import TYPE_CHECKING, Any

from frahm.errors import ParameterError, door
from frahm.files import json_or_nothing

if TYPE_CHECKING:
    from frahm.case import Case

_OWN_FILES = ("summary.json", "report.html", "report.pdf", "results.nc", "best.yaml", "members.csv", "products.csv")

_OWN_FIGURES = (
    "response-*", "motion-*", "slow-manifold*", "basin-map*", "unsteady-wind*", "fatigue*", "design-*", "decision*",
    "members-*", "products-*",
)  # fmt: skip


# What Windows takes for a device, with any ending.
_DEVICES = {"con", "prn", "aux", "nul", *(f"{port}{i}" for port in ("com", "lpt") for i in range(10))}


def default_folder(case: Case) -> Path:
    """Folder out/<name of the case>, with nothing in the name a file system could mind."""
    return folder_called(case.name)


def folder_called(title: str) -> Path:
    """Folder out/<name>, with nothing in the name a file system could mind."""
    name = re.sub(r"[^\w.-]+", "-", title).strip(".-")
    if name.split(".")[0].lower() in _DEVICES:
        name = f"case-{name}"
    return Path("out") / (name or "case")


def claim_folder(folder: Path, case: Case, *, force: bool) -> None:
    """Make sure `folder` exists, can be written, and holds nothing but this case.

    Raises
    ------
    ParameterError
        If it is a file, cannot be written, or holds anything else and `force` is not set.
    """
    if _occupied(folder) and not holds_case(folder, case):
        _take(folder, force, "a new or empty folder, or one of the same case")
    if not _same_case(folder / "case.yaml", case):
        case.to_yaml(folder / "case.yaml")


def claim_members_folder(folder: Path, digest: str, summary: dict[str, Any] | None, *, force: bool) -> None:
    """Make sure `folder` exists, can be written, and holds nothing but what was made of this very table.

    `summary` is what the folder says if it holds work of the same command; None otherwise.

    Raises
    ------
    ParameterError
        If it is a file, cannot be written, or holds anything else and `force` is not set.
    """
    same = summary is not None and summary["results"]["provenance"]["digest"] == digest
    if _occupied(folder) and not same:
        _take(folder, force, "a new or empty folder, or one of the same table")


def members_summary(folder: Path) -> dict[str, Any] | None:
    """Summary of a folder that `frahm screen` wrote; None if the folder holds something else."""
    from frahm.screening.store import SCHEMA

    summary = json_or_nothing(folder / "summary.json")
    if not isinstance(summary, dict) or summary.get("schema") != SCHEMA:
        return None
    with door("DIR", str(folder), "a folder that `frahm screen` wrote", "summary.json is damaged."):
        return {"unverified": [*summary["unverified"]], "results": {
            "sentence": str(summary["results"]["sentence"]), "members": [*summary["results"]["members"]],
            "not_judged": [*summary["results"]["not_judged"]],
            "provenance": {"digest": str(summary["results"]["provenance"]["digest"])},
        }}  # fmt: skip


def products_summary(folder: Path) -> dict[str, Any] | None:
    """Summary of a folder that `frahm design --members` wrote; None if the folder holds something else."""
    from frahm.products.store import SCHEMA

    summary = json_or_nothing(folder / "summary.json")
    if not isinstance(summary, dict) or summary.get("schema") != SCHEMA:
        return None
    with door("DIR", str(folder), "a folder that `frahm design --members` wrote", "summary.json is damaged."):
        results = summary["results"]
        return {"unverified": [*summary["unverified"]], "results": {
            "sentence": str(results["sentence"]), "products": [*results["products"]], "best": results["best"],
            "provenance": {"digest": str(results["provenance"]["digest"])},
        }}  # fmt: skip


def _occupied(folder: Path) -> bool:
    """Whether a folder, made if it was not there, holds anything."""
    allowed = "a folder that can be written"
    try:
        if folder.exists() and not folder.is_dir():
            raise ParameterError("--out", str(folder), allowed, hint="It is a file.")
        folder.mkdir(parents=True, exist_ok=True)
        return any(folder.iterdir())
    except OSError as error:
        raise ParameterError("--out", str(folder), allowed, hint=f"{error.strerror or error}.") from None


def _take(folder: Path, force: bool, allowed: str) -> None:
    """Refuse a folder that holds something else, or forget the results in it."""
    if not force:
        hint = f"{_contents(folder)} --force writes there all the same."
        raise ParameterError("--out", str(folder), allowed, hint=hint)
    _forget(folder)


def holds_case(folder: Path, case: Case) -> bool:
    """Whether the folder holds this very case: by its summary, or by case.yaml if there is no summary yet."""
    from frahm.case import load_case

    summary = folder / "summary.json"
    if not summary.exists():
        return _same_case(folder / "case.yaml", case)
    found = json_or_nothing(summary)
    try:
        return isinstance(found, dict) and load_case(found.get("case")).digest == case.digest
    except ParameterError:
        return False


def holds_sweep(folder: Path) -> bool:
    """Whether `frahm sweep` wrote the folder; quick, nothing heavy is imported for it."""
    group = json_or_nothing(folder / "zarr.json")
    attributes = group.get("attributes") if isinstance(group, dict) else None
    return isinstance(attributes, dict) and str(attributes.get("schema")).startswith("frahm-sweep-")


def holds_design(folder: Path) -> bool:
    """Whether `frahm design` wrote the folder."""
    from frahm.design.store import SCHEMA

    summary = json_or_nothing(folder / "summary.json")
    return isinstance(summary, dict) and summary.get("schema") == SCHEMA


def _same_case(file: Path, case: Case) -> bool:
    from frahm.case import load_case

    try:
        return file.is_file() and load_case(file).digest == case.digest
    except ParameterError:
        return False


def _contents(folder: Path) -> str:
    if (folder / "summary.json").exists() or (folder / "case.yaml").exists():
        return "It holds another case."
    return "It holds other files."


def _forget(folder: Path) -> None:
    """Remove the results of another case, so that they are never taken for those of this one."""
    own = [folder / name for name in _OWN_FILES]
    own += [path for pattern in _OWN_FIGURES for path in folder.glob(f"figures/{pattern}")]
    for path in own:
        try:
            path.unlink(missing_ok=True)
        except OSError as error:
            raise ParameterError(
                "--out", str(folder), "a folder that can be written", hint=f"{path}: {error.strerror}."
            ) from None
