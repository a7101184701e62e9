"""`find_attractors`: every long-term motion at one excitation frequency, and how likely each is."""

from __future__ import annotations

import dataclasses
import functools
import math
from collections.abc import Sequence
from typing import TYPE_CHECKING, Any

import numpy as np

from frahm.arrays import Floats, frozen
from frahm.attractors.attractor import Attractor, AttractorSet, clopper_pearson
from frahm.attractors.clouds import STRETCH, Cloud, peaks_of_long_motions
from frahm.attractors.extremes import DURATION, Level, RarePeaks, enough, expected_peak, poisson_interval
from frahm.attractors.modulation import beat_frequency
from frahm.attractors.orbits import Orbit
from frahm.attractors.regions import Region, checked_region, default_region, sample_region
from frahm.attractors.seeds import seed_states
from frahm.attractors.settling import UNLABELLED, Settled, Settling, known_orbits
from frahm.attractors.stroboscope import Stroboscope, stroboscope
from frahm.errors import Outcome, check_count
from frahm.harmonic_balance import PeriodicResponse, periodic_responses_of
from frahm.harmonic_balance.linear import linear_exponents
from frahm.systems import System, as_system, detuning_of, excitation_frequency
from frahm.tolerances import ALIKE

if TYPE_CHECKING:
    from frahm.case import Case

PERIODS = 3000
_TIME_CONSTANTS, _MOST_PERIODS = 28.0, 20_000  # of the slowest free vibration until it is gone; see `settling_periods`
_TURNS = 1e-6  # of the excitation frequency: what turns more slowly is no vibration
MOST_SAMPLES = 1_000_000
_SCOUTS = 16  # of the sample, settled first: attractors they find are known to the rest
_WATCH = 100  # periods over which an unsettled motion is watched


def find_attractors(
    case_or_system: Case | System | str,
    *,
    detuning: float | None = None,
    frequency: float | None = None,
    region: dict[str, tuple[float, float]] | None = None,
    samples: int = 200,
    seed: int = 1,
    periods: int | None = None,
    workers: int | None = None,
) -> AttractorSet:
    """Every long-term motion at one excitation frequency, with the share of initial states that leads to it.

    Motions are started from a scrambled Sobol sample of the region, from rest, beside every unstable periodic response,
    and from the jumps of the slow manifold; stable periodic responses are known from harmonic balance. A motion inside
    a ball around a stable orbit in which the exact equations contract (a radius verified by sampled iterations) is
    settled; one that nearly repeats, after up to 64 periods, is refined by Newton's method. One that keeps coming back
    to where it has been, and from where eight of sixteen motions have not left within 2500 periods, is on a modulated
    or chaotic set. As motions leave some chaotic sets in the end, those on one are followed to the last period: the
    fractions are those after `periods` periods, and the rate of leaving is told. Modulated attractors whose peaks and
    rms agree within 2 % of the peak are one: a beat can lock to the forcing in several ways.

    Parameters
    ----------
    case_or_system : Case, System or str
        What is excited.
    detuning, frequency : float
        sigma or Omega [rad/s]; give one of the two.
    region : dict, optional
        Ranges (lo, hi) of the initial x1 [m], v1 [m/s] (the output), z [m] and w [m/s] (the first element) at phase 0
        of the forcing; one not named is 0, other elements are at rest relative to what they hang on. By default all
        four, scaled by the largest periodic response, the host's resonance without elements and a gust.
    samples : int
        Initial states drawn from the region. Fractions come from these alone.
    seed : int
        Of the sample: the same seed gives the same answer on any number of threads.
    periods : int
        Periods after which basins are stated, and a motion that has not settled is called unsettled.
    workers : int, optional
        Threads; one per core by default.

    Returns
    -------
    AttractorSet
        A sequence of `Attractor`, the largest pipe peak first. An interruption leaves what is labelled.

    Raises
    ------
    ParameterError
        For bad input. Motions that escape or cannot be integrated are values of kind "unsettled".
    """
    system = as_system(case_or_system)
    W = excitation_frequency(system, detuning=detuning, frequency=frequency)
    samples = check_count("samples", samples, at_least=0, at_most=MOST_SAMPLES)
    seed = check_count("seed", seed, at_least=0)
    periods = settling_periods(system, W) if periods is None else check_count("periods", periods, at_most=1_000_000)
    workers = None if workers is None else check_count("workers", workers, at_most=1024)
    given = None if region is None else checked_region(system, region)
    responses = periodic_responses_of(system, W, None)
    box = default_region(system, W, responses) if given is None else given
    strobe = stroboscope(system, W, workers)
    return attractors_from(strobe, responses, box, samples, seed, periods, responses.unverified)


