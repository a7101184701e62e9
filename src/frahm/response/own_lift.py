"""Where one lift is asked about over a window of detuning: what the winds that shed there do, each with its own."""

from __future__ import annotations

from typing import NamedTuple

from frahm import readable
from frahm.case import Case
from frahm.errors import ParameterError
from frahm.loads import OperatingRange, wind_excitation
from frahm.response.frequency_response import frequency_response
from frahm.tolerances import AS_LARGE


class OwnLift(NamedTuple):
    """Largest stable response over winds with their own lift, beside the worst with one lift for all.

    Attributes
    ----------
    peak, speed : float
        Of the pipe [m], and the wind [m/s].
    worst : float
        With one lift for all [m].
    at : float
        Wind whose lift that is [m/s].
    """

    peak: float
    speed: float
    worst: float
    at: float

    @property
    def exceeds(self) -> bool:
        """Whether the winds move the pipe more than the one lift says."""
        return self.peak > AS_LARGE * self.worst

    @property
    def text(self) -> str:
        """Both numbers in a sentence, and what to do if the winds move the pipe more."""
        hint = " Leave out analysis.detuning, so that the lift follows the wind." if self.exceeds else ""
        return (
            f"Over the winds that shed in the window, each with its own lift, the largest stable response is"
            f" {readable.length(self.peak)} (at {readable.speed(self.speed)}), against {readable.length(self.worst)}"
            f" with the lift of {readable.speed(self.at)} at every frequency.{hint}"
        )


def own_lift(case: Case, within: OperatingRange, worst: float) -> OwnLift | None:
    """What winds with their own lift do where a case asks for one; None where no one range of winds sheds there."""
    window = winds_of_window(case, within)
    if within.over_wind or window is None:
        return None
    try:
        peak, frequency = frequency_response(case, wind=window).largest(stable_only=True)
    except ParameterError:  # no lift, or a wind of which it is not known
        return None
    return OwnLift(peak, float(wind_excitation(case).speed(frequency, *window)), worst, case.wind.speed)


def winds_of_window(case: Case, within: OperatingRange) -> tuple[float, float] | None:
    """Winds [m/s] of a range, or those that shed at the ends of its window of frequency, if one range of them does."""
    if within.wind is not None:
        return within.wind
    law = wind_excitation(case)
    ends = [law.speeds_of(W) for W in within.frequency]
    if any(found.size != 1 for found in ends):
        return None
    lo, hi = (float(found[0]) for found in ends)
    return (lo, hi) if lo < hi else None
