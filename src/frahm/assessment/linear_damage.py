"""Damage of a linear pipe in the wind, with or without linear absorbers: in closed form at every wind speed."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from frahm.arrays import Floats
from frahm.assessment.detail import Detail
from frahm.case import Case
from frahm.harmonic_balance import linear_growth, linear_response
from frahm.harmonic_balance.linear import linear_exponents
from frahm.loads import WindClimate, WindExcitation, wind_excitation
from frahm.systems import System, build_system

_GAUSS = np.polynomial.legendre.leggauss(8)
_SCAN = 4001
_DOUBLINGS = 40
_DECAYS = 1e-12  # growth rate over frequency below which nothing decays


@dataclass(frozen=True, eq=False)
class LinearPipe:
    """Stress of a linear system over the wind speed.

    Attributes
    ----------
    system : System
    excitation : WindExcitation
    reference_lift : float
        Lift the forcing of `system` belongs to [N].
    """

    system: System
    excitation: WindExcitation
    reference_lift: float

    @property
    def decays(self) -> bool:
        """Whether free motions die out."""
        return linear_growth(self.system) < -_DECAYS * self.system.reference_frequency

    def stress_range(self, speed: Floats, detail: Detail) -> Floats:
        """Hot-spot stress range [Pa] of the steady motion at wind speeds, shape (s,)."""
        X = linear_response(self.system, self.excitation.frequency(speed))
        scale = self.excitation.lift(speed) / self.reference_lift
        stress = np.einsum("pn,n->p", X, detail.row)  # a product of matrices would wake threads for nothing
        return np.asarray(2 * detail.factor * np.abs(stress) * scale)

    def rate(self, speed: Floats, detail: Detail) -> Floats:
        """Damage per time [1/s], one cycle per period: Omega/(2 pi N(S)), shape (s,)."""
        return self.rate_of(self.stress_range(speed, detail), speed, detail)

    def rate_of(self, stress_range: Floats, speed: Floats, detail: Detail) -> Floats:
        """The same of stress ranges [Pa] that are known, shape (s,)."""
        return np.asarray(self.excitation.frequency(speed) / (2 * np.pi) / detail.curve.cycles(stress_range))

    def resonances(self, low: float, high: float) -> list[tuple[float, float]]:
        """Winds between `low` and `high` that shed at a natural frequency, and half the width of the peak [m/s]."""
        speeds = np.linspace(low, high, _SCAN)
        Omega = self.excitation.frequency(speeds)
        found = []
        for value in linear_exponents(self.system):
            past = Omega - value.imag
            for i in np.flatnonzero(past[:-1] * past[1:] <= 0) if value.imag > 0 else ():
                slope = (Omega[i + 1] - Omega[i]) / (speeds[i + 1] - speeds[i])
                if slope != 0:
                    found.append((float(speeds[i] - past[i] / slope), float(abs(value.real / slope))))
        return found


def linear_pipe(case: Case) -> LinearPipe | None:
    """The pipe of a case with its absorbers, all laws linear; None if there is no lift at any wind."""
    excitation = wind_excitation(case)
    system = build_system(case)
    lift = float(excitation.lift(case.wind.speed))
    return LinearPipe(system, excitation, lift) if lift > 0 else None


def linear_damage(pipe: LinearPipe, detail: Detail, climate: WindClimate, edges: Floats) -> tuple[Floats, Floats]:
    """Damage in each wind bin over the duration of the climate [-], and the largest stress range in it [Pa].

    The density of the wind speed times the damage per time is integrated by Gauss' rule with eight points over panels
    that shrink towards each resonance, down to a fraction of its width.

    Parameters
    ----------
    edges : ndarray, shape (b + 1,)
        Ends of the bins [m/s], ascending.
    """
    panels = _panels(pipe, climate, edges)
    half = 0.5 * np.diff(panels)
    speeds = (panels[:-1] + half)[:, None] + half[:, None] * _GAUSS[0]
    flat = speeds.ravel()
    ranges = pipe.stress_range(flat, detail)
    rates = pipe.rate_of(ranges, flat, detail).reshape(speeds.shape)
    parts = climate.duration * half * np.sum(climate.density(flat).reshape(speeds.shape) * rates * _GAUSS[1], axis=1)
    bins = np.searchsorted(edges, panels[:-1] + half) - 1
    damage, largest = np.zeros(edges.size - 1), np.zeros(edges.size - 1)
    np.add.at(damage, bins, parts)
    np.maximum.at(largest, bins, ranges.reshape(speeds.shape).max(axis=1))
    return damage, largest


def _panels(pipe: LinearPipe, climate: WindClimate, edges: Floats) -> Floats:
    low, high = float(edges[0]), float(edges[-1])
    marks = [edges, climate.edges, pipe.excitation.kinks(low, high)]
    steps = np.concatenate([[0.0], 0.25 * 2.0 ** (0.5 * np.arange(_DOUBLINGS))])
    for speed, width in pipe.resonances(low, high):
        width = max(width, 1e-9 * speed)
        marks += [speed + width * steps, speed - width * steps]
    together = np.unique(np.concatenate(marks))
    return together[(together >= low) & (together <= high)]
