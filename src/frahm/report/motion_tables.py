"""Rows on motions and attractors, the worst of them and their basins, as text ready to be read."""

from __future__ import annotations

import math
from collections.abc import Mapping
from typing import Any

from frahm import readable
from frahm.analysis import CaseAnalysis
from frahm.errors import Outcome
from frahm.loads import vortex_shedding
from frahm.report.columns import Column, heads, of, rows_of, yes_or_no
from frahm.report.places import at, place_head, where


def motion_head(analysis: CaseAnalysis) -> list[str]:
    """Head of `motion_rows`."""
    return heads(_motions(analysis))


def motion_rows(analysis: CaseAnalysis) -> list[tuple[str, ...]]:
    """Every motion that was integrated."""
    return rows_of(_motions(analysis), analysis.results.get("motions", []))


def _motions(analysis: CaseAnalysis) -> list[Column]:
    """Columns of the motions: what absorbers change only where there are some."""
    columns = [
        Column(place_head(analysis), where),
        Column("Why here", of("reason")),
        _KIND,
        _PEAK,
        Column("Smallest peak [mm]", lambda motion: motion["pipe_envelope"][0], readable.in_mm),
        Column("Pipe rms [mm]", of("pipe_rms"), readable.in_mm),
    ]
    compared = [
        _STROKE,
        Column("Without absorber [mm]", of("pipe_peak_without_absorber"), readable.in_mm),
        Column("Ratio", _ratio),
    ]
    return columns + (compared if analysis.results["has_absorber"] else [])


def _ratio(motion: Mapping[str, Any]) -> str:
    peak, bare = motion["pipe_peak"], motion["pipe_peak_without_absorber"]
    return f"{peak / bare:.3g}" if peak is not None and bare else "-"


def _ended(motion: Mapping[str, Any]) -> str:
    """Kind of a motion, after how many periods it repeats, and what stopped its integration if something did."""
    outcome = Outcome[str(motion["outcome"]).upper()]
    kind = readable.motion(str(motion["kind"]), motion.get("period_multiple", 0))
    return kind if outcome.ok else f"{kind}: {outcome.value}"


def attractor_rows(analysis: CaseAnalysis) -> list[tuple[str, ...]]:
    """Every attractor at the design wind."""
    return rows_of(_ATTRACTORS, analysis.results.get("attractors", []))


def coexisting_head(analysis: CaseAnalysis) -> list[str]:
    """Head of `coexisting_rows`."""
    return heads(_coexisting(analysis))


def coexisting_rows(analysis: CaseAnalysis) -> list[tuple[str, ...]]:
    """Every attractor at frequencies of the range that have several."""
    return rows_of(_coexisting(analysis), analysis.results.get("coexisting", []))


def _coexisting(analysis: CaseAnalysis) -> list[Column]:
    return [Column(place_head(analysis), where), _KIND, _PEAK, _STROKE, *_BASIN]


def _basin_interval(found: Mapping[str, Any]) -> str:
    low, high = found["basin_interval"]
    return f"{100 * low:.3g} … {100 * high:.3g} %"


_KIND = Column("Kind", _ended)
_PEAK = Column("Pipe peak [mm]", of("pipe_peak"), readable.in_mm)
_STROKE = Column("Stroke [mm]", of("relative_peak"), readable.in_mm)
_BASIN = [
    Column("Basin", of("basin_fraction"), lambda share: f"{100 * share:.3g} %"),
    Column("95 % interval", _basin_interval),
    Column("From rest", of("from_rest"), yes_or_no),
]
_SMALLEST = Column("Smallest peak of a period [mm]", lambda found: found["pipe_envelope"][0], readable.in_mm)
_ATTRACTORS = [_KIND, _PEAK, _SMALLEST, _STROKE, *_BASIN]
ATTRACTOR_HEAD = heads(_ATTRACTORS)


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
