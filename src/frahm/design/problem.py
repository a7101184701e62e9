"""What a case and its settings come to: windows, disturbances, limits, and the closed form of every family."""

from __future__ import annotations

import dataclasses
import math
from dataclasses import dataclass, field

import numpy as np

from frahm.arrays import Floats
from frahm.assessment.counting import counted_band
from frahm.assessment.detail import detail_of, fatigue_section
from frahm.case import Case
from frahm.design.absorber import DesignedAbsorber, together, with_design
from frahm.design.disturbance import Disturbance, disturbances
from frahm.design.exact import ExcitedMode, Windows
from frahm.design.host import Host, Lift, host_of
from frahm.design.objective import ClimateMean, Objective
from frahm.design.screening import Screening
from frahm.design.search import ClosedFormSearch, Corrections, DesignLimits
from frahm.design.settings import DesignSettings
from frahm.design.space import DesignSpace, design_space
from frahm.errors import ParameterError
from frahm.loads import OperatingRange, operating_range, other_ranges, vortex_shedding, wind_climate
from frahm.systems import build_system

WIDE = (0.7, 1.3)  # of the pipe's frequency: where the lift may lock in
_RESPONSE_POINTS, _BIRTH_POINTS, _WIND_POINTS = 121, 481, 161
_GROUP_POINTS, _GROUP_BIRTHS = 61, 121  # of several absorbers, whose every response takes longer
_PLACES, _ROUNDS = 7, 3  # positions looked at first, and how often the gaps beside the best are halved


