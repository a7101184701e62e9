"""The worst motion and the damage against the limits of a case, apart from numerical health."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any

from frahm import readable
from frahm.case import Case, Limits

VERDICTS = ("pass", "fail", "not verified")
NO_LIMITS = "The case gives no limits to hold the motion against: see its section limits."


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
        Row of the `WorstMotion` of the case.
    fatigue : mapping or None
        With `utilisation_with`, the damage times the design fatigue factor.
    """
    limits, found = case.limits or Limits(), []
    if worst is not None:
        peak, stress, stroke = worst["pipe_peak"], worst["stress_range"], worst["relative_peak"]
        yielding, static = limits.yield_strength, limits.static_stress
        most = 0.5 * stress + static
        length, pressure = readable.length, readable.stress
        candidates = [
            ("displacement", peak, limits.displacement, "Displacement {} of {}", length),
            ("amplitude_ratio", peak / case.pipe.diameter, limits.amplitude_ratio, "A/D {} of {}", "{:.3g}".format),
            ("stress_range", stress, limits.stress_range, "Stress range {} of {}", pressure),
            ("yield", most, yielding, "Stress {} of the yield strength {}", pressure),
            ("stroke", stroke, limits.stroke if case.absorbers else None, "Stroke {} of {}", length),
        ]
        found = [Utilisation(name, float(value), limit, text.format(show(value), show(limit)))
                 for name, value, limit, text, show in candidates if limit is not None]  # fmt: skip
    if fatigue is not None:
        used = float(fatigue["utilisation_with"])
        text = f"Fatigue damage times design factor {used:.3g} of {limits.damage:g}"
        found.append(Utilisation("damage", used, limits.damage, text))
    return found


def accepted(found: Sequence[Utilisation], verified: bool) -> dict[str, Any]:
    """The verdict: "fail" if a limit is exceeded, "not verified" if anything else is in doubt, "pass" otherwise."""
    failed = any(row.ratio > 1 for row in found)
    known = not any(math.isnan(row.ratio) for row in found)
    verdict = "fail" if failed else ("pass" if verified and known else "not verified")
    return {
        "verdict": verdict,
        "utilisation": {row.name: row.ratio for row in found},
        "rows": [{**vars(row), "ratio": row.ratio} for row in found],
        "sentence": _sentence(found, verdict),
    }


def _sentence(found: Sequence[Utilisation], verdict: str) -> str:
    word = verdict.upper()
    if not found:
        return f"{word}. {NO_LIMITS}"
    beyond = [row for row in found if row.ratio > 1]
    if beyond:
        return f"{word}: " + "; ".join(f"{row.text}, {readable.share(row.ratio)}" for row in beyond) + "."
    known = [row for row in found if not math.isnan(row.ratio)]
    if not known:
        return f"{word}: the case does not say enough to judge its limits."
    most = max(known, key=lambda row: row.ratio)
    return f"{word}: the limit used most is {most.name.replace('_', ' ')}, {readable.share(most.ratio)}."
