"""Stability boundaries: saddle-node and Hopf points as curves in a plane of two parameters."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from frahm.arrays import Floats
from frahm.compiled import kernel
from frahm.continuation import bisected, zero_curves
from frahm.errors import ParameterError, check_number, nearest
from frahm.slow_flow.folds import double_root
from frahm.slow_flow.kernels import characteristic, equilibria, hurwitz, linear_parts, pipe_amplitude
from frahm.slow_flow.model import SlowFlow
from frahm.tolerances import TINY

AXES = {"detuning": "rad/s", "kappa": "1/(m^2 s^2)", "xi2": "1/s", "rho2": "1", "force": "1"}
_ROUNDING = 1e-13
_LOADS = ("kappa", "force")
_LOWEST = {"kappa": 0.0, "xi2": 0.0, "rho2": 0.0, "force": 0.0}


@dataclass(frozen=True)
class BoundaryCurve:
    """One connected boundary: kind, both plane coordinates, and the amplitudes [m] along it."""

    kind: str
    x: Floats
    y: Floats
    pipe_amplitude: Floats
    relative_amplitude: Floats


@kernel
def _tests_at_n(form, omega, xi1, k1, W, xi2, rho2, m, saddle, hopf, third):
    """delta_4, Hurwitz determinant and delta_3 where n = m |d0|/|s0|; flat arrays."""
    for i in range(W.size):
        d2, d1, d0, s1, s0, _, _ = linear_parts(form, W[i], omega, xi1, xi2[i], k1, rho2[i])
        n = m[i] * abs(d0) / abs(s0)
        c1, c2, c3, c4 = characteristic(d2, d1, d0, s1, s0, n)
        saddle[i], hopf[i], third[i] = c4, hurwitz(c1, c2, c3, c4), c3


@kernel
def _loads_at_n(form, omega, xi1, k1, W, xi2, rho2, m, load, X, Z2):
    """kappa F^2, and |X|^2 and |Z|^2 times kappa, where n = m |d0|/|s0|; no load where n only frees the motion."""
    for i in range(W.size):
        _, _, d0, _, s0, e, g2 = linear_parts(form, W[i], omega, xi1, xi2[i], k1, rho2[i])
        n = m[i] * abs(d0) / abs(s0)
        force = abs(d0 + n * s0)
        load[i] = n * force**2 / (0.75 * e * e) if force > _ROUNDING * (abs(d0) + n * abs(s0)) else 0.0
        Z2[i] = n / 0.75
        X[i] = pipe_amplitude(Z2[i], n, e, g2) ** 2


@kernel
def _tests_on_roots(form, omega, xi1, k1, W, xi2, rho2, F, kappa, double, saddle, hopf, third, X, Z):
    """Discriminant of the cubic, product of the Hurwitz determinants over its roots, and the amplitudes of one root.

    That root is the double one if `double`, as at a saddle-node, and otherwise the one closest to a Hopf point.
    """
    for i in range(W.size):
        d2, d1, d0, s1, s0, e, g2 = linear_parts(form, W[i], omega, xi1, xi2[i], k1, rho2[i])
        absd, abss = abs(d0), abs(s0)
        c = (d0.real * s0.real + d0.imag * s0.imag) / (absd * abss)
        h = 0.75 * kappa[i] * (e * F[i]) ** 2 * abss / absd**3
        saddle[i] = 4.0 * c * c - 4.0 + h * (32.0 * c * c * c - 36.0 * c - 27.0 * h)
        count, N1, N2, N3 = equilibria(d0, s0, e, F[i], kappa[i])
        product, closest = 1.0, math.inf
        for j in range(count):
            N = N1 if j == 0 else (N2 if j == 1 else N3)
            n = 0.75 * kappa[i] * N
            c1, c2, c3, c4 = characteristic(d2, d1, d0, s1, s0, n)
            value = hurwitz(c1, c2, c3, c4) / (abs(c3 * c1 * c2) + c3 * c3 + c1 * c1 * abs(c4))
            product *= value
            if abs(value) < closest and not double:
                closest = abs(value)
                third[i], Z[i], X[i] = c3, math.sqrt(N), pipe_amplitude(N, n, e, g2)
        hopf[i] = product
        if double:
            n = double_root(c, h) * absd / abss
            N = n / (0.75 * kappa[i])
            third[i], Z[i], X[i] = 1.0, math.sqrt(N), pipe_amplitude(N, n, e, g2)


def boundary_curves(
    slow: SlowFlow,
    plane: tuple[str, str],
    bounds: tuple[tuple[float, float], tuple[float, float]],
    detuning: float,
    resolution: int,
) -> list[BoundaryCurve]:
    """All saddle-node and Hopf boundaries in a rectangle of a parameter plane.

    Where one axis is kappa or the force, the boundary is followed in (other axis, n), in which neither occurs: only
    kappa F^2 enters the theory. Otherwise the discriminant of the cubic and the Hurwitz determinant are contoured in
    the plane itself. Vertices satisfy their function to rounding in both cases.
    """
    _check_plane(slow, plane, bounds)
    at = _At(slow, detuning)
    loads = [axis for axis in plane if axis in _LOADS]
    if loads:
        return _along_load(at, plane, bounds, loads[-1], resolution)
    return _in_plane(at, plane, bounds, resolution)


def _check_plane(slow: SlowFlow, plane: tuple[str, str], bounds: tuple[tuple[float, float], ...]) -> None:
    allowed = "two different names out of " + ", ".join(AXES)
    for name, given in (("plane", plane), ("bounds", bounds)):
        if not isinstance(given, tuple | list):
            raise ParameterError(name, given, allowed if name == "plane" else "((lo, hi), (lo, hi))")
    unknown = [str(axis) for axis in plane if axis not in AXES]
    if len(set(plane)) != 2:
        raise ParameterError("plane", plane, allowed)
    for axis in unknown:
        near = nearest(axis, AXES)
        raise ParameterError("plane", axis, allowed, hint=f"Did you mean {near!r}?" if near else None)
    if len(bounds) != 2 or any(np.shape(pair) != (2,) for pair in bounds):
        raise ParameterError("bounds", bounds, "((lo, hi), (lo, hi)), one pair for each axis of the plane")
    for axis, (lo, hi) in zip(plane, bounds, strict=True):
        above = slow.limits[0] - slow.omega if axis == "detuning" else -math.inf
        at_least = _LOWEST.get(axis, -math.inf)
        check_number(f"bounds of {axis}", lo, above=above, at_least=at_least, unit=AXES[axis])
        check_number(f"bounds of {axis}", hi, above=lo, unit=AXES[axis])
    if slow.force == 0 or (slow.kappa <= 0 and "kappa" not in plane):
        raise ParameterError("case", "no force or no hardening spring", "a force and a positive cubic stiffness")


@dataclass(frozen=True)
class _At:
    """The slow flow and the detuning at which the axes that are not in the plane are held."""

    slow: SlowFlow
    detuning: float

    @property
    def head(self) -> tuple[int, float, float, float]:
        """First arguments of the kernels: form, omega, xi1, linear spring (none)."""
        return self.slow.code, self.slow.omega, self.slow.xi1, 0.0

    def values(self, **given: Floats) -> dict[str, Floats]:
        """Flat arrays of Omega and of every axis; `force` is a factor."""
        shape = np.shape(next(iter(given.values())))
        s = self.slow
        fixed = {"detuning": self.detuning, "kappa": s.kappa, "xi2": s.xi2, "rho2": s.rho2, "force": 1.0}
        v = {name: np.ravel(np.asarray(given.get(name, np.full(shape, fixed[name])), dtype=float)) for name in AXES}
        return v | {"frequency": s.omega + v["detuning"]}


def _along_load(
    at: _At, plane: tuple[str, str], bounds: tuple[tuple[float, float], ...], load: str, resolution: int
) -> list[BoundaryCurve]:
    other = plane[0] if plane[1] == load else plane[1]
    limits = dict(zip(plane, bounds, strict=True))
    grid = np.linspace(*_open(limits[other]), resolution)
    curves = []
    for kind in ("saddle-node", "hopf"):
        test = _load_test(at, other, kind)
        for line in zero_curves(test, grid, np.linspace(-7.0, 7.0, resolution)):
            dense = _between_bounds(test, lambda part: _load_along(at, load, other, part)[0], line, limits[load])
            for part in dense:
                curves += _mapped(at, plane, load, other, kind, part)
    return curves


def _load_test(at: _At, other: str, kind: str) -> Callable[[Floats, Floats], Floats]:
    def test(q: Floats, log_m: Floats) -> Floats:
        v = at.values(**{other: q})
        saddle, hopf, third = (np.empty(v[other].size) for _ in range(3))
        arguments = (v["frequency"], v["xi2"], v["rho2"], np.exp(np.ravel(log_m)))
        _tests_at_n(*at.head, *arguments, saddle, hopf, third)
        chosen = saddle if kind == "saddle-node" else hopf
        return chosen.reshape(np.shape(q))

    return test


def _load_along(at: _At, load: str, other: str, line: Floats) -> tuple[Floats, ...]:
    """Value of the load axis, delta_3, |X| and |Z| [m] along a curve in (other axis, log m); infinite without load."""
    v = at.values(**{other: line[:, 0]})
    arguments = (v["frequency"], v["xi2"], v["rho2"], np.exp(line[:, 1]))
    saddle, hopf, third, load2, X2, Z2 = (np.empty(len(line)) for _ in range(6))
    _tests_at_n(*at.head, *arguments, saddle, hopf, third)
    _loads_at_n(*at.head, *arguments, load2, X2, Z2)
    kappa = load2 / (v["force"] * at.slow.force) ** 2 if load == "kappa" else v["kappa"]
    value = kappa if load == "kappa" else np.sqrt(load2 / kappa) / at.slow.force
    with np.errstate(divide="ignore"):
        return value, third, np.sqrt(X2 / kappa), np.sqrt(Z2 / kappa)


def _mapped(at: _At, plane: tuple[str, str], load: str, other: str, kind: str, line: Floats) -> list[BoundaryCurve]:
    """Carry a curve from (other axis, log m) to the plane and cut away what is no Hopf point."""
    value, third, X, Z = _load_along(at, load, other, line)
    coordinates = {other: line[:, 0], load: value}
    # Without any damping the free motion is a curve of saddle-nodes that no load reaches.
    keep = ((third > 0) | (kind == "saddle-node")) & (value > 0)
    return _runs(kind, keep, coordinates[plane[0]], coordinates[plane[1]], X, Z)


def _between_bounds(
    test: Callable[[Floats, Floats], Floats],
    load: Callable[[Floats], Floats],
    line: Floats,
    bounds: tuple[float, float],
) -> list[Floats]:
    """The stretches of a zero curve on which the load lies within its bounds, ended exactly on them.

    Vertices are added so that the load changes by at most a hundredth of the range from one to the next.
    """
    lo, hi = bounds
    value = load(line)
    inside = np.clip(value, lo, hi)
    parts = np.ceil(np.abs(np.diff(inside)) / (0.01 * (hi - lo))).astype(int).clip(1, 400)
    index = np.repeat(np.arange(len(parts)), parts)
    # fractions aim at equal steps of the load inside the bounds, if the load were linear along the segment
    step = np.concatenate([np.arange(count) / count for count in parts])
    change = value[index + 1] - value[index]
    target = inside[index] + step * (inside[index + 1] - inside[index])
    fraction = np.where(change == 0, step, (target - value[index]) / np.where(change == 0, 1.0, change)).clip(0, 1)
    points = np.vstack([_on_segment(test, line, index, fraction), line[-1:]])
    value = load(points)
    crossing, at_bound = _crossings(test, load, points, value, bounds)
    points, value = np.insert(points, crossing + 1, at_bound, axis=0), np.insert(value, crossing + 1, load(at_bound))
    margin = 1e-9 * (hi - lo)
    keep = (value >= lo - margin) & (value <= hi + margin)
    edges = np.flatnonzero(np.diff(np.concatenate([[False], keep, [False]]).astype(int)))
    return [points[a:b] for a, b in zip(edges[::2], edges[1::2], strict=True) if b - a > 1]


def _crossings(
    test: Callable[[Floats, Floats], Floats],
    load: Callable[[Floats], Floats],
    points: Floats,
    value: Floats,
    bounds: tuple[float, float],
) -> tuple[np.ndarray, Floats]:
    """Segments in which the load passes one of its bounds, and the points where it does."""
    found: list[tuple[int, Floats]] = []
    for bound in bounds:
        index = np.flatnonzero((value[:-1] - bound) * (value[1:] - bound) < 0)
        if not index.size:
            continue
        below, above = np.zeros(index.size), np.ones(index.size)
        start = np.sign(value[index] - bound)
        for _ in range(50):
            middle = 0.5 * (below + above)
            same = np.sign(load(_on_segment(test, points, index, middle)) - bound) == start
            below, above = np.where(same, middle, below), np.where(same, above, middle)
        found += list(zip(index.tolist(), _on_segment(test, points, index, above), strict=True))
    found.sort(key=lambda item: (item[0], float(np.sum((item[1] - points[item[0]]) ** 2))))
    return np.array([i for i, _ in found], dtype=int), np.array([point for _, point in found]).reshape(-1, 2)


def _on_segment(test: Callable[[Floats, Floats], Floats], line: Floats, index: np.ndarray, fraction: Floats) -> Floats:
    """Points of the zero curve at fractions of its segments, by bisection across the segment."""
    a, b = line[index], line[index + 1]
    guess = a + fraction[:, None] * (b - a)
    size = np.ptp(line, axis=0) + TINY
    along_first = np.abs(b - a)[:, 0] / size[0] >= np.abs(b - a)[:, 1] / size[1]
    moving, fixed = np.where(along_first, guess[:, 1], guess[:, 0]), np.where(along_first, guess[:, 0], guess[:, 1])

    def across(values: Floats) -> Floats:
        return test(np.where(along_first, fixed, values), np.where(along_first, values, fixed))

    width = np.where(along_first, np.abs(b - a)[:, 1], np.abs(b - a)[:, 0]) + 1e-9 * (1 + np.abs(moving))
    bracketed, zero = bisected(across, moving - width, moving + width)
    solved = np.where(bracketed & (fraction > 0) & (fraction < 1), zero, moving)
    return np.column_stack([np.where(along_first, fixed, solved), np.where(along_first, solved, fixed)])


def _in_plane(
    at: _At, plane: tuple[str, str], bounds: tuple[tuple[float, float], ...], resolution: int
) -> list[BoundaryCurve]:
    def tests(x: Floats, y: Floats, double: bool = False) -> tuple[Floats, ...]:
        v = at.values(**{plane[0]: x, plane[1]: y})
        out = tuple(np.empty(v[plane[0]].size) for _ in range(5))
        arguments = (v["frequency"], v["xi2"], v["rho2"], v["force"] * at.slow.force, v["kappa"])
        _tests_on_roots(*at.head, *arguments, double, *out)
        return tuple(part.reshape(np.shape(x)) for part in out)

    grids = [np.linspace(*_open(pair), resolution) for pair in bounds]
    curves = []
    for index, kind in enumerate(("saddle-node", "hopf")):
        for line in zero_curves(lambda x, y, index=index: tests(x, y)[index], *grids):  # type: ignore[misc]
            _, _, third, X, Z = tests(line[:, 0], line[:, 1], kind == "saddle-node")
            keep = (third > 0) | (kind == "saddle-node")
            curves += _runs(kind, keep, line[:, 0], line[:, 1], X, Z)
    return curves


def _open(pair: tuple[float, float]) -> tuple[float, float]:
    """The interval without a lower end at exactly zero, where a parameter loses its meaning."""
    lo, hi = pair
    return (1e-6 * hi if lo == 0 else lo), hi


def _runs(kind: str, keep: np.ndarray, *columns: Floats) -> list[BoundaryCurve]:
    """The stretches of a curve on which `keep` holds."""
    edges = np.flatnonzero(np.diff(np.concatenate([[False], keep, [False]]).astype(int)))
    stretches = zip(edges[::2], edges[1::2], strict=True)
    return [BoundaryCurve(kind, *(c[a:b] for c in columns)) for a, b in stretches if b - a > 1]