@dataclass(eq=False)
class Problem:
    """A case, what is asked for, and what was screened so far.

    Attributes
    ----------
    case : Case
    settings : DesignSettings
    objective : Objective
    windows : Windows
        Of the governing mode.
    others : tuple of (int, float, Windows)
        Governing mode, wind of the case [m/s] and where, of what else winds of the site excite, see `other_ranges`.
    within : OperatingRange
        What the worst motion of every device is asked about.
    wide : tuple of float
        Where the lift may lock in [rad/s].
    disturbances : list of Disturbance
    limits : DesignLimits
    tiers : dict
        Closed forms by family, the mode they are sized for, the number of absorbers and the force margin.
    singles : dict
        Best designs of one absorber by family, which searches for more of them begin at.
    """

    case: Case
    settings: DesignSettings
    objective: Objective
    windows: Windows
    others: tuple[tuple[int, float, Windows], ...]
    within: OperatingRange
    wide: tuple[float, float]
    disturbances: list[Disturbance]
    limits: DesignLimits
    tiers: dict[tuple[str, int | None, int, float], ClosedFormSearch] = field(default_factory=dict)
    singles: dict[str, list[DesignedAbsorber]] = field(default_factory=dict)
    _places: dict[tuple[str, int], float | None] = field(default_factory=dict)
    _tried: int = 0

    @classmethod
    def of(cls, case: Case, settings: DesignSettings) -> Problem:
        """The problem of a case.

        Raises
        ------
        ParameterError
            If the case lacks what the objective needs, or cannot have what is asked for.
        """
        objective = Objective(settings.objective, settings.quantile)
        _check(case, settings, objective)
        omega = case.pipe.frequency
        wide = (WIDE[0] * omega, WIDE[1] * omega)
        moving = settings.scatter.pipe_frequency > 0
        within = _range(case, settings, objective)
        if within.over_wind:
            windows = _over_wind(within, settings)
        else:
            windows = Windows(wide if moving else within.frequency, wide, moving, nominal=within)
        asked = within if not objective.over_climate else _range(case, settings, Objective())
        beside = other_ranges(case, _most_mass_ratio(settings)) if asked.moves else ()
        others = tuple(
            (other.pipe.governing_mode, other.wind.speed, _over_wind(part, settings)) for other, part in beside
        )
        conditions = disturbances(
            settings.scatter, settings.quantile, settings.scatter_samples, settings.seed,
            lock_in=not within.over_wind, others=len(case.absorbers[settings.counts[-1] :]),
        )  # fmt: skip
        gaps = [absorber.stops.gap for absorber in case.absorbers[: settings.counts[-1]] if absorber.stops is not None]
        stroke = min([settings.most_stroke, *gaps])
        limits = DesignLimits(settings.force_margin, stroke, False, settings.spring_length, settings.spring_stress)
        return cls(case, settings, objective, windows, others, asked, wide, conditions, limits)

    def check_host(self) -> None:
        """Refuse a case whose other absorbers are nonlinear, or whose absorber sits where nothing moves."""
        for count in self.settings.counts:
            self._host(None if self.settings.position is None else self.settings.position[1], count)

    def modes(self, case: Case) -> list[ExcitedMode]:
        """A pipe with a device as winds excite each of its modes, the governing one first."""
        others = [ExcitedMode(build_system(governed(case, k, speed)), windows) for k, speed, windows in self.others]
        return [ExcitedMode(build_system(case), self.windows), *others]

    def modes_of(self, design: DesignedAbsorber) -> list[ExcitedMode]:
        """The pipe with a design, see `modes`."""
        return self.modes(self.case_with(design))

    def case_with(self, design: DesignedAbsorber) -> Case:
        """The case with a design in place of the absorbers that are designed."""
        return with_design(self.case, design, replaced=self.settings.counts[-1])

    def modes_of_errors(self, case: Case) -> list[ExcitedMode]:
        """As `modes`, where a pipe off its frequency is looked at: all frequencies a fixed lift may lock in to."""
        governing, *others = self.modes(case)
        if not self.within.over_wind:
            governing = governing._replace(windows=Windows(self.wide, self.wide, True))
        return [governing, *others]

    @property
    def screened(self) -> int:
        """Designs judged by the closed form so far."""
        return self._tried + sum(tier.ledger.count for tier in self.tiers.values())

    @property
    def most_mass_ratio(self) -> float:
        """Largest mass ratio a design may have [-]."""
        return _most_mass_ratio(self.settings)

    def tier(
        self, family: str, margin: float | None = None, sized_for: int | None = None, count: int | None = None
    ) -> ClosedFormSearch:
        """Closed form for a family, with the force given and with its margin, at its best place.

        Springs and dampers are looked for around what suits the governing mode, or another one of `others`. The number
        of absorbers is the least asked for by default.
        """
        most = self.settings.force_margin if margin is None else margin
        number = self.settings.counts[0] if count is None else count
        key = (family, sized_for, number, most)
        if key not in self.tiers:
            first = next((tier for other, tier in list(self.tiers.items()) if other[:3] == key[:3]), None)
            if number > 1 and first is not None and first.is_asked_beside_1 and most != 1:
                self.tiers[key] = first.again(most)  # whose grid took long to judge
            else:
                self.tiers[key] = self._tier(family, most, self.place(family, number), sized_for, number)
        return self.tiers[key]

    def admits(self, design: DesignedAbsorber) -> bool:
        """Whether a design keeps the ranges of spring and damper."""
        ranges = {name: getattr(self.settings, name) for name in ("linear", "kappa", "quintic", "xi2")}
        slack = 1e-6
        return all(
            span is None or span[0] * (1 - slack) <= getattr(one, name) <= span[1] * (1 + slack)
            for name, span in ranges.items()
            for one in design.absorbers
        )

    def avoid(self, family: str, design: DesignedAbsorber, sized_for: int | None = None) -> None:
        """Search a family no longer near a design that failed."""
        self.tier(family, sized_for=sized_for, count=design.count).avoid(self.row(design))

    def row(self, design: DesignedAbsorber) -> Floats:
        """A design as the closed form takes it, (5 N,), in SI units."""
        return np.array(design.row) * self.case.pipe.mass

    def place(self, family: str, count: int = 1) -> float | None:
        """Position of the absorbers that is best by the closed form [m]; None where none is asked for."""
        if self.settings.position is None:
            return None
        if (family, count) not in self._places:
            self._places[family, count] = self._best_place(family, count, *self.settings.position)
        return self._places[family, count]

    def _best_place(self, family: str, count: int, lo: float, hi: float) -> float:
        known: dict[float, float] = {}

        def look(place: float) -> None:
            try:
                tier = self._tier(family, self.settings.force_margin, place, None, count)
            except ParameterError:  # the governing mode does not move there
                known[place] = math.inf
                return
            best = tier.best(self.limits, Corrections())
            known[place] = math.inf if best is None else best[1]
            self._tried += tier.ledger.count

        for place in np.linspace(lo, hi, _PLACES):
            look(float(place))
        for _ in range(_ROUNDS):
            places = sorted(known)
            at = places.index(min(places, key=lambda place: known[place]))
            for other in (at - 1, at + 1):
                if 0 <= other < len(places):
                    look(0.5 * (places[at] + places[other]))
        return min(sorted(known), key=lambda place: known[place])

    def _host(self, place: float | None, count: int, mode: int | None = None, speed: float | None = None) -> Host:
        """The pipe as absorbers feel it, where a mode governs; by default that of the case."""
        ratio = self.settings.mass_ratio
        mass = ratio[0] if isinstance(ratio, tuple) else ratio
        any_absorber = DesignedAbsorber((mass or 1.0) / count, 0.0, 1.0, 0.0, position=place)
        case = self.case_with(together([any_absorber] * count))
        return host_of(build_system(case if mode is None else governed(case, mode, speed)), count)

    def _tier(
        self, family: str, margin: float, place: float | None, sized_for: int | None, count: int
    ) -> ClosedFormSearch:
        host = self._host(place, count)
        screening = self.screening(sorted({1.0, margin}) if family != "tuned" else [1.0], place, count)
        settings = self.settings if family == self.settings.family else self.settings.for_rival()
        sizing = host if sized_for is None else self._host(place, count, sized_for)
        space = dataclasses.replace(design_space(sizing, self.case.pipe.mass, family, settings, count), position=place)
        return ClosedFormSearch(screening, space, self.objective, self.limits, known=self._known(family, space))

    def screening(self, forces: list[float], place: float | None = None, count: int = 1) -> Screening:
        """The pipe in every mode that winds excite, to be asked about designs in closed form at factors on the force.

        Raises
        ------
        ParameterError
            If an absorber sits where the governing mode does not move.
        """
        host = self._host(place, count)
        host.check_moves()
        others = tuple(
            self._screening(self._host(place, count, mode, speed), windows, forces, mode)
            for mode, speed, windows in self.others
        )
        governing = self._screening(host, self.windows, forces, self.case.pipe.governing_mode)
        return dataclasses.replace(governing, others=others)

    def _known(self, family: str, space: DesignSpace) -> Floats:
        """What the search for several absorbers of a family begins at besides: the best single ones, split."""
        single = [design for design in self.singles.get(family, ()) if space.count > 1]
        return np.array([space.split(self.row(design)) for design in single]).reshape(len(single), 5 * space.count)

    def counted(self) -> list[tuple[int, tuple[float, float]]]:
        """Modes besides the governing one whose damage counts, and the winds of each [m/s]."""
        fatigue = self.case.fatigue
        if not self.objective.of_damage or (fatigue is not None and fatigue.wind_speeds is not None):
            return []
        ranges = ((mode, windows.range(Disturbance()).winds) for mode, _, windows in self.others)
        return [(mode, winds) for mode, winds in ranges if winds is not None]

    def _screening(self, host: Host, windows: Windows, forces: list[float], mode: int) -> Screening:
        """One mode under all disturbances: where the response counts, and where detached curves are looked for."""
        lift: Lift | None = None if windows.axis is None else _lift(windows.axis)
        wide = windows.wide if lift is None else windows.window
        single = len(host.attachments) == 1
        responses, around = (_RESPONSE_POINTS, _BIRTH_POINTS) if single else (_GROUP_POINTS, _GROUP_BIRTHS)
        counts = host.conditions(
            self.disturbances, windows.window, responses, moving=windows.moving, forces=forces, lift=lift
        )
        moving = lift is None or windows.moving
        births = host.conditions(self.disturbances, wide, around, moving=moving, lift=lift)
        governing = self.objective.over_climate and windows is self.windows
        counted = governing or (mode, windows.range(Disturbance()).winds) in self.counted()
        return Screening(host, counts, births, self._climate(host, windows, mode) if counted else None)

    def _climate(self, host: Host, windows: Windows, mode: int) -> ClimateMean:
        """Mean over the winds of the band, equally spaced in frequency and closer around the resonance."""
        axis, climate = windows.axis, wind_climate(self.case)
        if axis is None:
            raise RuntimeError("a mean over the climate needs the wind as its axis")
        lift = _lift(axis)
        grid = host.conditions([Disturbance(lock_in=False)], axis.frequency, _WIND_POINTS, moving=False).frequency
        speeds = axis.speed(grid[0])
        ends = np.concatenate([[speeds[0]], 0.5 * (speeds[1:] + speeds[:-1]), [speeds[-1]]])
        chances = np.asarray(climate.probability(ends[:-1], ends[1:]))
        rows = np.repeat(grid, len(self.disturbances), axis=0)
        if not self.objective.of_damage:
            conditions = host.conditions_at(self.disturbances, rows, lift=lift)
            total = float(np.sum(chances))
            return ClimateMean(conditions, chances / total if total > 0 else chances, lambda x, W: x)
        detail = detail_of(governed(self.case, mode))
        stressed = dataclasses.replace(host, output=np.asarray(detail.row[: host.output.size]))
        conditions = stressed.conditions_at(self.disturbances, rows, lift=lift)

        def rate(stress: Floats, W: Floats) -> Floats:
            return np.asarray(W / (2 * np.pi) / detail.curve.cycles(2 * detail.factor * stress))

        return ClimateMean(conditions, climate.duration * chances, rate)


