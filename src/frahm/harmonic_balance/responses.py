"""All periodic responses at one frequency."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from frahm import readable
from frahm.arrays import Complexes, Floats, frozen
from frahm.harmonic_balance.alike import are_exchanged, interchangeable
from frahm.harmonic_balance.bifurcations import unstable_count
from frahm.harmonic_balance.branch import SolutionBranch
from frahm.harmonic_balance.branches import find_branches
from frahm.harmonic_balance.condensation import unknowns
from frahm.harmonic_balance.continued import continued
from frahm.harmonic_balance.floquet import monodromy
from frahm.harmonic_balance.following import lies_in_step, point_at
from frahm.harmonic_balance.found import Found
from frahm.harmonic_balance.indices import add_up, missing
from frahm.harmonic_balance.inventory import (
    NONE_FOUND,
    all_known,
    continued_text,
    inventory_text,
    not_proven,
    unfinished,
    unstable_unproven,
)
from frahm.harmonic_balance.kernels import harmonics_of, output_harmonic
from frahm.harmonic_balance.linear import check_rest, is_linear, linear_exponents, linear_response
from frahm.harmonic_balance.newton import solve_at
from frahm.harmonic_balance.orbits import peak_of
from frahm.harmonic_balance.search import Search, search_over
from frahm.harmonic_balance.starts import solve_seed
from frahm.harmonic_balance.variation import variation_of
from frahm.systems import System

_NEIGHBOURHOOD = 0.12
_FINE_GOAL = 1e-11
_EXACT = 1e-6  # residual up to which a response has the multipliers of an exact one
_SAME, _SAME_REST = 1e-6, 1e-9  # relative difference of states that are one, and of those near zero in relative peaks
_TINY = 1e-300  # keeps what is compared with zero apart from it


@dataclass(frozen=True, eq=False)
class PeriodicResponse:
    """One periodic response with the period of the excitation.

    Attributes
    ----------
    frequency : float
        Omega [rad/s].
    harmonics : dict of int to ndarray, shape (n,)
        Complex amplitudes X_k [m] of all coordinates: x(t) = Re sum_k X_k e^{i k Omega t}.
    multipliers : ndarray of complex, shape (2n,)
        Floquet multipliers over one period, by descending modulus; all infinite where a disturbance grows beyond what
        numbers hold, NaN where a period takes too many steps to follow one.
    stable : bool
        Whether no multiplier lies outside the unit circle.
    pipe_peak, relative_peak : float
        max |x_out| and max |z| over a period [m].
    pipe_amplitude, relative_amplitude : float
        First-harmonic amplitudes [m].
    element_amplitudes : ndarray, shape (E,)
        First-harmonic amplitudes [m] of all elements: which absorber carries the motion.
    residual : float
        Force harmonics that nothing balances, relative to all forces [-].
    symmetric : bool
        Whether x(t + T/2) = -x(t).
    """

    __repr__ = readable.summary

    frequency: float
    harmonics: dict[int, Complexes]
    multipliers: Complexes
    stable: bool
    pipe_peak: float
    relative_peak: float
    pipe_amplitude: float
    relative_amplitude: float
    element_amplitudes: Floats
    residual: float
    symmetric: bool

    @property
    def period(self) -> float:
        """Period of the excitation [s]."""
        return 2 * np.pi / self.frequency

    @property
    def state(self) -> Floats:
        """State at t = 0, in the order of `initial_state`: x_0, v_0, x_1, v_1, ... [m, m/s]."""
        x = sum(X.real for X in self.harmonics.values())
        v = sum((1j * k * self.frequency * X).real for k, X in self.harmonics.items())
        return frozen(np.column_stack([x, v]).ravel())

    def x(self, time: ArrayLike) -> Floats:
        """Displacements [m] of all coordinates at the given times, shape (times, n)."""
        t = np.atleast_1d(np.asarray(time, dtype=float))[:, None]
        return np.asarray(sum((X * np.exp(1j * k * self.frequency * t)).real for k, X in self.harmonics.items()))


def periodic_responses_of(
    system: System, frequency: float, harmonics: int | None, *, every: bool = False
) -> Found[PeriodicResponse]:
    """All periodic responses at Omega = `frequency` [rad/s], by ascending relative amplitude.

    If `every` one is asked for and not those that attract alone, what may lack among the unstable ones is said, too.

    Branches are searched and followed over a neighbourhood of the frequency, so that a response is found even where
    the first harmonic alone does not see it.
    """
    if is_linear(system) or not np.any(system.forcing):
        return Found([_linear(system, frequency)], "A linear system has one periodic response.")
    search = search_over(system, frequency * (1 - _NEIGHBOURHOOD), frequency * (1 + _NEIGHBOURHOOD), harmonics)
    known = _of_one_harmonic(search, frequency)
    if known is not None:
        return known
    continued_ones, complete = _continued(search, frequency)
    if complete:
        searched = continued_text() + exchanged_text(system, continued_ones)
        return Found(continued_ones, searched, tuple(search.unsearched))
    branches = find_branches(search, at=frequency)
    found = responses_on(search, branches, frequency)
    found += [response for response in continued_ones if not any(_same(response, other) for other in found)]
    found.sort(key=lambda response: response.relative_amplitude)
    doubts = (
        *search.unsearched, *search.budget.sentences(), *not_proven(search, frequency), *unfinished(branches),
        *(_missing(search, found) if found else (NONE_FOUND,)), *(unstable_unproven(search) if every else ()),
    )  # fmt: skip
    return Found(found, inventory_text(search) + exchanged_text(system, found), doubts)


def _of_one_harmonic(search: Search, frequency: float) -> Found[PeriodicResponse] | None:
    """The solutions of the equations of one harmonic where all of them are known at a frequency, or None."""
    seeds = search.seeder.at(frequency, search.x_scale) if search.harmonics == 1 else []
    if not seeds or not all_known(search, frequency):
        return None
    solved = [solve_seed(search, seed, True) for seed in seeds if set(seed.harmonics) == {1}]
    if any(one is None for one in solved):
        return None
    found = [_response(search, True, X, H, frequency) for X, H in (one for one in solved if one is not None)]
    found = sorted(found, key=lambda response: response.relative_amplitude)
    searched = "All solutions of the equations of one harmonic at this frequency."
    return Found(found, searched + exchanged_text(search.system, found), tuple(search.unsearched))


def _continued(search: Search, frequency: float) -> tuple[list[PeriodicResponse], bool]:
    """Responses continued from all solutions of one harmonic, and whether their indices say that none is missing."""
    found: list[PeriodicResponse] = []
    solutions = continued(search, frequency)
    if solutions is None:
        return found, False
    maps = []  # over half a period, of the symmetric ones
    for odd, X, H in [(odd, *one) for odd, part in zip((True, False), solutions, strict=True) for one in part]:
        solution = _solved(search, odd, frequency, X, H)
        if solution is None:
            return found, False
        values = _map_multipliers(search, odd, *solution, frequency)
        _add_response(search, found, odd, *solution, frequency, values)
        maps += [values] if odd else []
    if not found or any(response.residual > _EXACT for response in found):
        return found, False
    largest = max(response.relative_peak for response in found)
    both = (maps, [response.multipliers for response in found])
    found.sort(key=lambda response: response.relative_amplitude)
    return found, all(add_up(search.system, values, largest) for values in both)


def exchanged_text(system: System, responses: Sequence[PeriodicResponse]) -> str:
    """How many responses are left if those are counted once that an exchange of equal absorbers makes of each other.

    Nothing where no absorbers are equal.
    """
    groups = [group for group in interchangeable(system) if len(group) > 1]
    if not groups:
        return ""
    kept: list[PeriodicResponse] = []
    for response in responses:
        if not any(are_exchanged(groups, response.harmonics, other.harmonics) for other in kept):
            kept.append(response)
    return (
        f" Absorbers are equal: {len(responses)} responses are listed, {len(kept)} if those that differ only in which"
        " of the equal ones carries the motion (`element_amplitudes`) are counted once."
    )


def _missing(search: Search, found: Sequence[PeriodicResponse]) -> tuple[str, ...]:
    """A sentence if the responses found cannot be all; of those of a fixed number of harmonics nothing is known."""
    if search.harmonics is not None or any(response.residual > _EXACT for response in found):
        return ()
    largest = max(response.relative_peak for response in found)
    return missing(search.system, [response.multipliers for response in found], largest)


def responses_on(search: Search, branches: Iterable[SolutionBranch], frequency: float) -> list[PeriodicResponse]:
    """Periodic responses at Omega = `frequency` [rad/s] on branches already followed, by relative amplitude."""
    found: list[PeriodicResponse] = []
    for branch in branches:
        for X, H in _crossings(search, branch, frequency):
            _add_response(search, found, branch.odd, X, H, frequency)
    return sorted(found, key=lambda response: response.relative_amplitude)


def _add_response(
    search: Search,
    found: list[PeriodicResponse],
    odd: bool,
    X: Floats,
    H: int,
    frequency: float,
    of_map: Complexes | None = None,
) -> None:
    """Add a response that is new, and its mirror image if it is not symmetric."""
    solutions = [X] if odd or not search.problem.odd else [X, _mirrored(search, X, H)]
    for solution in solutions:
        response = _response(search, odd, solution, H, frequency, of_map)
        if not any(_same(response, other) for other in found):
            found.append(response)


def _crossings(search: Search, branch: SolutionBranch, W: float) -> list[tuple[Floats, int]]:
    """Solutions of a branch at one frequency, after Newton there with harmonics added as needed."""
    out, points = [], branch.points
    for i in np.flatnonzero((points.frequency[:-1] - W) * (points.frequency[1:] - W) <= 0):
        a, b = points.frequency[i : i + 2]
        f = 0.5 if a == b else (W - a) / (b - a)
        guess = np.zeros(search.size(branch.odd))
        for k, weight in ((i, 1 - f), (i + 1, f)):
            n = unknowns(search.problem, points.Hs[k], branch.odd)
            guess[:n] += weight * points.ys[k, :n]
        found = _solved(search, branch.odd, W, guess, int(max(points.Hs[i : i + 2])))
        if a != b and (found is None or not lies_in_step(search, branch, *found, W, int(i))):
            # beside a special point another orbit is nearer to the chord than that of the branch
            start = point_at(search, branch, int(i), W)
            found = None if start is None else _solved(search, branch.odd, W, start.y, start.H)
        if found is not None:
            out.append(found)
    return out


def _solved(search: Search, odd: bool, W: float, X: Floats, H: int) -> tuple[Floats, int] | None:
    """The solution at Omega = W near X, with harmonics added as needed."""
    goal = _FINE_GOAL if search.harmonics is None else np.inf
    ok, H, _ = solve_at(search.problem, odd, W, X, H, search.highest, goal, 15)
    return (X, H) if ok else None


def _mirrored(search: Search, X: Floats, H: int) -> Floats:
    """The other one of a pair of asymmetric responses: even harmonics change their sign."""
    r = search.problem.M11.shape[0]
    n = unknowns(search.problem, H, False)
    other = X.copy()
    other[:n].reshape(-1, 2 * r)[::2] *= -1
    return other


def _map_multipliers(search: Search, odd: bool, X: Floats, H: int, W: float) -> Complexes:
    """Multipliers of the map over half a period to the opposite state (odd harmonics), or over a period."""
    n = search.system.size
    Phi = np.empty((2 * n, 2 * n))
    followed = monodromy(search.problem, variation_of(search.system), H, odd, W, _harmonics(search, odd, X, H), Phi)
    if np.all(np.isfinite(Phi)):
        return np.linalg.eigvals(-Phi if odd else Phi).astype(complex)
    # a disturbance grows beyond all numbers, or the period is too long to follow: no multiplier is known
    return np.full(2 * n, np.inf if followed else np.nan, complex)


def _harmonics(search: Search, odd: bool, X: Floats, H: int) -> Complexes:
    u = np.empty((H + 5, search.problem.M11.shape[0]), complex)
    harmonics_of(search.problem, H, odd, X, u)
    return u


def _response(
    search: Search, odd: bool, X: Floats, H: int, W: float, of_map: Complexes | None = None
) -> PeriodicResponse:
    """The response with the unknowns X; `of_map` are its `_map_multipliers` if they are known."""
    pb, n = search.problem, search.system.size
    u = _harmonics(search, odd, X, H)
    ks = range(1, H + 1, 2) if odd else range(H + 1)
    rows = {k: np.array([output_harmonic(pb, k, W, u[k], row) for row in range(2 + n)]) for k in ks}
    values = _map_multipliers(search, odd, X, H, W) if of_map is None else of_map
    multipliers = values**2 if odd and np.all(np.isfinite(values)) else values
    multipliers = multipliers[np.argsort(-np.abs(multipliers))]
    peaks = []
    for row in range(2):
        series = np.zeros(H + 1, complex)
        for k in ks:
            series[k] = rows[k][row]
        peaks.append(float(peak_of(series, H, odd)))
    check = X.copy()
    _, _, truncation = solve_at(pb, odd, W, check, H, H, np.inf, 3)
    return PeriodicResponse(
        frequency=W,
        harmonics={k: frozen(values[2:], complex) for k, values in rows.items()},
        multipliers=frozen(multipliers, complex),
        stable=bool(unstable_count(multipliers) == 0),
        pipe_peak=peaks[0],
        relative_peak=peaks[1],
        pipe_amplitude=float(abs(rows[1][0])),
        relative_amplitude=float(abs(rows[1][1])),
        element_amplitudes=_element_amplitudes(search.system, rows[1][2:]),
        residual=float(truncation),
        symmetric=odd,
    )


def _element_amplitudes(system: System, X: Complexes) -> Floats:
    return frozen([abs(element.direction @ X) for element in system.elements])


def _same(a: PeriodicResponse, b: PeriodicResponse) -> bool:
    return bool(np.allclose(a.state, b.state, rtol=_SAME, atol=_SAME_REST * max(a.relative_peak, _TINY)))


def _linear(system: System, W: float) -> PeriodicResponse:
    """The only response of a linear or unforced system (its rest, where nothing drives it)."""
    check_rest(system)
    X = linear_response(system, np.array([W]))[0]
    multipliers = np.exp(linear_exponents(system) * 2 * np.pi / W)
    first = system.elements[0].direction if system.elements else np.zeros(system.size)
    pipe, relative = float(abs(system.output @ X)), float(abs(first @ X))
    order = np.argsort(-np.abs(multipliers))
    return PeriodicResponse(
        frequency=W,
        harmonics={1: frozen(X, complex)},
        multipliers=frozen(multipliers[order], complex),
        stable=bool(unstable_count(multipliers) == 0),
        pipe_peak=pipe,
        relative_peak=relative,
        pipe_amplitude=pipe,
        relative_amplitude=relative,
        element_amplitudes=_element_amplitudes(system, X),
        residual=0.0,
        symmetric=True,
    )
