"""Variational equation of a system about a periodic orbit, without the modes that only follow."""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np
import scipy.linalg

from frahm.arrays import Floats
from frahm.harmonic_balance.condensation import linear_part
from frahm.systems import System

_REACHED = 10.0  # up to this multiple of the frequency a mode does not follow statically
_FALL_OFF = 0.3  # of the harmonics of the slope, from one even harmonic to the next
_HARDLY = 0.1  # of a mode's damping: excitation below this share does not keep the mode alive
_ROUNDING = 1e-12  # relative error of symmetric matrices and of their eigenvalues


class Variation(NamedTuple):
    """Matrices of the variational equation in m coordinates: x'' + C x' + K x + push P(t) feel x = 0.

    P is made of the slopes p_e: diagonal, or P (1 + flexibility P)^-1 where faster modes follow statically.
    """

    K: Floats  # (m, m)
    C: Floats  # (m, m)
    push: Floats  # (m, E)
    feel: Floats  # (E, m)
    flexibility: Floats  # (E, E)
    fastest: float
    hardest: Floats  # (E,): stiffness of an element to frequency squared


def variation_of(system: System, steepest: float = math.inf, frequency: float = math.inf) -> Variation:
    """Variational equation of a system; elements with linear laws belong to C and K.

    Parameters
    ----------
    system : System
    steepest : float
        Largest slope p_e [N/m] expected. Fast modes that such a slope cannot excite parametrically against their
        damping are replaced by their static flexibility (`_lively`); infinite: none are, nor where elements have stops
        or friction, whose slopes hold high harmonics.
    frequency : float
        Omega [rad/s].
    """
    C, K = linear_part(system)
    active = [element.direction for element in system.elements if not element.law.is_linear]
    N = np.column_stack(active) if active else np.zeros((system.size, 0))
    smooth = all(element.law.is_smooth for element in system.elements)
    if not smooth or not math.isfinite(steepest) or not np.allclose(K, K.T, rtol=_ROUNDING, atol=0):
        inverse = np.linalg.inv(system.mass)
        return _variation(inverse @ K, inverse @ C, inverse @ N, N.T, np.zeros((N.shape[1], N.shape[1])))
    squares, modes = scipy.linalg.eigh(K, system.mass)
    squares[np.abs(squares) < _ROUNDING * np.max(np.abs(squares))] = 0.0  # rounding; less than zero is a buckled system
    damping, feel = modes.T @ C @ modes, N.T @ modes
    keep = _lively(np.sqrt(np.maximum(squares, 0.0)), np.diag(damping), np.sum(feel**2, axis=0), steepest, frequency)
    rest = feel[:, ~keep] / squares[~keep] @ feel[:, ~keep].T if np.any(~keep) else np.zeros((len(feel), len(feel)))
    return _variation(np.diag(squares[keep]), damping[np.ix_(keep, keep)], feel[:, keep].T, feel[:, keep], rest)


def _lively(omega: Floats, damping: Floats, coupling: Floats, steepest: float, frequency: float) -> np.ndarray:
    """Which modes take part in the motion: those the orbit's harmonics reach, and those the slope's could excite.

    Harmonic m of the slope is taken to fall off as 0.3^(m/2 - 1); mode j can be excited in combination with a slow one
    by m = omega_j/Omega - 1 and above, at the rate steepest coupling/(2 omega_j), against half its damping.
    """
    m = np.maximum(omega / frequency - 1.0, 2.0)
    with np.errstate(divide="ignore", invalid="ignore"):
        rate = steepest * _FALL_OFF ** (m / 2 - 1) * coupling / (2 * omega)
    return np.asarray((omega < _REACHED * frequency) | ~(rate < _HARDLY * damping))


def _variation(K: Floats, C: Floats, push: Floats, feel: Floats, flexibility: Floats) -> Variation:
    m = K.shape[0]
    A = np.block([[np.zeros((m, m)), np.eye(m)], [-K, -C]])
    return Variation(
        np.ascontiguousarray(K),
        np.ascontiguousarray(C),
        np.ascontiguousarray(push),
        np.ascontiguousarray(feel),
        np.ascontiguousarray(flexibility),
        float(np.max(np.abs(np.linalg.eigvals(A)))),
        np.ascontiguousarray(np.einsum("em,me->e", feel, push)),
    )