def settling_periods(system: System, frequency: float) -> int:
    """Periods of the forcing in which the slowest free vibration of the linear part dies out, 3000 at least.

    28 of its time constants; 20 000 periods at most, where what has not settled is called unsettled.
    """
    values = linear_exponents(system)
    decays = -values.real[values.imag > _TURNS * frequency]
    slowest = float(np.min(decays[decays > 0], initial=math.inf))
    if not math.isfinite(slowest):
        return PERIODS
    return int(np.clip(_TIME_CONSTANTS * frequency / (2 * np.pi * slowest), PERIODS, _MOST_PERIODS))


def attractors_from(
    strobe: Stroboscope,
    responses: Sequence[PeriodicResponse],
    region: Region,
    samples: int,
    seed: int,
    periods: int,
    unverified: tuple[str, ...] = (),
    others: Sequence[Floats] = (),
) -> AttractorSet:
    """Attractors where the periodic responses are known, and what of these is unverified.

    Motions from the states `others` are followed as well; they do not count in a basin.
    """
    system = strobe.system
    starts = sample_region(system, region, samples, seed) if samples else np.zeros((0, 2 * system.size))
    settling = begin_settling(strobe, responses, periods)
    begun = [seed_states(strobe, responses), starts[:_SCOUTS], *(state[None] for state in others)]
    seeds = settling.settle(np.concatenate(begun))
    scouts = seeds.part(np.arange(len(begun[0]), len(begun[0]) + len(begun[1])))
    settled = settling.settle_left(starts, scouts, resume=not seeds.interrupted)
    rest = settling.settle_left(begun[0][:1], seeds.part(np.arange(1)), resume=not settled.interrupted)
    counted = np.array([outcome is not Outcome.INTERRUPTED for outcome in settled.outcomes], dtype=bool)
    found = describe(settling, settled, counted, int(rest.labels[0]))
    return AttractorSet(
        attractors=tuple(attractor for _, attractor in found),
        frequency=strobe.frequency,
        detuning=float(detuning_of(system, strobe.frequency)),
        region=region,
        samples=int(np.count_nonzero(counted)),
        seed=seed,
        periods=periods,
        outcome=Outcome.DONE if np.all(counted) and not rest.interrupted else Outcome.INTERRUPTED,
        unverified=unverified,
    )


def attractors_reached(
    strobe: Stroboscope, responses: Sequence[PeriodicResponse], states: Floats, periods: int
) -> list[Attractor]:
    """Attractors that motions from the states (k, 2n) end on; they say nothing of basins: their fractions are 0."""
    settling = begin_settling(strobe, responses, periods)
    settled = settling.settle(states)
    found = describe(settling, settled, np.zeros(len(states), dtype=bool))
    reached = [attractor for labels, attractor in found if np.isin(settled.labels, labels).any()]
    return [dataclasses.replace(attractor, basin_fraction=0.0) for attractor in reached]


def begin_settling(strobe: Stroboscope, responses: Sequence[PeriodicResponse], periods: int) -> Settling:
    """Settling that knows the stable periodic responses."""
    orbits = known_orbits(strobe, [response.state for response in responses if response.stable])
    return Settling(strobe, periods, [orbit for orbit in orbits if orbit is not None])


