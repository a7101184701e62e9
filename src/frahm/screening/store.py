"""A screening on disk: summary.json, members.csv, and the members as cases, each complete or not there at all."""

from __future__ import annotations

import csv
import io
import json
import math
import re
from collections.abc import Callable, Iterable, Sequence
from pathlib import Path
from typing import Any

from frahm.errors import ParameterError
from frahm.files import write_text
from frahm.screening.member import ScreenedMember
from frahm.screening.screen import MemberScreen
from frahm.screening.verdict import NOT_JUDGED, PASS

SCHEMA = "frahm-members-1"
SUMMARY_FILE, TABLE_FILE = "summary.json", "members.csv"
_JUDGED = "Every row of the table is judged"
_MM, _MPA = 1e3, 1e-6
Row = dict[str, Any]
Value = Callable[[Row], Any]


def _scaled(name: str, factor: float = 1.0) -> Value:
    return lambda row: None if row.get(name) is None else factor * row[name]


def _used(name: str) -> Value:
    return lambda row: row.get("utilisation", {}).get(name)


_LIMITS = ("damage", "displacement", "amplitude_ratio", "stress_range", "yield")
CSV_COLUMNS: tuple[tuple[str, Value], ...] = (
    ("name", lambda row: row["name"]),
    ("verdict", lambda row: row["verdict"]),
    ("why", lambda row: " ".join(row["reasons"])),
    ("largest utilisation", _scaled("largest_utilisation")),
    *((f"utilisation {name.replace('_', ' ')}", _used(name)) for name in _LIMITS),
    ("diameter [mm]", _scaled("diameter", _MM)),
    ("wall thickness [mm]", _scaled("wall", _MM)),
    ("length [m]", _scaled("length")),
    ("ends", lambda row: row.get("ends")),
    ("damping ratio [%]", _scaled("damping_ratio", 100.0)),
    ("natural frequency [Hz]", _scaled("natural_frequency_hz")),
    ("critical wind [m/s]", _scaled("critical_wind")),
    ("lock-in from [m/s]", lambda row: row["lock_in_band"][0] if "lock_in_band" in row else None),
    ("lock-in to [m/s]", lambda row: row["lock_in_band"][1] if "lock_in_band" in row else None),
    ("strongest wind [m/s]", lambda row: row["site_winds"][1] if "site_winds" in row else None),
    ("excited", lambda row: None if "excited" not in row else "yes" if row["excited"] else "no"),
    ("K_s", _scaled("scruton_number")),
    ("criteria that expect vibration", lambda row: "; ".join(expecting(row))),
    ("amplitude [mm]", _scaled("pipe_peak", _MM)),
    ("amplitude over diameter", _scaled("amplitude_ratio")),
    ("wind of the amplitude [m/s]", _scaled("wind_speed")),
    ("mode", _scaled("mode", 1)),
    ("stress range [MPa]", _scaled("stress_range", _MPA)),
    ("fatigue damage", _scaled("damage")),
    ("fatigue damage if locked in", _scaled("damage_locked_in")),
    ("life [year]", _scaled("life_years")),
    ("assumed", lambda row: "; ".join(f"{name}: {text}" for name, text in row.get("assumed", {}).items())),
    ("row", lambda row: row["place"]),
)


def expecting(row: Row) -> list[str]:
    """Names of the published criteria that expect vibration of a member at some wind of its site."""
    return [one["name"] for one in row.get("criteria", []) if one["expects_vibration"]]


def summary_of(screen: MemberScreen) -> dict[str, Any]:
    """Everything as plain data for strict JSON; numbers that are not finite become None."""
    left = screen.counts[NOT_JUDGED]
    detail = f"{len(screen) - left} of {len(screen)} rows of {screen.table.title}."
    return {
        "schema": SCHEMA,
        "frahm": screen.version,
        "results": screen.results(),
        "checks": [{"name": _JUDGED, "status": "unverified" if left else "pass", "detail": detail}],
        "unverified": list(screen.unverified),
    }


def members_csv(screen: MemberScreen) -> str:
    """The members as a table, the worst first; units in the head."""
    stream = io.StringIO()
    writer = csv.writer(stream, lineterminator="\n")
    writer.writerow([head for head, _ in CSV_COLUMNS])
    for member in screen.members:
        row = member.row()
        writer.writerow([cell(value(row)) for _, value in CSV_COLUMNS])
    return stream.getvalue()


def cell(value: Any) -> str:
    """A cell of a CSV file; text that a spreadsheet would take for a formula begins with an apostrophe."""
    if value is None:
        return ""
    if isinstance(value, float):
        return f"{value:.6g}" if math.isfinite(value) else ""
    text = str(value)
    return f"'{text}" if text.startswith(("=", "+", "-", "@")) else text


def save_screen(screen: MemberScreen, folder: str | Path) -> list[Path]:
    """Write summary.json and members.csv into an existing folder; return their paths.

    Raises
    ------
    ParameterError
        If a file cannot be written.
    """
    folder = Path(folder)
    summary = json.dumps(summary_of(screen), indent=2, allow_nan=False, ensure_ascii=False) + "\n"
    write_text(folder / SUMMARY_FILE, summary)
    write_text(folder / TABLE_FILE, members_csv(screen))
    return [folder / SUMMARY_FILE, folder / TABLE_FILE]


def wanted_members(screen: MemberScreen, names: Sequence[str]) -> list[ScreenedMember]:
    """The members of these names; without any all that were judged and do not pass.

    Raises
    ------
    ParameterError
        If a name is none of the table, or of a row that could not be read.
    """
    if not names:
        return [member for member in screen.judged if member.verdict.word != PASS]
    found = [screen[name] for name in names]
    for member in found:
        if member.findings is None:
            raise ParameterError("name", member.name, "a member whose row can be read", hint=member.verdict.why)
    return found


def save_cases(members: Iterable[ScreenedMember], folder: str | Path) -> list[Path]:
    """Write members as case files, named after them, into a folder that is made if it is not there; return the paths.

    Raises
    ------
    ParameterError
        If a file cannot be written.
    """
    folder = Path(folder)
    try:
        folder.mkdir(parents=True, exist_ok=True)
    except OSError as error:
        raise ParameterError(
            "--cases", str(folder), "a folder that can be written", hint=f"{error.strerror}."
        ) from None
    chosen = list(members)
    paths = [folder / name for name in file_names([member.name for member in chosen])]
    for path, member in zip(paths, chosen, strict=True):
        member.case.to_yaml(path)
    return paths


def file_names(names: Sequence[str]) -> list[str]:
    """Names of case files, one a member, none like another whatever the case of its letters."""
    taken: set[str] = set()
    files: list[str] = []
    for name in names:
        stem, number = file_name(name), 2
        found = stem
        while found.lower() in taken:
            found, number = f"{stem}-{number}", number + 1
        taken.add(found.lower())
        files.append(f"{found}.yaml")
    return files


def file_name(name: str) -> str:
    """A name with nothing in it that a file system could mind."""
    return re.sub(r"[^\w.-]+", "-", name).strip(".-")[:80] or "member"
