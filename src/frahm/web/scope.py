"""What the page can show of a case: known before anything is computed."""

from __future__ import annotations

from frahm.case import Case, CubicLaw, Pipe
from frahm.errors import ParameterError
from frahm.loads import operating_range, vortex_shedding

PLANES = ("kappa", "xi2")


def check_shown(case: Case) -> None:
    """Refuse a case that the page has nothing to show of.

    Raises
    ------
    ParameterError
        If the case has no absorber.
    """
    if not case.absorbers:
        allowed = "for this page: a case with an absorber"
        raise ParameterError("absorbers", "a pipe without any", allowed, hint="frahm run takes any case.")


def has_slow_flow(case: Case) -> bool:
    """Whether the slow flow tells the response of a case: one mode with one purely cubic sink."""
    if not isinstance(case.pipe, Pipe) or len(case.absorbers) != 1:
        return False
    sink = case.absorbers[0]
    return isinstance(sink.law, CubicLaw) and sink.stops is None and sink.friction is None and not sink.gravity


def shedding_detuning(case: Case) -> float:
    """Detuning [rad/s] at which the wind of the case sheds vortices."""
    return vortex_shedding(case).detuning


def detuning_window(case: Case) -> tuple[float, float]:
    """Lowest and highest detuning [rad/s] of the range of operation of a case."""
    return operating_range(case).detuning


def start_detuning(case: Case) -> float:
    """Detuning the page starts with: that of the wind, if it lies in the window."""
    lo, hi = detuning_window(case)
    return min(hi, max(lo, shedding_detuning(case)))
