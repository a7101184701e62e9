"""Rows on motions and attractors, the worst of them and their basins, as text ready to be read."""

from __future__ import annotations

import math
from collections.abc import Mapping
from typing import Any

from frahm import readable
from frahm.analysis import CaseAnalysis
from frahm.errors import Outcome
from frahm.loads import vortex_shedding
from frahm.report.places import at, place_head, where

ATTRACTOR_HEAD = [
    "Kind", "Pipe peak [mm]", "Smallest peak of a period [mm]", "Stroke [mm]", "Basin", "95 % interval", "From rest",
]  # fmt: skip


def motion_head(analysis: CaseAnalysis) -> list[str]:
    """Column heads of `motion_rows`."""
    head = [place_head(analysis), "Why here", "Kind", "Pipe peak [mm]", "Smallest peak [mm]", "Pipe rms [mm]"]
    return [*head, *(("Stroke [mm]", "Without absorber [mm]", "Ratio") if analysis.results["has_absorber"] else ())]


def motion_rows(analysis: CaseAnalysis) -> list[tuple[str, ...]]:
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
    """Kind of a motion, after how many periods it repeats, and what stopped its integration if something did."""
    outcome = Outcome[str(motion["outcome"]).upper()]
    kind = readable.motion(str(motion["kind"]), motion.get("period_multiple", 0))
    return kind if outcome.ok else f"{kind}: {outcome.value}"


def attractor_rows(analysis: CaseAnalysis) -> list[tuple[str, ...]]:
    """Kind, peaks, envelope, basin fraction with its interval, and whether the motion from rest ends there."""
    return [
        (
            _ended(found),
            *map(readable.in_mm, (found["pipe_peak"], found["pipe_envelope"][0], found["relative_peak"])),
            *_basin(found),
        )
        for found in analysis.results.get("attractors", [])
    ]  # fmt: skip


def coexisting_rows(analysis: CaseAnalysis) -> list[tuple[str, ...]]:
    """Place, kind, peaks and basin of every attractor at frequencies of the range that have several."""
    return [
        (
            where(found), _ended(found),
            *map(readable.in_mm, (found["pipe_peak"], found["relative_peak"])),
            *_basin(found),
        )
        for found in analysis.results.get("coexisting", [])
    ]  # fmt: skip


def _basin(found: dict[str, Any]) -> tuple[str, str, str]:
    low, high = found["basin_interval"]
    return (
        f"{100 * found['basin_fraction']:.3g} %",
        f"{100 * low:.3g} … {100 * high:.3g} %",
        "yes" if found["from_rest"] else "no",
    )


def basin_caption(analysis: CaseAnalysis) -> str:
    """What the basin map shows, and where."""
    mapped, design = analysis.results["basin_map"], vortex_shedding(analysis.case).detuning
    here = math.isclose(mapped["detuning"], design, rel_tol=1e-9)
    place = "at the design wind" if here else "where the worst motion is"
    return (
        f"Motion reached from an initial displacement and velocity of the pipe {place},"
        f" {at(mapped)}, the absorber at rest relative to it. The cross is rest."
    )


def worst_sentence(analysis: CaseAnalysis) -> str:
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
