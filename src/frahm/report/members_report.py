"""The report of a screening: one HTML file that needs no network, with a table a design office can file."""

from __future__ import annotations

import math
from collections.abc import Mapping
from pathlib import Path
from typing import Any

from markupsafe import Markup

from frahm.files import write_text
from frahm.loads import amplitude_estimates, lock_in_band
from frahm.plotting.members import save_member_figures
from frahm.readable import YEAR
from frahm.report.environment import kept_together, template, with_indices
from frahm.report.numbers import number
from frahm.report.references import Reference, reference_rows
from frahm.report.report import REPORT_FILE, figures_folder, image_address
from frahm.screening import FAIL, LOOK_CLOSER, NOT_JUDGED, PASS, MemberScreen, share

Row = Mapping[str, Any]
_MARKS = {FAIL: "fail", LOOK_CLOSER: "unverified", NOT_JUDGED: "unverified", PASS: "pass"}
VERDICT_HEAD = ["Member", "Verdict", "Most used", "Why"]
NUMBER_HEAD = [
    "Member", "f [Hz]", "Critical wind [m/s]", "Lock-in [m/s]", "K\N{LATIN SUBSCRIPT SMALL LETTER S}", "Amplitude [mm]",
    "A/D", "Estimates of A/D", "Stress range [MPa]", "Damage", "Damage if locked in",
]  # fmt: skip
INPUT_HEAD = [
    "Member", "D [mm]", "t [mm]", "L [m]", "Ends", "Damping [%]", "Mass [kg/m]", "Winds [m/s]", "Modes", "Curve", "SCF",
    "DFF", "Life [years]", "Row",
]  # fmt: skip
CRITERION_HEAD = ["Criterion", "It expects vibration for", "Yes", "No", "Not decided", "Standing"]
_UNKNOWN = "-"


def write_members_report(screen: MemberScreen, folder: str | Path) -> Path:
    """Draw the figures into `folder`/figures and write the report beside them; return the path of the report.

    Raises
    ------
    ParameterError
        If a file cannot be written.
    """
    figures, path = figures_folder(folder), Path(folder) / REPORT_FILE
    drawn = save_member_figures(screen.results()["members"], figures)
    images = {file.stem: image_address(file.read_text(encoding="utf-8")) for file in drawn if file.suffix == ".svg"}
    write_text(path, render_members_report(screen, images))
    return path


def render_members_report(screen: MemberScreen, images: dict[str, str]) -> str:
    """The report as HTML text; `images` are addresses of the figures by name."""
    results = screen.results()
    rows = results["members"]
    worst = FAIL if screen.failed else LOOK_CLOSER if screen.unverified else PASS
    return template("members.html.jinja").render(
        screen=screen,
        results=results,
        worst=worst,
        mark=_MARKS[worst],
        images=images,
        plots={},
        verdict_head=VERDICT_HEAD,
        verdicts=[_verdict_row(row) for row in rows],
        left_out=[(row["name"] or _UNKNOWN, row["place"], row["why"]) for row in results["not_judged"]],
        number_head=NUMBER_HEAD,
        numbers=[_number_row(row) for row in rows],
        input_head=INPUT_HEAD,
        inputs=[_input_row(row) for row in rows],
        criterion_head=CRITERION_HEAD,
        criteria=_criterion_rows(rows),
        other_modes=[_mode_row(row) for row in rows if row["mode"] != 1],
        assumptions=_assumption_rows(screen),
        references=_references(screen),
        provenance=[*results["provenance"]["versions"].items()],
    )


def _status(word: str) -> Markup:
    return Markup('<span class="status {}">{}</span>').format(_MARKS[word], word)


def _verdict_row(row: Row) -> tuple[Any, ...]:
    used = row["largest_utilisation"]
    limit = max(row["utilisation"], key=lambda name: row["utilisation"][name] or 0.0, default="")
    most = _UNKNOWN if used is None else f"{share(used)}, {limit.replace('_', ' ')}"
    reasons = Markup("<br>").join(kept_together(reason) for reason in with_indices([tuple(row["reasons"])])[0])
    return row["name"], _status(row["verdict"]), most, reasons


