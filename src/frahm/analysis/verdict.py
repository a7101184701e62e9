"""Steps `largest_motion` and `lock_in`, and the verdict: what it all comes to in a few sentences."""

from __future__ import annotations

import math
from typing import Any

import numpy as np

from frahm import readable
from frahm.analysis.linear import others_of
from frahm.analysis.margin import margin_sentence
from frahm.analysis.section import PASS, UNVERIFIED, Check, Section, Work
from frahm.loads import lock_in_band

_SAME = 1.01  # a motion larger by less is as large
FIXED_LIFT = "The fixed lift is not exceeded by the winds of its window"


def largest_motion(work: Work) -> Section:
    """The one worst motion: that of the search, or what another step met that is larger still."""
    worst = work.done.results.get("worst_case")
    candidates = [*_from_motions(work), *_from_response(work), *_from_worst_case(work)]
    if not candidates:
        return Section()
    largest = max(candidates, key=lambda candidate: candidate["pipe_peak"])
    bare = work.done.results["without_absorber"]["pipe_peak_max"]
    ratio = largest["pipe_peak"] / bare if math.isfinite(bare) and bare > 0 else None
    stroke = max((c["relative_peak"] for c in candidates if c["relative_peak"] is not None), default=None)
    found: dict[str, Any] = {"largest_motion": {**largest, "ratio_to_no_absorber": ratio, "stroke": stroke}}
    doubts: tuple[str, ...] = ()
    if worst is not None:
        found["worst_case"] = {name: largest[name] for name in ("pipe_peak", "detuning", "wind_speed", "kind")}
        found["worst_case"]["frequency"] = largest.get("frequency", work.case.pipe.frequency + largest["detuning"])
        found["worst_case"]["relative_peak"] = max(stroke or 0.0, worst["relative_peak"])
        if largest["pipe_peak"] > _SAME * worst["pipe_peak"]:
            doubts = (f"The search for the worst case missed a motion of {readable.length(largest['pipe_peak'])}"
                      f" ({largest['source']}).",)  # fmt: skip
            found["worst_case"]["verified"] = False
    checks = _fixed_lift(work, largest["pipe_peak"])
    return Section(results=found, checks=checks, unverified=doubts)


def _fixed_lift(work: Work, worst: float) -> tuple[Check, ...]:
    """Where a case asks for one lift over a window: whether the winds that shed there do not move the pipe more."""
    over = work.done.results.get("response_over_wind")
    if work.range.over_wind or over is None:
        return ()
    peak, speed = over["pipe_peak_max_with"], over["wind_speed_with"]
    detail = (
        f"Over the winds that shed in the window, each with its own lift, the largest stable response is"
        f" {readable.length(peak)} (at {readable.speed(speed)}), against {readable.length(worst)} with the lift of"
        f" {readable.speed(work.case.wind.speed)} at every frequency."
    )
    good = not peak > _SAME * worst
    hint = "" if good else " Leave out analysis.detuning, so that the lift follows the wind."
    return (Check(FIXED_LIFT, PASS if good else UNVERIFIED, detail + hint),)


def _from_motions(work: Work) -> list[dict[str, Any]]:
    return [
        {
            "pipe_peak": motion["pipe_peak"],
            "relative_peak": motion["relative_peak"] if work.system.elements else None,
            "detuning": motion["detuning"],
            "wind_speed": motion["wind_speed"],
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
    row = {name: found[name] for name in ("pipe_peak", "relative_peak", "detuning", "wind_speed", "frequency")}
    return [{**row, "kind": readable.motion(found["kind"]), "source": found["tier"]}]


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
            "wind_speed": float(curve["wind_speed"].values[i]) if "wind_speed" in curve else math.nan,
            "kind": "periodic",
            "source": "stable response by harmonic balance",
        }
        for i in places
    ]


