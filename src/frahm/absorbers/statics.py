"""Where an element rests: equilibria, sag under weight, and the stroke up to which springs count as cubic."""

from __future__ import annotations

import numpy as np

from frahm.absorbers.law import Law
from frahm.absorbers.polynomial_laws import Polynomial
from frahm.absorbers.transverse_springs import TransverseSprings
from frahm.arrays import Floats, frozen
from frahm.errors import check_number
from frahm.polynomials import REAL

STANDARD_GRAVITY = 9.80665  # [m/s^2], by definition
CUBIC_UP_TO = 0.25  # stroke per length up to which two transverse springs count as cubic; exact/cubic is .955 there
_NEAR = 1e-6  # what counts as beside the middle [m]
_DECADES, _PER_DECADE = (-9, 4), 64  # displacements searched [m]


def equilibria(law: Law) -> Floats:
    """All displacements z [m] at which the law exerts no static force, ascending.

    Roots of a polynomial are complete. Otherwise they are found by sign changes on a logarithmic grid of 64 points a
    decade from 1 nm to 10 km to both sides.
    """
    if law.stops is None and isinstance(law, Polynomial):
        roots = np.polynomial.Polynomial([-law.weight, *law.coefficients]).trim().roots()
        real = np.sort(roots[np.abs(roots.imag) <= REAL * np.abs(roots)].real)
        apart = np.diff(real, prepend=-np.inf) > 1e-7 * np.max(np.abs(real), initial=0.0)
        return frozen(real[apart])
    from scipy.optimize import brentq  # takes long to load

    side = np.logspace(*_DECADES, (_DECADES[1] - _DECADES[0]) * _PER_DECADE + 1)
    grid = np.concatenate([-side[::-1], [0.0], side])
    values = law.static_force(grid)
    found = list(grid[values == 0])
    for i in np.flatnonzero(values[:-1] * values[1:] < 0):
        found.append(brentq(lambda z: float(law.static_force(z)), grid[i], grid[i + 1], xtol=1e-300))
    return frozen(sorted(found))


def wells(law: Law) -> Floats:
    """The stable ones of `equilibria` [m]: where the energy has a minimum."""
    stable = []
    for z in equilibria(law):
        aside = z + np.array([-1e-3, 1e-3]) * (abs(z) or _NEAR)
        if np.all(law.energy(aside) > law.energy(z)):
            stable.append(float(z))
    return frozen(stable)


def sag(law: Law, mass: float, gravity: float = STANDARD_GRAVITY) -> float:
    """How far a mass sags on the law under gravity along the motion [m]: (m g/k)^(1/3) for a cubic spring.

    The nearest equilibrium in the direction of the weight; infinite if the law cannot carry it.

    Parameters
    ----------
    law : Law
        Its own `weight` is replaced by that of the mass.
    mass : float
        Moving mass [kg].
    gravity : float
        Component of gravity along the motion [m/s^2].
    """
    weight = check_number("mass", mass, above=0, unit="kg") * check_number("gravity", gravity, at_least=0, unit="m/s^2")
    places = equilibria(law.with_weight(weight))
    return float(min(places[places >= 0], default=np.inf))


def cubic_stroke_limit(law: Law) -> float:
    """Stroke [m] up to which a law counts as its cubic term: 0.25 L for transverse springs, otherwise infinite."""
    return CUBIC_UP_TO * law.length if isinstance(law, TransverseSprings) else np.inf