def _number_row(row: Row) -> tuple[str, ...]:
    low, high = row["lock_in_band"]
    stress = row["stress_range"]
    return (
        row["name"], number(row["natural_frequency_hz"], 3), number(row["critical_wind"], 3), _span(low, high),
        number(row["scruton_number"], 3), _least(_times(row["pipe_peak"], 1e3), 0.01, 3),
        _least(row["amplitude_ratio"], 1e-4, 3), _span(*row["estimates"]), _least(_times(stress, 1e-6), 0.1, 3),
        _least(row["damage"], 1e-4, 2), _least(row["damage_locked_in"], 1e-4, 2) if row["excited"] else _UNKNOWN,
    )  # fmt: skip


def _least(value: float | None, least: float, digits: int) -> str:
    """A number for people; what is too small to matter is "below" that."""
    return f"below {least:g}" if value is not None and 0 < value < least else number(value, digits)


def _times(value: float | None, factor: float) -> float | None:
    return None if value is None else factor * value


def _span(low: float | None, high: float | None) -> str:
    ends = ("no bound" if end is None else number(end, 3) for end in (low, high))
    return " \N{HORIZONTAL ELLIPSIS} ".join(ends)


def _input_row(row: Row) -> tuple[str, ...]:
    fatigue, climate = row["case"].get("fatigue"), row["case"].get("climate")
    detail = ("curve", "stress_concentration", "design_fatigue_factor")
    return (
        row["name"], number(1e3 * row["diameter"], 4), number(1e3 * row["wall"], 4), number(row["length"], 4),
        row["ends"], number(100 * row["damping_ratio"], 3), number(row["mass_per_length"], 4),
        _span(*row["site_winds"]), str(row["mode_count"]),
        *(_UNKNOWN if fatigue is None else number(fatigue.get(name, _UNKNOWN)) for name in detail),
        _UNKNOWN if climate is None else number(climate["duration"] / YEAR), row["place"].rpartition(":")[2],
    )  # fmt: skip


def _mode_row(row: Row) -> tuple[str, ...]:
    own = next(one for one in row["modes"] if one["mode"] == row["mode"])
    first = row["modes"][0]
    return (
        row["name"], str(row["mode"]), number(own["natural_frequency"] / (2 * math.pi), 3),
        number(own["wind_speed"], 3), number(_times(own["pipe_peak"], 1e3), 3),
        number(_times(first["pipe_peak"], 1e3), 3),
    )  # fmt: skip


def _criterion_rows(rows: list[Row]) -> list[tuple[str, ...]]:
    """Every criterion, and how many members it expects to vibrate in the winds of their site."""
    found: dict[str, tuple[Row, list[bool | None]]] = {}
    for row in rows:
        for one in row["criteria"]:
            found.setdefault(one["name"], (one, []))[1].append(one["expects_vibration"])
    return [
        (name, one["condition"], *(str(says.count(word)) for word in (True, False, None)), one["standing"])
        for name, (one, says) in found.items()
    ]


def _assumption_rows(screen: MemberScreen) -> list[tuple[str, str, str]]:
    count = len(screen.judged)
    return [
        (name, text, "all" if members == count else str(members))
        for name, (text, members) in screen.assumptions.items()
    ]


def _references(screen: MemberScreen) -> list[Reference]:
    """Everything that any member rests on, once."""
    found: list[Reference] = []
    for member, row in zip(screen.judged, screen.results()["members"], strict=True):
        band = lock_in_band(member.case)
        wind = {"criteria": row["criteria"], "lock_in_band": {"source": band.source, "standing": band.standing}}
        found += reference_rows(member.case, wind, ())
    if screen.judged:
        for estimate in amplitude_estimates(screen.judged[0].case).estimates:
            found.append((f"Amplitude: {estimate.name}", estimate.source, estimate.standing))
    if any(member.ends.startswith("fixity") for member in screen.judged):
        found.append(("Fixity of an end", "Monforton and Wu, J. Struct. Div. ASCE 89 (1963)", "secondary"))
    return list(dict.fromkeys(found))
