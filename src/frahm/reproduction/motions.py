"""Exact motions over the detuning: from rest, and from every stable equilibrium of the slow flow."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from frahm.arrays import Floats
from frahm.published.yang2022 import Sink
from frahm.reproduction.cases import case_of
from frahm.response import slow_flow_map
from frahm.slow_flow import SlowFlow, slow_flow_of
from frahm.slow_flow.kernels import STABLE, coefficients
from frahm.systems import build_system
from frahm.time_integration import integrate_batch

PERIODS = 2500  # a disturbance of the pipe has then decayed to e^-24
WINDOW = 300  # several beats of the slowest modulation
_MODULATED = 0.01  # of the largest peak: what the peaks of a motion called periodic may differ by
GRID = np.round(np.linspace(-0.4, 0.4, 801), 12)


@dataclass(frozen=True)
class SettledMotions:
    """What exact motions look like once settled, one per detuning and initial state.

    Parameters
    ----------
    detuning : ndarray
        [rad/s].
    pipe_peak, pipe_least_peak, relative_peak : ndarray
        Largest |x1|, smallest peak of x1 over a period, largest |z| [m].
    ok : ndarray of bool
        Whether the integration reached its end.
    """

    detuning: Floats
    pipe_peak: Floats
    pipe_least_peak: Floats
    relative_peak: Floats
    ok: np.ndarray

    @property
    def modulated(self) -> np.ndarray:
        """Whether the peaks of the pipe vary from period to period by more than 1 %."""
        return np.asarray(self.pipe_peak - self.pipe_least_peak > _MODULATED * self.pipe_peak)

    @property
    def modulated_range(self) -> tuple[float, float]:
        """First and last detuning [rad/s] with a modulated motion; NaN if there is none."""
        found = self.detuning[self.modulated]
        return (float(found.min()), float(found.max())) if found.size else (float("nan"), float("nan"))

    def largest_pipe(self, low: float = -np.inf, high: float = np.inf) -> float:
        """Largest |x1| [m] with the detuning in [low, high]."""
        return float(np.max(self.pipe_peak[(self.detuning >= low) & (self.detuning <= high)]))

    def at(self, detuning: float) -> SettledMotions:
        """The motions at the detuning nearest to the one asked for."""
        return self.where(self.detuning == self.detuning[np.argmin(np.abs(self.detuning - detuning))])

    def where(self, chosen: np.ndarray) -> SettledMotions:
        """Some of the motions."""
        columns = (self.detuning, self.pipe_peak, self.pipe_least_peak, self.relative_peak, self.ok)
        return SettledMotions(*(column[chosen] for column in columns))


def motions_from_rest(sink: Sink) -> SettledMotions:
    """Exact motions of the pipe with a sink, started at rest, over the detuning."""
    return _settled(sink, GRID, np.zeros((1, 4)))


def motions_on_branches(sink: Sink) -> SettledMotions:
    """Exact motions started on every stable equilibrium of the slow flow (averaged form)."""
    slow = slow_flow_of(build_system(case_of(sink)), "averaged")
    found = slow_flow_map(case_of(sink), detuning=GRID, form="averaged")
    points, roots = np.nonzero(found["stability"].values == STABLE)
    relative = found["relative_amplitude"].values[points, roots]
    states = [
        equilibrium_state(slow, slow.omega + sigma, amplitude)
        for sigma, amplitude in zip(GRID[points], relative, strict=True)
    ]
    return _settled(sink, GRID[points], np.array(states))


def equilibrium_state(slow: SlowFlow, frequency: float, relative_amplitude: float) -> tuple[float, float, float, float]:
    """State (x1, v1, x2, v2) [m, m/s] at t = 0 of an equilibrium of the slow flow with amplitude |Z| [m]."""
    _, a, _, _, e, g1, g2 = coefficients(slow.code, frequency, *slow.host)
    n = 0.75 * slow.kappa * relative_amplitude**2
    pipe_per_relative = (g2 + n) / e - 1
    Z = slow.force / (a * pipe_per_relative - (g1 + n))
    X = pipe_per_relative * Z
    X2 = X + Z
    return X.real, -frequency * X.imag, X2.real, -frequency * X2.imag


def _settled(sink: Sink, detuning: Floats, states: Floats) -> SettledMotions:
    result = integrate_batch(case_of(sink), detuning=detuning, initial_states=states, periods=PERIODS, window=WINDOW)
    return SettledMotions(detuning, result.pipe_peak, result.pipe_least_peak, result.relative_peak, result.ok)
