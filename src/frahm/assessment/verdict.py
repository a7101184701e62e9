"""What speaks against counted damage, and what its reader must know, in sentences."""

from __future__ import annotations

import math
import re
from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING, Any

import numpy as np

from frahm.assessment.detail import fatigue_section
from frahm.assessment.motion_damage import SETTLED

if TYPE_CHECKING:
    from frahm.assessment.damage import FatigueDamage
    from frahm.assessment.linear_damage import LinearPipe
    from frahm.assessment.wind_survey import WindFindings, WindSurvey

_NUMBER = re.compile(r"-?\d+(\.\d+)?(e[+-]?\d+)?")
_COARSE = 0.2  # relative change of the damage between two ways to sum over the bins
_COUNTS = 1e-2  # share of the largest rate below which a motion that has not settled cannot matter
_NEGLIGIBLE = 0.05  # share of the damage counted that may be left out
_NOTABLE = 1e-4  # damage too small for any design fatigue factor to matter


def doubts_of(
    known: Mapping[str, Any],
    survey: WindSurvey,
    bare: LinearPipe | None,
    linear: LinearPipe | None,
) -> tuple[str, ...]:
    """What speaks against the numbers, the winds that are not counted apart."""
    found = [survey.at[speed] for speed in sorted(survey.at)]
    doubts = [*unsettled_winds(found), *_uncounted(found), *_drifting(found), *_not_searched(found)]
    if known["binning"] > _COARSE:
        doubts.append(
            f"The damage with absorbers changes by {known['binning']:.0%} with the way it is summed over the wind bins:"
            " it needs more of them (fatigue.bins)."
        )
    if any(pipe is not None and not pipe.decays for pipe in (bare, linear)):
        doubts.append("Without damping free motions never die out, and the damage of the linear pipe has no bound.")
    return tuple(doubts)


def doubts_of_the_rest(parts: Sequence[FatigueDamage]) -> tuple[str, ...]:
    """What speaks against parts that are summed, for winds that none of them counts: once, by the part they harm most.

    Every wind sheds at one frequency, so that its damage is in step with one mode and not with all.
    """
    most = max(parts, key=lambda part: part.outside_without)
    outside, inside = most.outside_without, sum(part.damage_with for part in parts)
    if not (outside > _NOTABLE and outside > _NEGLIGIBLE * inside):
        return ()
    band = "the band" if len(parts) == 1 else "all bands"
    return (
        f"Winds outside {band} do a damage of {outside:.2g} to the pipe without absorbers, most of it near"
        f" {most.outside_wind:.3g} m/s, which is not counted: widen the band (fatigue.wind_speeds, or"
        " analysis.detuning).",
    )


def _not_searched(found: Sequence[WindFindings]) -> list[str]:
    """What the searches for periodic responses could not verify, and at which winds.

    Sentences that differ in their numbers alone are one, with the numbers of the first wind.
    """
    winds: dict[str, list[WindFindings]] = {}
    says: dict[str, str] = {}
    for at in found:
        for doubt in at.found.unverified:
            kind = _NUMBER.sub("#", doubt)
            says.setdefault(kind, doubt)
            if at not in winds.setdefault(kind, []):
                winds[kind].append(at)
    return [
        f"{_where(at)}{f', here at {at[0].speed:.4g} m/s' if len(at) > 1 else ''}: {says[kind]}"
        for kind, at in winds.items()
    ]


def notes_of(known: Mapping[str, Any], survey: WindSurvey) -> tuple[str, ...]:
    """Limits of what was counted."""
    fatigue, stay = fatigue_section(survey.case), known["persistence"]
    notes = [
        "The damage is that of vortex shedding in the band of wind speeds, at frequencies that follow the wind. Lock-in"
        " can hold the shedding at the natural frequency from {:.3g} to {:.3g} m/s (secondary): did the pipe move there"
        " as it does at its worst wind, the damage would be {:.3g} with absorbers and {:.3g} without.".format(
            *known["lock_in"], known["locked_in_with"], known["locked_in_without"]
        ),
        f"The S-N curve {fatigue.curve} is that of DNV-RP-C203 (2016) in air, read in a reproduction of its table;"
        " reference thicknesses and the formula for Weibull distributed ranges are secondary.",
        "The steady motion is counted as if it had always built up. By a simple model with an assumed correlation time"
        f" the wind stays in the lock-in band for {stay.mean_stay:.3g} s on average, and {stay.share_built_up:.0%} of"
        f" the time in it belong to stays with {stay.build_up:.3g} s still to come, which the build-up takes"
        " (secondary).",
    ]
    if "design_fatigue_factor" not in fatigue.model_fields_set:
        notes.append("The design fatigue factor was left at 1; rules ask for up to 10 (secondary).")
    if survey.at:
        fewest = min(one.found.samples for one in survey.at.values())
        share = min(one.found.missed_below for one in survey.at.values())
        notes.append(
            f"At each wind {fewest} states were sampled: an attractor that less than {share:.2g} of the states lead to"
            " can have been missed, unless it is one of a neighbouring wind."
        )
    return tuple(notes)


def unsettled_winds(found: list[WindFindings]) -> list[str]:
    """Sentence about the winds at which motions did not settle, if there are any."""
    winds = [one for one in found if one.unsettled > 0]
    if not winds:
        return []
    share = max(one.unsettled for one in winds)
    reasons = {a.outcome.value for one in winds for a in one.found if a.kind == "unsettled"}
    return [f"{_where(winds)} up to {share:.2g} of the sampled motions did not settle: {' '.join(sorted(reasons))}"]


def _uncounted(found: list[WindFindings]) -> list[str]:
    winds = [one for one in found if not len(one.damage) or any(math.isnan(entry.rate) for entry in one.damage)]
    return [f"{_where(winds)} the damage of a motion could not be counted."] if winds else []


def _drifting(found: list[WindFindings]) -> list[str]:
    top = max((one.worst_rate for one in found if np.isfinite(one.worst_rate)), default=0.0)
    drifts: dict[float, float] = {}
    for one in found:
        for attractor, entry in zip(one.found, one.damage, strict=True):
            if attractor.kind != "unsettled" and not entry.settled and entry.rate > _COUNTS * top:
                drifts[one.speed] = max(drifts.get(one.speed, 0.0), entry.scatter)
    winds = [one for one in found if one.speed in drifts]
    if not winds:
        return []
    scatter = max(drifts.values())
    return [
        f"{_where(winds)} the damage per time of a motion that does not repeat still changes by {scatter:.1%} between"
        f" the halves of its history ({SETTLED:.0%} is allowed)."
    ]


def _where(winds: list[WindFindings]) -> str:
    speeds = [one.speed for one in winds]
    if len(speeds) == 1:
        return f"At a wind of {speeds[0]:.4g} m/s"
    return f"At {len(speeds)} winds between {min(speeds):.4g} and {max(speeds):.4g} m/s"