def describe(
    settling: Settling, settled: Settled, counted: np.ndarray, rest: int = UNLABELLED
) -> list[tuple[list[int], Attractor]]:
    """Attractors with the labels each stands for, the largest pipe peak first; the unsettled ones have no label."""
    total = int(np.count_nonzero(counted))
    open_ended = np.array([outcome is Outcome.NOT_CONVERGED for outcome in settled.outcomes], dtype=bool)
    doubtful = int(np.count_nonzero(open_ended & counted))
    found: list[tuple[list[int], Attractor]] = []
    for group in _groups(settling.known):
        hits = int(np.count_nonzero(np.isin(settled.labels, group) & counted))
        chance = _chance(hits, total, doubtful) | _escape(settling, settled, counted, group)
        first = settling.known[group[0]]
        if isinstance(first, Orbit):
            looks = _orbit_looks(settling.strobe, first)
        else:
            clouds = [item for item in (settling.known[i] for i in group) if isinstance(item, Cloud)]
            looks = _cloud_looks(settling, clouds)
        found.append((group, Attractor(**_where(settling.strobe), **looks, **chance, from_rest=rest in group)))
    found += [([], lost) for lost in _unsettled(settling.strobe, settled, counted, total)]
    return sorted(found, key=lambda item: -np.nan_to_num(item[1].pipe_peak, nan=-1.0, posinf=np.inf))


def _groups(known: Sequence[Orbit | Cloud]) -> list[list[int]]:
    """Indices of known attractors that count as one."""
    groups: list[list[int]] = []
    for index, item in enumerate(known):
        for group in groups:
            first = known[group[0]]
            if isinstance(item, Cloud) and isinstance(first, Cloud) and _alike(item, first):
                group.append(index)
                break
        else:
            groups.append([index])
    return groups


def _alike(a: Cloud, b: Cloud) -> bool:
    """Whether peaks and rms agree within 2 % of the peak, or within their scatter between windows."""
    (mean_a, spread_a), (mean_b, spread_b) = ((np.mean(c.seen, axis=0), np.std(c.seen, axis=0, ddof=1)) for c in (a, b))
    peaks = np.repeat(np.maximum(mean_a, mean_b)[[0, 3]], 3)
    return bool(np.all(np.abs(mean_a - mean_b) <= np.maximum(ALIKE * peaks, spread_a + spread_b)))


def _where(strobe: Stroboscope) -> dict[str, Any]:
    return {"frequency": strobe.frequency, "detuning": float(detuning_of(strobe.system, strobe.frequency))}


def _chance(hits: int, total: int, doubtful: int = 0) -> dict[str, Any]:
    fraction = hits / total if total else float("nan")
    return {"basin_fraction": fraction, "basin_interval": clopper_pearson(hits, total, doubtful)}


def _escape(settling: Settling, settled: Settled, counted: np.ndarray, group: list[int]) -> dict[str, Any]:
    """Rate at which motions leave a set that is no orbit, from those of the sample and those that confirmed it."""
    clouds = [item for item in (settling.known[i] for i in group) if isinstance(item, Cloud)]
    if not clouds:
        return {"escape_rate": 0.0, "escape_interval": (0.0, 0.0)}
    held = np.flatnonzero(np.isin(settled.held, group) & counted)
    on_orbit = [label != UNLABELLED and isinstance(settling.known[label], Orbit) for label in settled.labels[held]]
    escaped = [settled.outcomes[i] is Outcome.DIVERGED for i in held]
    left = int(np.count_nonzero(np.logical_or(on_orbit, escaped))) + sum(cloud.left for cloud in clouds)
    periods = int(np.sum((settled.periods - settled.held_from)[held])) + sum(cloud.followed for cloud in clouds)
    exposure = periods * settling.strobe.period
    return {"escape_rate": left / exposure, "escape_interval": poisson_interval(left, exposure)}


