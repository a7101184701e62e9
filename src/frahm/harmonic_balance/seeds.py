"""Where branches are looked for: every root of the first-harmonic problem, and of the superharmonic ones.

With one nonlinear element, or parallel ones, whose springs are odd polynomials, the first-harmonic problem
S Z + k(|Z|^2) Z = F is one polynomial in |Z|^2, so its roots are known completely at any frequency; the same holds for
a free third harmonic beside a given first one. With one element of any other law, and for motions about another mean
than 0, the roots are searched on a dense grid of amplitudes (`describing`). Those of several cubic elements that one
motion drives are found along one unknown (`shared_drive`); otherwise, with several elements, they are searched by
Newton's method from a fixed, spread set of starts. The result says which.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, field

import numpy as np

from frahm.absorbers.packed import law_force_and_slopes
from frahm.arrays import Complexes, Floats
from frahm.harmonic_balance.condensation import CondensedSystem, stiffness_at, stiffness_over, unknowns
from frahm.harmonic_balance.describing import AmplitudeTable, amplitude_table, outer_balances
from frahm.harmonic_balance.newton import solve_at
from frahm.harmonic_balance.shared_drive import Solutions, shared_stiffnesses, solutions_at
from frahm.polynomials import REAL, cubic_roots

_STARTS = 48
_TWO_HARMONIC_STARTS = 16
_ROUNDING = 1e-9
_SAME = 1e-6  # relative difference of two solutions that are one
_NOTHING = 1e-12  # of the scale: solutions that are all but zero are one


@dataclass(frozen=True)
class Seed:
    """A start for Newton's method: Omega and complex harmonics {k: (r,)}."""

    frequency: float
    harmonics: dict[int, Complexes]


@dataclass(frozen=True)
class Extreme:
    """A first-harmonic motion at which the force it needs is extreme over amplitude and Omega, see `births`.

    sign is +1 for a minimum and -1 for a maximum; `odd` says whether it is followed without even harmonics.
    """

    frequency: float
    harmonics: dict[int, Complexes]
    sign: int
    odd: bool

    @property
    def largest(self) -> int:
        """Coordinate with the largest first harmonic."""
        return int(np.argmax(np.abs(self.harmonics[1])))


