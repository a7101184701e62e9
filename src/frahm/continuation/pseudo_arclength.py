"""Pseudo-arclength continuation of residual(y) = 0 with one unknown more than equations, as an iterator.

Allgower and Georg (2003), doi 10.1137/1.9780898719154.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass

import numpy as np

from frahm.arrays import Floats
from frahm.errors import Outcome, check_count, check_number

Residual = Callable[[Floats], tuple[Floats, Floats]]


@dataclass(frozen=True)
class ContinuationSettings:
    """How a curve is followed; lengths are in scaled unknowns.

    Attributes
    ----------
    first_step, longest_step, shortest_step : float
        Arclength of a step.
    angle : float
        Turn of the tangent aimed at per step [rad].
    tolerance : float
        Last Newton step at which a point counts as converged.
    most_points : int
        Number of points after which the curve is left unfinished.
    """

    first_step: float = 0.01
    longest_step: float = 0.05
    shortest_step: float = 1e-8
    angle: float = 0.2
    tolerance: float = 1e-10
    most_points: int = 2000

    def __post_init__(self) -> None:
        for name in ("first_step", "longest_step", "shortest_step", "angle", "tolerance"):
            check_number(name, getattr(self, name), above=0)
        check_count("most_points", self.most_points, at_least=2)


@dataclass(frozen=True)
class CurvePoint:
    """A point y and the unit tangent of the curve there, both in scaled unknowns."""

    y: Floats
    tangent: Floats


def newton(residual: Residual, y: Floats, normal: Floats, tolerance: float, iterations: int = 10) -> CurvePoint | None:
    """Correct y onto the curve inside the hyperplane through it across `normal`; None if Newton's method fails.

    It fails, too, where the residual or a step meets a matrix that cannot be solved with or decomposed.
    """
    try:
        return _newton(residual, y, normal, tolerance, iterations)
    except np.linalg.LinAlgError:
        return None


def _newton(residual: Residual, y: Floats, normal: Floats, tolerance: float, iterations: int) -> CurvePoint | None:
    y, start = y.copy(), y
    for _ in range(iterations):
        R, J = residual(y)
        A, b = np.vstack([J, normal]), np.append(R, normal @ (y - start))
        if not (np.all(np.isfinite(A)) and np.all(np.isfinite(b))):
            return None
        step = np.linalg.solve(A, b)
        y = y - step
        size = float(np.linalg.norm(step))
        if size > 1e3:
            return None
        if size < tolerance:
            right = np.zeros(y.size)
            right[-1] = 1.0
            tangent = np.linalg.solve(A, right)
            size = float(np.linalg.norm(tangent))
            return CurvePoint(y, np.asarray(tangent / size)) if np.isfinite(size) and size > 0 else None
    return None


def follow_curve(
    residual: Residual,
    start: Floats,
    direction: Floats,
    inside: Callable[[Floats], bool],
    settings: ContinuationSettings | None = None,
) -> Iterator[CurvePoint | Outcome]:
    """Points along the curve from `start`, and at the end the `Outcome`.

    Parameters
    ----------
    residual : callable
        y (n + 1,) -> residual (n,), Jacobian (n, n + 1).
    start, direction : ndarray, shape (n + 1,)
        A point near the curve, and the side to which to go.
    inside : callable
        Whether a point is still in the region of interest; the first point outside is yielded, too.
    settings : ContinuationSettings, optional
    """
    settings = settings or ContinuationSettings()
    first = newton(residual, start, direction / np.linalg.norm(direction), settings.tolerance)
    if first is None:
        yield Outcome.NOT_CONVERGED
        return
    point, ds, count = first, settings.first_step, 1
    yield point
    while count < settings.most_points:
        new = newton(residual, point.y + ds * point.tangent, point.tangent, settings.tolerance, 7)
        turn = np.pi if new is None else float(np.arccos(np.clip(point.tangent @ new.tangent, -1, 1)))
        if new is None or turn > 3 * settings.angle or np.linalg.norm(new.y - point.y) > 2 * ds:
            ds *= 0.4
            if ds < settings.shortest_step:
                yield Outcome.STEP_TOO_SMALL
                return
            continue
        count += 1
        if count > 4 and _passes(point, new, first):
            yield first
            yield Outcome.CLOSED
            return
        point = new
        yield point
        if not inside(point.y):
            yield Outcome.WINDOW_LEFT
            return
        ds = min(settings.longest_step, ds * float(np.clip(settings.angle / max(turn, 1e-3), 0.5, 2.0)))
    yield Outcome.STEP_LIMIT


def between_points(
    residual: Residual, a: CurvePoint, b: CurvePoint, test: Callable[[CurvePoint], float], tolerance: float
) -> CurvePoint | None:
    """Point between two neighbouring points of a curve at which `test` changes its sign; None if it cannot be found."""
    fa, fb = test(a), test(b)
    if fa * fb > 0:
        return None
    chord = b.y - a.y
    normal = chord / np.linalg.norm(chord)
    lo, hi = 0.0, 1.0
    point = None
    for _ in range(60):
        middle = 0.5 * (lo + hi) if fa == fb else (lo * fb - hi * fa) / (fb - fa)
        point = newton(residual, a.y + middle * chord, normal, 1e-11, 10)
        if point is None:
            return None
        f = test(point)
        if f == 0 or abs(hi - middle) * float(np.linalg.norm(chord)) < tolerance:
            return point
        if f * fb < 0:
            lo, fa = hi, fb
        else:
            fa *= 0.5
        hi, fb = middle, f
    return point


def _passes(a: CurvePoint, b: CurvePoint, first: CurvePoint) -> bool:
    """Whether the chord from a to b passes through the first point, in its direction."""
    chord, gap = b.y - a.y, first.y - a.y
    position = float(chord @ gap) / float(chord @ chord)
    off = float(gap @ gap) - position**2 * float(chord @ chord)
    along = float(first.tangent @ b.tangent)
    return 0 <= position <= 1 and off < 0.02 * float(chord @ chord) and along > 0.7
