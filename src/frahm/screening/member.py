"""One member with its verdict, for people and as plain data."""

from __future__ import annotations

import math
from dataclasses import dataclass, field
from typing import Any

from frahm import readable
from frahm.analysis import plain
from frahm.case import Case, Tube
from frahm.screening.judging import Findings, criterion_row
from frahm.screening.verdict import VERDICTS, MemberVerdict


@dataclass(frozen=True, eq=False)
class ScreenedMember:
    """A member of a platform, and how it is judged.

    Attributes
    ----------
    name : str
        As in the table.
    place : str
        File and line it stands in.
    verdict : MemberVerdict
        With `word`, `why` and all `reasons`.
    ends : str
        As in the table.
    findings : Findings or None
        What is known about it; None if its row could not be read.
    assumed : dict of str to str
        What the table does not say, and what was taken.
    """

    __repr__ = readable.summary

    name: str
    place: str
    verdict: MemberVerdict
    ends: str = ""
    findings: Findings | None = None
    assumed: dict[str, str] = field(default_factory=dict)

    @property
    def case(self) -> Case:
        """The member as a case, for `frahm.worst_case`, `frahm.design_absorber` and the other verbs.

        Raises
        ------
        RuntimeError
            If its row could not be read; `verdict.why` says why.
        """
        if self.findings is None:
            raise RuntimeError(f"{self.name or self.place} is no case: {self.verdict.why}")
        return self.findings.case

    @property
    def utilisation(self) -> float:
        """The largest utilisation of a limit [-]; NaN where no limit is known."""
        used = None if self.findings is None else self.findings.most_used
        return math.nan if used is None else used.ratio

    @property
    def rank(self) -> tuple[Any, ...]:
        """Sorts members, the worst first: by verdict, by utilisation, and by amplitude over diameter."""
        used = -1.0 if math.isnan(self.utilisation) else self.utilisation
        ratio = 0.0 if self.findings is None else self.findings.motion.pipe_peak / self.case.pipe.diameter
        return VERDICTS.index(self.verdict.word), -used, -ratio, self.name

    def row(self) -> dict[str, Any]:
        """Plain data for the summary, in SI units."""
        head = {"name": self.name, "place": self.place, "verdict": self.verdict.word, "why": self.verdict.why,
                "reasons": list(self.verdict.reasons)}  # fmt: skip
        if self.findings is None:
            return head
        return plain(head | {"ends": self.ends, "assumed": self.assumed} | _numbers(self.findings))


def _numbers(found: Findings) -> dict[str, Any]:
    case, motion, used = found.case, found.motion, found.most_used
    pipe, damage = case.pipe, found.damage or {}
    assert isinstance(pipe, Tube)
    return {
        "diameter": pipe.diameter,
        "wall": pipe.wall,
        "length": pipe.length,
        "damping_ratio": pipe.damping_ratio,
        "mass_per_length": pipe.mass_per_length,
        "mode_count": pipe.mode_count,
        "natural_frequency": pipe.frequency,
        "natural_frequency_hz": pipe.frequency / (2 * math.pi),
        "site_winds": list(found.site),
        "critical_wind": found.band.resonance,
        "lock_in_band": [found.band.low, found.band.high],
        "excited": found.excited,
        "scruton_number": found.numbers.scruton_number,
        "reduced_velocity": found.numbers.reduced_velocity,
        "reynolds_number": found.numbers.reynolds_number,
        "criteria": [criterion_row(criterion, found.site) for criterion in found.criteria],
        "pipe_peak": motion.pipe_peak,
        "amplitude_ratio": motion.pipe_peak / pipe.diameter,
        "estimates": list(found.estimates),
        "wind_speed": motion.wind_speed,
        "frequency": motion.frequency,
        "mode": found.mode,
        "stress_range": motion.stress_range,
        "stress_section": motion.stress_section,
        "tier": motion.tier,
        "range": motion.range,
        "damage": damage.get("damage_with"),
        "damage_locked_in": max(damage["locked_in_with"], damage["held"]) if damage else None,
        "damage_outside": damage.get("outside"),
        "damage_utilisation": damage.get("utilisation_with"),
        "life_years": damage.get("life_years"),
        "utilisation": {row.name: row.ratio for row in found.limits},
        "largest_utilisation": None if used is None else used.ratio,
        "modes": [
            {"mode": one.pipe.governing_mode, "natural_frequency": one.pipe.frequency, "pipe_peak": worst.pipe_peak,
             "wind_speed": worst.wind_speed, "stress_range": worst.stress_range}
            for one, worst in found.motions
        ],
        "digest": case.digest,
        "case": case.to_dict(),
    }  # fmt: skip
