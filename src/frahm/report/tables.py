"""Rows of the tables in a report, as text ready to be read."""

from __future__ import annotations

import math
import re
from collections.abc import Callable, Mapping
from typing import Any, NamedTuple

from markupsafe import Markup, escape
from pydantic import BaseModel

from frahm import readable
from frahm.analysis import Analysis
from frahm.case import Case, field_values
from frahm.case.fields import FieldValue
from frahm.errors import Outcome
from frahm.loads import vortex_shedding
from frahm.report.numbers import number
from frahm.report.places import at, over_wind, place_head, span, where

_LISTED = 12  # pairs of a table that are still written out
ATTRACTOR_HEAD = [
    "Kind", "Pipe peak [mm]", "Smallest peak of a period [mm]", "Stroke [mm]", "Basin", "95 % interval", "From rest",
]  # fmt: skip
_MARKS = {"pass": "✓ pass", "fail": "✗ fail", "unverified": "? unverified"}


_INDEXED, _SIGNS = re.compile(r"\b([A-Za-z])_([A-Za-z]\w*)\b"), re.compile("[<>]=")
_GREEK = {"omega": "ω", "zeta": "ζ", "rho": "ρ", "sigma": "σ", "nu": "ν"}
_SETTINGS = {
    "slow_flow_form": "Form of the slow flow",
    "harmonic_balance_residual": "Harmonic balance: residual below",
    "integration_tolerance": "Integration: local error below this share of the motion",
    "integration_periods": "Integration: excitation periods",
    "samples_per_period": "Integration: samples in a period",
    "periodic_below": "Periodic: Poincaré section within this share of its size",
}


class InputRow(NamedTuple):
    """One field of the case; the symbol is its letter and its index, `typed` what was written, with its own unit."""

    path: str
    title: str
    symbol: tuple[str, str]
    value: str
    unit: str
    defaulted: bool
    typed: str = ""


def with_indices(rows: list[tuple[str, ...]]) -> list[list[Markup]]:
    """Cells in which letters such as K_s and v_crit have their index below, and <= is one sign."""
    signs = {"<=": "\N{LESS-THAN OR EQUAL TO}", ">=": "\N{GREATER-THAN OR EQUAL TO}"}
    return [
        [Markup(_INDEXED.sub(r"\1<sub>\2</sub>", str(escape(_SIGNS.sub(lambda m: signs[m[0]], cell))))) for cell in row]
        for row in rows
    ]


def input_rows(case: Case, defaulted: list[str], typed: Mapping[str, str]) -> list[InputRow]:
    """Every field of the case in SI units, as typed where that is another unit, those left out in the file marked."""
    return [
        InputRow(
            field.path, field.facts.title, _symbol(field.facts.symbol), _value(field.value), _unit(field.facts.unit),
            field.path in defaulted, _typed(field, typed.get(field.path)),
        )
        for field in field_values(case)
        if field.path not in ("name", "title", "absorbers") and not field.path.startswith("document")
    ]  # fmt: skip


def _typed(field: FieldValue, text: str | None) -> str:
    """What was typed, if it is not the very value in the very unit."""
    same = text is None or text.replace(" ", "") == f"{_value(field.value)}{field.facts.unit}"
    return "" if same else str(text)


def mode_count(case: Case) -> int:
    """Number of modes of the pipe that take part."""
    modal = getattr(case.pipe, "modal", None)
    return 1 if modal is None else len(modal.frequencies)


def derived_rows(case: Case) -> list[tuple[str, str, str]]:
    """What follows from the inputs: name, value, unit."""
    shedding, pipe = vortex_shedding(case), case.pipe
    rows = [
        ("Natural frequency of the pipe", number(pipe.frequency / (2 * math.pi)), "Hz"),
        ("Vortex shedding frequency", number(shedding.frequency_hz), "Hz"),
        ("Detuning of the wind", number(shedding.detuning), "rad/s"),
        ("Amplitude of the lift", number(shedding.lift), "N"),
        ("Reduced velocity", number(shedding.reduced_velocity), ""),
        ("Reynolds number", number(shedding.reynolds_number, 3), ""),
    ]
    units = {"rho2": ("mass over mass of the pipe", ""), "xi2": ("damping over mass of the pipe", "1/s"),
             "kappa": ("cubic stiffness over mass of the pipe", "1/(m² s²)")}  # fmt: skip
    for absorber in case.absorbers:
        for name, value in absorber.normalised(pipe.mass).items():
            text, unit = units[name]
            rows.append((f"{absorber.name}: {text}", number(value, 5), unit))
    return rows


