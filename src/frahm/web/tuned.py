"""The competitor: a tuned mass damper of the same mass, tuned for equal peaks, and the pipe without any."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass

import numpy as np

from frahm.arrays import Floats
from frahm.case import Case
from frahm.harmonic_balance.linear import around_resonance
from frahm.systems import build_system
from frahm.web.scope import range_of

MASS_RATIO = 0.02  # of an absorber that is offered to a pipe without one
_EVEN, _AROUND = 301, 61  # points over the range, and around every resonance


@dataclass(frozen=True)
class LinearResponse:
    """Amplitudes over the range of operation.

    Attributes
    ----------
    frequency, detuning : ndarray
        Omega, sigma [rad/s].
    wind_speed : ndarray or None
        U [m/s] where every wind has its own lift.
    pipe, relative : ndarray
        [m]; `relative` is empty without an absorber.
    """

    frequency: Floats
    detuning: Floats
    wind_speed: Floats | None
    pipe: Floats
    relative: Floats

    @property
    def x(self) -> Floats:
        """What it is drawn over."""
        return self.detuning if self.wind_speed is None else self.wind_speed


def tuned_mass_damper_response(case: Case) -> LinearResponse:
    """Response of the pipe with a tuned mass damper of the same mass, in closed form."""
    from frahm.design.tuned import textbook_damper  # half a second that the page can do without until it is asked for
    from frahm.harmonic_balance.condensation import linear_part
    from frahm.harmonic_balance.linear import linear_exponents

    system = build_system(textbook_damper(case, MASS_RATIO))
    damping, stiffness = linear_part(system)
    values = linear_exponents(system)
    grid = _grid(case, ((value.imag, -value.real) for value in values[values.imag > 0]))
    W = grid[:, None, None]
    dynamic = stiffness - W**2 * system.mass + 1j * W * damping
    force = np.broadcast_to(system.forcing[:, None], (grid.size, system.size, 1))
    X = np.linalg.solve(dynamic, force)[..., 0]
    return _response(case, grid, np.abs(X @ system.output), np.abs(X @ system.elements[0].direction))


def bare_response(case: Case) -> LinearResponse:
    """Response of the pipe without any absorber, mode by mode; NaN where it is infinite."""
    system = build_system(case.without_absorbers())
    mass, damping, stiffness = (np.diag(matrix) for matrix in (system.mass, system.damping, system.stiffness))
    grid = _grid(case, zip(np.sqrt(stiffness / mass), 0.5 * damping / mass, strict=True))
    W = grid[:, None]
    dynamic = stiffness - W**2 * mass + 1j * W * damping
    finite = np.abs(dynamic) > 0
    X = np.where(finite, system.forcing / np.where(finite, dynamic, 1.0), np.nan)
    return _response(case, grid, np.abs(X @ system.output), np.empty(0))


def _grid(case: Case, resonances: Iterable[tuple[float, float]]) -> Floats:
    """Frequencies [rad/s] true to resonances at omega with the decay delta: evenly along the circle that each draws."""
    lo, hi = range_of(case).frequency
    around = [around_resonance(omega, delta, _AROUND) for omega, delta in resonances]
    grid = np.unique(np.concatenate([np.linspace(lo, hi, _EVEN), *around]))
    return grid[(grid >= lo) & (grid <= hi)]


def _response(case: Case, frequency: Floats, pipe: Floats, relative: Floats) -> LinearResponse:
    """Amplitudes with the lift of the case, as every wind drives them."""
    within = range_of(case)
    detuning = frequency - within.reference
    if not within.over_wind:
        return LinearResponse(frequency, detuning, None, pipe, relative)
    factors = np.array([within.lift_factor(float(W)) for W in frequency])
    return LinearResponse(
        frequency, detuning, within.speed(frequency), factors * pipe, factors[: relative.size] * relative
    )