def _check(case: Case, settings: DesignSettings, objective: Objective) -> None:
    if objective.over_climate:
        wind_climate(case)
    if vortex_shedding(case).lift == 0:
        raise ParameterError("wind", case.wind.lift_coefficient, "a wind with lift: without it nothing moves the pipe")
    if objective.of_damage:
        fatigue_section(case)
    if settings.wind is not None and objective.over_climate:
        hint = "The band of the climate is fatigue.wind_speeds, or the winds that shed inside analysis.detuning."
        raise ParameterError("design.wind", settings.wind, "nothing where the objective is a mean", hint=hint)
    if settings.position is not None:
        if case.pipe.kind == "mode":
            allowed = "nothing, because a pipe given as one mode moves alike all along"
            raise ParameterError("design.position", settings.position, allowed)
        if settings.position[1] > case.pipe.length:
            raise ParameterError(
                "design.position", settings.position, f"sections of the pipe, 0 to {case.pipe.length:g} m"
            )
    if settings.quantile is not None and not settings.scatter.names:
        hint = "Say what scatters: design: {scatter: {pipe_frequency: 0.1}}."
        raise ParameterError("design.quantile", settings.quantile, "nothing where nothing scatters", hint=hint)


def _range(case: Case, settings: DesignSettings, objective: Objective) -> OperatingRange:
    if objective.over_climate:
        return operating_range(case, wind=counted_band(case))
    return operating_range(case, wind=settings.wind, most_mass_ratio=_most_mass_ratio(settings))


