"""Coil springs across the motion: how large they must be for a force and a stress (textbook formulas, secondary)."""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from frahm.arrays import Floats

SHEAR_MODULUS = 7.9e10  # of spring steel [Pa]
SPRING_INDEX, LEAST_INDEX = 8.0, 4.0  # mean over wire diameter [-]: usual, and the smallest that is wound
ALLOWED_SHEAR = 4.0e8  # [Pa]
MOST_SPRING_STROKE = 0.25  # of the free length: transverse springs are cubic within 4.5 % up to there
LEAST_COILS = 3.0  # active ones; with fewer the ends decide about the stiffness
_WIRES = (1e-4, 0.1)  # diameters spring wire is drawn and bars are coiled in [m]
_END_COILS = 2.0
_ROUNDS = 15  # of the index, each a twentieth of the error of the last
_ROUNDING = 1e-9


class CoilSprings(NamedTuple):
    """Each of two springs of length L across the motion; arrays of one shape, SI units.

    Attributes
    ----------
    length, free, stiffness, extension, pretension, force : ndarray
        L in the middle and without tension [m], k_s [N/m], extension by the stroke [m], tension in the middle and at
        the stroke [N].
    spring_index, wire, coils, solid : ndarray
        C, mean diameter over that of the wire [-], diameter of the wire [m], active coils [-], and length with all
        coils touching [m].
    """

    length: Floats
    free: Floats
    stiffness: Floats
    extension: Floats
    pretension: Floats
    force: Floats
    spring_index: Floats
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
        Shear stress at the stroke [Pa], 400 MPa by default: tau = 8 F C K/(pi d^2) with Wahl's factor K, and
        k_s = G d/(8 C^3 n) for n active coils. The spring index C is 8, and down to 4 where 8 leaves fewer than three
        active coils.
    """
    k1, k3, stroke = (np.asarray(value, dtype=float) for value in (k1, k3, stroke))
    length = np.asarray(stroke / MOST_SPRING_STROKE if room is None else np.full(stroke.shape, room))
    pretension = 0.5 * k1 * length
    stiffness = k3 * length**2 + 0.5 * k1
    free = length - pretension / np.maximum(stiffness, 1e-300)
    extension = np.hypot(length, stroke) - length
    force = stiffness * extension + pretension
    bare = np.sqrt(8 * force / (math.pi * (ALLOWED_SHEAR if stress is None else stress)))  # wire over sqrt(C K)
    softness = SHEAR_MODULUS * bare / (8 * np.maximum(stiffness, 1e-300))  # coils over sqrt(C K)/C^3
    index = _index(softness)
    wire = bare * np.sqrt(index * wahl_factor(index))
    coils = softness * np.sqrt(index * wahl_factor(index)) / index**3
    solid = (coils + _END_COILS) * wire
    return CoilSprings(length, free, stiffness, extension, pretension, force, index, wire, coils, solid)


def wahl_factor(index: ArrayLike) -> Floats:
    """Wahl's factor K = (4 C - 1)/(4 C - 4) + 0.615/C on the shear stress of a coil spring of index C [-]."""
    C = np.asarray(index, dtype=float)
    return (4 * C - 1) / (4 * C - 4) + 0.615 / C


def _index(softness: Floats) -> Floats:
    """Largest index up to 8 that leaves three active coils, n = softness sqrt(K) C^-5/2; at least 4."""
    C = np.full(np.shape(softness), SPRING_INDEX)
    for _ in range(_ROUNDS):
        C = np.clip((softness * np.sqrt(wahl_factor(C)) / LEAST_COILS) ** 0.4, LEAST_INDEX, SPRING_INDEX)
    return C


def why_not_wound(springs: CoilSprings) -> str | None:
    """Why nobody can wind one coil spring of these sizes, as a sentence; None if it can be wound.

    Parameters
    ----------
    springs : CoilSprings
        Of one design: every array of shape ().
    """
    coils, index, wire, free = (float(v) for v in (springs.coils, springs.spring_index, springs.wire, springs.free))
    if coils < LEAST_COILS * (1 - _ROUNDING):
        return f"it would have {coils:.2g} active coils even at a spring index of {index:g}, and needs {LEAST_COILS:g}"
    if not _WIRES[0] <= wire <= _WIRES[1]:
        least, most = (1e3 * limit for limit in _WIRES)
        return f"its wire would be {1e3 * wire:.2g} mm thick, and spring wire is {least:g} mm to {most:g} mm"
    if springs.solid >= free:
        share = float(springs.solid) / free
        return (
            f"with all coils touching it is {share:.3g} times as long as free, {free:.3g} m, at an index of {index:g}"
        )
    if (index + 1) * wire >= free:
        return f"it would be wider, {(index + 1) * wire:.3g} m, than its free length of {free:.3g} m"
    return None
