"""`modulated_branches`: modulated responses as limit cycles of the slow flow, continued over the frequency."""

from __future__ import annotations

import itertools
from collections.abc import Sequence
from concurrent.futures import ThreadPoolExecutor
from typing import TYPE_CHECKING

import numpy as np

from frahm.arrays import frozen
from frahm.attractors.cycle_branches import CyclePoint, End, followed_branch
from frahm.attractors.cycle_starts import Start, start_from_motion, start_states, starts_at_hopf
from frahm.attractors.modulated_curve import ExactCheck, ModulatedCurve, ModulatedPoint, Range
from frahm.attractors.seeds import states_of_amplitudes
from frahm.attractors.slow_cycles import Scales, SlowCycle
from frahm.attractors.stroboscope import stroboscope
from frahm.errors import check_count
from frahm.slow_flow import SlowBranches, SlowFlow, pipe_scale, slow_branches, slow_flow_of, slow_manifold
from frahm.systems import System, as_system, excitation_window

if TYPE_CHECKING:
    from frahm.case import Case

LOOKS, CHECKS = 33, 3
_POINTS = 401  # of the periodic response over the window
_ALIKE = 0.02  # relative: a cycle is already on a branch
_NEUTRAL = 1e-9  # growth rate, in units of omega, of a point where stability changes
_UNSURE = 1e-3  # error of the trivial multiplier beyond which the others are in doubt
_SETTLE, _WATCH, _DEPTH = 600, 400, 0.03
_AGREES = 0.1  # relative: the slow flow leaves out harmonics of this size
_BESIDE = 1e-3  # of omega: looks on both sides of a Hopf point
_AT_HOPF = 1e-4  # of omega: a branch that ended this close to a Hopf point ended in it

Branch = tuple[list[CyclePoint], tuple[End, End]]


def modulated_branches(
    case_or_system: Case | System | str,
    *,
    detuning: tuple[float, float] | None = None,
    frequency: tuple[float, float] | None = None,
    form: str = "averaged",
    looks: int = LOOKS,
    checks: int = CHECKS,
    workers: int | None = None,
) -> ModulatedCurve:
    """Branches of modulated responses over a window of the frequency, as limit cycles of the slow flow.

    Branches start at the Hopf points of the periodic response and at modulations met by integrating the slow flow from
    rest and from the jumps of the slow manifold at `looks` frequencies. Each is followed by multiple shooting and
    pseudo-arclength to both ends; an unstable one is given up where a disturbance
    grows 10,000-fold in a turn.
    A branch that enters the window from outside, is unstable throughout and has no Hopf point in it is not found.

    Parameters
    ----------
    case_or_system : Case, System or str
        One mode with one cubic sink.
    detuning, frequency : tuple of float
        Window (lo, hi) of sigma or Omega [rad/s]; give one of the two.
    form : {"averaged", "paper"}
        Form of the slow flow, see `SlowFlow`.
    looks : int
        Frequencies at which the slow flow is integrated; the Hopf points and what lies between them are added.
    checks : int
        Samples of the stable responses held against the exact equations.
    workers : int, optional
        Threads; one per core by default. The result does not depend on it.

    Returns
    -------
    ModulatedCurve
        Envelopes [m] of every modulated response over the frequency, their stability and where it changes.

    Raises
    ------
    ParameterError
        For bad input, or a system that is not one mode with one cubic sink.
    """
    system = as_system(case_or_system)
    slow = slow_flow_of(system, form)
    window = excitation_window(system, detuning=detuning, frequency=frequency)
    looks = check_count("looks", looks, at_least=0, at_most=10_000)
    checks = check_count("checks", checks, at_least=0, at_most=10_000)
    workers = None if workers is None else check_count("workers", workers, at_most=1024)
    periodic = slow_branches(slow, *window, _POINTS)
    branches, doubts = _branches(slow, window, periodic, looks, workers)
    doubts = [*periodic.unverified, *doubts]
    tested = _checked(system, slow, branches, checks, workers)
    doubts += [
        f"At detuning {c.detuning:.5g} rad/s the exact motion does not stay on the modulated response of the slow "
        f"flow: it peaks at {c.exact_pipe_max:.3g} m, not {c.pipe_max:.3g} m"
        f"{'.' if c.modulated else ', and is not modulated.'}"
        for c in tested if not (c.modulated and abs(c.exact_pipe_max - c.pipe_max) < _AGREES * c.pipe_max)
    ]  # fmt: skip
    settings = {"form": form, "window": window, "looks": looks}
    return _assembled(system, slow, branches, periodic, tested, tuple(doubts), settings)


