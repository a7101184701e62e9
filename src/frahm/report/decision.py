"""The page that decides, at the head of a report: verdict, limits, devices and ranking as text ready to be read."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from typing import Any

from frahm import readable
from frahm.assessment import headline
from frahm.design import SIMPLEST_FIRST
from frahm.plotting.decision import DEVICES
from frahm.report.columns import Column, heads, of, rows_of

RANKING_HEAD = ["Frequency of the pipe off by", "Best first: worst pipe peak [mm]"]
_STATUS = {"pass": "pass", "fail": "fail", "not verified": "unverified"}
_BAR = 1.5  # utilisation that fills the bar


def banner(acceptance: Mapping[str, Any]) -> tuple[str, str, str]:
    """Status for the colour, the verdict in capitals, and the sentence behind it.

    A case without limits is not coloured as one that was judged.
    """
    word = headline(acceptance)
    status = _STATUS[acceptance["verdict"]] if acceptance["rows"] else "open"
    sentence = str(acceptance["sentence"]).removeprefix(word).lstrip(":. ")
    return status, word, sentence[:1].upper() + sentence[1:]


def limit_rows(acceptance: Mapping[str, Any]) -> list[tuple[str, str, str, float]]:
    """Text, utilisation, status and length of the bar in per cent of every limit."""
    rows = []
    for row in acceptance["rows"]:
        ratio = row["ratio"]
        known = ratio is not None and not math.isnan(ratio)
        status = "unverified" if not known else "fail" if ratio > 1 else "pass"
        text = readable.share(ratio) if known else "not known"
        rows.append((row["text"], text, status, 100 * min(ratio / _BAR, 1.0) if known else 0.0))
    return rows


def device_rows(decision: Mapping[str, Any]) -> list[tuple[str, ...]]:
    """A row a device; what is unverified names its reason."""
    remarks = decision.get("remarks", {})
    return rows_of(_DEVICES, [row | {"remark": remarks.get(row["name"])} for row in decision["rows"]])


def _device(row: Mapping[str, Any]) -> str:
    name = DEVICES[row["name"]]
    return f"{name} ({row['remark']})" if row["remark"] else name


def _place(row: Mapping[str, Any]) -> str:
    speed = row["wind_speed"]
    if speed is not None and math.isfinite(speed):
        return readable.speed(speed)
    return "-" if row["detuning"] is None else f"σ = {round(row['detuning'], 4) + 0.0:.3g} rad/s"


def _life(row: Mapping[str, Any]) -> str:
    if row["damage"] is None:
        return "-"
    life = math.inf if row["life_years"] is None else row["life_years"]
    return readable.duration(life * readable.YEAR)


def _used(row: Mapping[str, Any]) -> str:
    used = {name: ratio for name, ratio in row["utilisation"].items() if ratio is not None}
    if not used:
        return "no limit given"
    name = max(used, key=lambda one: used[one])
    share = "below 1%" if used[name] < 0.01 else readable.share(used[name])
    words = f"{name.replace('_', ' ')} {share}"
    return f"{words}: FAIL" if used[name] > 1 else words


def _plain(value: float | None) -> str:
    return "-" if value is None or math.isnan(value) else f"{value:.3g}"


_DEVICES = [
    Column("Device", _device),
    Column("Peak [mm]", of("pipe_peak"), readable.in_mm),
    Column("At", _place),
    Column("Motion", of("kind"), readable.motion),
    Column("A/D", of("amplitude_ratio"), _plain),
    Column("Stress range [MPa]", of("stress_range"), readable.in_mpa),
    Column("Damage × factor", of("damage_times_factor"), _plain),
    Column("Life", _life),
    Column("Stroke [mm]", of("stroke"), readable.in_mm),
    Column("Limit used most", _used),
    Column("Verified", lambda row: "yes" if row["verified"] else "no: " + " ".join(row["unverified"])),
]
DEVICE_HEAD = heads(_DEVICES)


def ranking_rows(errors: Mapping[str, Any]) -> list[tuple[str, str]]:
    """Devices in the order of their worst peak at every error of the pipe's frequency; "?" where one is unverified."""
    if not errors or not errors["pipe_peak"]:
        return []
    rows = []
    for i, error in enumerate(errors["error"]):
        found = [(peaks[i], name, errors["verified"][name][i]) for name, peaks in errors["pipe_peak"].items()]
        found.sort(key=lambda item: (_shown(item[0]), SIMPLEST_FIRST.index(item[1])))
        words = (f"{DEVICES[name]} {readable.in_mm(peak)}{'' if sure else ' ?'}" for peak, name, sure in found)
        rows.append((f"{100 * error:+.3g} %" if abs(error) > 1e-9 else "0 %", ", ".join(words)))
    return rows


def _shown(peak: float | None) -> float:
    """A peak as precisely as it is printed: what reads the same ranks the same."""
    return math.inf if peak is None else float(f"{peak:.3g}")


def left_out_of_ranking(decision: Mapping[str, Any], errors: Mapping[str, Any]) -> str:
    """The devices whose peaks under frequency errors are not known, as a sentence; empty if there are none."""
    known = errors.get("pipe_peak", {})
    missing = [DEVICES[row["name"]] for row in decision["rows"] if row["name"] not in known]
    if not missing or not known:
        return ""
    return f"Not searched here: {' and '.join(missing)}; frahm design searches it."


def numerical_checks(checks: Sequence[tuple[str, str]], unverified: Sequence[str]) -> tuple[str, str]:
    """Status and sentence on the numerical health: name and status of every check, and what else is in doubt."""
    failed = sum(status == "fail" for _, status in checks)
    doubts = len(unverified) + sum(status == "unverified" for _, status in checks)
    if failed:
        more = f", {doubts} unverified" if doubts else ""
        return "fail", f"✗ {failed} of {len(checks)} numerical checks failed{more}"
    if doubts:
        return "unverified", f"? {doubts} unverified"
    return "sound", f"✓ all {len(checks)} numerical checks hold"
