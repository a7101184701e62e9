"""Rows on the response curves: special points, branches, modes and slow manifold, as text ready to be read."""

from __future__ import annotations

import math
from typing import Any

from frahm import readable
from frahm.analysis import CaseAnalysis
from frahm.report.columns import Column, heads, of, rows_of, yes_or_no
from frahm.report.numbers import number
from frahm.report.places import place_head, span, where


def special_point_head(analysis: CaseAnalysis) -> list[str]:
    """Head of `special_point_rows`."""
    return heads(_special_points(analysis, set()))


def special_point_rows(analysis: CaseAnalysis, method: str = "harmonic-balance") -> list[tuple[str, ...]]:
    """Every special point of a method."""
    from frahm.plotting.lines import special_marks

    name = {"harmonic-balance": "response", "slow-flow": "slow_flow"}[method]
    if name not in analysis.data:
        return []
    found = analysis.results["response"][method]
    detached = {b["number"] for b in found.get("branches", []) if b["detached"]}
    marks = special_marks(analysis.data[name], "pipe_peak")
    records = [{"label": mark.label} | point for mark, point in zip(marks, found["special_points"], strict=True)]
    return rows_of(_special_points(analysis, detached), records)


def _special_points(analysis: CaseAnalysis, detached: set[int]) -> list[Column]:
    """Columns of special points; `detached` are numbers of branches."""
    return [
        Column("Label", of("label")),
        Column("Kind", of("kind"), _kind_name),
        Column(place_head(analysis), where),
        Column("Frequency [Hz]", lambda point: point["frequency"] / (2 * math.pi), lambda value: number(value, 5)),
        Column("Pipe peak [mm]", of("pipe_peak"), readable.in_mm),
        Column("Stroke [mm]", of("relative_peak"), readable.in_mm),
        Column("Branch", of("branch"), lambda branch: f"{branch}{' (detached)' if branch in detached else ''}"),
        Column("Status", of("status")),
    ]


def _kind_name(kind: str) -> str:
    from frahm.plotting.lines import KIND_NAMES

    return KIND_NAMES[kind]


def has_asymmetric(results: dict[str, Any]) -> bool:
    """Whether there is a branch without the symmetry of the equations."""
    branches = results.get("response", {}).get("harmonic-balance", {}).get("branches", [])
    return any(branch["asymmetric"] for branch in branches)


def branch_head(analysis: CaseAnalysis) -> list[str]:
    """Head of `branch_rows`."""
    return heads(_branches(analysis))


def branch_rows(analysis: CaseAnalysis) -> list[tuple[str, ...]]:
    """Every branch of the exact response."""
    found = analysis.results.get("response", {}).get("harmonic-balance", {})
    return rows_of(_branches(analysis), found.get("branches", []))


def _branches(analysis: CaseAnalysis) -> list[Column]:
    return [
        Column("Branch", of("number")),
        Column("Kind", lambda one: " ".join(name for name in ("detached", "asymmetric") if one[name]) or "main"),
        Column(place_head(analysis), span),
        Column("Largest pipe peak [mm]", of("pipe_peak_max"), readable.in_mm),
        Column("Stable somewhere", of("stable_anywhere"), yes_or_no),
    ]


def modulated_sentence(analysis: CaseAnalysis) -> str:
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


def other_mode_rows(analysis: CaseAnalysis) -> list[tuple[str, ...]]:
    """Every other mode that the wind excites."""
    return rows_of(_OTHER_MODES, analysis.results.get("other_modes", []))


_OTHER_MODES = [
    Column("Mode", of("mode")),
    Column("Frequency", of("natural_frequency"), readable.frequency),
    Column("Over", lambda row: row["range"].split(",")[0]),
    Column("Peak [mm]", of("pipe_peak"), readable.in_mm),
    Column("At", of("wind_speed"), readable.speed),
    Column("Motion", of("kind"), readable.motion),
    Column("Stress range [MPa]", of("stress_range"), readable.in_mpa),
    Column("Verified", lambda row: "yes" if row["verified"] else "no: " + " ".join(row["unverified"])),
]
OTHER_MODE_HEAD = heads(_OTHER_MODES)


def manifold_rows(analysis: CaseAnalysis) -> list[tuple[str, str, str]]:
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
    beating = [m for m in analysis.results.get("motions", []) if m["kind"] in ("modulated", "chaotic")]
    if beating:
        largest = max(beating, key=lambda motion: motion["pipe_peak"])
        ratio = largest["pipe_peak"] / folds["pipe"][0]
        rows.append((f"Largest {largest['kind']} pipe peak integrated, over the ceiling", f"{ratio:.3f}", ""))
    return rows
