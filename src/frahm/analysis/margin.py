"""Step `detached_curve_margin`: how much more force it takes until a detached response curve appears or merges."""

from __future__ import annotations

import math
import time
from itertools import pairwise
from typing import Any

import numpy as np

from frahm import readable
from frahm.analysis.linear import others_of
from frahm.analysis.section import Section, Work
from frahm.harmonic_balance import LOOKED_AHEAD, births_ahead, is_linear, search_over
from frahm.loads import OperatingRange
from frahm.response import DetachedCurveEvent, ResponseCurve, detached_curve_events
from frahm.response.exact import exact_curve
from frahm.systems import System, build_system, with_parameters

UPWARD, DOWNWARD = (1.0, 1.6, 3.0), (1.0, 0.5, 0.2)  # factors on the force: the search ends with the first find
_LADDER = (1.02, 1.05, 1.1, 1.2, 1.35, 1.6, 2.0, 2.5, 3.0)  # factors asked in turn where the lift follows the wind
_BIRTH = 1e-3  # relative width to which a birth is bisected
_SLICES = 4
_MOST_SADDLE_NODES = 16
_MOST_SECONDS = 30.0
_JUST = 1e-4  # of the force: beyond a birth its curve is met
_BESIDE = 0.002  # of the force: where a merge is looked at from both sides


def detached_curve_margin(work: Work) -> Section:
    """Nearest births and merges of detached curves as the force alone grows or falls, within the window."""
    if is_linear(work.system) or not np.any(work.system.forcing) or "response" not in work.done.data:
        return Section()
    curve = work.done.results["response"]["harmonic-balance"]
    folds = sum(point["kind"] == "saddle-node" for point in curve["special_points"])
    if folds > _MOST_SADDLE_NODES:
        why = f"The response has {folds} saddle-nodes, more than can be followed over the force in reasonable time:"
        return Section(notes=(f"{why} births and merges of detached curves were not searched.",))
    exists = any(branch["detached"] and not branch["asymmetric"] for branch in curve["branches"])
    if work.range.over_wind:
        return _over_the_winds(work, curve, exists)
    end = time.monotonic() + _MOST_SECONDS
    doubts: list[str] = []
    above, highest = _searched(work, UPWARD, end, doubts)
    nearest = min((event.value for event in above), default=highest)
    birth = None if exists else _next_birth(work.system, work.range, nearest)
    below, lowest = _searched(work, DOWNWARD, end, doubts) if exists else ([], 1.0)
    ahead = min(above, key=lambda event: event.value, default=None)
    born = max((e for e in below if e.direction > 0), key=lambda event: event.value, default=None)
    found: dict[str, Any] = {
        "exists": exists,
        "next_event": birth or (None if ahead is None else _described(work, ahead)),
        "born": None if born is None else _described(work, born),
        "searched": [lowest, highest],
    }
    found["force_margin"] = _force_margin(found)
    late = time.monotonic() > end
    note = f"The search for births and merges of detached curves took long: it ended at {highest:g} times the force."
    return Section(
        results={"response": {"harmonic-balance": curve | {"detached_curve_margin": found}}},
        unverified=tuple(dict.fromkeys(f"Births and merges of detached curves: {doubt}" for doubt in doubts)),
        notes=(note,) if late else (),
    )


def _over_the_winds(work: Work, curve: dict[str, Any], exists: bool) -> Section:
    """The same where the lift follows the wind, in every mode that winds excite.

    The curves themselves are asked at more and more force, and then bisected.
    """
    ranges = [(work.system, work.range), *((build_system(case), within) for case, within in others_of(work))]
    exists = exists or any(_detached_count(*one, 1.0) for one in ranges[1:])
    free, taken, event = 1.0, math.nan, None

    def having(force: float) -> list[tuple[System, OperatingRange]]:
        return [one for one in ranges if _detached_count(*one, force)]

    if not exists:
        for force in _LADDER:
            if having(force):
                taken = force
                break
            free = force
        while math.isfinite(taken) and taken - free > _BIRTH * taken:
            middle = 0.5 * (free + taken)
            free, taken = (free, middle) if having(middle) else (middle, taken)
        most = taken if math.isfinite(taken) else free
        births = [event for one in ranges if (event := _next_birth(*one, most)) is not None]
        event = min(births, key=lambda one: one["force"], default=None)
        if event is not None:
            free = taken = event["force"]
        elif math.isfinite(taken):
            event = _born(*having(taken)[0], taken)
    found: dict[str, Any] = {
        "exists": exists,
        "next_event": event,
        "born": None,
        "searched": [1.0, free if event is None else taken],
    }
    found["force_margin"] = math.nan if exists else free
    return Section(results={"response": {"harmonic-balance": curve | {"detached_curve_margin": found}}})