def similarity_rows(analysis: Analysis) -> list[tuple[str, str]]:
    """Name and value of every similarity number."""
    found = analysis.results["wind"]
    band = found["lock_in_band"]
    return [
        ("Reduced velocity U / (f D)", number(found["reduced_velocity"], 3)),
        ("Reynolds number", number(found["reynolds_number"], 3)),
        ("Strouhal number", number(found["strouhal"], 3)),
        ("Mass ratio m / (ρ D²)", number(found["mass_ratio"], 3)),
        ("Mass damping K_s, the Scruton number", number(found["scruton_number"], 3)),
        ("Skop-Griffin number S_G", number(found["skop_griffin_number"], 3)),
        (f"Lock-in band [m/s], {band['standing']}", f"{number(band['low'], 3)} … {number(band['high'], 3)}"),
        ("Time constant of the build-up 1/(ζω) [s]", number(found["build_up_time"], 3)),
    ]


def criterion_rows(analysis: Analysis) -> list[tuple[str, ...]]:
    """Name, condition, verdict, evidence and standing of every onset criterion."""
    words = {True: "yes", False: "no", None: "not decided"}
    return [
        (row["name"], row["condition"], words[row["expects_vibration"]], row["detail"], row["standing"])
        for row in analysis.results["wind"]["criteria"]
    ]


def estimate_rows(analysis: Analysis) -> list[tuple[str, ...]]:
    """Name, ratio, amplitude, what went in and standing of every amplitude estimate."""
    return [
        (row["name"], number(row["ratio"], 3), readable.in_mm(row["amplitude"]), row["detail"], row["standing"])
        for row in analysis.results["wind"]["estimates"]
    ]


def estimate_sentence(analysis: Analysis) -> str:
    """The interval of the estimates beside the computed amplitude."""
    found = analysis.results["wind"]
    low, high, computed = (readable.in_mm(value) for value in (*found["interval"], found["computed"]))
    used = f"this analysis uses the harmonic lift of the case, which gives {computed} mm over its range"
    if sum(row["ratio"] is not None and not math.isnan(row["ratio"]) for row in found["estimates"]) == 1:
        return f"No published estimate can be given; {used}."
    return f"The estimates span {low} … {high} mm; {used}."


def load_cycle_row(analysis: Analysis) -> tuple[str, ...]:
    """Name, number, what went in and standing of the number of load cycles at resonance."""
    found = analysis.results["wind"]["load_cycles"]
    return "EN 1991-1-4, load cycles at resonance", number(found["number"], 3), found["detail"], found["standing"]


def unsteady_rows(analysis: Analysis) -> list[tuple[str, ...]]:
    """Quantity, value with absorbers and value without; one value if there are none."""
    found = analysis.results["unsteady_wind"]
    gusts = found["reduction_by_gusts"]
    rows: list[tuple[str, ...]] = [
        ("Largest pipe displacement [mm]", readable.in_mm(found["pipe_peak"]), readable.in_mm(found["bare_pipe_peak"])),
        ("Pipe rms [mm]", readable.in_mm(found["pipe_rms"]), readable.in_mm(found["bare_pipe_rms"])),
        ("Pipe rms in steady wind of the same mean [mm]", readable.in_mm(found["steady_pipe_rms"]),
         readable.in_mm(found["bare_steady_pipe_rms"])),
        ("Reduction by the gusts", _percent(gusts["with_absorbers"]), _percent(gusts["without_absorbers"])),
        ("Reduction by the absorbers", _percent(found["reduction_by_absorbers"]), "-"),
        ("Amplitude in steady resonant wind [mm]", "-", readable.in_mm(found["resonant_amplitude"])),
        ("Build-up in steady resonant wind, time constant [s]", "-", number(found["build_up_time"])),
    ]  # fmt: skip
    if analysis.results["has_absorber"]:
        return rows
    return [(row[0], row[2]) for row in rows if row[2] != "-"]