def _orbit_looks(strobe: Stroboscope, orbit: Orbit) -> dict[str, Any]:
    p = orbit.multiple
    seen = strobe.run(orbit.states[:1], p, window=p).seen
    rate = float(np.log(max(np.max(np.abs(orbit.multipliers)), 1e-300))) / (p * strobe.period)
    return {
        "kind": "periodic",
        **_sizes(seen),
        "rare_peaks": RarePeaks.known(float(seen[0, 0]), float(seen[0, 3])),
        "return_time": DURATION * strobe.period,
        "period_multiple": p,
        "beat_period": float("nan"),
        "frequencies": (strobe.frequency / p,),
        "lyapunov": rate,
        "lyapunov_interval": (rate, rate),
        "representative_state": orbit.states[0],
        "outcome": Outcome.DONE,
    }


def _cloud_looks(settling: Settling, clouds: Sequence[Cloud]) -> dict[str, Any]:
    strobe, members = settling.strobe, clouds[0].members
    exponent = clouds[0].exponent
    beat = beat_frequency(strobe, members)
    return {
        "kind": "chaotic" if exponent.chaotic else "quasi-periodic",
        **_sizes(np.concatenate([cloud.seen for cloud in clouds])),
        "rare_peaks": RarePeaks(functools.partial(_levels, strobe, clouds[0], settling.orbits)),
        "return_time": DURATION * strobe.period,
        "period_multiple": 0,
        "beat_period": 2 * np.pi / beat,
        "frequencies": (strobe.frequency, beat),
        "lyapunov": exponent.value,
        "lyapunov_interval": exponent.interval,
        "representative_state": frozen(members[0, -1]),
        "outcome": Outcome.DONE,
    }


def _sizes(seen: Floats) -> dict[str, Any]:
    """Peaks, rms and envelopes from windows, see `Glimpse.seen`."""
    least, most = np.min(seen, axis=0), np.max(seen, axis=0)
    rms = np.sqrt(np.mean(seen**2, axis=0))
    return {
        "pipe_peak": float(most[0]),
        "relative_peak": float(most[3]),
        "pipe_rms": float(rms[2]),
        "relative_rms": float(rms[5]),
        "envelope": (float(least[1]), float(most[0])),
        "relative_envelope": (float(least[4]), float(most[3])),
    }


def _levels(strobe: Stroboscope, cloud: Cloud, orbits: Sequence[Orbit]) -> tuple[Level, Level]:
    """What is exceeded once in the return time on an attractor that is no orbit, by pipe and first element."""
    stretches = DURATION / STRETCH
    peaks = peaks_of_long_motions(strobe, cloud, orbits, lambda seen: enough(seen, stretches))
    return expected_peak(peaks[..., 0], stretches), expected_peak(peaks[..., 1], stretches)


def _unsettled(strobe: Stroboscope, settled: Settled, counted: np.ndarray, total: int) -> list[Attractor]:
    """One entry for every reason a motion of the sample has no label."""
    lost, nan = [], float("nan")
    unlabelled = counted & (settled.labels == UNLABELLED)
    for reason in (Outcome.DIVERGED, Outcome.NOT_CONVERGED, Outcome.STEP_LIMIT, Outcome.STEP_TOO_SMALL):
        members = np.array([i for i in np.flatnonzero(unlabelled) if settled.outcomes[i] is reason], dtype=int)
        if not members.size:
            continue
        seen = np.full((1, 6), np.inf if reason is Outcome.DIVERGED else nan)
        if reason is Outcome.NOT_CONVERGED:
            seen = np.max(strobe.run(settled.states[members], _WATCH, window=_WATCH).seen, axis=0, keepdims=True)
        lost.append(
            Attractor(
                kind="unsettled",
                **_where(strobe),
                **_sizes(seen),
                rare_peaks=RarePeaks.known(nan, nan),
                return_time=DURATION * strobe.period,
                period_multiple=0,
                beat_period=nan,
                frequencies=(strobe.frequency,),
                lyapunov=nan,
                lyapunov_interval=(nan, nan),
                **_chance(members.size, total),
                escape_rate=nan,
                escape_interval=(nan, nan),
                representative_state=frozen(settled.states[members[0]]),
                from_rest=False,
                outcome=reason,
            )
        )
    return lost
