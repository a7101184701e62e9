"""Every lasting motion at each wind speed of a band, and the damage per time it does."""

from __future__ import annotations

import dataclasses
import os
from collections.abc import Callable, Iterable, Sequence
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass, field

import numpy as np

from frahm.arrays import Floats
from frahm.assessment.detail import Detail
from frahm.assessment.lasting_part import lasting
from frahm.assessment.motion_damage import MotionDamage, largest_place, motion_damage
from frahm.attractors import Attractor, AttractorSet
from frahm.attractors.finding import attractors_from, attractors_reached, settling_periods
from frahm.attractors.regions import default_region
from frahm.attractors.stroboscope import Stroboscope, stroboscope
from frahm.case import Case
from frahm.harmonic_balance import PeriodicResponse, periodic_responses_of
from frahm.loads import wind_excitation
from frahm.systems import System, build_system
from frahm.tolerances import ALIKE

_UNLIKE = 0.05  # relative difference of rates above which a neighbour's worst motion is tried, too
_ROUNDS = 3
Seen = Callable[[int], None]


@dataclass(frozen=True, eq=False)
class WindFindings:
    """What there is at one wind speed.

    Attributes
    ----------
    speed : float
        U [m/s].
    frequency : float
        Omega(U) [rad/s].
    system : System
        With the forcing F(U).
    responses : tuple of PeriodicResponse
    found : AttractorSet
    damage : tuple of MotionDamage
        Of every attractor, in their order.
    """

    speed: float
    frequency: float
    system: System
    responses: tuple[PeriodicResponse, ...]
    found: AttractorSet
    damage: tuple[MotionDamage, ...]

    @property
    def worst(self) -> int:
        """Which attractor does most damage; one that cannot be counted is passed over."""
        rates = np.array([entry.rate for entry in self.damage])
        return int(np.nanargmax(rates)) if np.any(~np.isnan(rates)) else 0

    @property
    def worst_rate(self) -> float:
        """Largest damage per time of any attractor found, however small its basin [1/s]."""
        return self.damage[self.worst].rate if self.damage else 0.0

    @property
    def weighted_rate(self) -> float:
        """Damage per time weighted by basin fractions [1/s]; what has not settled counts as the worst."""
        worst, total = self.worst_rate, 0.0
        for attractor, entry in zip(self.found, self.damage, strict=True):
            if attractor.basin_fraction > 0:
                total += attractor.basin_fraction * (worst if attractor.kind == "unsettled" else entry.rate)
        return total

    @property
    def unsettled(self) -> float:
        """Share of the sampled motions that ended on no attractor [-]."""
        return sum(attractor.basin_fraction for attractor in self.found if attractor.kind == "unsettled")