def verdict(results: dict[str, Any], failed: int, unverified: int) -> str:
    """What the results come to, in a few sentences."""
    sentences = [
        *_about_acceptance(results),
        *_about_largest(results),
        *_about_lock_in(results),
        *_about_detached(results),
        *_about_fatigue(results),
    ]
    if failed:
        sentences.append(f"{_count(failed, 'check')} failed.")
    if unverified:
        sentences.append(f"{_count(unverified, 'statement')} could not be verified.")
    return " ".join(sentences) or "Nothing was finished."


def _about_acceptance(results: dict[str, Any]) -> list[str]:
    found = results.get("acceptance", {})
    return [found["sentence"]] if found.get("rows") else []


def _about_largest(results: dict[str, Any]) -> list[str]:
    largest = results.get("largest_motion")
    if largest is None:
        return []
    over = results.get("worst_case", {}).get("range", "the window")
    text = (
        f"Over {over}, the largest pipe motion found, transients aside, is {readable.length(largest['pipe_peak'])} "
        f"({largest['kind']}, {_place(largest)})"
    )
    if not results["has_absorber"]:
        return [text + "; there is no absorber."]
    ratio = largest["ratio_to_no_absorber"]
    bare = results["without_absorber"]["pipe_peak_max"]
    if ratio is None:
        why = "there is no lift" if bare == 0 else "without an absorber no damping bounds the resonance"
        return [f"{text}; {why}."]
    return [text + f": {readable.share(ratio)} of the {readable.length(bare)} at resonance without an absorber."]


def _place(found: dict[str, Any]) -> str:
    """Where a motion is, for a sentence."""
    speed = found.get("wind_speed")
    if speed is not None and math.isfinite(speed):
        return f"at {readable.speed(speed)}"
    return f"at detuning {found['detuning']:.3g} rad/s"


def lock_in(work: Work) -> Section:
    """The motion at the design wind beside the resonant one, and which of them counts."""
    motions, worst = work.done.results.get("motions"), work.done.results.get("worst_case")
    if not motions or worst is None:
        return Section()
    speed, here = work.case.wind.speed, motions[0]
    bands = [lock_in_band(case) for case in (work.case, *(case for case, _ in others_of(work)))]
    band = next((band for band in bands if band.low <= speed <= band.high), bands[0])
    inside = bool(band.low <= speed <= band.high)
    return Section(results={"lock_in": {
        "design_wind": speed, "band": [band.low, band.high], "standing": band.standing, "inside": inside,
        "at_design_wind": here["pipe_peak"], "kind": here["kind"],
        "at_design_wind_without_absorber": here["pipe_peak_without_absorber"],
        "resonant": worst["pipe_peak"], "counted": worst["pipe_peak"] if inside else here["pipe_peak"],
    }})  # fmt: skip


def _about_lock_in(results: dict[str, Any]) -> list[str]:
    found = results.get("lock_in")
    if found is None or found["at_design_wind"] is None or not math.isfinite(found["at_design_wind"]):
        return []
    low, high = found["band"]
    band = f"the winds in which codes expect lock-in, {low:.3g} ... {high:.3g} m/s ({found['standing']})"
    bare = found["at_design_wind_without_absorber"]
    against = ""
    if results["has_absorber"] and bare is not None and math.isfinite(bare):
        against = f", {readable.length(bare)} without an absorber"
    moves = f"the pipe, started at rest, moves {readable.length(found['at_design_wind'])} ({found['kind']}{against})"
    if not found["inside"]:
        return [f"At the design wind of {readable.speed(found['design_wind'])}, outside {band}, {moves}."]
    text = f"The design wind of {readable.speed(found['design_wind'])} is one of {band}: the resonant motion counts"
    return [f"{text}, {readable.length(found['resonant'])}; without lock-in {moves}."]


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
    text = f"The fatigue damage of {readable.duration(years * readable.YEAR)}{times} is {used:.2g}"
    if results["has_absorber"]:
        text += f" with the worst motion at every wind, {bare:.2g} without absorbers"
    if not used <= 1:
        return [f"{text}."]
    held = factor * found["locked_in_with"]
    return [f"{text}; {held:.2g} if the shedding locked in over the whole lock-in band at the worst of it."]


def _count(number: int, what: str) -> str:
    return f"{number} {what}{'' if number == 1 else 's'}"
