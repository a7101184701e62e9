"""The report of a screening: one HTML file that needs no network, with a table a design office can file."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping, Sequence
from pathlib import Path
from typing import Any

from markupsafe import Markup

from frahm.files import write_text
from frahm.loads import amplitude_estimates, lock_in_band
from frahm.plotting.lines import MM
from frahm.plotting.members import save_member_figures
from frahm.readable import YEAR
from frahm.report.columns import Column, heads, of, rows_of
from frahm.report.environment import kept_together, template, with_indices
from frahm.report.numbers import number
from frahm.report.references import Reference, reference_rows
from frahm.report.report import REPORT_FILE, figures_folder, image_address
from frahm.screening import FAIL, LOOK_CLOSER, NOT_JUDGED, PASS, MemberScreen, share

Row = Mapping[str, Any]
_MARKS = {FAIL: "fail", LOOK_CLOSER: "unverified", NOT_JUDGED: "unverified", PASS: "pass"}
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
        verdict_head=heads(_VERDICTS),
        verdicts=rows_of(_VERDICTS, rows),
        left_out=[(row["name"] or _UNKNOWN, row["place"], row["why"]) for row in results["not_judged"]],
        number_head=heads(_NUMBERS),
        numbers=rows_of(_NUMBERS, rows),
        input_head=heads(_INPUTS),
        inputs=rows_of(_INPUTS, rows),
        criterion_head=heads(_CRITERIA),
        criteria=rows_of(_CRITERIA, _criteria(rows)),
        mode_head=heads(_MODES),
        other_modes=rows_of(_MODES, [row for row in rows if row["mode"] != 1]),
        assumptions=_assumption_rows(screen),
        references=_references(screen),
        provenance=[*results["provenance"]["versions"].items()],
    )


def _status(word: str) -> Markup:
    return Markup('<span class="status {}">{}</span>').format(_MARKS[word], word)


def _most_used(row: Row) -> str:
    used = row["largest_utilisation"]
    limit = max(row["utilisation"], key=lambda name: row["utilisation"][name] or 0.0, default="")
    return _UNKNOWN if used is None else f"{share(used)}, {limit.replace('_', ' ')}"


def _reasons(reasons: Sequence[str]) -> Markup:
    return Markup("<br>").join(kept_together(reason) for reason in with_indices([tuple(reasons)])[0])


def _digits(digits: int) -> Callable[[Any], str]:
    return lambda value: number(value, digits)


def _least(value: float | None, least: float, digits: int) -> str:
    """A number for people; what is too small to matter is "below" that."""
    return f"below {least:g}" if value is not None and 0 < value < least else number(value, digits)


def _times(value: float | None, factor: float) -> float | None:
    return None if value is None else factor * value


def _span(low: float | None, high: float | None) -> str:
    ends = ("no bound" if end is None else number(end, 3) for end in (low, high))
    return " \N{HORIZONTAL ELLIPSIS} ".join(ends)


def _of_fatigue(name: str) -> Callable[[Row], Any]:
    """What the case of a member says of its fatigue."""
    return lambda row: (row["case"].get("fatigue") or {}).get(name, _UNKNOWN)


def _life(row: Row) -> str:
    climate = row["case"].get("climate")
    return _UNKNOWN if climate is None else number(climate["duration"] / YEAR)


def _of_mode(name: str) -> Callable[[Row], Any]:
    """A number of the mode that governs a member."""
    return lambda row: next(one for one in row["modes"] if one["mode"] == row["mode"])[name]


def _criteria(rows: list[Row]) -> list[dict[str, Any]]:
    """Every criterion, and what it says of every member in the winds of its site."""
    found: dict[str, dict[str, Any]] = {}
    for row in rows:
        for one in row["criteria"]:
            found.setdefault(one["name"], {**one, "says": []})["says"].append(one["expects_vibration"])
    return list(found.values())


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


_VERDICTS = [
    Column("Member", of("name")),
    Column("Verdict", of("verdict"), _status),
    Column("Most used", _most_used),
    Column("Why", of("reasons"), _reasons),
]
_NUMBERS = [
    Column("Member", of("name")),
    Column("f [Hz]", of("natural_frequency_hz"), _digits(3)),
    Column("Critical wind [m/s]", of("critical_wind"), _digits(3)),
    Column("Lock-in [m/s]", of("lock_in_band"), lambda band: _span(*band)),
    Column("K\N{LATIN SUBSCRIPT SMALL LETTER S}", of("scruton_number"), _digits(3)),
    Column("Amplitude [mm]", lambda row: _times(row["pipe_peak"], MM), lambda value: _least(value, 0.01, 3)),
    Column("A/D", of("amplitude_ratio"), lambda value: _least(value, 1e-4, 3)),
    Column("Estimates of A/D", of("estimates"), lambda ends: _span(*ends)),
    Column("Stress range [MPa]", lambda row: _times(row["stress_range"], 1e-6), lambda value: _least(value, 0.1, 3)),
    Column("Damage", of("damage"), lambda value: _least(value, 1e-4, 2)),
    Column("Damage if locked in", lambda row: _least(row["damage_locked_in"], 1e-4, 2) if row["excited"] else _UNKNOWN),
]
_INPUTS = [
    Column("Member", of("name")),
    Column("D [mm]", lambda row: MM * row["diameter"], _digits(4)),
    Column("t [mm]", lambda row: MM * row["wall"], _digits(4)),
    Column("L [m]", of("length"), _digits(4)),
    Column("Ends", of("ends")),
    Column("Damping [%]", lambda row: 100 * row["damping_ratio"], _digits(3)),
    Column("Mass [kg/m]", of("mass_per_length"), _digits(4)),
    Column("Winds [m/s]", of("site_winds"), lambda winds: _span(*winds)),
    Column("Modes", of("mode_count")),
    Column("Curve", _of_fatigue("curve"), number),
    Column("SCF", _of_fatigue("stress_concentration"), number),
    Column("DFF", _of_fatigue("design_fatigue_factor"), number),
    Column("Life [years]", _life),
    Column("Row", lambda row: row["place"].rpartition(":")[2]),
]
_MODES = [
    Column("Member", of("name")),
    Column("Mode", of("mode")),
    Column("f [Hz]", _of_mode("natural_frequency"), lambda omega: number(omega / (2 * math.pi), 3)),
    Column("Wind [m/s]", _of_mode("wind_speed"), _digits(3)),
    Column("Amplitude [mm]", _of_mode("pipe_peak"), lambda peak: number(_times(peak, MM), 3)),
    Column("of the first mode [mm]", lambda row: number(_times(row["modes"][0]["pipe_peak"], MM), 3)),
]
_CRITERIA = [
    Column("Criterion", of("name")),
    Column("It expects vibration for", of("condition")),
    Column("Yes", lambda one: one["says"].count(True)),
    Column("No", lambda one: one["says"].count(False)),
    Column("Not decided", lambda one: one["says"].count(None)),
    Column("Standing", of("standing")),
]
