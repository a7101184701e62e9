"""Sentences of the page about what it shows."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Any

import numpy as np

from frahm import readable
from frahm.case import Case
from frahm.loads import lock_in_band
from frahm.web.controls import Control, controls_of, shown, shown_symbol
from frahm.web.scope import Axis
from frahm.web.sessions import Job

if TYPE_CHECKING:  # loaded when the first curve is drawn, not before the page is shown
    from dash import html

    from frahm.response import ResponseCurve
    from frahm.web.live import ManifoldLines

NOT_VALID = "Drawn for the last valid values: see the field marked."
NO_SLOW_FLOW = (
    "The slow flow is of one mode with one cubic sink: for this case the exact response is drawn, each time the "
    "sliders rest; until then the curve of the last values stays, in a paler tint."
)


NO_ABSORBER = "The pipe carries no absorber: its response, in closed form, is all there is to draw."
OVER_WIND = (
    "Over the wind, each with its own lift: the slow flow knows one lift and is not drawn. The exact response is drawn "
    "each time the sliders rest; until then the curve of the last values stays, in a paler tint."
)


def no_slow_status(case: Case) -> str:
    """Why the slow flow is not drawn."""
    if not case.absorbers:
        return NO_ABSORBER
    return OVER_WIND if Axis(case).over_wind else NO_SLOW_FLOW


def slow_status(curve: ResponseCurve) -> str:
    """What the slow flow says, and what it cannot."""
    peak, frequency = curve.largest()
    stable, at = curve.largest(stable_only=True)
    omega = float(curve.frequency[0] - curve.detuning[0])
    words = [f"Slow flow: largest response {_metres(peak)} at σ = {frequency - omega:.3g} rad/s"]
    if np.isnan(stable):
        words.append("none is stable")
    elif stable < peak:
        words.append(f"largest stable one {_metres(stable)} at σ = {at - omega:.3g} rad/s")
    detached = sum(curve.detached)
    if detached:
        words.append(f"{detached} detached {_plural('branch', detached)}")
    return "; ".join(words) + "." + _doubts(curve.unverified)


def exact_status(case: Case, found: dict[str, Any]) -> str:
    """What the exact response says, and what was not verified."""
    count = found["branches"]
    words = [f"Exact response: {count} {_plural('branch', count)}", f"largest response {_metres(found['largest'])}"]
    if found["largest_stable"] is None:
        words.append("none is stable")
    else:
        stable, at = found["largest_stable"]
        words.append(f"largest stable one {_metres(stable)} at {_at(case, at)}")
    if found["detached"]:
        words.append(f"{found['detached']} detached")
    text = "; ".join(words) + "."
    if not found["linear"]:
        text += " Modulated motions are not on this curve: find the attractors."
    return text + _doubts(found["unverified"])


def wind_outside(axis: Axis) -> str:
    """Why the wind of the case is not looked at."""
    low, high = axis.shown
    if axis.over_wind:
        return f"The wind of the case, {axis.wind:.4g} m/s, is outside the range {low:g} ... {high:g} m/s."
    return (
        f"The wind sheds at detuning {axis.wind:.3g} rad/s, outside the window {low:g} ... {high:g} rad/s: "
        "the detuning stays as it is."
    )


def _at(case: Case, at: float) -> str:
    return f"{at:.4g} m/s" if Axis(case).over_wind else f"σ = {at:.3g} rad/s"


def manifold_status(lines: ManifoldLines) -> str:
    """Folds of the slow manifold and the ceiling they set."""
    if lines.folds is None:
        return "No folds at this damping: no jumps, and no ceiling for a modulated response."
    return f"A modulated response of the pipe jumps at {_metres(lines.folds.pipe_ceiling)}, the upper fold."


def motion_status(case: Case, found: dict[str, Any]) -> str:
    """What an integrated motion is, and the values it belongs to."""
    sink = "" if found["relative_peak"] is None else f", the sink at {_metres(found['relative_peak'])}"
    return (
        f"{_values(case, found['at'])}, {found['about']}: {found['kind']}; at the end the pipe peaks at "
        f"{_metres(found['pipe_peak'])}{sink}. {found['outcome']}"
    ).strip()


def attractor_table(case: Case, found: dict[str, Any]) -> html.Div:
    """Attractors with their basin fractions, and the values they belong to."""
    from dash import html

    about = f"{_values(case, found['at'])}; {found['samples']} starts, seed {found['seed']}:"
    head = html.Tr([html.Th(text) for text in ("kind", "pipe [m]", "sink [m]", "share of starts (95 %)")])
    rows = [html.Tr(_attractor_cells(row)) for row in found["attractors"]]
    named: dict[str, Any] = {"tabIndex": "0", "role": "region", "aria-label": "attractors found"}
    table = html.Div(html.Table([html.Thead(head), html.Tbody(rows)]), className="table", **named)
    return html.Div([html.P(about, className="status"), table])


def _values(case: Case, at: float) -> str:
    """The place on the axis and every value of the fields, by which what is shown can be told from that of others."""
    values = [
        f"{shown_symbol(control)} = {shown(control.value(case))}{_unit(control)}"
        for control in controls_of(case)
        if control.name != "wind.speed"
    ]
    place = f"In a wind of {at:.4g} m/s" if Axis(case).over_wind else f"At σ = {at:.4g} rad/s"
    return ", ".join(
        [place, *values, f"wind {'of the case ' if Axis(case).over_wind else ''}{shown(case.wind.speed)} m/s"]
    )


def _unit(control: Control) -> str:
    """Unit of a value behind its number; the reciprocal ones stand beside the fields alone."""
    unit = control.unit.replace("^2", "²").replace("^3", "³")
    return f" {unit}" if unit and not unit.startswith("1/") else ""


def _attractor_cells(row: dict[str, Any]) -> list[html.Td]:
    from dash import html

    low, high = (100 * share for share in row["basin_interval"])
    share = "-" if row["basin_fraction"] is None else f"{100 * row['basin_fraction']:.3g} % ({low:.2g} to {high:.3g} %)"
    name = readable.motion(row["kind"])
    kind = "; ".join(word for word in (name, "from rest" if row["from_rest"] else "", row["outcome"]) if word)
    numbers = [_metres(row[name], unit="") for name in ("pipe_peak", "relative_peak")]
    return [html.Td(kind), *(html.Td(text, className="number") for text in (*numbers, share))]


def decision_row(case: Case, device: str, found: dict[str, Any]) -> dict[str, str]:
    """Cells of a row of the decision, in units people use, and the sentence that belongs to it."""
    from frahm.assessment import headline

    worst, judged = found["worst"], found["acceptance"]
    if worst is None:
        return no_decision("; ".join(found["unverified"]))
    known = [row for row in judged["rows"] if not math.isnan(row["ratio"])]
    most = max(known, key=lambda row: row["ratio"], default=None)
    limits = (
        "no limits given" if most is None else f"{readable.share(most['ratio'])} ({most['name'].replace('_', ' ')})"
    )
    doubt = f" Unverified: {_first(found['unverified'])}" if found["unverified"] else ""
    speed = worst.get("wind_speed")
    windy = speed is not None and math.isfinite(speed)
    return {
        "peak": readable.length(worst["pipe_peak"]),
        "ratio": f"{worst['pipe_peak'] / case.pipe.diameter:.3g}",
        "place": f"at {readable.speed(speed)}" if windy else f"at σ = {round(worst['detuning'], 4) + 0.0:.3g} rad/s",
        "used": limits,
        "verdict": headline(judged),
        "sentence": judged["sentence"] + doubt + _about_band(case)
        if device == ("this" if case.absorbers else "bare")
        else "",
    }


def no_decision(problem: str) -> dict[str, str]:
    """Cells of a row where nothing came out."""
    return {"peak": "-", "ratio": "-", "place": "-", "used": "-", "verdict": "NOT VERIFIED", "sentence": problem}


def _first(doubts: list[str]) -> str:
    more = len(doubts) - 1
    return doubts[0].rstrip(".") + (f", and {more} more: see the full report." if more else ".")


def _about_band(case: Case) -> str:
    band = lock_in_band(case)
    if not band.low < band.high:
        return ""
    return f" Codes expect lock-in from {band.low:.3g} to {band.high:.3g} m/s ({band.standing})."


def attractors_status(found: dict[str, Any]) -> str:
    """The worst of the attractors found, and what did not settle."""
    lost = [row for row in found["attractors"] if row["kind"] == "unsettled"]
    settled = [row for row in found["attractors"] if row["kind"] != "unsettled"]
    words = f"{len(settled)} {_plural('attractor', len(settled))} found"
    if settled:
        words += f"; the largest takes the pipe to {_metres(max(row['pipe_peak'] or 0.0 for row in settled))}"
    if lost:
        share = 100 * sum(row["basin_fraction"] or 0.0 for row in lost)
        words += f". Unverified: {share:.3g} % of the motions have not settled"
    return words + "."


def job_progress(job: Job) -> tuple[str, str]:
    """Text of the progress, and the share done for the bar."""
    title, at, total = job.progress
    share = f"{at / total:.3f}" if total else "0"
    steps = f" ({at + 1} of {total})" if total and at < total else ""
    return f"{job.name}: {title}{steps}, {job.seconds:.0f} s", share


def _metres(value: float | None, unit: str = " m") -> str:
    return "-" if value is None or not np.isfinite(value) else f"{value:.4g}{unit}"


def _doubts(sentences: Any) -> str:
    return f" Unverified: {'; '.join(sentences)}." if sentences else ""


def _plural(word: str, count: int) -> str:
    return word if count == 1 else word + ("es" if word.endswith("ch") else "s")
