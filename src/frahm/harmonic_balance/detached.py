"""Births and merges of detached response curves: where a parameter is extreme along a curve of saddle-nodes."""

from __future__ import annotations

import itertools
from dataclasses import dataclass

import numpy as np

from frahm.arrays import Complexes, Floats
from frahm.continuation import CurvePoint, between_points
from frahm.harmonic_balance.condensation import CondensedSystem
from frahm.harmonic_balance.equations import Equations, Linearisation
from frahm.harmonic_balance.found import Found
from frahm.harmonic_balance.loci import loci_with_frequency, orbit_peaks
from frahm.systems import System

_LOCATED = 1e-9  # along a curve, in scaled unknowns: where the parameter is extreme
_NULL = 1e-10  # singular values below this share of the largest are those of the null direction
_SAME = 1e-5  # relative difference below which two events are one


@dataclass(frozen=True)
class DetachedCurveEvent:
    """A detached response curve is born, or merges with another one, as a parameter passes a value.

    Attributes
    ----------
    kind : str
        "birth": the curve appears out of a point; "merge": it touches another curve.
    parameter : str
        Name of the parameter.
    value, frequency : float
        Value of the parameter and Omega [rad/s] at the event.
    pipe_peak, relative_peak : float
        Peaks of the response there [m].
    direction : int
        +1 if the pair of saddle-nodes that meets here exists above the value, -1 if below.
    """

    kind: str
    parameter: str
    value: float
    frequency: float
    pipe_peak: float
    relative_peak: float
    direction: int


def detached_events(
    system: System, parameter: str, window: tuple[float, float], bounds: tuple[float, float], slices: int
) -> Found[DetachedCurveEvent]:
    """Births and merges of detached curves: extremes of the parameter along its saddle-node curves."""
    doubts: list[str] = []
    _, traces = loci_with_frequency(system, "saddle-node", parameter, window, bounds, slices, False, doubts)
    events: list[DetachedCurveEvent] = []
    for equations, points in traces:
        at = equations.n + 1
        for a, b in itertools.pairwise(points):
            cusp = a.tangent[at - 1] * b.tangent[at - 1] < 0  # both axes turn back: two saddle-nodes meet on one curve
            if a.tangent[at] * b.tangent[at] >= 0 or a.tangent @ b.tangent < 0 or cusp:
                continue
            point = between_points(equations.residual, a, b, lambda p, at=at: float(p.tangent[at]), _LOCATED)  # type: ignore[misc]
            if point is None:
                continue
            event = _event(equations, point, parameter, 1 if a.tangent[at] < 0 else -1)
            inside = bounds[0] <= event.value <= bounds[1] and window[0] <= event.frequency <= window[1]
            if inside and not any(_same_event(event, other) for other in events):
                events.append(event)
    searched = (
        f"Between {window[0]:.6g} and {window[1]:.6g} rad/s, {parameter} between {bounds[0]:.6g} and {bounds[1]:.6g},"
        f" along the saddle-nodes met at {slices} values of {parameter}; nothing beyond."
    )
    return Found(sorted(events, key=lambda event: event.value), searched, tuple(doubts))


def _event(equations: Equations, point: CurvePoint, parameter: str, direction: int) -> DetachedCurveEvent:
    orbit = equations.orbit(point.y)
    definite = _quadratic_form(equations, orbit) > 0
    pipe, relative = orbit_peaks(equations, point.y)
    return DetachedCurveEvent(
        "birth" if definite else "merge",
        parameter,
        equations.axis_values(point.y)[1],
        equations.frequency_at(point.y),
        pipe,
        relative,
        direction,
    )


def _quadratic_form(equations: Equations, orbit: Linearisation) -> float:
    """Determinant of the second-order form on the two directions in which the equations are singular.

    Where the parameter is extreme along a saddle-node curve, (X, Omega) has two null directions; the solutions nearby
    are the zeros of a quadratic form in them: an ellipse if it is definite (a closed curve is born), else a crossing.
    """
    left, _, right = np.linalg.svd(orbit.J)
    v, w = np.asarray(right[-1], dtype=float), np.asarray(left[:, -1], dtype=float)
    by_frequency = orbit.changes[0]
    u = np.asarray(np.linalg.lstsq(orbit.J, -by_frequency.rate, rcond=_NULL)[0], dtype=float)
    Kv, Ku = orbit.curvature_matrix(v), orbit.curvature_matrix(u)
    vv = w @ (Kv @ v)
    vu = w @ (Kv @ u + by_frequency.applied(orbit, v))
    uu = w @ (Ku @ u + 2 * by_frequency.applied(orbit, u) + _second_by_frequency(equations, orbit))
    return float(vv * uu - vu * vu)


def _second_by_frequency(equations: Equations, orbit: Linearisation) -> Floats:
    """Second derivative (n,) of the residual by Omega."""
    r = orbit.problem.M11.shape[0]
    out = np.zeros(equations.n)
    for m, k in enumerate(equations.harmonics):
        u = orbit.X[2 * r * m : 2 * r * (m + 1)].reshape(r, 2) @ np.array([1, 1j])
        S2, F2 = _second_derivatives(orbit.problem, 1j * k * orbit.W)
        value = (1j * k) ** 2 * (S2 @ u - (F2 if k == 1 else 0))
        out[2 * r * m : 2 * r * (m + 1)] = np.column_stack([value.real, value.imag]).ravel()
    if orbit.problem.rates:
        out += equations.projected(orbit.problem, orbit.derivatives[3] * (orbit.w / orbit.W) ** 2)
    return out


def _second_derivatives(pb: CondensedSystem, s: complex) -> tuple[Complexes, Complexes]:
    """d2S/ds2 (r, r) and d2F/ds2 (r,) of the condensed stiffness and force."""
    g = 1.0 / (s - pb.poles)
    a, da, dda = s * s * pb.a2 + s * pb.a1 + pb.a0, 2 * s * pb.a2 + pb.a1, 2 * pb.a2
    b, db, ddb = s * s * pb.b2 + s * pb.b1 + pb.b0, 2 * s * pb.b2 + pb.b1, 2 * pb.b2

    def summed(f: Complexes, df: Complexes, ddf: Complexes) -> Complexes:
        shape = (-1,) + (1,) * (f.ndim - 1)
        h = g.reshape(shape)
        return np.asarray(np.sum(ddf * h - 2 * df * h**2 + 2 * f * h**3, axis=0))

    def outer(p: Complexes, q: Complexes) -> Complexes:
        return np.asarray(p[:, :, None] * q[:, None, :])

    f = outer(a, b)
    df = outer(da, b) + outer(a, db)
    ddf = outer(dda, b) + 2 * outer(da, db) + outer(a, ddb)
    drive = pb.force_y[:, None]
    return 2 * pb.M11 - summed(f, df, ddf), -summed(a * drive, da * drive, dda * drive)


def _same_event(a: DetachedCurveEvent, b: DetachedCurveEvent) -> bool:
    return abs(a.value - b.value) < _SAME * abs(a.value) and abs(a.frequency - b.frequency) < _SAME * a.frequency