def _next_birth(system: System, within: OperatingRange, most: float) -> dict[str, Any] | None:
    """The nearest birth at more force, below `most` times it: also of a curve that merges again soon after."""
    force = 1.0
    while force < most:
        search = search_over(with_parameters(system, force=force), *within.frequency, None, within.factor)
        for factor, _ in births_ahead(search):
            born = _born(system, within, force * factor) if force * factor < most else None
            if born is not None:
                return born
        force *= LOOKED_AHEAD
    return None


def _born(system: System, within: OperatingRange, force: float) -> dict[str, Any] | None:
    """Where the detached curve is that a factor on the force has made appear; None if there is none beyond it."""
    curve = _curve(system, within, (1 + _JUST) * force)
    new = next((branch for branch in curve.branches if branch.detached and not branch.asymmetric), None)
    if new is None:
        return None
    at = int(np.argmax(new.pipe_peak))
    return {
        "kind": "birth",
        "change": "appears",
        "force": force,
        "frequency": float(new.frequency[at]),
        "detuning": float(new.detuning[at]),
        "wind_speed": float(within.speed(new.frequency[at])),
        "pipe_peak": float(new.pipe_peak[at]),
        "relative_peak": float(new.relative_peak[at]),
    }


def _curve(system: System, within: OperatingRange, force: float) -> ResponseCurve:
    return exact_curve(with_parameters(system, force=force), *within.frequency, None, within.factor)


def _searched(
    work: Work, edges: tuple[float, ...], end: float, doubts: list[str]
) -> tuple[list[DetachedCurveEvent], float]:
    """Events in the first stretch of force factors that has any, and the factor up to which was searched."""
    reached = edges[0]
    for near, far in pairwise(edges):
        if time.monotonic() > end:
            return [], reached
        bounds, window = (min(near, far), max(near, far)), work.range.detuning
        events = detached_curve_events(work.system, "force", bounds, detuning=window, slices=_SLICES)
        doubts += events.unverified
        reached = far
        if events:
            return events, reached
    return [], reached


def _described(work: Work, event: DetachedCurveEvent) -> dict[str, Any]:
    return {
        "kind": event.kind,
        "change": _change(work, event),
        "force": event.value,
        "frequency": event.frequency,
        "detuning": event.frequency - work.system.reference_frequency,
        "pipe_peak": event.pipe_peak,
        "relative_peak": event.relative_peak,
    }


def _change(work: Work, event: DetachedCurveEvent) -> str:
    """What becomes of detached curves as the force grows past the event: "appears", "vanishes", "joins" or "parts".

    A birth tells it by the side on which its pair of saddle-nodes exists. At a merge the curves on both sides tell it.
    """
    if event.kind == "birth":
        return "appears" if event.direction > 0 else "vanishes"
    before, after = (
        _detached_count(work.system, work.range, event.value * factor) for factor in (1 - _BESIDE, 1 + _BESIDE)
    )
    return "parts" if after > before else "joins"


def _detached_count(system: System, within: OperatingRange, force: float) -> int:
    curve = _curve(system, within, force)
    return sum(branch.detached and not branch.asymmetric for branch in curve.branches)


FORCE_MARGIN = "The force margin is the largest factor on the force up to which no detached response curve was met."


def _force_margin(margin: dict[str, Any]) -> float:
    """Largest factor on the force up to which no detached response curve was met [-]; NaN if one was everywhere."""
    if margin["exists"]:
        return math.nan if margin["born"] is None else float(margin["born"]["force"])
    return float(margin["searched"][1] if margin["next_event"] is None else margin["next_event"]["force"])


def margin_sentence(margin: dict[str, Any] | None) -> str:
    """What the margin means, for people; empty if it was not searched."""
    if margin is None:
        return ""
    size, ahead, born = margin["force_margin"], margin["next_event"], margin["born"]
    lo, _ = margin["searched"]
    then = "" if ahead is None else f"{_event(ahead)}, {_place(ahead)}."
    if not margin["exists"]:
        if ahead is None:
            return f"The force margin is at least {size:.4g}: up to that factor no detached response curve was met."
        return f"The force margin is {size:.4g}: beyond that factor on the force {then}"
    if born is None:
        text = f"The force margin is below {lo:g}: a detached response curve exists down to that factor on the force."
    else:
        where = f"at that factor on the force the detached curve is born, {_place(born)}."
        text = f"The force margin is {size:.4g}: {where}"
    return text if ahead is None else f"{text} At the factor {ahead['force']:.4g} {then}"


def _event(event: dict[str, Any]) -> str:
    words = {"joins": "merges with another one", "parts": "splits off"}
    return f"a detached response curve {words.get(event['change'], event['change'])}"


def _place(event: dict[str, Any]) -> str:
    if math.isfinite(event.get("wind_speed", math.nan)):
        return f"at {readable.speed(event['wind_speed'])}"
    return f"at detuning {event['detuning']:.3g} rad/s"