def _over_wind(within: OperatingRange, settings: DesignSettings) -> Windows:
    """The winds of a range, and those of every pipe that is off by as much as anything is asked about."""
    axis = within.stretched(*_frequencies(settings)) if within.moves else within
    return Windows(within.asked, within.asked, within.moves, axis, within)


def governed(case: Case, mode: int, speed: float | None = None) -> Case:
    """The case where the lift is in step with a mode, and counts from a wind [m/s] if that is another one."""
    other = case if mode == case.pipe.governing_mode else case.with_pipe(governing_mode=mode)
    return other if speed is None or speed == case.wind.speed else other.with_wind(speed=speed)


def _most_mass_ratio(settings: DesignSettings) -> float:
    ratio = settings.mass_ratio
    return (max(ratio) if isinstance(ratio, tuple) else ratio) or 0.0


def _frequencies(settings: DesignSettings) -> tuple[float, float]:
    """Least and largest frequency of the pipe over the nominal one that anything is asked about [-]."""
    spread = settings.scatter.pipe_frequency
    return min(1 - spread, *settings.errors, 1.0), max(1 + spread, *settings.errors, 1.0)


def _lift(axis: OperatingRange) -> Lift:
    """Lift over that at the wind of the case; none at frequencies that no wind of the site sheds at."""
    first, last = axis.frequency

    def factor(W: float) -> float:
        near = 1e-9 * W
        return axis.lift_factor(W) if first - near <= W <= last + near else 0.0

    return np.vectorize(factor, otypes=[float])
