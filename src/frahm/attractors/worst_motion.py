"""The worst lasting motion over a range of operation: one immutable record, made once and carried whole."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace
from typing import Any

from frahm.arrays import Floats
from frahm.tolerances import AS_LARGE


@dataclass(frozen=True, eq=False)
class WorstMotion:
    """Largest lasting motion of the pipe over a range of operation, and what that rests on.

    Attributes
    ----------
    pipe_peak : float
        Largest pipe displacement [m].
    frequency, detuning, wind_speed : float
        Where it occurs: Omega, sigma [rad/s] and U [m/s], NaN where the lift does not follow the wind.
    kind : str
        Of the motion that causes it: "periodic", "quasi-periodic", "chaotic" or "unsettled".
    basin_fraction : float
        Share of the sampled initial states at that frequency that end on it [-]; 1 where the response is the only one.
    basin_interval : tuple of float
        95 % interval of it [-].
    relative_peak, relative_frequency : float
        Largest stroke of the first absorber [m] over the range, which another motion may cause, and where [rad/s].
    pipe_rms, rms_frequency : float
        Largest rms of the pipe [m], and where [rad/s].
    stress_range, stress_frequency, stress_section : float
        Largest range of the nominal bending stress [Pa] of any lasting motion met anywhere along the pipe, where over
        the range [rad/s] and along the pipe [m]; NaN for a pipe whose stress is not known.
    state : ndarray, shape (2n,)
        On the motion of the pipe peak, at phase 0 of the forcing [m, m/s].
    range : str
        The range of operation, in words.
    tier : str
        What the numbers rest on.
    samples, searched : int
        Initial states at every frequency searched, and number of these.
    unverified : tuple of str
        What speaks against it; empty if nothing.
    beyond : dict of str to float
        Those of the doubts that are about an end of the range, and the largest motion there or beyond it [m].
    """

    pipe_peak: float
    frequency: float
    detuning: float
    wind_speed: float
    kind: str
    basin_fraction: float
    basin_interval: tuple[float, float]
    relative_peak: float
    relative_frequency: float
    pipe_rms: float
    rms_frequency: float
    state: Floats
    range: str
    tier: str
    samples: int
    searched: int
    unverified: tuple[str, ...] = ()
    stress_range: float = math.nan
    stress_frequency: float = math.nan
    stress_section: float = math.nan
    beyond: Mapping[str, float] = field(default_factory=dict)

    @property
    def verified(self) -> bool:
        """Whether nothing speaks against it."""
        return not self.unverified and math.isfinite(self.pipe_peak)

    @property
    def place(self) -> str:
        """Where it occurs, for a sentence."""
        if math.isfinite(self.wind_speed):
            return f"at {self.wind_speed:.4g} m/s"
        if math.isfinite(self.detuning):
            return f"at detuning {self.detuning:.3g} rad/s"
        return f"at {self.frequency:.5g} rad/s"

    def row(self) -> dict[str, Any]:
        """Plain data for the summary, in SI units."""
        return {
            "pipe_peak": self.pipe_peak,
            "frequency": self.frequency,
            "detuning": self.detuning,
            "wind_speed": self.wind_speed,
            "kind": self.kind,
            "basin_fraction": self.basin_fraction,
            "basin_interval": list(self.basin_interval),
            "relative_peak": self.relative_peak,
            "relative_frequency": self.relative_frequency,
            "pipe_rms": self.pipe_rms,
            "stress_range": self.stress_range,
            "stress_frequency": self.stress_frequency,
            "stress_section": self.stress_section,
            "range": self.range,
            "tier": self.tier,
            "samples": self.samples,
            "frequencies_searched": self.searched,
            "verified": self.verified,
            "unverified": list(self.unverified),
        }


def joined(motions: Sequence[WorstMotion]) -> WorstMotion:
    """The worst of several ranges as one: the largest motion, the largest stroke, rms and stress, and every doubt.

    But for those about an end of a range where nothing comes near the largest motion of all.
    """
    largest = max(motions, key=lambda motion: motion.pipe_peak)
    if len(motions) == 1:
        return largest
    stroke = max(motions, key=lambda motion: motion.relative_peak)
    loudest = max(motions, key=lambda motion: motion.pipe_rms)
    known = [motion for motion in motions if not math.isnan(motion.stress_range)]
    stressed = max(known, key=lambda motion: motion.stress_range, default=largest)
    return replace(
        largest,
        relative_peak=stroke.relative_peak,
        relative_frequency=stroke.relative_frequency,
        pipe_rms=loudest.pipe_rms,
        rms_frequency=loudest.rms_frequency,
        stress_range=stressed.stress_range,
        stress_frequency=stressed.stress_frequency,
        stress_section=stressed.stress_section,
        range=_together(list(dict.fromkeys(motion.range for motion in motions))),
        tier=" and ".join(dict.fromkeys(motion.tier for motion in motions)),
        searched=sum(motion.searched for motion in motions),
        unverified=tuple(
            dict.fromkeys(
                doubt
                for motion in motions
                for doubt in motion.unverified
                if not AS_LARGE * motion.beyond.get(doubt, math.inf) < largest.pipe_peak
            )
        ),
    )


_WINDS = ("winds of ", " m/s, each with its own lift")


def _together(ranges: Sequence[str]) -> str:
    """Several ranges in words, what is the same in all of them said once."""
    before, behind = _WINDS
    if not all(text.startswith(before) and text.endswith(behind) for text in ranges):
        return "; ".join(ranges)
    inner = [text[len(before) : -len(behind)] for text in ranges]
    return before + ", ".join(inner[:-1]) + (" and " if len(inner) > 1 else "") + inner[-1] + behind
