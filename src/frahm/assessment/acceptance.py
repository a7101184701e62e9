"""The worst motion and the damage against the limits of a case, apart from numerical health."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from typing import Any

from frahm import readable
from frahm.case import Case, Limits

VERDICTS = ("pass", "fail", "not verified")
NOT_JUDGED = "NOT JUDGED"
NO_LIMITS = "the case gives no limit to hold this motion against, see its section limits."
ONLY_STROKE = "the only limit given is the stroke of an absorber (limits.stroke), and there is none."


_SIZES = ("pipe_peak", "stress_range", "relative_peak")


@dataclass(frozen=True)
class Utilisation:
    """One limit: what there is, what is allowed, and the first over the second; NaN where the case lacks data."""

    name: str
    value: float
    limit: float
    text: str

    @property
    def ratio(self) -> float:
        """Value over limit [-]."""
        return self.value / self.limit


def utilisations(case: Case, worst: Mapping[str, Any] | None, fatigue: Mapping[str, Any] | None) -> list[Utilisation]:
    """Every limit that is given, and those that hold by default where the case has the data.

    Parameters
    ----------
    case : Case
    worst : mapping or None
        Row of the `WorstMotion` of the case; without it nothing it would be held against is known.
    fatigue : mapping or None
        With `utilisation_with`, the damage times the design fatigue factor.
    """
    limits = case.limits or Limits()
    peak, stress, stroke = (math.nan if worst is None else float(worst[name]) for name in _SIZES)
    most = 0.5 * stress + limits.static_stress
    length, pressure = readable.length, readable.stress
    candidates = [
        ("displacement", peak, limits.displacement, "Displacement {} of {}", length),
        ("amplitude_ratio", peak / case.pipe.diameter, limits.amplitude_ratio, "A/D {} of {}", "{:.3g}".format),
        ("stress_range", stress, limits.stress_range, "Stress range {} of {}", pressure),
        ("yield", most, limits.yield_strength, "Stress {} of the yield strength {}", pressure),
        ("stroke", stroke, limits.stroke if case.absorbers else None, "Stroke {} of {}", length),
    ]
    found = [Utilisation(name, value, limit, text.format(_shown(value, show), show(limit)))
             for name, value, limit, text, show in candidates if limit is not None]  # fmt: skip
    if fatigue is not None:
        used = float(fatigue["utilisation_with"])
        text = f"Fatigue damage times design factor {used:.3g} of {limits.damage:g}"
        found.append(Utilisation("damage", used, limits.damage, text))
    return found


def _shown(value: float, show: Callable[[float], str]) -> str:
    return "not known" if math.isnan(value) else show(value)


def nothing_to_judge(case: Case) -> str:
    """Why no limit of a case was judged."""
    alone = case.limits is not None and case.limits.stroke is not None and not case.absorbers
    return ONLY_STROKE if alone else NO_LIMITS


def accepted(found: Sequence[Utilisation], verified: bool, nothing: str = NO_LIMITS) -> dict[str, Any]:
    """The verdict: "fail" if a limit is exceeded, "pass" if all are kept and nothing is in doubt, else "not verified".

    Where there is no limit nothing is judged, and nothing can pass: "not verified" with the headline NOT JUDGED, and
    `nothing` says why.
    """
    failed = any(row.ratio > 1 for row in found)
    known = bool(found) and not any(math.isnan(row.ratio) for row in found)
    verdict = "fail" if failed else ("pass" if verified and known else "not verified")
    judged: dict[str, Any] = {
        "verdict": verdict,
        "utilisation": {row.name: row.ratio for row in found},
        "rows": [{**vars(row), "ratio": row.ratio} for row in found],
    }
    return judged | {"sentence": _sentence(found, headline(judged), nothing)}


def headline(judged: Mapping[str, Any]) -> str:
    """The verdict in capitals, for people: PASS, FAIL, NOT VERIFIED, or NOT JUDGED where there is no limit."""
    return str(judged["verdict"]).upper() if judged["rows"] else NOT_JUDGED


def _sentence(found: Sequence[Utilisation], word: str, nothing: str) -> str:
    if not found:
        return f"{word}: {nothing}"
    beyond = [row for row in found if row.ratio > 1]
    if beyond:
        return f"{word}: " + "; ".join(f"{row.text}, {readable.share(row.ratio)}" for row in beyond) + "."
    known = [row for row in found if not math.isnan(row.ratio)]
    if not known:
        return f"{word}: nothing is known that the limits of the case could be held against."
    most = max(known, key=lambda row: row.ratio)
    return f"{word}: the limit used most is {most.name.replace('_', ' ')}, {readable.share(most.ratio)}."
