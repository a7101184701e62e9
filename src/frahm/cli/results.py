"""The results of an analysis as text for a terminal."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

from frahm.analysis import CaseAnalysis
from frahm.report import check_tables, motion_tables, response_tables


def results_text(analysis: CaseAnalysis) -> str:
    """Verdict, special points, motions, checks and doubts."""
    return "\n".join(_lines(analysis))


def _lines(analysis: CaseAnalysis) -> Iterator[str]:
    case = analysis.case
    yield f"{case.name}: {case.title}" if case.title else case.name
    yield ""
    yield analysis.verdict
    points = response_tables.special_point_rows(analysis)
    if points:
        yield "\nSpecial points"
        yield from _columns(response_tables.special_point_head(analysis), points)
    motions = motion_tables.motion_rows(analysis)
    if motions:
        yield "\nMotions from rest"
        yield from _columns(motion_tables.motion_head(analysis), motions)
    attractors = motion_tables.attractor_rows(analysis)
    if attractors:
        yield "\nAttractors at the design wind"
        yield from _columns(motion_tables.ATTRACTOR_HEAD, attractors)
    yield "\nChecks"
    for name, _, sign, detail in check_tables.check_rows(analysis):
        yield f"  {sign:<13} {name}. {detail}"
    if analysis.unverified:
        yield "\nUnverified"
        yield from (f"  {sentence}" for sentence in analysis.unverified)
    yield "\nLimits"
    yield from (f"  {note}" for note in analysis.notes)


def _columns(head: Sequence[str], rows: Sequence[Sequence[str]]) -> Iterator[str]:
    widths = [max(len(row[i]) for row in (head, *rows)) for i in range(len(head))]
    for row in (head, *rows):
        yield "  " + "  ".join(f"{cell:<{width}}" for cell, width in zip(row, widths, strict=True)).rstrip()
