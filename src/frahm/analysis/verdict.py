"""Steps `largest_motion` and `verdict`: the largest motion found, and what it all comes to in a few sentences."""

from __future__ import annotations

import math
from typing import Any

import numpy as np

from frahm.analysis.margin import margin_sentence
from frahm.analysis.section import Section, Work


def largest_motion(work: Work) -> Section:
    """The largest pipe displacement among the stable responses and the integrated motions."""
    candidates = [*_from_motions(work), *_from_response(work), *_from_worst_case(work)]
    if not candidates:
        return Section()
    largest = max(candidates, key=lambda candidate: candidate["pipe_peak"])
    bare = work.done.results["without_absorber"]["pipe_peak_max"]
    ratio = largest["pipe_peak"] / bare if math.isfinite(bare) and bare > 0 else None
    stroke = max((c["relative_peak"] for c in candidates if c["relative_peak"] is not None), default=None)
    return Section(
        results={"largest_motion": {**largest, "ratio_to_no_absorber": ratio, "stroke": stroke}},
        notes=_at_the_edge(work, largest["detuning"]),
    )


def _at_the_edge(work: Work, detuning: float) -> tuple[str, ...]:
    lo, hi = work.case.analysis.detuning
    if min(abs(detuning - lo), abs(detuning - hi)) > 1e-3 * (hi - lo):
        return ()
    return ("The largest motion lies at the edge of the window: beyond analysis.detuning it may be larger.",)


def _from_motions(work: Work) -> list[dict[str, Any]]:
    return [
        {
            "pipe_peak": motion["pipe_peak"],
            "relative_peak": motion["relative_peak"] if work.system.elements else None,
            "detuning": motion["detuning"],
            "kind": motion["kind"],
            "source": "integration from rest",
        }
        for motion in work.done.results.get("motions", [])
        if math.isfinite(motion["pipe_peak"])
    ]


def _from_worst_case(work: Work) -> list[dict[str, Any]]:
    found = work.done.results.get("worst_case")
    if found is None or not math.isfinite(found["pipe_peak"]):
        return []
    kind = "modulated" if found["kind"] == "quasi-periodic" else found["kind"]
    row = {"pipe_peak": found["pipe_peak"], "relative_peak": found["relative_peak"], "detuning": found["detuning"]}
    return [{**row, "kind": kind, "source": "search for attractors"}]


def _from_response(work: Work) -> list[dict[str, Any]]:
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
            "kind": "periodic",
            "source": "stable response by harmonic balance",
        }
        for i in places
    ]


def verdict(results: dict[str, Any], failed: int, unverified: int) -> str:
    """What the results come to, in two or three sentences."""
    sentences = [
        *_about_largest(results),
        *_about_design_wind(results),
        *_about_detached(results),
        *_about_fatigue(results),
    ]
    if failed:
        sentences.append(f"{_count(failed, 'check')} failed.")
    if unverified:
        sentences.append(f"{_count(unverified, 'statement')} could not be verified.")
    return " ".join(sentences) or "Nothing was finished."


def _about_largest(results: dict[str, Any]) -> list[str]:
    largest = results.get("largest_motion")
    if largest is None:
        return []
    text = (
        f"The largest pipe motion found, transients aside, is {_length(largest['pipe_peak'])} "
        f"({largest['kind']}, at detuning {largest['detuning']:.3g} rad/s)"
    )
    if not results["has_absorber"]:
        return [text + "; there is no absorber."]
    ratio = largest["ratio_to_no_absorber"]
    bare = results["without_absorber"]["pipe_peak_max"]
    if ratio is None:
        why = "there is no lift" if bare == 0 else "without an absorber no damping bounds the resonance"
        return [f"{text}; {why}."]
    return [text + f": {_share(ratio)} of the {_length(bare)} at resonance without an absorber."]


def _about_design_wind(results: dict[str, Any]) -> list[str]:
    if not results.get("motions") or not results["has_absorber"]:
        return []
    motion = results["motions"][0]
    peak, bare = motion["pipe_peak"], motion["pipe_peak_without_absorber"]
    if peak is None or not math.isfinite(peak):
        return []
    text = (
        f"At the design wind (detuning {motion['detuning']:.3g} rad/s) the pipe, started at rest, moves {_length(peak)}"
    )
    against = f", against {_length(bare)} without an absorber" if bare is not None and math.isfinite(bare) else ""
    return [f"{text}{against} ({motion['kind']})."]


def _about_detached(results: dict[str, Any]) -> list[str]:
    exact = results.get("response", {}).get("harmonic-balance", {})
    sentence = margin_sentence(exact.get("detached_curve_margin"))
    return [sentence] if sentence else []


def _about_fatigue(results: dict[str, Any]) -> list[str]:
    found = results.get("fatigue")
    if found is None:
        return []
    years, factor = found["duration_years"], found["design_fatigue_factor"]
    used, bare = found["utilisation_with"], found["utilisation_without"]
    times = f" times the design fatigue factor {factor:g}" if factor != 1 else ""
    text = f"The fatigue damage of {years:.3g} years{times} is {used:.2g}"
    if results["has_absorber"]:
        text += f" with the worst motion at every wind, {bare:.2g} without absorbers"
    if not used <= 1:
        return [f"{text}; that is more than 1."]
    held = factor * found["locked_in_with"]
    return [f"{text}; {held:.2g} if the shedding locked in over the whole lock-in band at the worst of it."]


def _length(value: float) -> str:
    return f"{value:#.3g} m"


def _share(ratio: float) -> str:
    return f"{ratio:.0%}" if ratio < 10 else f"{ratio:.0f} times"


def _count(number: int, what: str) -> str:
    return f"{number} {what}{'' if number == 1 else 's'}"