def _percent(value: float | None) -> str:
    return "-" if value is None or not math.isfinite(value) else f"{value:.0%}"


def special_point_head(analysis: Analysis) -> list[str]:
    """Column heads of `special_point_rows`."""
    place = place_head(analysis)
    return ["Label", "Kind", place, "Frequency [Hz]", "Pipe peak [mm]", "Stroke [mm]", "Branch", "Status"]


def special_point_rows(analysis: Analysis, method: str = "harmonic-balance") -> list[tuple[str, ...]]:
    """Label, kind, place, frequency in Hz, pipe peak, stroke, branch, status of every special point."""
    from frahm.plotting.lines import KIND_NAMES, special_marks

    name = {"harmonic-balance": "response", "slow-flow": "slow_flow"}[method]
    if name not in analysis.data:
        return []
    found = analysis.results["response"][method]
    detached = {b["number"] for b in found.get("branches", []) if b["detached"]}
    return [
        (
            mark.label, KIND_NAMES[point["kind"]], where(point),
            number(point["frequency"] / (2 * math.pi), 5),
            readable.in_mm(point["pipe_peak"]), readable.in_mm(point["relative_peak"]),
            f"{point['branch']}{' (detached)' if point['branch'] in detached else ''}", point["status"],
        )
        for mark, point in zip(
            special_marks(analysis.data[name], "pipe_peak"), found["special_points"], strict=True
        )
    ]  # fmt: skip


def has_asymmetric(results: dict[str, Any]) -> bool:
    """Whether there is a branch without the symmetry of the equations."""
    branches = results.get("response", {}).get("harmonic-balance", {}).get("branches", [])
    return any(branch["asymmetric"] for branch in branches)


def branch_rows(analysis: Analysis) -> list[tuple[str, ...]]:
    """Number, kind, range of wind or detuning, largest pipe peak, stability of every branch of the exact response."""
    found = analysis.results.get("response", {}).get("harmonic-balance", {})
    return [
        (
            str(branch["number"]),
            " ".join(name for name in ("detached", "asymmetric") if branch[name]) or "main",
            span(branch),
            readable.in_mm(branch["pipe_peak_max"]),
            "yes" if branch["stable_anywhere"] else "no",
        )
        for branch in found.get("branches", [])
    ]


def motion_head(analysis: Analysis) -> list[str]:
    """Column heads of `motion_rows`."""
    head = [place_head(analysis), "Why here", "Kind", "Pipe peak [mm]", "Smallest peak [mm]", "Pipe rms [mm]"]
    return [*head, *(("Stroke [mm]", "Without absorber [mm]", "Ratio") if analysis.results["has_absorber"] else ())]


def motion_rows(analysis: Analysis) -> list[tuple[str, ...]]:
    """Place, reason, kind, largest and smallest peak and rms of every motion; stroke and what absorbers change."""
    rows: list[tuple[str, ...]] = []
    for motion in analysis.results.get("motions", []):
        peak, bare = motion["pipe_peak"], motion["pipe_peak_without_absorber"]
        ratio = peak / bare if peak is not None and bare else None
        pipe = (peak, motion["pipe_envelope"][0], motion["pipe_rms"])
        row = (where(motion), motion["reason"], _ended(motion), *map(readable.in_mm, pipe))
        if analysis.results["has_absorber"]:
            compared = f"{ratio:.3g}" if ratio is not None else "-"
            row = (*row, readable.in_mm(motion["relative_peak"]), readable.in_mm(bare), compared)
        rows.append(row)
    return rows


def _ended(motion: Mapping[str, Any]) -> str:
    """Kind of a motion, and what stopped its integration if something did."""
    outcome = Outcome[str(motion["outcome"]).upper()]
    kind = readable.motion(str(motion["kind"]))
    return kind if outcome.ok else f"{kind}: {outcome.value}"


