"""`worst_case`: the largest lasting motion over a range of operation, all attractors considered."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, Any

import numpy as np

from frahm import readable
from frahm.arrays import Floats
from frahm.attractors.attractor import Attractor, AttractorSet
from frahm.attractors.bracketing import FINE, bracket, largest, pipe_size, rms_size, stroke_size
from frahm.attractors.doubts import Place, doubts_of, frequencies_beyond
from frahm.attractors.finding import MOST_SAMPLES, attractors_from, settling_periods
from frahm.attractors.periodic_motion import linear_motions
from frahm.attractors.regions import Region, checked_region, region_for
from frahm.attractors.stroboscope import Stroboscope, stroboscope
from frahm.attractors.worst_motion import WorstMotion, joined
from frahm.case import load_case
from frahm.errors import Outcome, ParameterError, check_count, check_number
from frahm.harmonic_balance import PeriodicResponse, is_linear, responses_on
from frahm.harmonic_balance.quasi_static import searched_window
from frahm.loads import OperatingRange, frequency_range, operating_range, other_ranges
from frahm.response import ResponseCurve
from frahm.response.exact import curve_and_branches
from frahm.systems import System, as_system, build_system, detuning_of, excitation_window, with_parameters

if TYPE_CHECKING:
    from frahm.case import Case

# Frequencies are compared by their ratio: what is near scales with the pipe, and does not depend on the range.
_SPREAD, _BAND = 9, 0.55  # frequencies spread over the range: at least so many, and over every such ln(hi/lo)
_SPECIAL = 10  # special points of the response curve looked at on both sides, the largest first
BESIDE = 5e-4  # how far beside a special point, of the frequency: nearer to it motions hardly settle
_CLOSE = 8e-5  # frequencies nearer than this are one

UNMOVED_TIER = "nothing excites the pipe: the lift is zero"


@dataclass(frozen=True)
class Sampling:
    """How a range is searched, see `worst_case`; special points are looked at from `beside` of the frequency away."""

    samples: int
    min_basin: float
    seed: int
    region: Region | None = None
    periods: int | None = None
    workers: int | None = None
    rms: bool = False
    beside: float = BESIDE

    def __post_init__(self) -> None:
        whole = {"samples": (1, MOST_SAMPLES), "seed": (0, 2**31 - 1), "periods": (1, 1_000_000), "workers": (1, 1024)}
        for name, (least, most) in whole.items():
            value = getattr(self, name)
            if value is not None or name in ("samples", "seed"):
                object.__setattr__(self, name, check_count(name, value, at_least=least, at_most=most))
        object.__setattr__(self, "min_basin", check_number("min_basin", self.min_basin, at_least=0.0, at_most=1.0))


@dataclass(frozen=True, eq=False)
class WorstCase:
    """The worst over a range of operation, and where it was looked for.

    Attributes
    ----------
    motion : WorstMotion
        The record; the properties below read it.
    attractor : Attractor
        What causes the pipe peak.
    range : OperatingRange
        What was asked about.
    not_excluded : float
        Largest pipe peak [m] of an attractor whose 95 % interval of the basin fraction reaches `min_basin`.
    surveys : tuple of AttractorSet
        All frequencies looked at, ascending.
    min_basin : float
    curve : ResponseCurve
        Every periodic response over the range and half as much beside it.
    others : tuple of WorstCase
        Of what else winds of the site excite, see `frahm.loads.other_ranges`; `motion` is the worst of all.
    """

    def __repr__(self) -> str:
        motion = self.motion
        said = f"largest pipe motion {readable.length(motion.pipe_peak)} ({readable.motion(motion.kind)})"
        where = f"{said} at {motion.frequency:.6g} rad/s, largest stroke {readable.length(motion.relative_peak)}"
        asked = f"over {motion.range}, {motion.searched} frequencies, {motion.samples} initial states each"
        sure = "verified" if motion.verified else "UNVERIFIED:"
        return readable.listed((), where, asked, sure, *motion.unverified, name=type(self).__name__)

    motion: WorstMotion
    attractor: Attractor
    range: OperatingRange
    not_excluded: float
    surveys: tuple[AttractorSet, ...]
    min_basin: float
    curve: ResponseCurve
    others: tuple[WorstCase, ...] = ()

    @property
    def pipe_peak(self) -> float:
        """Largest pipe peak [m] of an attractor with a basin fraction of at least `min_basin`."""
        return self.motion.pipe_peak

    @property
    def relative_peak(self) -> float:
        """Largest peak of the first element [m], which another attractor at another frequency may cause."""
        return self.motion.relative_peak

    @property
    def pipe_rms(self) -> float:
        """Largest pipe rms [m]; bracketed like the peaks only if it was asked for."""
        return self.motion.pipe_rms

    @property
    def detuning(self) -> float:
        """Where the pipe peak occurs [rad/s]."""
        return self.motion.detuning

    @property
    def frequency(self) -> float:
        """Where the pipe peak occurs [rad/s]."""
        return self.motion.frequency

    @property
    def wind_speed(self) -> float:
        """Where the pipe peak occurs [m/s]; NaN for a window of detuning or frequency."""
        return self.motion.wind_speed

    @property
    def relative_frequency(self) -> float:
        """Where the relative peak occurs [rad/s]."""
        return self.motion.relative_frequency

    @property
    def relative_detuning(self) -> float:
        """Where the relative peak occurs [rad/s]."""
        return self.motion.relative_frequency - (self.motion.frequency - self.motion.detuning)

    @property
    def rms_frequency(self) -> float:
        """Where the rms is largest [rad/s]."""
        return self.motion.rms_frequency

    @property
    def verified(self) -> bool:
        """Whether nothing speaks against it; the sentences that do stand beside it."""
        return self.motion.verified

    @property
    def unverified(self) -> tuple[str, ...]:
        """Sentences: motions that did not settle, a larger one beyond the range or with a smaller basin."""
        return self.motion.unverified


def worst_case(
    case_or_system: Case | System | str,
    *,
    detuning: tuple[float, float] | None = None,
    frequency: tuple[float, float] | None = None,
    wind: tuple[float, float] | None = None,
    samples: int = 100,
    min_basin: float = 0.01,
    seed: int = 1,
    region: dict[str, tuple[float, float]] | None = None,
    periods: int | None = None,
    workers: int | None = None,
    rms: bool = False,
) -> WorstCase:
    """Largest pipe and relative peak over all attractors with a basin fraction of at least `min_basin`.

    The frequencies looked at are spread over the range, stand beside the special points of the exact response curve
    and at its stable maxima; around the worst they are then halved until its frequency is known to 0.03 %. The worst
    is unverified if it sits at an end of the range while something excites the pipe, if the range widened by half has a
    motion larger by more than 1 %, or if a stable response with a smaller basin is larger by more than 1 %.

    Parameters
    ----------
    case_or_system : Case, System or str
        What is excited.
    detuning, frequency : tuple of float
        Window (lo, hi) of sigma or Omega [rad/s].
    wind : tuple of float
        Window (lo, hi) of the wind speed of a case [m/s]: shedding frequency and lift both follow it. Give one of the
        three; with none a case is asked about its own range of operation, see `frahm.loads.operating_range`, and an
        elastic pipe about every other mode that winds of its site excite, too.
    samples : int
        Initial states at every frequency.
    min_basin : float
        Least basin fraction in the sample that counts [-].
    seed : int
        Of the sample.
    region : dict, optional
        Of the initial states, see `find_attractors`; by default one region for the whole window, scaled by the largest
        stable periodic response in it.
    periods : int
        Periods after which a motion that has not settled is given up; it counts as it is, as unverified.
    workers : int, optional
        Threads; one per core by default.
    rms : bool
        Whether the largest rms of the pipe is bracketed, too.

    Returns
    -------
    WorstCase

    Raises
    ------
    ParameterError
        For bad input.
    """
    system = as_system(case_or_system)
    within = _range(case_or_system, system, detuning, frequency, wind)
    box = None if region is None else checked_region(system, region)
    sampling = Sampling(samples, min_basin, seed, box, periods, workers, rms)
    first = _worst(system, within, sampling)
    if isinstance(case_or_system, System) or not within.moves:
        return first
    sampling = replace(sampling, region=None)
    others = [_worst(build_system(case), part, sampling) for case, part in other_ranges(load_case(case_or_system))]
    return worst_of((first, *others))


def worst_of(parts: Sequence[WorstCase]) -> WorstCase:
    """The worst of several ranges, such as those of the modes of an elastic pipe; the others stay in `others`."""
    largest = max(parts, key=lambda part: part.pipe_peak)
    others = tuple(part for part in parts if part is not largest)
    return replace(largest, motion=joined([part.motion for part in parts]), others=others)


def _range(case_or_system: Any, system: System, detuning: Any, frequency: Any, wind: Any) -> OperatingRange:
    """The range asked about: what was given, or that of the case."""
    if isinstance(case_or_system, System):
        if wind is not None:
            raise ParameterError("wind", wind, "left out for a System, which knows no wind; give a case instead")
    elif detuning is None and frequency is None:
        return operating_range(load_case(case_or_system), wind=wind)
    elif wind is not None:
        raise ParameterError("detuning, frequency, wind", (detuning, frequency, wind), "at most one of the three")
    lo, hi = excitation_window(system, detuning=detuning, frequency=frequency)
    return frequency_range(lo, hi, lo - float(detuning_of(system, lo)))


def worst_over(system: System, within: OperatingRange, **asked: Any) -> WorstCase:
    """`worst_case` of a system over a range; what is asked are fields of `Sampling`."""
    return _worst(system, within, Sampling(**asked))


def _worst(system: System, within: OperatingRange, sampling: Sampling) -> WorstCase:
    wide = within.widened()
    curve, responses_at = _curve(system, wide)
    at = driven_at(system, wide)
    surveys: dict[float, AttractorSet] = {}
    sizes = (pipe_size, stroke_size, rms_size) if sampling.rms else (pipe_size, stroke_size)
    min_basin = sampling.min_basin
    lo, hi, _ = searched_window(system, *within.frequency)  # the sentence stands among those of the curve
    if is_linear(system) or not np.any(system.forcing):
        return _concluded(system, within, wide, curve, linear_motions(system, curve, within), min_basin, (), ())
    box = sampling.region or _region_of(system, curve, lo, hi)

    def survey(W: float, others: Sequence[Floats] = ()) -> AttractorSet:
        responses, followed = responses_at(W), sampling.periods or settling_periods(system, W)
        return attractors_from(strobe(W), responses, box, sampling.samples, sampling.seed, followed, others=others)

    def strobe(W: float) -> Stroboscope:
        return stroboscope(at(W), W, sampling.workers)

    doubts: list[str] = []
    beyond: list[Place] = []
    bracketed = False
    try:
        for W in _first_frequencies(curve, lo, hi, sampling.beside):
            surveys[W] = survey(W)
        bracketed = bracket(surveys, survey, strobe, min_basin, sizes)
        for W in frequencies_beyond(curve, lo, hi):
            beyond.append((W, largest({W: survey(W)}, pipe_size, min_basin)[1].pipe_peak))
    except KeyboardInterrupt:
        if not surveys:
            raise
        doubts.append(Outcome.INTERRUPTED.value)
    if not bracketed:
        doubts.append("The frequency of the worst was not bracketed to 0.03 %.")
    return _concluded(system, within, wide, curve, surveys, min_basin, tuple(doubts), beyond, "attractor search")


def driven_at(system: System, within: OperatingRange) -> Callable[[float], System]:
    """The system as it is driven at a frequency of a range."""
    if not within.over_wind:
        return lambda W: system
    return lambda W: with_parameters(system, force=within.lift_factor(W))


def _curve(system: System, within: OperatingRange) -> tuple[ResponseCurve, Callable[[float], list[PeriodicResponse]]]:
    """The exact response over a range, and the periodic responses at a frequency of it; branches are followed once."""
    curve, search, branches = curve_and_branches(system, *within.frequency, None, within.factor)
    return curve, lambda W: [] if search is None else responses_on(search, branches, W)


def _region_of(system: System, curve: ResponseCurve, lo: float, hi: float) -> Region:
    inside = (curve.frequency >= lo) & (curve.frequency <= hi)
    pipe, stroke = (
        float(np.max(peaks[inside & curve.stable & np.isfinite(peaks)], initial=0.0))
        for peaks in (curve.pipe_peak, curve.relative_peak)
    )
    return region_for(system, hi, pipe, stroke)


def _first_frequencies(curve: ResponseCurve, lo: float, hi: float, beside: float) -> list[float]:
    """Frequencies to start with, ascending, none too near to another nor at a point where motions hardly settle."""
    count = max(_SPREAD, math.ceil(_SPREAD * math.log(hi / lo) / _BAND))
    wanted = [lo, hi, *np.linspace(lo, hi, count)[1:-1]]
    inside = (curve.frequency >= lo) & (curve.frequency <= hi)
    for peaks in (curve.pipe_peak, curve.relative_peak):
        for branch in np.unique(curve.branch):
            here = np.flatnonzero((curve.branch == branch) & inside & curve.stable & np.isfinite(peaks))
            if here.size:
                wanted.append(float(curve.frequency[here[np.argmax(peaks[here])]]))
    within = [point for point in curve.special_points if lo <= point.frequency <= hi]
    special = np.array([point.frequency for point in within])
    wanted = [W for W in wanted if W in (lo, hi) or not np.any(np.abs(special - W) < 0.5 * beside * W)]
    for point in sorted(within, key=lambda point: -point.pipe_peak)[:_SPECIAL]:
        wanted += [point.frequency * (1 - beside), point.frequency * (1 + beside)]
    chosen: list[float] = []
    for W in wanted:
        if lo <= W <= hi and all(abs(W - other) > _CLOSE * W for other in chosen):
            chosen.append(float(W))
    return sorted(chosen)


def _concluded(
    system: System, within: OperatingRange, wide: OperatingRange, curve: ResponseCurve,
    surveys: dict[float, AttractorSet], min_basin: float, doubts: tuple[str, ...], beyond: Sequence[Place],
    tier: str = "exact linear response",
) -> WorstCase:  # fmt: skip
    W, worst = largest(surveys, pipe_size, min_basin)
    W_relative, stroke = largest(surveys, stroke_size, min_basin)
    W_rms, loudest = largest(surveys, rms_size, min_basin)
    moved = worst.pipe_peak > 0  # where nothing excites the pipe no wind is worse than another
    found, ends = [*within.doubts, *curve.unverified], dict[str, float]()
    if moved:
        found, ends = doubts_of(within, wide, curve, surveys, (W, worst), min_basin, beyond, FINE)
    possible = [a.pipe_peak for s in surveys.values() for a in s if a.basin_interval[1] >= min_basin]
    motion = WorstMotion(
        pipe_peak=worst.pipe_peak,
        frequency=W,
        detuning=float(detuning_of(system, W)),
        wind_speed=float(within.speed(W)),
        kind=worst.kind,
        basin_fraction=worst.basin_fraction,
        basin_interval=worst.basin_interval,
        relative_peak=stroke.relative_peak,
        relative_frequency=W_relative,
        pipe_rms=loudest.pipe_rms,
        rms_frequency=W_rms,
        state=worst.representative_state,
        range=within.text,
        tier=tier if moved else UNMOVED_TIER,
        samples=surveys[W].samples,
        searched=len(surveys),
        unverified=tuple(dict.fromkeys([*doubts, *found])),
        beyond=ends,
    )
    return WorstCase(
        motion=motion,
        attractor=worst,
        range=within,
        not_excluded=float(np.fmax.reduce([*possible, worst.pipe_peak])),
        surveys=tuple(surveys[at] for at in sorted(surveys)),
        min_basin=min_basin,
        curve=curve,
    )
