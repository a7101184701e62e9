"""Curves of saddle-node and Neimark-Sacker points in two parameters.

Bifurcation tracking in harmonic balance: Detroux et al. (2015), doi 10.1016/j.cma.2015.07.017.
"""

from __future__ import annotations

import itertools
import math
from dataclasses import dataclass
from typing import Any

import numpy as np

from frahm.arrays import Floats
from frahm.continuation import ContinuationSettings, CurvePoint, between_points, follow_curve, newton
from frahm.errors import Outcome
from frahm.harmonic_balance.bifurcations import COMPLEX
from frahm.harmonic_balance.branch import Bifurcation, Point, SolutionBranch, located
from frahm.harmonic_balance.branches import find_branches
from frahm.harmonic_balance.condensation import condense, unknowns
from frahm.harmonic_balance.equations import FREQUENCY, Equations
from frahm.harmonic_balance.floquet import map_multipliers
from frahm.harmonic_balance.fold_equations import FoldEquations
from frahm.harmonic_balance.kernels import harmonics_of
from frahm.harmonic_balance.orbits import output_series, peak_of
from frahm.harmonic_balance.search import Search, search_over
from frahm.harmonic_balance.torus_equations import TorusEquations
from frahm.systems import System, parameter_value, with_parameters

_SETTINGS = ContinuationSettings(first_step=5e-3, longest_step=0.06, angle=0.2, tolerance=1e-9, most_points=1500)
_MOST_HARMONICS = 61
_GOAL = 1e-6
_RESIDUAL, _MOST_STEPS = 1e-9, 12  # of Newton's method, in scaled unknowns
_EDGE = 1e-9  # a point this far beyond the bounds lies on them
_RETURN = 0.5  # cosine of the angle by which a curve in its plane turns back at a cusp
_TURN = 0.5  # change of a multiplier's argument from point to point [rad], above which it has wrapped around
_ON_SLICE = (0.3, 2e-3, 0.05)  # one point on a slice: of the step and of the window in frequency, of the peak
_SAME_PLACE, _SAME_HEIGHT = 0.05, 0.1  # same curve: distance of its middle in units of the bounds, and of its peak
_AT = 1e-10  # along a curve, in scaled unknowns: where it is cut at a frequency


@dataclass(frozen=True)
class Locus:
    """One connected curve of special points.

    Attributes
    ----------
    kind : str
        "saddle-node" or "neimark-sacker".
    values : ndarray, shape (points, 2)
        Both axes.
    frequency, pipe_peak, relative_peak : ndarray, shape (points,)
        Omega [rad/s] and the peaks of the orbit [m].
    marks : tuple of (index, str)
        Points of codimension two on the curve: "cusp", "1:1 resonance", "1:2 resonance".
    outcomes : tuple of Outcome
        How both ends ended.
    symmetric : bool
        Whether the orbits repeat themselves mirrored after half a period.
    """

    kind: str
    values: Floats
    frequency: Floats
    pipe_peak: Floats
    relative_peak: Floats
    marks: tuple[tuple[int, str], ...]
    outcomes: tuple[Outcome, ...]
    symmetric: bool


@dataclass(frozen=True)
class _Start:
    """A located special point: its slice, its orbit and the branches' scales."""

    search: Search
    branch: SolutionBranch
    event: Bifurcation
    point: Point
    slice_value: float


def loci_with_frequency(
    system: System,
    kind: str,
    parameter: str,
    window: tuple[float, float],
    bounds: tuple[float, float],
    slices: int,
    asymmetric: bool = True,
    doubts: list[str] | None = None,
) -> tuple[list[Locus], list[tuple[Equations, list[CurvePoint]]]]:
    """Curves of one kind in the plane (Omega, parameter): those that cross one of several slices of the plane.

    Every slice is the complete response curve at one value of the parameter; all its special points of that kind are
    followed in both directions to the edge of the plane. A slice whose search met its limit of work, and a curve that
    was not followed to its end for want of it, adds a sentence to `doubts`.
    """
    doubts = [] if doubts is None else doubts
    loci: list[Locus] = []
    traces: list[tuple[Equations, list[CurvePoint]]] = []
    for value in _slice_values(system, parameter, bounds, slices):
        for start in _starts(system, kind, parameter, window, value, asymmetric, doubts):
            frequency, peak = float(start.event.columns[0]), float(start.event.columns[4])
            alike = [locus for locus in loci if locus.symmetric == start.branch.odd]
            if any(_lies_on(locus, frequency, value, peak, window) for locus in alike):
                continue
            found = _follow(system, start, kind, (FREQUENCY, parameter), (window, bounds), frequency)
            if found is not None:
                loci.append(found[0])
                traces.append(found[1])
                if Outcome.STEP_LIMIT in found[0].outcomes:
                    doubts.append(f"A curve of {kind} points from {frequency:.6g} rad/s was not followed to its end.")
    return loci, traces


