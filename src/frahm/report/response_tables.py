"""Rows on the response curves: special points, branches, modes and slow manifold, as text ready to be read."""

from __future__ import annotations

import math
from typing import Any

from frahm import readable
from frahm.analysis import CaseAnalysis
from frahm.report.numbers import number
from frahm.report.places import place_head, span, where


def special_point_head(analysis: CaseAnalysis) -> list[str]:
    """Column heads of `special_point_rows`."""
    place = place_head(analysis)
    return ["Label", "Kind", place, "Frequency [Hz]", "Pipe peak [mm]", "Stroke [mm]", "Branch", "Status"]


def special_point_rows(analysis: CaseAnalysis, method: str = "harmonic-balance") -> list[tuple[str, ...]]:
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


def branch_rows(analysis: CaseAnalysis) -> list[tuple[str, ...]]:
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