def spring_polynomial(pb: CondensedSystem) -> Floats | None:
    """Coefficients e_i of k(N) = sum_i e_i N^i, equivalent stiffness at N = |U|^2, of the odd polynomials at u = U."""
    if pb.directions.shape[0] != 1 or pb.degree == 0 or not pb.odd:
        return None
    e = np.zeros((int(np.max(pb.codes[:, 2])) + 1) // 2)
    for (_, start, count), d in zip(pb.codes, pb.directions[0], strict=True):
        c = pb.table[start + 1 : start + 1 + count][::-1]  # c_1 ... c_p
        for k in range(1, count + 1, 2):
            e[(k - 1) // 2] += c[k - 1] * math.comb(k, (k - 1) // 2) / 2 ** (k - 1) * d ** (k + 1)
    return e[: max(1, int(np.max(np.nonzero(e)[0], initial=0)) + 1)]


def amplitude_roots(S: complex, F: complex, e: Floats) -> Floats:
    """All |Z|^2 > 0 with |S + k(N)|^2 N = |F|^2, ascending."""
    if e.size == 2 and e[0] == 0:
        count, *roots = cubic_roots(complex(S), complex(F), e[1])
        return np.array(roots[:count])
    real = np.polynomial.Polynomial([S.real + e[0], *e[1:]])
    polynomial = np.polynomial.Polynomial([0, 1]) * (real * real + S.imag**2) - abs(F) ** 2
    roots = polynomial.trim().roots()
    keep = (np.abs(roots.imag) < REAL * np.abs(roots)) & (roots.real > 0)
    return np.sort(roots[keep].real)


def single_element_seeds(pb: CondensedSystem, W: float, e: Floats) -> list[Seed]:
    """All first-harmonic roots at one frequency, and those with a large free third harmonic beside each of them."""
    S, F = stiffness_at(pb, 1, W)
    S3, _ = stiffness_at(pb, 3, W)
    seeds = []
    for N in amplitude_roots(S[0, 0], F[0], e):
        Z = F[0] / (S[0, 0] + np.polynomial.polynomial.polyval(N, e))
        seeds.append(Seed(W, {1: np.array([Z])}))
        seeds += [Seed(W, {1: np.array([Z]), 3: np.array([Z3])}) for Z3 in third_harmonics(S3[0, 0], Z, e)]
    return seeds


def third_harmonics(S3: complex, Z: complex, e: Floats) -> list[complex]:
    """Third harmonics that a cubic spring admits beside Z, when there is more than the one that vanishes with it."""
    if e.size < 2:
        return []
    k = e[1]  # 3/4 of the cubic coefficient: k |Z3|^2 Z3 + 2 k |Z|^2 Z3 + k Z^3 / 3
    shifted, drive = S3 + e[0] + 2 * k * abs(Z) ** 2, -k * Z**3 / 3
    count, *roots = cubic_roots(shifted, drive, k)
    return [drive / (shifted + k * N) for N in roots[:count]] if count > 1 else []


def two_harmonic_seeds(pb: CondensedSystem, W: float, e: Floats) -> list[Seed]:
    """Solutions with harmonics 1 and 3 of one element, searched by Newton's method from a fixed spread of starts.

    Where the third harmonic is strong it changes the first, and solutions exist that no first-harmonic root leads to.
    """
    from scipy.stats import qmc  # takes half a second to load

    S, F = stiffness_at(pb, 1, W)
    radius = math.sqrt(np.max(amplitude_roots(S[0, 0], F[0], e), initial=0.0))
    sample = qmc.Halton(4, seed=1).random(_TWO_HARMONIC_STARTS)
    first = radius * (0.5 + 0.8 * sample[:, 0]) * np.exp(2j * np.pi * sample[:, 1])
    third = radius * 0.6 * sample[:, 2] * np.exp(2j * np.pi * sample[:, 3])
    found: list[Complexes] = []
    for start in np.stack([first, third], axis=1):
        X = np.zeros(unknowns(pb, 3, True) + 1)
        X[:4] = start.real[0], start.imag[0], start.real[1], start.imag[1]
        ok, _, _ = solve_at(pb, True, W, X, 3, 3, math.inf, 20)
        u = X[:4:2] + 1j * X[1:4:2]
        if ok and not any(np.max(np.abs(u - other)) < _SAME * np.max(np.abs(u)) for other in found):
            found.append(u)
    return [Seed(W, {1: u[:1], 3: u[1:]}) for u in found]


def searched_seeds(pb: CondensedSystem, W: float, scale: float, odd: bool) -> list[Seed]:
    """First-harmonic solutions with several elements, searched from a fixed spread set of starts.

    With `odd` those without a mean, otherwise with the means they come with.
    """
    from scipy.stats import qmc  # takes half a second to load

    r = pb.M11.shape[0]
    sample = qmc.Halton((2 if odd else 3) * r, seed=1).random(_STARTS)
    radius = scale * 10 ** (-2.5 + 2.8 * sample[:, :r])
    starts = radius * np.exp(2j * np.pi * sample[:, r : 2 * r])
    S, F = stiffness_at(pb, 1, W)
    starts = np.vstack([_linear(S, F), np.zeros(r), starts])
    means = np.zeros((len(starts), r))
    if not odd:
        means[2:] = 1.5 * scale * (2 * sample[:, 2 * r :] - 1)
    found: list[Complexes] = []
    for start, mean in zip(starts, means, strict=True):
        X = np.zeros(unknowns(pb, 1, odd) + 1)
        at = 0 if odd else 2 * r
        X[at : at + 2 * r] = np.column_stack([start.real, start.imag]).ravel()
        if not odd:
            X[: 2 * r : 2] = mean
        ok, _, _ = solve_at(pb, odd, W, X, 1, 1, math.inf, 30)
        u = X[: at + 2 * r : 2] + 1j * X[1 : at + 2 * r : 2]
        close = _SAME * (np.max(np.abs(u)) + _NOTHING * scale)
        if ok and not any(np.max(np.abs(u - other)) < close for other in found):
            found.append(u)
    return [Seed(W, {1: u} if odd else {0: u[:r], 1: u[r:]}) for u in found]


def _linear(S: Complexes, F: Complexes) -> Complexes:
    """Motion of the elements without their springs; none right at an undamped resonance, where it has no bound."""
    try:
        return np.asarray(np.linalg.solve(S, F), dtype=complex)
    except np.linalg.LinAlgError:
        return np.zeros(len(F), dtype=complex)


@dataclass(frozen=True)
class Seeder:
    """Starts at any frequency of a window: in closed form, from a table of amplitudes, or searched."""

    problem: CondensedSystem
    spring: Floats | None  # equivalent stiffness of one odd polynomial element, see `spring_polynomial`
    table: AmplitudeTable | None  # of one element otherwise, or of its motions about other means
    buckled: bool  # whether an odd system has other equilibria, wells or tops, about which it may respond
    shared: Floats | None = None  # cubic stiffnesses of several coordinates that one motion drives, see `shared_drive`
    doubtful: set[float] = field(default_factory=set)  # frequencies at which not all of their solutions were found
    solved: dict[float, Solutions] = field(default_factory=dict)  # by frequency

    def at(self, W: float, scale: float, first_only: bool = False) -> list[Seed]:
        """All starts at Omega = W [rad/s]; `first_only` leaves out free third harmonics and searches."""
        pb = self.problem
        seeds: list[Seed] = []
        if self.spring is not None:
            seeds = single_element_seeds(pb, W, self.spring)
            seeds = [seed for seed in seeds if 3 not in seed.harmonics] if first_only else seeds
        if self.table is not None:
            S, F = stiffness_at(pb, 1, W)
            for mean, u in self.table.roots(pb, W, complex(S[0, 0]), complex(F[0])):
                still = {} if pb.odd and mean == 0 else {0: np.array([mean])}
                seeds.append(Seed(W, {**still, 1: np.array([u])}))
        if pb.directions.shape[0] == 1:
            return seeds
        if first_only:
            S, F = stiffness_at(pb, 1, W)
            return [Seed(W, {1: _linear(S, F)})]
        if self.shared is None:
            seeds = searched_seeds(pb, W, scale, pb.odd)
        else:
            seeds = [Seed(W, {1: u}) for u in self.solutions(W).harmonics]
        return seeds + searched_seeds(pb, W, scale, False) if self.buckled else seeds

    def solutions(self, W: float) -> Solutions:
        """All first-harmonic solutions of several elements that one motion drives at Omega = W [rad/s]."""
        assert self.shared is not None
        if W not in self.solved:
            self.solved[W] = solutions_at(self.problem, W, self.shared)
            if not self.solved[W].complete:
                self.doubtful.add(W)
        return self.solved[W]


def seeder_for(pb: CondensedSystem, window: Floats) -> Seeder:
    """Seeder of a condensed problem for frequencies spread over a window [rad/s]."""
    spring = spring_polynomial(pb)
    if pb.directions.shape[0] != 1:
        return Seeder(pb, None, None, pb.odd and _may_buckle(pb, float(window[0])), shared_stiffnesses(pb, window))
    rest = float(stiffness_at(pb, 0, 1.0)[0][0, 0].real)
    if abs(rest) < _ROUNDING * abs(stiffness_at(pb, 1, float(window[0]))[0][0, 0]):
        rest = 0.0  # of an absorber that nothing but its nonlinear spring holds: its rounding makes no two wells
    if spring is not None and rest >= 0 and np.all(spring >= 0):
        return Seeder(pb, spring, None, False)
    buckled = bool(pb.odd and outer_balances(pb, rest) > 0)
    if spring is not None and not buckled:
        return Seeder(pb, spring, None, False)
    stiffness, force = stiffness_over(pb, 1, window)
    S, F = stiffness[:, 0, 0], force[:, 0]
    with np.errstate(divide="ignore"):
        damped = np.where(S.imag > 0, np.abs(F) / S.imag, np.inf)
        linear = np.abs(F) / np.abs(S)
    table = amplitude_table(pb, rest, linear[np.isfinite(linear)], damped, symmetric=spring is None)
    return Seeder(pb, spring, table, buckled)


def _may_buckle(pb: CondensedSystem, W: float) -> bool:
    """Whether the middle, or an element by itself, may be unstable without motion.

    An absorber that nothing but its nonlinear spring holds has no static stiffness; its rounding is none either.
    """
    K = stiffness_at(pb, 0, 1.0)[0].real.copy()
    K[np.abs(K) < _ROUNDING * np.max(np.abs(stiffness_at(pb, 1, W)[0]))] = 0.0
    for e, code in enumerate(pb.codes):
        slope = law_force_and_slopes(code[0], code[1], code[2], pb.table, 0.0, 0.0)[1]
        K += slope * np.outer(pb.directions[:, e], pb.directions[:, e])
    return bool(np.min(np.linalg.eigvalsh((K + K.T) / 2), initial=0.0) < -_ROUNDING * np.max(np.abs(K), initial=0.0))