def attractor_rows(analysis: Analysis) -> list[tuple[str, ...]]:
    """Kind, peaks, envelope, basin fraction with its interval, and whether the motion from rest ends there."""
    return [
        (
            _kind(found),
            *map(readable.in_mm, (found["pipe_peak"], found["pipe_envelope"][0], found["relative_peak"])),
            *_basin(found),
        )
        for found in analysis.results.get("attractors", [])
    ]  # fmt: skip


def coexisting_rows(analysis: Analysis) -> list[tuple[str, ...]]:
    """Place, kind, peaks and basin of every attractor at frequencies of the range that have several."""
    return [
        (
            where(found), _kind(found),
            *map(readable.in_mm, (found["pipe_peak"], found["relative_peak"])),
            *_basin(found),
        )
        for found in analysis.results.get("coexisting", [])
    ]  # fmt: skip


def _kind(found: dict[str, Any]) -> str:
    multiple = found["period_multiple"]
    kind = _ended(found)
    return f"{kind}, {multiple} periods" if multiple > 1 else kind


def _basin(found: dict[str, Any]) -> tuple[str, str, str]:
    low, high = found["basin_interval"]
    return (
        f"{100 * found['basin_fraction']:.3g} %",
        f"{100 * low:.3g} … {100 * high:.3g} %",
        "yes" if found["from_rest"] else "no",
    )


def basin_caption(analysis: Analysis) -> str:
    """What the basin map shows, and where."""
    mapped, design = analysis.results["basin_map"], vortex_shedding(analysis.case).detuning
    here = math.isclose(mapped["detuning"], design, rel_tol=1e-9)
    place = "at the design wind" if here else "where the worst motion is"
    return (
        f"Motion reached from an initial displacement and velocity of the pipe {place},"
        f" {at(mapped)}, the absorber at rest relative to it. The cross is rest."
    )


def modulated_sentence(analysis: Analysis) -> str:
    """Where modulated responses are stable and coexist with periodic ones, as sentences; empty if there are none."""
    found = analysis.results.get("modulated")
    if not found or not found["ranges"]:
        return ""
    both = _ranges_text(found["coexistence"])
    beside = f"; in {both} beside a stable periodic response, so that the start decides" if both else ""
    return (
        f"By the slow flow a stable modulated response exists at detunings {_ranges_text(found['ranges'])} rad/s"
        f"{beside}. Its amplitude reaches {readable.length(found['pipe_max'])} at the pipe and"
        f" {readable.length(found['relative_max'])} at the absorber."
    )


def _ranges_text(ranges: list[list[float]]) -> str:
    return " and ".join(f"{number(lo)} … {number(hi)}" for lo, hi in ranges)


def other_mode_rows(analysis: Analysis) -> list[tuple[str, ...]]:
    """Mode, natural frequency, range, peak, wind, stress range and standing of what else the wind excites."""
    return [
        (
            str(row["mode"]), readable.frequency(row["natural_frequency"]), row["range"].split(",")[0],
            readable.in_mm(row["pipe_peak"]),
            readable.speed(row["wind_speed"]), readable.motion(row["kind"]), readable.in_mpa(row["stress_range"]),
            "yes" if row["verified"] else "no: " + " ".join(row["unverified"]),
        )
        for row in analysis.results.get("other_modes", [])
    ]  # fmt: skip


def worst_sentence(analysis: Analysis) -> str:
    """Where the worst attractor over the window is, as a sentence; empty if it was not searched."""
    worst = analysis.results.get("worst_case")
    if worst is None:
        return ""
    return (
        f"Over the range of operation the largest pipe peak of an attractor that at least"
        f" {100 * worst['min_basin']:.3g} % of the sampled states reach is {readable.length(worst['pipe_peak'])}"
        f" ({readable.motion(worst['kind'])}, {at(worst)}), and the largest stroke"
        f" {readable.length(worst['relative_peak'])}, from {worst['frequencies_searched']} frequencies searched;"
        f" {'verified' if worst['verified'] else 'unverified'}."
    )


def comparison_head(analysis: Analysis) -> list[str]:
    """Column heads of `comparison_rows`."""
    return [place_head(analysis), *(head for head, _, _ in _comparisons(analysis))]


