"""Coil springs across the motion: how large they must be for a force and a stress (textbook formulas, secondary)."""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from frahm.arrays import Floats

SHEAR_MODULUS = 7.9e10  # of spring steel [Pa]
SPRING_INDEX, ALLOWED_SHEAR = 8.0, 4.0e8  # mean over wire diameter [-], shear stress [Pa]
MOST_SPRING_STROKE = 0.25  # of the free length: transverse springs are cubic within 4.5 % up to there
_WAHL = (4 * SPRING_INDEX - 1) / (4 * SPRING_INDEX - 4) + 0.615 / SPRING_INDEX
_END_COILS = 2.0


class CoilSprings(NamedTuple):
    """Each of two springs of length L across the motion; arrays of one shape, SI units.

    Attributes
    ----------
    length, free, stiffness, extension, pretension, force : ndarray
        L in the middle and without tension [m], k_s [N/m], extension by the stroke [m], tension in the middle and at
        the stroke [N].
    wire, coils, solid : ndarray
        Diameter of the wire [m], active coils [-], and length with all coils touching [m].
    """

    length: Floats
    free: Floats
    stiffness: Floats
    extension: Floats
    pretension: Floats
    force: Floats
    wire: Floats
    coils: Floats
    solid: Floats


def coil_springs(
    k1: ArrayLike, k3: ArrayLike, stroke: ArrayLike, room: float | None = None, stress: float | None = None
) -> CoilSprings:
    """Two springs across the motion with k1 = 2 T0/L and k3 = (k_s - T0/L)/L^2.

    Parameters
    ----------
    k1, k3 : array_like
        Linear and cubic stiffness of the pair [N/m, N/m^3].
    stroke : array_like
        Largest displacement [m].
    room : float, optional
        L [m]; by default four times the stroke, up to where the force is cubic within 4.5 %.
    stress : float, optional
        Shear stress at the stroke [Pa], 400 MPa by default: tau = 8 F C K/(pi d^2) with Wahl's factor K at the spring
        index C = 8, and k_s = G d/(8 C^3 n) for n active coils.
    """
    k1, k3, stroke = (np.asarray(value, dtype=float) for value in (k1, k3, stroke))
    length = np.asarray(stroke / MOST_SPRING_STROKE if room is None else np.full(stroke.shape, room))
    pretension = 0.5 * k1 * length
    stiffness = k3 * length**2 + 0.5 * k1
    free = length - pretension / np.maximum(stiffness, 1e-300)
    extension = np.hypot(length, stroke) - length
    force = stiffness * extension + pretension
    wire = np.sqrt(8 * force * SPRING_INDEX * _WAHL / (math.pi * (ALLOWED_SHEAR if stress is None else stress)))
    coils = SHEAR_MODULUS * wire / (8 * SPRING_INDEX**3 * np.maximum(stiffness, 1e-300))
    return CoilSprings(length, free, stiffness, extension, pretension, force, wire, coils, (coils + _END_COILS) * wire)