def _branches(
    slow: SlowFlow, window: Range, periodic: SlowBranches, looks: int, workers: int | None
) -> tuple[list[Branch], list[str]]:
    """All branches, and sentences on what is in doubt."""
    branches: list[Branch] = []
    scales = _scales(slow, window, periodic)
    if scales is None:
        return branches, []
    doubts = []
    hopfs = [point for point in periodic.points if point.kind == "hopf"]
    for point in hopfs:
        if any(_ends_at(slow, branch, point.frequency) for branch in branches):
            continue
        at = point.frequency - slow.omega
        branch = _born(scales, starts_at_hopf(slow, scales, point), window, at)
        if branch is None:
            doubts.append(f"The branch of modulated responses born at detuning {at:.5g} rad/s could not be started.")
        else:
            branches.append(branch)
    between = [0.5 * (a.frequency + b.frequency) for a, b in itertools.pairwise(hopfs)]
    beside = [point.frequency + side * _BESIDE * slow.omega for point in hopfs for side in (-1, 1)]
    wanted = [*np.linspace(*window, looks), *between, *beside] if looks else []
    grid = sorted({float(W) for W in wanted if window[0] <= W <= window[1]})
    with ThreadPoolExecutor(workers) as pool:
        met = list(pool.map(lambda W: _met(slow, scales, W), grid))
    irregular = [W - slow.omega for W, (_, strange) in zip(grid, met, strict=True) if strange]
    for start, _ in met:
        cycle = None if start is None else start.shooting.cycle(start.y)
        if start is None or cycle is None or any(_is_on(branch, cycle) for branch in branches):
            continue
        points, ends = followed_branch(scales, start, window, None)
        if points:
            branches.append((points, ends))
        else:
            doubts.append(f"The modulation met at detuning {cycle.frequency - slow.omega:.5g} rad/s is on no branch.")
    if irregular:
        doubts.append(
            f"At {len(irregular)} of {len(grid)} frequencies, detuning {irregular[0]:.4g} to {irregular[-1]:.4g} "
            "rad/s, the slow flow ends in motion that is no cycle of one beat: it is not on these branches."
        )  # fmt: skip
    return branches, doubts + _branch_doubts(branches)


def _scales(slow: SlowFlow, window: Range, periodic: SlowBranches) -> Scales | None:
    """Sizes by which states and frequency are measured; None where nothing can move."""
    folds = slow_manifold(slow, float(np.clip(slow.omega, *window))).folds
    if folds is not None:
        pipe, relative = folds.pipe_ceiling, folds.relative_ceiling
    else:
        pipe, relative = (float(np.max(a, initial=0.0)) for a in (periodic.pipe_amplitude, periodic.relative_amplitude))
    if not (pipe > 0 and relative > 0 and np.isfinite(pipe + relative)) or slow.kappa == 0 or slow.force == 0:
        return None
    return Scales(float(pipe), float(relative), min(0.02 * slow.omega, 0.5 * (window[1] - window[0])))


def _born(scales: Scales, starts: Sequence[Start], window: Range, at: float) -> Branch | None:
    """The branch born at a Hopf point, from the largest of the small cycles that can be corrected."""
    for start in starts:
        points, ends = followed_branch(scales, start, window, at)
        if points:
            return points, ends
    return None


def _ends_at(slow: SlowFlow, branch: Branch, hopf: float) -> bool:
    points, ends = branch
    last = points[-1].cycle.frequency
    return ends[1].kind == "hopf" and abs(last - hopf) < _AT_HOPF * slow.omega


def _met(slow: SlowFlow, scales: Scales, W: float) -> tuple[Start | None, bool]:
    """A cycle met from rest or from a jump, and whether a motion was neither cycle nor periodic response."""
    strange = False
    for state in start_states(slow, W):
        start, odd = start_from_motion(slow, scales, state, W)
        strange = strange or odd
        if start is not None:
            return start, strange
    return None, strange