def comparison_rows(analysis: Analysis) -> list[tuple[str, ...]]:
    """Peaks by three methods and their differences, response by response, in order of the detuning."""
    if "cross_check" not in analysis.data:
        return []
    table = analysis.data["cross_check"].sortby("detuning")
    columns = [[form(float(value)) for value in table[name].values] for _, name, form in _comparisons(analysis)]
    places = table["wind_speed" if over_wind(analysis) else "detuning"].values
    return list(zip([number(float(place)) for place in places], *columns, strict=True))


def _comparisons(analysis: Analysis) -> list[tuple[str, str, Callable[[float], str]]]:
    """Head, variable and form of every column that is there."""
    columns: list[tuple[str, str, Callable[[float], str]]] = []
    for name, text in (("pipe", "Pipe"), ("relative", "Stroke")):
        columns += [
            (f"{text}, harmonic balance [mm]", f"{name}_peak", lambda value: number(1e3 * value, 6)),
            ("Off integration by", f"{name}_error", lambda value: f"{value:+.1e}"),
            (f"{text}, slow flow [mm]", f"slow_{name}_peak", lambda value: number(1e3 * value)),
            ("Off by", f"slow_{name}_error", lambda value: f"{value:+.2%}"),
        ]
    return [column for column in columns if column[1] in analysis.data["cross_check"]]


def check_rows(analysis: Analysis) -> list[tuple[str, str, str, str]]:
    """Name, status, its sign in words, detail of every check."""
    return [(check.name, check.status, _MARKS[check.status], check.detail) for check in analysis.checks]


def manifold_rows(analysis: Analysis) -> list[tuple[str, str, str]]:
    """Folds and ceilings of the slow manifold: name, value, unit."""
    manifold = analysis.results.get("slow_manifold")
    if manifold is None:
        return []
    rows = [("λ = ξ₂/(ρ₂ ω); folds exist below 0.577", number(float(manifold["lambda"])), "")]
    folds = manifold["folds"]
    if folds is None:
        return rows
    rows += [
        ("Upper fold: pipe |X|, the ceiling of the modulated response", readable.in_mm(folds["pipe"][0]), "mm"),
        ("Upper fold: absorber |Z|", readable.in_mm(folds["relative"][0]), "mm"),
        ("Absorber |Z| after the jump, the ceiling of the stroke", readable.in_mm(folds["landing"][0]), "mm"),
        ("Lower fold: pipe |X|", readable.in_mm(folds["pipe"][1]), "mm"),
        ("Lower fold: absorber |Z|", readable.in_mm(folds["relative"][1]), "mm"),
    ]
    modulated = [m for m in analysis.results.get("motions", []) if m["kind"] == "modulated"]
    if modulated:
        largest = max(m["pipe_peak"] for m in modulated)
        rows.append(
            ("Largest modulated pipe peak integrated, over the ceiling", f"{largest / folds['pipe'][0]:.3f}", "")
        )
    return rows


def provenance_rows(analysis: Analysis) -> list[tuple[str, str]]:
    """Versions, seed and tolerances: name and value."""
    found, settings = analysis.results["provenance"], analysis.case.analysis
    rows = [("frahm", analysis.version), *found["versions"].items()]
    rows += [("Seed of the sampled initial states", str(settings.seed)), ("Initial states", str(settings.samples))]
    return rows + [
        (_SETTINGS.get(name, name.replace("_", " ")), number(value)) for name, value in found["settings"].items()
    ]


def _symbol(symbol: str) -> tuple[str, str]:
    letter, _, index = symbol.partition("_")
    return _GREEK.get(letter, letter), index


def _unit(unit: str) -> str:
    return unit.replace("^2", "²").replace("^3", "³")


def _value(value: Any) -> str:
    if value == ():
        return "none"
    if isinstance(value, tuple) and isinstance(value[0], BaseModel):
        return f"{len(value)} rows"
    if isinstance(value, tuple) and isinstance(value[0], tuple):
        pairs = "; ".join(" → ".join(number(entry) for entry in pair) for pair in value)
        return pairs if len(value) <= _LISTED else f"{len(value)} pairs"
    if isinstance(value, tuple):
        return " … ".join(number(float(entry), 6) for entry in value) if len(value) == 2 else str(list(value))
    return number(value, 6)
