"""Sentences of the page about what it shows."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from frahm.case import Case
from frahm.web.controls import Control, controls_of, shown, shown_symbol
from frahm.web.sessions import Job

if TYPE_CHECKING:  # loaded when the first curve is drawn, not before the page is shown
    from dash import html

    from frahm.response import ResponseCurve
    from frahm.web.live import ManifoldLines

COMPUTING = "Computing the exact response … (the first time ever, its code is compiled, which takes about a minute)"
LATER = "The exact response follows when the sliders rest."
NOT_VALID = "Drawn for the last valid values: see the field marked."
NO_SLOW_FLOW = (
    "The slow flow is of one mode with one cubic sink: for this case the exact response is drawn, each time the "
    "sliders rest; until then the curve of the last values stays, in a paler tint."
)


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


def exact_status(found: dict[str, Any]) -> str:
    """What the exact response says, and what was not verified."""
    count = found["branches"]
    words = [f"Exact response: {count} {_plural('branch', count)}", f"largest response {_metres(found['largest'])}"]
    if found["largest_stable"] is None:
        words.append("none is stable")
    else:
        stable, at = found["largest_stable"]
        words.append(f"largest stable one {_metres(stable)} at σ = {at:.3g} rad/s")
    if found["detached"]:
        words.append(f"{found['detached']} detached")
    text = "; ".join(words) + "."
    if not found["linear"]:
        text += " Modulated motions are not on this curve: find the attractors."
    return text + _doubts(found["unverified"])


def wind_outside(detuning: float, low: float, high: float) -> str:
    """Why the detuning [rad/s] is not set to that of the wind."""
    return (
        f"The wind sheds at detuning {detuning:.3g} rad/s, outside the window {low:g} ... {high:g} rad/s: "
        "the detuning stays as it is."
    )


def manifold_status(lines: ManifoldLines) -> str:
    """Folds of the slow manifold and the ceiling they set."""
    if lines.folds is None:
        return "No folds at this damping: no jumps, and no ceiling for a modulated response."
    return f"A modulated response of the pipe jumps at {_metres(lines.folds.pipe_ceiling)}, the upper fold."


def motion_status(case: Case, found: dict[str, Any]) -> str:
    """What an integrated motion is, and the values it belongs to."""
    return (
        f"{_values(case, found['detuning'])}, {found['about']}: {found['kind']}; at the end the pipe peaks at "
        f"{_metres(found['pipe_peak'])}, the sink at {_metres(found['relative_peak'])}. {found['outcome']}"
    ).strip()


def attractor_table(case: Case, found: dict[str, Any]) -> html.Div:
    """Attractors with their basin fractions, and the values they belong to."""
    from dash import html

    about = f"{_values(case, found['detuning'])}; {found['samples']} starts, seed {found['seed']}:"
    head = html.Tr([html.Th(text) for text in ("kind", "pipe [m]", "sink [m]", "share of starts (95 %)")])
    rows = [html.Tr(_attractor_cells(row)) for row in found["attractors"]]
    named: dict[str, Any] = {"tabIndex": "0", "role": "region", "aria-label": "attractors found"}
    table = html.Div(html.Table([html.Thead(head), html.Tbody(rows)]), className="table", **named)
    return html.Div([html.P(about, className="status"), table])


def _values(case: Case, detuning: float) -> str:
    """The detuning [rad/s] and every value of the fields, by which what is shown can be told from that of others."""
    values = [
        f"{shown_symbol(control)} = {shown(control.value(case))}{_unit(control)}"
        for control in controls_of(case)
        if control.name != "wind.speed"
    ]
    return f"At σ = {detuning:.4g} rad/s, {', '.join(values)}, wind {shown(case.wind.speed)} m/s"


def _unit(control: Control) -> str:
    """Unit of a value behind its number; the reciprocal ones stand beside the fields alone."""
    unit = control.unit.replace("^2", "²").replace("^3", "³")
    return f" {unit}" if unit and not unit.startswith("1/") else ""


def _attractor_cells(row: dict[str, Any]) -> list[html.Td]:
    from dash import html

    low, high = (100 * share for share in row["basin_interval"])
    share = "-" if row["basin_fraction"] is None else f"{100 * row['basin_fraction']:.3g} % ({low:.2g} to {high:.3g} %)"
    kind = "; ".join(word for word in (row["kind"], "from rest" if row["from_rest"] else "", row["outcome"]) if word)
    numbers = [_metres(row[name], unit="") for name in ("pipe_peak", "relative_peak")]
    return [html.Td(kind), *(html.Td(text, className="number") for text in (*numbers, share))]


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