@dataclass(eq=False)
class WindSurvey:
    """Findings by wind speed; `look` adds to them.

    Attributes
    ----------
    case : Case
    detail : Detail or None
        Whose damage is counted; none without one.
    samples, seed : int
    workers : int
        Threads; each takes a wind speed at a time.
    changed : callable, optional
        What is done to the system of the case at every wind.
    at : dict of float to WindFindings
    """

    case: Case
    detail: Detail | None
    samples: int
    seed: int
    workers: int | None = None
    seen: Seen | None = None
    changed: Callable[[System], System] | None = None
    at: dict[float, WindFindings] = field(default_factory=dict)

    @property
    def place(self) -> Detail:
        """The detail, of a survey that counts its damage."""
        if self.detail is None:
            raise RuntimeError("a survey without a detail counts no damage")
        return self.detail

    def look(self, speeds: Sequence[float]) -> None:
        """Find the motions at the speeds not looked at yet [m/s]."""
        self._all(self._found, [speed for speed in speeds if speed not in self.at])

    def carry(self) -> None:
        """Start from the worst motion of a neighbour wherever that does more damage.

        A motion with a small basin that the sample missed at one wind is found if the next one has it.
        """
        for _ in range(_ROUNDS):
            before = {speed: found.worst_rate for speed, found in self.at.items()}
            wanted = [speed for speed in before if len(self._from_neighbours(speed))]
            self._all(self._carried, wanted)
            if not any(self.at[speed].worst_rate > rate * (1 + _UNLIKE) for speed, rate in before.items()):
                break

    def moved_to(self, detail: Detail) -> WindSurvey:
        """The same motions, their damage counted at another detail."""
        new = WindSurvey(self.case, detail, self.samples, self.seed, self.workers, None, self.changed)

        def counted(found: WindFindings) -> WindFindings:
            damage = tuple(motion_damage(found.system, attractor, detail) for attractor in found.found)
            return dataclasses.replace(found, damage=damage)

        with self._pool() as pool:
            new.at = {found.speed: found for found in pool.map(counted, self.at.values())}
        return new

    def larger_place(self, sections: Floats, rows: Floats, least: float) -> tuple[float, int] | None:
        """Section, and its row, where the worst motion of some wind has a range more than `least` times the detail's.

        Winds that do less than a thousandth of the largest damage per time are passed over.
        """
        top = max((found.worst_rate for found in self.at.values()), default=0.0)
        best: tuple[float, float, int] | None = None
        for found in self.at.values():
            worst = found.found[found.worst] if len(found.found) else None
            if worst is None or worst.kind == "unsettled" or not found.worst_rate > 1e-3 * top:
                continue
            section, ranges = largest_place(found.system, worst, sections, rows)
            here = ranges[np.argmin(np.abs(sections - (self.place.section or 0.0)))]
            if ranges.max() > least * here and (best is None or found.worst_rate > best[0]):
                best = (found.worst_rate, section, int(np.argmax(ranges)))
        return None if best is None else best[1:]

    def _from_neighbours(self, speed: float) -> Floats:
        """States (k, 2n) of the neighbours' worst motions that do more damage than any of this wind."""
        ordered = sorted(self.at)
        place, own = ordered.index(speed), self.at[speed].worst_rate
        states = [np.zeros((0, 2 * self.at[speed].system.size))]
        for other in (place - 1, place + 1):
            found = self.at[ordered[other]] if 0 <= other < len(ordered) else None
            if found is None or not len(found.found) or not found.worst_rate > own * (1 + _UNLIKE):
                continue
            worst: Attractor = found.found[found.worst]
            if worst.kind != "unsettled":
                states.append(worst.representative_state[None])
        return np.concatenate(states)

    def _all(self, find: Callable[[float], WindFindings], speeds: Sequence[float]) -> None:
        with self._pool() as pool:
            for found in list(pool.map(find, speeds)):
                self.at[found.speed] = found
                if self.seen is not None:
                    self.seen(len(self.at))

    def _pool(self) -> ThreadPoolExecutor:
        return ThreadPoolExecutor(self.workers or os.cpu_count() or 1)

    def _found(self, speed: float) -> WindFindings:
        system = build_system(self.case.with_wind(speed=speed))
        if self.changed is not None:
            system = self.changed(system)
        W = float(wind_excitation(self.case).frequency(speed))
        responses = periodic_responses_of(system, W, None)
        region = default_region(system, W, responses)
        strobe = _strobe(system, W)
        found = attractors_from(
            strobe, responses, region, self.samples, self.seed, settling_periods(system, W), responses.unverified
        )
        found = lasting(strobe, responses, found)
        damage = self._damage(system, found)
        return WindFindings(speed, W, system, tuple(responses), found, damage)

    def _carried(self, speed: float) -> WindFindings:
        here = self.at[speed]
        strobe = _strobe(here.system, here.frequency)
        periods = settling_periods(here.system, here.frequency)
        reached = tuple(attractors_reached(strobe, here.responses, self._from_neighbours(speed), periods))
        reached = lasting(strobe, here.responses, dataclasses.replace(here.found, attractors=reached)).attractors
        new = tuple(one for one in reached if not any(_alike(one, known) for known in here.found))
        damage = self._damage(here.system, new)
        found = dataclasses.replace(here.found, attractors=(*here.found.attractors, *new))
        return dataclasses.replace(here, found=found, damage=(*here.damage, *damage))

    def _damage(self, system: System, attractors: Iterable[Attractor]) -> tuple[MotionDamage, ...]:
        if self.detail is None:
            return ()
        return tuple(motion_damage(system, attractor, self.detail) for attractor in attractors)


def _strobe(system: System, frequency: float) -> Stroboscope:
    """Stroboscope on one thread: every wind speed has its own."""
    return stroboscope(system, frequency, 1)


def _alike(a: Attractor, b: Attractor) -> bool:
    """Whether rms and rare peaks of two motions agree within 2 % of the peak, or these as far as they are known."""
    pipe, stroke = max(a.pipe_peak, b.pipe_peak), max(a.relative_peak, b.relative_peak)
    return bool(
        abs(a.pipe_rms - b.pipe_rms) <= ALIKE * pipe
        and abs(a.relative_rms - b.relative_rms) <= ALIKE * stroke
        and _levels_agree(
            a.pipe_peak_expected, a.pipe_peak_expected_interval, b.pipe_peak_expected, b.pipe_peak_expected_interval
        )
        and _levels_agree(
            a.relative_peak_expected,
            a.relative_peak_expected_interval,
            b.relative_peak_expected,
            b.relative_peak_expected_interval,
        )
    )


def _levels_agree(a: float, interval_a: tuple[float, float], b: float, interval_b: tuple[float, float]) -> bool:
    """Whether two levels of rare peaks agree within 2 %, or as far as they are known."""
    scatter = [high - low for low, high in (interval_a, interval_b) if np.isfinite(high - low)]
    return abs(a - b) <= max(ALIKE * max(a, b), sum(scatter))
