"""A branch of limit cycles of the slow flow, followed to both of its ends, with the points where it changes."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field
from functools import partial
from typing import NamedTuple

import numpy as np

from frahm.arrays import Floats
from frahm.attractors.cycle_starts import CLOSE, Start
from frahm.attractors.slow_cycles import Scales, Shooting, SlowCycle
from frahm.continuation import ContinuationSettings, CurvePoint, between_points, follow_curve
from frahm.errors import Outcome

MOST_POINTS = 400
_CHUNK = 16  # points between two settings of the nodes
_FIRST, _LONGEST, _SHORTEST, _ANGLE = 0.003, 0.2, 1e-6, 0.3
_WORN, _LOST = 0.8, 0.4  # cosine between flow and section at which the nodes are set anew, and a point is given up
_LONG = 12.0  # times the median period of the branch: it grows without bound
_SLOW = 2e-3  # least speed beside the mean one, where a cycle waits beside an equilibrium
_HOPELESS = 1e4  # multiplier beyond which a cycle is not followed
_CANARD = (
    f"It is followed until a disturbance grows {_HOPELESS:,.0f}-fold in a turn, as where a cycle runs along the "
    "repelling part of the slow manifold; no motion stays near it."
)
CRITICAL = ("fold of cycles", "period-doubling", "torus")
_NEAR = 5e-3  # residual share of a test function at which a point counts as located
_AHEAD = 1e-4  # of the scaled unknowns along a branch: the direction on new nodes is a difference over as much
_AT_EDGE, _AT_SPECIAL = 1e-9, 1e-7  # along a branch, in scaled unknowns: where it leaves the window, and is special
_ALIKE, _ROUNDING = 0.6, 1e-6  # off the mean of two neighbours, in gaps between them: a cycle between them is theirs


class CyclePoint(NamedTuple):
    """A cycle on a branch; `special` names what happens there, "" if nothing does."""

    cycle: SlowCycle
    special: str


@dataclass(frozen=True)
class End:
    """How a branch of cycles ends on one side.

    Attributes
    ----------
    kind : str
        "hopf", "period without bound", "edge of the window", "closed", "given up" (too unstable to matter) or
        "not followed".
    outcome : Outcome
        Whether the end is one of the branch or of the search.
    sentence : str
        What happens there.
    """

    kind: str
    outcome: Outcome
    sentence: str


@dataclass
class _Way:
    """One side of a branch while it is followed."""

    points: list[CyclePoint] = field(default_factory=list)
    end: End | None = None


def followed_branch(
    scales: Scales, start: Start, window: tuple[float, float], from_hopf: float | None
) -> tuple[list[CyclePoint], tuple[End, End]]:
    """Cycles in order along the branch through a start, and both ends.

    `from_hopf` is the detuning [rad/s] of the Hopf point at which the branch begins, None if it is followed both ways.
    """
    ahead = _follow(scales, start, window, start.direction)
    if from_hopf is not None:
        born = End("hopf", Outcome.DONE, f"It is born at the Hopf point at detuning {from_hopf:.5g} rad/s.")
        return ahead.points, (born, _end(ahead))
    if _end(ahead).kind == "closed":
        return ahead.points, (_end(ahead), _end(ahead))
    behind = _follow(scales, start, window, -start.direction)
    return behind.points[:0:-1] + ahead.points, (_end(behind), _end(ahead))


def _end(way: _Way) -> End:
    if way.end is None:
        raise AssertionError("a way is followed to an end")
    return way.end


def _follow(scales: Scales, start: Start, window: tuple[float, float], direction: Floats) -> _Way:
    """Follow a branch one way, with the nodes set anew every few points."""
    way = _Way()
    shooting, y, step = start.shooting, start.y, _FIRST
    while True:
        last, step = _run(way, shooting, y, direction, step, window)
        if way.end is not None:
            break
        if last is None or step < _SHORTEST:
            way.end = _gave_up(Outcome.NOT_CONVERGED if last is None else Outcome.STEP_TOO_SMALL)
            break
        shooting, y, direction = _renewed(shooting, last, scales)
    return way


class _Run(NamedTuple):
    """Where points on one set of nodes end: the last good one, and the step to go on with."""

    last: CurvePoint | None
    step: float


def _run(way: _Way, shooting: Shooting, y: Floats, direction: Floats, step: float, window: tuple[float, float]) -> _Run:
    """Add points until the nodes should be set anew or the branch ends."""
    settings = ContinuationSettings(
        first_step=step, longest_step=_LONGEST, shortest_step=_SHORTEST, angle=_ANGLE, tolerance=CLOSE,
        most_points=_CHUNK,
    )  # fmt: skip
    last: CurvePoint | None = None
    for item in follow_curve(shooting.residual, y, direction, _inside(shooting, window), settings):
        if isinstance(item, Outcome):
            short = item is Outcome.STEP_TOO_SMALL
            if item not in (Outcome.STEP_LIMIT, Outcome.STEP_TOO_SMALL):
                way.end = _gave_up(item)
            return _Run(last, 0.2 * step if short and step > 20 * _SHORTEST else (0.0 if short else step))
        crossing = shooting.crossing(item.y)
        if crossing < _LOST:
            return _Run(last, 0.3 * step)
        if last is not None:
            step = float(np.linalg.norm(item.y - last.y))
        if last is not None or not way.points:
            way.end = _take(way, shooting, last, item, window) or _ended(way)
            if way.end is not None:
                return _Run(item, step)
        last = item
        if crossing < _WORN:
            return _Run(last, step)
    return _Run(last, step)


def _inside(shooting: Shooting, window: tuple[float, float]) -> Callable[[Floats], bool]:
    return lambda y: window[0] <= shooting.unpack(y)[2] <= window[1]


def _renewed(shooting: Shooting, point: CurvePoint, scales: Scales) -> tuple[Shooting, Floats, Floats]:
    """The same cycle and direction on nodes that share steps and time evenly."""
    _, _, W = shooting.unpack(point.y)
    durations = shooting.durations_anew(point.y)
    new = Shooting(shooting.slow, scales, shooting.nodes_at(point.y, durations), durations, W)
    beside = point.y + _AHEAD * point.tangent
    _, stretched, W_beside = shooting.unpack(beside)
    stretched = durations * np.sum(stretched) / np.sum(durations)
    ahead = new.pack(shooting.nodes_at(beside, durations), stretched, W_beside)
    return new, new.start, new.on_sections(ahead - new.start)


def _take(
    way: _Way, shooting: Shooting, a: CurvePoint | None, b: CurvePoint, window: tuple[float, float]
) -> End | None:
    """Add point b, with what happens between a and b; the end of the branch if it is there."""
    W = shooting.unpack(b.y)[2]
    if a is not None and _deviation(shooting, a.y) @ _deviation(shooting, b.y) < 0:
        return End(
            "hopf",
            Outcome.DONE,
            f"It shrinks to nothing at a Hopf point near detuning {W - shooting.slow.omega:.5g} rad/s.",
        )
    if not window[0] <= W <= window[1]:
        edge = window[0] if window[0] > W else window[1]
        if a is not None:
            at = between_points(shooting.residual, a, b, lambda p: shooting.unpack(p.y)[2] - edge, _AT_EDGE)
            cycle = None if at is None else shooting.cycle(at.y)
            if cycle is not None:
                way.points.append(CyclePoint(cycle, ""))
        return End("edge of the window", Outcome.WINDOW_LEFT, "It leaves the window there.")
    cycle = shooting.cycle(b.y)
    if cycle is None:
        return _gave_up(Outcome.NOT_CONVERGED)
    if np.max(np.abs(cycle.multipliers)) > _HOPELESS:
        return End("given up", Outcome.DONE, _CANARD)
    if a is not None and way.points:
        _add_special(way, shooting, a, b, cycle)
    way.points.append(CyclePoint(cycle, ""))
    return None


def _deviation(shooting: Shooting, y: Floats) -> Floats:
    """Scaled nodes without their mean over the cycle: they change sign where the cycle shrinks to a point."""
    nodes, durations, _ = shooting.unpack(y)
    scaled = nodes / shooting.scales.state
    return np.asarray((scaled - durations @ scaled / np.sum(durations)).ravel())


def _add_special(way: _Way, shooting: Shooting, a: CurvePoint, b: CurvePoint, new: SlowCycle) -> None:
    """Locate folds, and changes of stability, between the last point and the cycle at b."""
    changes = way.points[-1].cycle.stable or new.stable
    for index, name in enumerate(CRITICAL):
        if not (index == 0 or changes):  # doublings of unstable cycles lead to nothing stable
            continue
        test = partial(_test, shooting, index)
        if test(a) * test(b) >= 0:
            continue
        at = between_points(shooting.residual, a, b, test, _AT_SPECIAL)
        cycle = None if at is None else shooting.cycle(at.y)
        if cycle is not None and (index == 0 or _is_critical(index, cycle.multipliers)):
            way.points.append(CyclePoint(cycle, name))


def _test(shooting: Shooting, index: int, point: CurvePoint) -> float:
    """Zero at a special point: the direction of Omega at a fold, a function of the multipliers at the others."""
    return float(point.tangent[-1]) if index == 0 else shooting.tests(point.y)[index - 1]


def _is_critical(index: int, multipliers: np.ndarray) -> bool:
    """Whether a multiplier is where the special point says: two real ones with product 1 are no torus."""
    if index == 2:
        turning = multipliers[multipliers.imag > 0]
        return bool(turning.size and abs(abs(turning[0]) - 1) < _NEAR)
    return bool(np.min(np.abs(multipliers + 1)) < _NEAR)


def _ended(way: _Way) -> End | None:
    """Ends that show in the points so far."""
    if len(way.points) < 8:
        return None
    cycle = way.points[-1].cycle
    usual = float(np.median([point.cycle.period for point in way.points]))
    first = way.points[0].cycle
    if (cycle.slowest < _SLOW and cycle.period > 2 * usual) or cycle.period > _LONG * max(usual, first.period):
        return End(
            "period without bound", Outcome.DONE,
            "Its period grows without bound there: it comes to wait beside a periodic response (homoclinic).",
        )  # fmt: skip
    if len(way.points) >= MOST_POINTS:
        return _gave_up(Outcome.STEP_LIMIT)
    if len(way.points) > 20 and _same(way.points[-1].cycle, way.points[-2].cycle, first):
        return End("closed", Outcome.CLOSED, Outcome.CLOSED.value)
    return None


def _same(new: SlowCycle, old: SlowCycle, first: SlowCycle) -> bool:
    """Whether the first cycle lies between two neighbours in frequency, and is like them in period and size."""
    if not min(new.frequency, old.frequency) <= first.frequency <= max(new.frequency, old.frequency):
        return False
    looks = np.array([[c.period, *c.pipe, *c.relative] for c in (new, old, first)])
    gap = np.abs(looks[0] - looks[1])
    return bool(np.all(np.abs(looks[2] - looks[:2].mean(axis=0)) <= _ALIKE * gap + _ROUNDING * looks[2]))


def _gave_up(outcome: Outcome) -> End:
    if outcome is Outcome.CLOSED:
        return End("closed", outcome, outcome.value)
    return End("not followed", outcome, f"It could not be followed further. {outcome.value}")
