"""Answers to the script of the page: what is drawn for the values its fields show."""

from __future__ import annotations

import functools
import json
from collections.abc import Mapping
from typing import Any

from frahm.case import Case
from frahm.errors import ParameterError
from frahm.loads import lock_in_band
from frahm.web import words
from frahm.web.asked import read_case, read_json
from frahm.web.controls import Reading, controls_of, field_texts, reading, spans, with_sink
from frahm.web.figures import linear_lines, manifold_part, map_part, slow_part
from frahm.web.layout import heading
from frahm.web.scope import has_slow_flow
from frahm.web.sessions import ENDED, Sessions
from frahm.web.tuned import bare_response, tuned_mass_damper_response


@functools.lru_cache(maxsize=64)
def _case(text: str) -> Case:
    return read_case(read_json(text, "case"))


def case_of(wanted: Mapping[str, Any]) -> Case:
    """The case that was opened, as the script sends it with every question: JSON text."""
    return _case(wanted["case"])


def response(wanted: Mapping[str, Any]) -> dict[str, Any]:
    """Everything live in the response figure, or what is wrong beside which field."""
    read = reading(case_of(wanted), wanted["values"])
    problems = dict(read.problems)
    if not problems:
        try:
            return _drawn(read, bool(wanted["tuned"]))
        except ParameterError as error:
            names = {control.name for control in controls_of(read.case)}
            problems[error.name if error.name in names else read.axis.name] = str(error)
    return {"problems": problems, "status": words.NOT_VALID}


def _drawn(read: Reading, tuned: bool) -> dict[str, Any]:
    case, axis, slow = read.case, read.axis, has_slow_flow(read.case)
    part: dict[str, Any] = {"lines": [], "points": [], "tops": None}
    status = words.no_slow_status(case)
    if slow:
        part, curve = slow_part(case, read.at)
        status = words.slow_status(curve)
    part["lines"] += linear_lines("bare", bare_response(case))
    if tuned:
        part["lines"] += linear_lines("tuned", tuned_mass_damper_response(case))
    band = lock_in_band(case)
    return {
        "problems": {}, "slow": slow, "key": case.digest, "part": part, "status": status, "heading": heading(case),
        "at": read.at, "wind": axis.wind if abs(axis.wind) < 1e300 else None, "window": axis.ends, "axis": axis.name,
        "absorber": bool(case.absorbers),
        "band": [band.low, band.high] if axis.over_wind and band.low < band.high else None,
    }  # fmt: skip


def beside(wanted: Mapping[str, Any]) -> dict[str, Any]:
    """Slow manifold and stability map; the map only if the one that is drawn belongs to other values."""
    read = reading(case_of(wanted), wanted["values"])
    if read.problems or not has_slow_flow(read.case):
        return {}
    case, plane = read.case, wanted["plane"]
    span = spans(case_of(wanted))[plane]
    same = with_sink(case, plane, span.low).with_name(case.name, "")  # the map does not depend on these
    key = f"{plane} {span.low} {span.high} {same.digest}"
    manifold, lines = manifold_part(case, read.at)
    answer = {
        "manifold": manifold, "status": words.manifold_status(lines), "key": key,
        "now": [read.at, case.absorbers[0].normalised(case.pipe.mass)[plane]],
    }  # fmt: skip
    if wanted["drawn"] != key:
        answer["map"] = map_part(case, plane, (span.low, span.high))
    return answer


def exact(wanted: Mapping[str, Any], sessions: Sessions) -> dict[str, Any]:
    """The exact response; nothing if newer values were asked about meanwhile."""
    read = reading(case_of(wanted), wanted["values"])
    if read.problems:
        return {}
    session = sessions.of(wanted["session"])
    session.deciding.cancel()  # it was about other values
    job = session.quick.ask("exact response", read.case.to_dict())
    if job is None:
        return {}
    if job.result is None:
        return {"key": read.case.digest, "part": None, "status": f"Exact response: unverified. {job.problem}"}
    return {"key": read.case.digest, "part": job.result["part"], "status": words.exact_status(read.case, job.result)}


def decision(wanted: Mapping[str, Any], sessions: Sessions) -> dict[str, Any]:
    """One row of the decision, of the device that is asked about; nothing if newer values were asked about."""
    read, device = reading(case_of(wanted), wanted["values"]), wanted["device"]
    if read.problems:
        return {}
    job = sessions.of(wanted["session"]).deciding.ask("decision", read.case.to_dict(), device=device)
    if job is None or (job.result is None and job.problem in ENDED):
        return {}
    if job.result is None:
        return {"key": read.case.digest, "row": words.no_decision(job.problem)}
    return {"key": read.case.digest, "row": words.decision_row(read.case, device, job.result)}


def warm_up(case: Case, at: float) -> None:
    """Draw once, so that the first visitor finds everything loaded."""
    values = field_texts(case, at)
    wanted = {"case": json.dumps(case.to_dict()), "values": values, "tuned": False, "plane": "kappa", "drawn": ""}
    response(wanted)
