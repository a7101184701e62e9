"""What the page can show of a case: known before anything is computed."""

from __future__ import annotations

import functools
import math
from dataclasses import dataclass

from frahm.case import Case, CubicLaw, Pipe
from frahm.loads import OperatingRange, operating_range, vortex_shedding

PLANES = ("kappa", "xi2")
DETUNING, PLACE = "detuning", "place"  # names of the field that says where the motion is looked at


def has_slow_flow(case: Case) -> bool:
    """Whether the slow flow tells the response of a case: one mode, one purely cubic sink, one lift for all."""
    if not isinstance(case.pipe, Pipe) or len(case.absorbers) != 1 or range_of(case).over_wind:
        return False
    sink = case.absorbers[0]
    return isinstance(sink.law, CubicLaw) and sink.stops is None and sink.friction is None and not sink.gravity


@functools.lru_cache(maxsize=256)
def range_of(case: Case) -> OperatingRange:
    """The range of operation of a case, made once."""
    return operating_range(case)


@dataclass(frozen=True)
class Axis:
    """What the response is drawn over: the wind speed [m/s], or the detuning [rad/s] where one lift is for all.

    Attributes
    ----------
    case : Case
    """

    case: Case

    @property
    def over_wind(self) -> bool:
        """Whether it is the wind speed."""
        return range_of(self.case).over_wind

    @property
    def name(self) -> str:
        """Name of the field that says where on it the motion is looked at."""
        return PLACE if self.over_wind else DETUNING

    @property
    def unit(self) -> str:
        """Unit of its values."""
        return "m/s" if self.over_wind else "rad/s"

    @property
    def ends(self) -> tuple[float, float]:
        """Lowest and highest value."""
        within = range_of(self.case)
        return within.wind or within.detuning

    @property
    def shown(self) -> tuple[float, float]:
        """The ends rounded inward to four digits, so that what a slider says lies in the range."""
        lo, hi = self.ends
        step = 10.0 ** (math.floor(math.log10(max(abs(lo), abs(hi)))) - 3)
        inward = round(math.ceil(lo / step) * step, 12), round(math.floor(hi / step) * step, 12)
        return inward if lo <= inward[0] < inward[1] <= hi else (lo, hi)

    @property
    def wind(self) -> float:
        """Where the wind of the case stands on it."""
        return self.case.wind.speed if self.over_wind else shedding_detuning(self.case)

    @property
    def start(self) -> float:
        """Where the motion is looked at first: in the wind of the case, if that lies in the range."""
        lo, hi = self.shown
        return min(hi, max(lo, self.wind))

    def driven(self, at: float) -> tuple[Case, float]:
        """The case with the lift at a value, and the detuning [rad/s] there."""
        if not self.over_wind:
            return self.case, at
        there = self.case.with_wind(speed=at)
        return there, shedding_detuning(there)


def shedding_detuning(case: Case) -> float:
    """Detuning [rad/s] at which the wind of the case sheds vortices."""
    return float(vortex_shedding(case).detuning)
