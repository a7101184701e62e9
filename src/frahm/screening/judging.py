"""One member through the closed forms of the bare pipe: what the wind does to it, and how that is judged."""

from __future__ import annotations

import dataclasses
import math
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from typing import Any

from frahm.analysis import Work, bare_motions
from frahm.assessment import (
    Utilisation,
    constant_range_damage,
    damage_of_modes,
    doubts_of_modes,
    doubts_of_the_rest,
    total_damage,
    utilisations,
)
from frahm.assessment.detail import detail_of
from frahm.attractors import WorstMotion, joined
from frahm.case import Case
from frahm.errors import ParameterError
from frahm.loads import (
    Criterion,
    LockInBand,
    Similarity,
    amplitude_estimates,
    lock_in_band,
    locking_wind,
    onset_criteria,
    similarity,
    site_winds,
    wind_climate,
    wind_excitation,
)
from frahm.plausibility import plausibility
from frahm.screening.member_case import MemberCase, lacks_modes


@dataclass(frozen=True, eq=False)
class Findings:
    """What is known about a member before it is judged.

    Attributes
    ----------
    case : Case
        An elastic tube without absorbers.
    site : (float, float)
        Lowest and highest wind it can meet [m/s].
    band : LockInBand
        Of the first mode.
    numbers : Similarity
        Of the first mode at the wind of the case.
    criteria : tuple of Criterion
        For the first mode.
    motions : tuple of (Case, WorstMotion)
        Worst motion of the first mode, and of every other range that winds of the site excite.
    motion : WorstMotion
        The worst of all: what `frahm run` of the case calls its worst case.
    excited : bool
        Whether a wind of the site lies in the lock-in band of a mode, or can lock in to it.
    damage : dict or None
        Fatigue of all modes, and beside it what winds outside all of their bands do (`outside`, mostly near the wind
        `outside_wind` [m/s]), and what lock-in to a resonance that the site has no wind for would do (`held`);
        None without climate and S-N curve.
    damage_doubts : tuple of str
        What speaks against it.
    limits : tuple of Utilisation
        Every limit that is given, and damage.
    estimates : (float, float)
        Smallest and largest published estimate of the amplitude over the diameter in resonance [-].
    lacks_modes : bool
        Whether winds of the site excite a mode above those that take part.
    implausible : tuple of str
        What a practised engineer would ask about.
    """

    case: Case
    site: tuple[float, float]
    band: LockInBand
    numbers: Similarity
    criteria: tuple[Criterion, ...]
    motions: tuple[tuple[Case, WorstMotion], ...]
    motion: WorstMotion
    excited: bool
    damage: dict[str, Any] | None
    damage_doubts: tuple[str, ...]
    limits: tuple[Utilisation, ...]
    estimates: tuple[float, float]
    lacks_modes: bool
    implausible: tuple[str, ...]

    @property
    def onset(self) -> float:
        """Lowest wind in the lock-in band of the first mode [m/s]."""
        return self.band.low

    @property
    def mode(self) -> int:
        """Number of the mode of the worst motion."""
        case, _ = max(self.motions, key=lambda pair: pair[1].pipe_peak)
        return int(case.pipe.governing_mode)

    @property
    def most_used(self) -> Utilisation | None:
        """The limit that is used most; None if none is known."""
        known = [row for row in self.limits if not math.isnan(row.ratio)]
        return max(known, key=lambda row: row.ratio, default=None)


def findings(member: MemberCase) -> Findings:
    """What the wind does to a member, in closed form.

    Parameters
    ----------
    member : MemberCase

    Raises
    ------
    ParameterError
        If the tables of Strouhal number or lift do not reach the winds of the member.
    """
    case = member.case
    work, (site, _) = Work(case), site_winds(case)
    motions = tuple(bare_motions(work))
    motion = joined([one for _, one in motions])
    damage, doubts = _damage(case, motions, site)
    band = lock_in_band(case)
    excited = _meets(band, site) or len(motions) > 1
    low, high = (amplitude / case.pipe.diameter for amplitude in amplitude_estimates(case).interval)
    return Findings(
        case=case,
        site=site,
        band=band,
        numbers=similarity(case),
        criteria=tuple(onset_criteria(case)),
        motions=motions,
        motion=motion,
        excited=excited,
        damage=damage,
        damage_doubts=doubts,
        limits=tuple(utilisations(case, motion.row(), damage)),
        estimates=(float(low), float(high)),
        lacks_modes=lacks_modes(case),
        implausible=tuple(_implausible(case, excited)),
    )


def _damage(
    case: Case, motions: Sequence[tuple[Case, WorstMotion]], site: tuple[float, float]
) -> tuple[dict[str, Any] | None, tuple[str, ...]]:
    if case.fatigue is None:
        return None, ()
    try:
        parts = damage_of_modes(case)
    except ParameterError as refused:
        return None, (f"The fatigue damage could not be counted: {refused}",)
    most = max(parts, key=lambda part: part.outside_without)
    outside = {"outside": most.outside_without, "outside_wind": most.outside_wind}
    rest = doubts_of_the_rest(parts)  # here the damage of these winds is held against the limit, too
    outside["held"] = max(_held_damage(one, motion, site) for one, motion in motions)
    return total_damage(parts) | outside, tuple(doubt for doubt in doubts_of_modes(parts) if doubt not in rest)


def _held_damage(case: Case, motion: WorstMotion, site: tuple[float, float]) -> float:
    """Damage if every wind of the site in the lock-in band of a mode held its resonance, where it lacks that wind.

    0 where the site has the resonant wind: then the locked-in damage of the count says more.
    """
    if locking_wind(wind_excitation(case), case.pipe.frequency, site) is None:
        return 0.0
    band, climate, detail = lock_in_band(case), wind_climate(case), detail_of(case)
    chance = float(climate.probability(max(band.low, site[0]), min(band.high, site[1])))
    cycles = climate.duration * chance * motion.frequency / (2 * math.pi)
    return constant_range_damage(detail.curve, detail.factor * motion.stress_range, cycles)


def _implausible(case: Case, excited: bool) -> Iterator[str]:
    """What is odd about a member; that no wind excites it is what a screen is made to find."""
    found_anyway = ("wind.speed", "climate") if excited else ("wind.speed", "climate", "wind.range")
    return (str(one) for one in plausibility(case) if not one.name.startswith(found_anyway))


def _meets(band: LockInBand, site: tuple[float, float]) -> bool:
    """Whether a wind of the site lies in a band; where it is not known, it may."""
    return not (band.low > site[1] or band.high < site[0])


def expects_vibration(criterion: Criterion, site: tuple[float, float]) -> bool | None:
    """Whether a criterion expects vibration at some wind of the site; None where it is not decided."""
    if criterion.expects_vibration is None or criterion.speeds is None:
        return criterion.expects_vibration
    return criterion.speeds[0] <= site[1] and criterion.speeds[1] >= site[0]


def criterion_row(criterion: Criterion, site: tuple[float, float]) -> dict[str, Any]:
    """A criterion over the winds of the site as plain data."""
    row = dataclasses.asdict(criterion)
    kept = ("name", "condition", "speeds", "standing", "source")
    return {name: row[name] for name in kept} | {"expects_vibration": expects_vibration(criterion, site)}