def loci_at_frequency(
    system: System,
    kind: str,
    plane: tuple[str, str],
    bounds: tuple[tuple[float, float], tuple[float, float]],
    frequency: float,
    slices: int,
    doubts: list[str] | None = None,
) -> list[Locus]:
    """Curves of one kind in a plane of two parameters at fixed Omega.

    They start where curves in the plane (Omega, first axis), followed at spread values of the second axis, cross the
    frequency.
    """
    window = (0.85 * frequency, 1.15 * frequency)
    loci: list[Locus] = []
    for value in _slice_values(system, plane[1], bounds[1], slices):
        changed = with_parameters(system, **{plane[1]: value})
        _, traces = loci_with_frequency(changed, kind, plane[0], window, bounds[0], 3, doubts=doubts)
        for equations, points in traces:
            for start in _at_frequency(equations, points, frequency):
                found = _from_point(changed, equations, start, kind, plane, bounds, frequency, value)
                if found is not None and not any(_same_curve(found, other, bounds) for other in loci):
                    loci.append(found)
    return loci


def _slice_values(system: System, parameter: str, bounds: tuple[float, float], slices: int) -> Floats:
    lo, hi = bounds
    values = np.geomspace(lo, hi, slices) if lo > 0 and hi / lo > 20 else np.linspace(lo, hi, slices)
    now = parameter_value(system, parameter)
    return np.unique(np.append(values[values > 0], [now] if lo <= now <= hi else []))


def _starts(
    system: System, kind: str, parameter: str, window: tuple[float, float], value: float, asymmetric: bool,
    doubts: list[str],
) -> list[_Start]:  # fmt: skip
    search = search_over(with_parameters(system, **{parameter: float(value)}), *window, None)
    starts = []
    branches = find_branches(search, asymmetric)
    doubts += [f"At {parameter} {value:.6g}: {sentence}" for sentence in search.budget.sentences()]
    for branch in branches:
        for event, point in located(branch.bifurcations, kind):
            starts.append(_Start(search, branch, event, point, float(value)))
    return starts


