"""A design study on disk: summary.json, results.nc and best.yaml, each complete or not there at all."""

from __future__ import annotations

import json
import math
from pathlib import Path
from typing import Any

from frahm.design.study import DesignStudy
from frahm.files import remove_file, write_bytes, write_text

SCHEMA = "frahm-design-1"
SUMMARY_FILE, ARRAYS_FILE, BEST_FILE = "summary.json", "results.nc", "best.yaml"


def save_design(study: DesignStudy, folder: str | Path) -> list[Path]:
    """Write the three files into an existing folder, the summary first, and return their paths.

    Raises
    ------
    ParameterError
        If a file cannot be written.
    """
    folder = Path(folder)
    summary = json.dumps(design_summary(study), indent=2, allow_nan=False, ensure_ascii=False) + "\n"
    arrays = study.to_dataset().to_netcdf(engine="h5netcdf")
    remove_file(folder / ARRAYS_FILE)
    write_text(folder / SUMMARY_FILE, summary)
    study.best_case.to_yaml(folder / BEST_FILE)
    write_bytes(folder / ARRAYS_FILE, arrays)
    return [folder / name for name in (SUMMARY_FILE, ARRAYS_FILE, BEST_FILE)]


def design_summary(study: DesignStudy) -> dict[str, Any]:
    """Everything as plain data for strict JSON; numbers that are not finite become None."""
    return {
        "schema": SCHEMA,
        "frahm": study.version,
        "case": study.case.to_dict(),
        "results": {
            "design": _plain(study.results()),
            "acceptance": _plain(study.acceptance),
            "decision": _plain(study.decision | {"frequency_errors": study.frequency_errors()}),
        },
        "checks": [
            {
                "name": f"Worst case of {rival.name} over all attractors",
                "status": "pass" if rival.verified else "unverified",
                "detail": f"{rival.worst_pipe_peak:.6g} m by {rival.tier}, {rival.samples} states per frequency",
            }
            for rival in study.comparison
        ],
        "unverified": list(study.unverified),
    }


def _plain(value: Any) -> Any:
    if isinstance(value, dict):
        return {str(key): _plain(entry) for key, entry in value.items()}
    if isinstance(value, list | tuple):
        return [_plain(entry) for entry in value]
    if isinstance(value, float) and not math.isfinite(value):
        return None
    return value
