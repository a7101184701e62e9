"""Step `lock_in`, and the verdict: what it all comes to in a few sentences."""

from __future__ import annotations

import math
from typing import Any

from frahm import readable
from frahm.analysis.linear import others_of
from frahm.analysis.margin import margin_sentence
from frahm.analysis.section import Section, Work
from frahm.loads import lock_in_band


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
    found = results.get("acceptance")
    return [] if found is None else [found["sentence"]]


def _about_largest(results: dict[str, Any]) -> list[str]:
    largest = results.get("largest_motion")
    if largest is None:
        return []
    over = results.get("worst_case", {}).get("range", "the window")
    if largest["pipe_peak"] == 0:
        return [f"Over {over}, nothing excites the pipe, for the lift is zero: no motion lasts."]
    text = (
        f"Over {over}, the largest pipe motion found, transients aside, is {readable.length(largest['pipe_peak'])} "
        f"({largest['kind']}, {_place(largest)})"
    )
    if not results["has_absorber"]:
        return [text + "; there is no absorber."]
    ratio = largest["ratio_to_no_absorber"]
    bare = results["without_absorber"]["pipe_peak_max"]
    if ratio is None:
        return [f"{text}; without an absorber no damping bounds the resonance."]
    return [text + f": {readable.share(ratio)} of the {readable.length(bare)} at resonance without an absorber."]


def _place(found: dict[str, Any]) -> str:
    """Where a motion is, for a sentence."""
    speed = found.get("wind_speed")
    if speed is not None and math.isfinite(speed):
        return f"at {readable.speed(speed)}"
    return f"at detuning {found['detuning']:.3g} rad/s"


def lock_in(work: Work) -> Section:
    """The motion at the design wind beside the resonant one of the mode this wind may lock in to, and which counts."""
    motions, worst = work.done.results.get("motions"), work.done.results.get("worst_case")
    if not motions or worst is None:
        return Section()
    speed, here = work.case.wind.speed, motions[0]
    bands = [lock_in_band(case) for case in (work.case, *(case for case, _ in others_of(work)))]
    modes = [worst["of_governing_mode"], *(row["pipe_peak"] for row in work.done.results["other_modes"])]
    held = [at for at, band in enumerate(bands) if band.low <= speed <= band.high]
    mode = max(held, key=lambda at: modes[at], default=0)
    band, resonant, inside = bands[mode], modes[mode], bool(held)
    return Section(results={"lock_in": {
        "design_wind": speed, "band": [band.low, band.high], "standing": band.standing, "inside": inside,
        "at_design_wind": here["pipe_peak"], "kind": here["kind"],
        "at_design_wind_without_absorber": here["pipe_peak_without_absorber"],
        "resonant": resonant, "counted": resonant if inside else here["pipe_peak"],
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
    kind = "not settled yet" if found["kind"] == "unsettled" else found["kind"]
    moves = f"the pipe, started at rest, moves {readable.length(found['at_design_wind'])} ({kind}{against})"
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