def _is_on(branch: Branch, cycle: SlowCycle) -> bool:
    """Whether a cycle lies on a branch, judged by period and amplitudes between neighbouring points."""
    points = [point.cycle for point in branch[0]]
    for a, b in itertools.pairwise(points):
        if not min(a.frequency, b.frequency) <= cycle.frequency <= max(a.frequency, b.frequency):
            continue
        share = (cycle.frequency - a.frequency) / (b.frequency - a.frequency) if b.frequency != a.frequency else 0.5
        there, here, beyond = (np.array([c.period, c.pipe[1], c.relative[1]]) for c in (a, cycle, b))
        if np.all(np.abs((1 - share) * there + share * beyond - here) < _ALIKE * here + np.abs(beyond - there)):
            return True
    return False


def _branch_doubts(branches: list[Branch]) -> list[str]:
    doubts = []
    for number, (points, ends) in enumerate(branches):
        for at, end in zip((points[0], points[-1]), ends, strict=True):
            if not end.outcome.ok:
                lost = f"amplitude {at.cycle.pipe[1]:.3g} m"
                doubts.append(f"Modulated branch {number} is open at {lost}: {end.sentence}")
        unsure = sum(_unsure(point) for point in points)
        if unsure:
            doubts.append(
                f"The stability of {unsure} of {len(points)} points of modulated branch {number} is in doubt."
            )
    return doubts


def _unsure(point: CyclePoint) -> bool:
    """Whether the error of the trivial multiplier leaves the stability open."""
    largest, error = float(np.max(np.abs(point.cycle.multipliers))), point.cycle.trivial_error
    return not point.special and error > _UNSURE and largest < 1 + 10 * error


def _checked(
    system: System, slow: SlowFlow, branches: list[Branch], checks: int, workers: int | None
) -> tuple[ExactCheck, ...]:
    """Stable cycles, spread over the detuning, held against the exact equations started on them."""
    stable = sorted(
        (point.cycle for points, _ in branches for point in points if not point.special and point.cycle.stable),
        key=lambda cycle: cycle.frequency,
    )  # fmt: skip
    if not stable or not checks:
        return ()
    lo, hi = stable[0].frequency, stable[-1].frequency
    wanted = np.linspace(lo, hi, checks + 2)[1:-1]
    chosen = {_deepest_near(stable, W, (hi - lo) / (2 * checks + 2)) for W in wanted}
    scale, found = pipe_scale(system), []
    for index in sorted(chosen):
        cycle = stable[index]
        strobe = stroboscope(system, cycle.frequency, workers)
        X, Z = cycle.nodes[:, 0] + 1j * cycle.nodes[:, 1], cycle.nodes[:, 2] + 1j * cycle.nodes[:, 3]
        glimpse = strobe.run(states_of_amplitudes(system, X, Z, cycle.frequency), _SETTLE + _WATCH, window=_WATCH)
        peak, least = float(np.max(glimpse.seen[:, 0])), float(np.min(glimpse.seen[:, 1]))
        found.append(ExactCheck(
            cycle.frequency, cycle.frequency - slow.omega, scale * cycle.pipe[1], scale * cycle.pipe[0], peak, least,
            bool(np.all(glimpse.codes == 0) and np.any(glimpse.seen[:, 0] - glimpse.seen[:, 1] > _DEPTH * peak)),
        ))  # fmt: skip
    return tuple(found)


def _deepest_near(cycles: list[SlowCycle], W: float, reach: float) -> int:
    """Index of the cycle that is modulated most among those within reach of W, of the nearest if there is none."""
    near = [i for i, cycle in enumerate(cycles) if abs(cycle.frequency - W) <= reach]
    near = near or [int(np.argmin([abs(cycle.frequency - W) for cycle in cycles]))]
    return max(
        near,
        key=lambda i: (
            round((cycles[i].pipe[1] - cycles[i].pipe[0]) / cycles[i].pipe[1], 1),
            -abs(cycles[i].frequency - W),
        ),
    )