def _follow(
    system: System,
    start: _Start,
    kind: str,
    axes: tuple[str, str],
    bounds: tuple[tuple[float, float], tuple[float, float]],
    frequency: float,
) -> tuple[Locus, tuple[Equations, list[CurvePoint]]] | None:
    """Follow a curve from a located point in both directions, with more harmonics if it needs them."""
    pb, odd = start.search.problem, start.branch.odd
    y, H0 = start.point.y, start.point.H
    n0, H = unknowns(pb, H0, odd), H0 + 4
    scales = bounds[0][1] - bounds[0][0], bounds[1][1] - bounds[1][0]
    while True:
        first = np.append(np.zeros(unknowns(pb, H, odd)), [y[n0], start.slice_value] / np.array(scales))
        first[:n0] = y[:n0] / start.search.x_scale
        if kind != "saddle-node":
            first = np.append(first, _angular_rate(start) / frequency)
        equations = _equations(kind, system, axes, frequency, H, odd, start.search.x_scale, scales, first)
        found = None if equations is None else _both_ways(equations, bounds)
        if equations is None or found is None:
            return None
        points, outcomes = found
        worst = max(equations.orbit(p.y).truncation for p in points[:: max(1, len(points) // 12)])
        if worst < _GOAL or H + 8 > _MOST_HARMONICS:
            return _locus(equations, points, kind, outcomes), (equations, points)
        H += 8


def _equations(kind: str, *given: Any) -> Equations | None:
    """Defining equations of a kind of points; None where the matrix at their start cannot be decomposed."""
    try:
        return FoldEquations(*given) if kind == "saddle-node" else TorusEquations(*given)
    except np.linalg.LinAlgError:
        return None


def _both_ways(
    equations: Equations, bounds: tuple[tuple[float, float], tuple[float, float]]
) -> tuple[list[CurvePoint], tuple[Outcome, ...]] | None:
    """Follow the curve from the start of its equations in both directions."""
    n, first = equations.n, equations.start

    def inside(y: Floats) -> bool:
        values = equations.axis_values(y)
        return all(lo - _EDGE <= value <= hi + _EDGE for value, (lo, hi) in zip(values, bounds, strict=True))

    guide = np.zeros(first.size)
    guide[n + 1] = 1.0
    settled = newton(equations.residual, first, guide, _RESIDUAL, _MOST_STEPS)
    if settled is None:
        guide[n], guide[n + 1] = 1.0, 0.0
        settled = newton(equations.residual, first, guide, _RESIDUAL, _MOST_STEPS)
    if settled is None:
        return None
    parts, outcomes = [], []
    for sign in (1.0, -1.0):
        part: list[CurvePoint] = []
        for item in follow_curve(equations.residual, settled.y, sign * settled.tangent, inside, _SETTINGS):
            if isinstance(item, Outcome):
                outcomes.append(item)
            else:
                part.append(item)
        parts.append(part)
        if outcomes[-1] is Outcome.CLOSED:
            return part, tuple(outcomes)
    forward, backward = (_before_mirror(equations, part) for part in parts)
    points = [CurvePoint(p.y, -p.tangent) for p in backward[:0:-1]] + forward
    return (points, tuple(outcomes)) if len(points) > 2 else None


def _before_mirror(equations: Equations, points: list[CurvePoint]) -> list[CurvePoint]:
    """Points of asymmetric orbits up to where they pass through a symmetric one into their mirror images."""
    if equations.odd or not equations.problem.odd:
        return points
    r = equations.problem.M11.shape[0]
    even = [p.y[: equations.n].reshape(-1, 2 * r)[::2].ravel() for p in points]
    for i in range(1, len(points)):
        if even[i - 1] @ even[i] < 0:
            return points[:i]
    return points


def _angular_rate(start: _Start) -> float:
    """Imaginary part nu [rad/s] of the critical exponent at a Neimark-Sacker point."""
    pb, odd = start.search.problem, start.branch.odd
    y, H = start.point.y, start.point.H
    W = y[unknowns(pb, H, odd)]
    u = np.empty((H + 5, pb.M11.shape[0]), complex)
    harmonics_of(pb, H, odd, y, u)
    values = np.empty(2 * start.search.variation.K.shape[0], complex)
    map_multipliers(pb, start.search.variation, H, odd, W, u, values)
    pairs = values[values.imag > COMPLEX]
    critical = pairs[np.argmin(np.abs(np.log(np.abs(pairs))))]
    return float(np.angle(critical) * W / (math.pi if odd else 2 * math.pi))


def _locus(equations: Equations, points: list[CurvePoint], kind: str, outcomes: tuple[Outcome, ...]) -> Locus:
    values = np.array([equations.axis_values(p.y) for p in points])
    described = np.array([orbit_peaks(equations, p.y) for p in points])
    frequency = np.array([equations.frequency_at(p.y) for p in points])
    marks = _marks(equations, points, kind)
    return Locus(kind, values, frequency, described[:, 0], described[:, 1], marks, outcomes, equations.odd)


def _marks(equations: Equations, points: list[CurvePoint], kind: str) -> tuple[tuple[int, str], ...]:
    """Points of codimension two: cusps of saddle-node curves, strong resonances that end Neimark-Sacker curves."""
    n = equations.n
    marks = []
    if kind == "saddle-node":
        plane = np.array([p.tangent[n : n + 2] for p in points])
        size = np.linalg.norm(plane, axis=1)
        for i in range(1, len(points)):
            if plane[i - 1] @ plane[i] < -_RETURN * size[i - 1] * size[i]:  # the curve turns back on itself
                marks.append((i, "cusp"))
        return tuple(marks)
    angle = np.array([p.y[n + 2] * equations.frequency / equations.frequency_at(p.y) for p in points])
    turn = math.pi * angle * (1 if equations.odd else 2)  # argument of the multiplier of the (half) map
    for i in range(1, len(points)):
        for target, name in ((0.0, "1:1 resonance"), (math.pi, "1:2 resonance")):
            if (turn[i - 1] - target) * (turn[i] - target) < 0 and abs(turn[i] - turn[i - 1]) < _TURN:
                marks.append((i, name))
    return tuple(marks)


def orbit_peaks(equations: Equations, y: Floats) -> tuple[float, float]:
    """max |x| and max |z| [m] of the orbit at a scaled point."""
    X, W, H, odd = y[: equations.n] * equations.x_scale, equations.frequency_at(y), equations.H, equations.odd
    pb = condense(equations.system_at(y))
    u = np.empty((H + 5, pb.M11.shape[0]), complex)
    harmonics_of(pb, H, odd, np.ascontiguousarray(X), u)
    x = np.empty(H + 1, complex)
    peaks = []
    for row in range(2):
        output_series(pb, H, odd, W, u, row, x)
        peaks.append(float(peak_of(x, H, odd)))
    return peaks[0], peaks[1]


def _lies_on(locus: Locus, frequency: float, value: float, peak: float, window: tuple[float, float]) -> bool:
    """Whether a special point on a slice belongs to a curve already followed."""
    p, W = locus.values[:, 1], locus.frequency
    for i in np.flatnonzero((p[:-1] - value) * (p[1:] - value) <= 0):
        f = 0.5 if p[i] == p[i + 1] else (value - p[i]) / (p[i + 1] - p[i])
        near = W[i] + f * (W[i + 1] - W[i])
        height = locus.relative_peak[i] + f * (locus.relative_peak[i + 1] - locus.relative_peak[i])
        leap = abs(W[i + 1] - W[i])
        of_step, of_window, of_peak = _ON_SLICE
        close = abs(near - frequency) < of_step * leap + of_window * (window[1] - window[0])
        if close and abs(height - peak) < of_peak * peak:
            return True
    return False


def _at_frequency(equations: Equations, points: list[CurvePoint], frequency: float) -> list[CurvePoint]:
    """Points of a curve in the plane (Omega, parameter) at one frequency."""
    scaled = frequency / equations.scales[0]
    found = []
    for a, b in itertools.pairwise(points):
        if (a.y[equations.n] - scaled) * (b.y[equations.n] - scaled) <= 0:
            point = between_points(equations.residual, a, b, lambda p: float(p.y[equations.n] - scaled), _AT)
            if point is not None:
                found.append(point)
    return found


def _from_point(
    system: System,
    given: Equations,
    point: CurvePoint,
    kind: str,
    plane: tuple[str, str],
    bounds: tuple[tuple[float, float], tuple[float, float]],
    frequency: float,
    value: float,
) -> Locus | None:
    """Follow a curve in a plane without the frequency from a point of a curve in a plane with it."""
    scales = bounds[0][1] - bounds[0][0], bounds[1][1] - bounds[1][0]
    first = point.y.copy()
    first[given.n] = given.axis_values(point.y)[1] / scales[0]
    first[given.n + 1] = value / scales[1]
    if kind != "saddle-node":
        first[-1] = point.y[-1] * given.frequency / frequency
    equations = _equations(kind, system, plane, frequency, given.H, given.odd, given.x_scale, scales, first)
    found = None if equations is None else _both_ways(equations, bounds)
    return None if equations is None or found is None else _locus(equations, found[0], kind, found[1])


def _same_curve(a: Locus, b: Locus, bounds: tuple[tuple[float, float], tuple[float, float]]) -> bool:
    """Whether the middle of one curve lies on the other."""
    scales = np.array([hi - lo for lo, hi in bounds])
    middle = a.values[len(a.values) // 2] / scales
    distance = np.linalg.norm(b.values / scales - middle, axis=1)
    i = int(np.argmin(distance))
    same_height = abs(b.relative_peak[i] - a.relative_peak[len(a.values) // 2]) < _SAME_HEIGHT * b.relative_peak[i]
    return bool(distance[i] < _SAME_PLACE and same_height)
