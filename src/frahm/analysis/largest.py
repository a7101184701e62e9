"""Step `largest_motion`: the one worst motion, that of the search or what another step met that is larger still."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import Any

import numpy as np

from frahm import readable
from frahm.analysis.section import PASS, UNVERIFIED, Check, Section, Work
from frahm.harmonic_balance import is_linear
from frahm.response.own_lift import OwnLift
from frahm.tolerances import AS_LARGE

Row = dict[str, Any]
_EDGE = 1e-9  # of a frequency: what is no farther beyond the end of the range is at its end
_SIZES = {"pipe_peak": "motion", "relative_peak": "stroke"}
FIXED_LIFT = "The fixed lift is not exceeded by the winds of its window"


def largest_motion(work: Work) -> Section:
    """The one worst motion: that of the search, or what another step met in the range that is larger still.

    A motion from rest is there to be looked at. Where the equations are linear their response is exact, and what a
    motion has beside it is a transient. Elsewhere one that has not settled counts only where it is larger than the
    worst: then nobody knows where it ends.
    """
    worst = work.done.results.get("worst_case")
    met = [*_from_motions(work), *_from_response(work)]
    inside = [row for row in met if _is_inside(work, row["frequency"])]
    candidates = [row for row in inside if row["settled"] or _larger(row, worst)] + _from_worst_case(work)
    if is_linear(work.system) and worst is not None:
        candidates = _from_worst_case(work)
    if not candidates:
        return Section()
    largest = max(candidates, key=lambda candidate: candidate["pipe_peak"])
    stroke = max((row["relative_peak"] for row in candidates if row["relative_peak"] is not None), default=None)
    bare = work.done.results["without_absorber"]["pipe_peak_max"]
    ratio = largest["pipe_peak"] / bare if math.isfinite(bare) and bare > 0 else None
    shown = {name: value for name, value in largest.items() if name != "settled"}
    found: Row = {"largest_motion": {**shown, "ratio_to_no_absorber": ratio, "stroke": stroke}}
    doubts: tuple[str, ...] = ()
    if worst is not None:
        doubts = tuple(_doubts(work, worst, candidates))
        names = ("pipe_peak", "detuning", "wind_speed", "frequency", "kind")
        found["worst_case"] = {name: largest[name] for name in names}
        found["worst_case"]["relative_peak"] = max(stroke or 0.0, worst["relative_peak"])
        found["worst_case"] |= {"verified": False} if doubts else {}
    checks = _fixed_lift(work, largest["pipe_peak"])
    return Section(results=found, checks=checks, unverified=doubts, notes=_outside(work, met, largest))


def _is_inside(work: Work, frequency: float) -> bool:
    lo, hi = work.range.frequency
    return lo * (1 - _EDGE) <= frequency <= hi * (1 + _EDGE)


def _larger(row: Row, worst: Row | None) -> list[str]:
    """In what a motion is larger than the worst: pipe or stroke; in both where there is none."""
    known = [name for name in _SIZES if row[name] is not None]
    return [name for name in known if worst is None or row[name] > AS_LARGE * worst[name]]


def _doubts(work: Work, worst: Row, candidates: Sequence[Row]) -> list[str]:
    """What was met in the range that is larger than the worst: one sentence for the largest of each size."""
    doubts = []
    for name, what in _SIZES.items():
        beyond = [row for row in candidates if name in _larger(row, worst)]
        if not beyond:
            continue
        row = max(beyond, key=lambda one: one[name])
        size, place = readable.length(row[name]), f"at {work.range.place(row['frequency'])}"
        if row["settled"]:
            doubts.append(f"The search for the worst case missed a {what} of {size} {place} ({row['source']}).")
        else:
            doubts.append(
                f"The motion from rest {place} has not settled within {work.case.analysis.periods} periods and has a"
                f" {what} of {size}, more than any that lasts: raise analysis.periods."
            )
    return doubts


def _outside(work: Work, met: Sequence[Row], largest: Row) -> tuple[str, ...]:
    """A note on what moves more outside the range; what is just beyond its ends the search itself looks at."""
    lo, hi = work.range.widened().frequency
    beyond = [row for row in met if row["settled"] and not lo <= row["frequency"] <= hi]
    row = max(beyond, key=lambda one: one["pipe_peak"], default=None)
    if row is None or not row["pipe_peak"] > AS_LARGE * largest["pipe_peak"]:
        return ()
    place = f"at detuning {row['detuning']:.4g} rad/s"
    return (
        f"Outside the range asked about, {place}, the motion is larger than the worst in it:"
        f" {readable.length(row['pipe_peak'])} ({row['source']}).",
    )


def _fixed_lift(work: Work, worst: float) -> tuple[Check, ...]:
    """Where a case asks for one lift over a window: whether the winds that shed there do not move the pipe more."""
    over = work.done.results.get("response_over_wind")
    if work.range.over_wind or over is None:
        return ()
    found = OwnLift(over["pipe_peak_max_with"], over["wind_speed_with"], worst, work.case.wind.speed)
    return (Check(FIXED_LIFT, UNVERIFIED if found.exceeds else PASS, found.text),)


def _from_motions(work: Work) -> list[Row]:
    return [
        {
            "pipe_peak": motion["pipe_peak"],
            "relative_peak": motion["relative_peak"] if work.system.elements else None,
            "detuning": motion["detuning"],
            "wind_speed": motion["wind_speed"],
            "frequency": motion["frequency"],
            "kind": motion["kind"],
            "settled": motion["kind"] != "unsettled",
            "source": "integration from rest",
        }
        for motion in work.done.results.get("motions", [])
        if math.isfinite(motion["pipe_peak"])
    ]


def _from_worst_case(work: Work) -> list[Row]:
    found = work.done.results.get("worst_case")
    if found is None or not math.isfinite(found["pipe_peak"]):
        return []
    row = {name: found[name] for name in ("pipe_peak", "relative_peak", "detuning", "wind_speed", "frequency")}
    return [{**row, "kind": readable.motion(found["kind"]), "settled": True, "source": found["tier"]}]


def _from_response(work: Work) -> list[Row]:
    """The largest stable responses, by pipe and by stroke."""
    if "response" not in work.done.data:
        return []
    curve = work.done.data["response"]
    names = [name for name in ("pipe_peak", "relative_peak") if name in curve]
    stable = curve["stable"].values.astype(bool)
    places = {int(np.argmax(np.where(stable, curve[name].values, -np.inf))) for name in names} if stable.any() else ()
    return [
        {
            "pipe_peak": float(curve["pipe_peak"].values[i]),
            "relative_peak": float(curve["relative_peak"].values[i]) if "relative_peak" in curve else None,
            "detuning": float(curve["detuning"].values[i]),
            "frequency": float(curve["frequency"].values[i]),
            "wind_speed": float(curve["wind_speed"].values[i]) if "wind_speed" in curve else math.nan,
            "kind": "periodic",
            "settled": True,
            "source": "stable response by harmonic balance",
        }
        for i in places
    ]