def _assembled(
    system: System, slow: SlowFlow, branches: list[Branch], periodic: SlowBranches, tested: tuple[ExactCheck, ...],
    doubts: tuple[str, ...], settings: dict,
) -> ModulatedCurve:  # fmt: skip
    scale, omega = pipe_scale(system), slow.omega
    stable = [_stable(points) for points, _ in branches]
    cycles = [point.cycle for points, _ in branches for point in points]
    columns = {
        "frequency": [cycle.frequency for cycle in cycles],
        "detuning": [cycle.frequency - omega for cycle in cycles],
        "period": [cycle.period for cycle in cycles],
        "pipe_max": [scale * cycle.pipe[1] for cycle in cycles],
        "pipe_min": [scale * cycle.pipe[0] for cycle in cycles],
        "relative_max": [cycle.relative[1] for cycle in cycles],
        "relative_min": [cycle.relative[0] for cycle in cycles],
        "multiplier": [float(np.max(np.abs(cycle.multipliers))) for cycle in cycles],
    }
    special = [
        ModulatedPoint(point.special, point.cycle.frequency, point.cycle.frequency - omega, point.cycle.period,
                       scale * point.cycle.pipe[1], number)
        for number, (points, _) in enumerate(branches) for index, point in enumerate(points)
        if point.special and _matters(point, stable[number], index)
    ]  # fmt: skip
    lone = _united([r for (points, _), good in zip(branches, stable, strict=True) for r in _stretches(points, good)])
    both = [_overlap(a, b) for a in lone for b in _united(_periodic_stretches(slow, periodic))]
    return ModulatedCurve(
        **{name: frozen(values) for name, values in columns.items()},
        stable=frozen(np.concatenate([*stable, np.zeros(0, dtype=bool)]), bool),
        branch=frozen(np.repeat(np.arange(len(branches)), [len(points) for points, _ in branches]), int),
        special_points=tuple(special),
        ends=tuple(ends for _, ends in branches),
        ranges=tuple((lo - omega, hi - omega) for lo, hi in lone),
        coexistence=tuple((lo - omega, hi - omega) for lo, hi in _united([r for r in both if r is not None])),
        checks=tested,
        unverified=doubts,
        settings=settings,
        system=system.name,
    )


def _stable(points: list[CyclePoint]) -> np.ndarray:
    """Stability of every point; a special point is as stable as the better of its neighbours."""
    own = np.array([point.cycle.stable and not point.special for point in points], dtype=bool)
    beside = np.concatenate([own[1:], [False]]) | np.concatenate([[False], own[:-1]])
    return own | (beside & np.array([bool(point.special) for point in points], dtype=bool))


def _matters(point: CyclePoint, stable: np.ndarray, index: int) -> bool:
    """Whether a special point is a fold or changes stability: doublings of what is unstable anyway are left out."""
    return point.special == "fold of cycles" or bool(stable[index])


def _stretches(points: list[CyclePoint], stable: np.ndarray) -> list[Range]:
    """Ranges of Omega between neighbouring points that are both stable."""
    W = [point.cycle.frequency for point in points]
    return [(min(W[i : i + 2]), max(W[i : i + 2])) for i in range(len(W) - 1) if stable[i] and stable[i + 1]]


def _periodic_stretches(slow: SlowFlow, periodic: SlowBranches) -> list[Range]:
    """Ranges of Omega over which neighbouring points of the periodic response are stable."""
    W, growth, small = periodic.frequency, periodic.growth_rate, _NEUTRAL * slow.omega
    joined = (periodic.branch[:-1] == periodic.branch[1:]) & (periodic.piece[:-1] == periodic.piece[1:])
    good = joined & (np.fmin(growth[:-1], growth[1:]) < -small) & (np.fmax(growth[:-1], growth[1:]) <= small)
    return [(min(W[i], W[i + 1]), max(W[i], W[i + 1])) for i in np.flatnonzero(good)]


def _united(ranges: list[Range]) -> list[Range]:
    """Overlapping and touching ranges as one, ascending."""
    united: list[Range] = []
    for lo, hi in sorted(ranges):
        if united and lo <= united[-1][1] + 1e-12 * abs(hi):
            united[-1] = united[-1][0], max(hi, united[-1][1])
        else:
            united.append((float(lo), float(hi)))
    return united


def _overlap(a: Range, b: Range) -> Range | None:
    lo, hi = max(a[0], b[0]), min(a[1], b[1])
    return (lo, hi) if lo < hi else None
