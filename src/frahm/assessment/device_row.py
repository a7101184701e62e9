"""One row of the table that decides: a device, its worst motion, its fatigue, and what it uses of every limit."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

from frahm.assessment.acceptance import utilisations
from frahm.case import Case

_OF_THE_MOTION = ("pipe_peak", "wind_speed", "detuning", "frequency", "kind", "stress_range", "tier")


def device_row(
    name: str, case: Case, worst: Mapping[str, Any], fatigue: Mapping[str, Any] | None, doubts: Sequence[str]
) -> dict[str, Any]:
    """What decides between devices, as plain data in SI units.

    Parameters
    ----------
    name : str
        "none", "case", "sink", "tuned mass damper" or "mixed".
    case : Case
        The case with this device.
    worst : mapping
        Row of its `WorstMotion`.
    fatigue : mapping or None
        `damage`, `utilisation_with` (damage times design factor) and `life_years`; None for a case that asks for none.
    doubts : sequence of str
        Why it is unverified; empty if it is not.

    Returns
    -------
    dict
        Of the worst motion: where, kind, `pipe_peak` [m], `stress_range` [Pa]; `amplitude_ratio` A/D [-], `stroke` [m],
        `damage` [-], `life_years`, `utilisation` by limit and `governing`, the largest of them; `verified` with its
        reasons in ``unverified``.
    """
    used = {row.name: row.ratio for row in utilisations(case, worst, fatigue)}
    return {
        "name": name,
        **{key: worst[key] for key in _OF_THE_MOTION},
        "amplitude_ratio": worst["pipe_peak"] / case.pipe.diameter,
        "stroke": worst["relative_peak"] if case.absorbers else None,
        "mass": sum(absorber.mass for absorber in case.absorbers),
        "damage": None if fatigue is None else fatigue["damage"],
        "damage_times_factor": None if fatigue is None else fatigue["utilisation_with"],
        "life_years": None if fatigue is None else fatigue["life_years"],
        "utilisation": used,
        "governing": max(used.values(), default=None),
        "verified": not doubts,
        "unverified": list(doubts),
    }
