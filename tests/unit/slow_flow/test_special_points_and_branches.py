"""Special points and branches: against reference values, brute-force counting and each other."""

import itertools
import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from frahm.slow_flow import SlowFlow, boundary_curves, locate_points, slow_branches, slow_manifold
from frahm.slow_flow.kernels import characteristic, equilibria, hurwitz, linear_parts
from searching import at_most

OMEGA = 2 * math.pi * 0.78
XI1 = 2 * 0.0015 * OMEGA
FORCE = 0.5 * 0.4535 * 1.225 * 2.7**2 * 0.762 / 247


def seed(kappa=367.38, xi2=0.0085, form="averaged", **more):
    return SlowFlow(
        **{"omega": OMEGA, "xi1": XI1, "xi2": xi2, "kappa": kappa, "rho2": 0.02, "force": FORCE} | more, form=form
    )


def roots_at(slow, W):
    _, _, d0, _, s0, e, _ = linear_parts(slow.code, W, *slow.host)
    count, *roots = equilibria(d0, s0, e, slow.force, slow.kappa)
    return np.array(roots[:count])


@pytest.mark.parametrize(
    ("kappa", "form", "hopf", "saddle"),
    [
        (367.38, "averaged", [-0.01307, 0.05901], [-0.16809, -0.09737, 0.05099, 0.12949]),
        (367.38, "paper", [-0.01318, 0.05919], [-0.16602, -0.09689, 0.05130, 0.13296]),
        (97.97, "paper", [0.01164, 0.03482], [0.02783, 0.04015]),
        (24.425, "paper", [], []),
    ],
)
def test_special_points_of_the_seed_paper(kappa, form, hopf, saddle):
    slow = seed(kappa, form=form)
    for kind, expected in (("hopf", hopf), ("saddle-node", saddle)):
        points = locate_points(slow, kind, OMEGA - 0.4, OMEGA + 0.4)
        assert [p.frequency - OMEGA for p in points] == pytest.approx(expected, abs=1e-5)
        assert all(p.proven for p in points)


@at_most(60)
@given(
    st.floats(0.5, 3.7),
    st.floats(-3, -1),
    st.floats(-2.3, -0.7),
    st.floats(0.1, 3),
    st.sampled_from(["averaged", "paper"]),
)
def test_no_special_point_is_missed_that_a_fine_grid_can_see(log_kappa, log_xi2, log_rho2, load, form):
    slow = seed(10**log_kappa, 10**log_xi2, form, rho2=10**log_rho2, force=load * FORCE)
    lo, hi = OMEGA - 0.4, OMEGA + 0.4
    grid = np.linspace(lo, hi, 4001)
    counts = np.array([roots_at(slow, W).size for W in grid])
    changes = np.flatnonzero(np.diff(counts))
    folds = [p.frequency for p in locate_points(slow, "saddle-node", lo, hi)]
    for index in changes:
        assert any(grid[index] - 1e-9 <= W <= grid[index + 1] + 1e-9 for W in folds)
    # pairs closer than the grid may be invisible to it, never the other way round
    assert len(folds) >= len(changes)
    assert (len(folds) - len(changes)) % 2 == 0
    hopfs = [p.frequency for p in locate_points(slow, "hopf", lo, hi)]
    for a, b in itertools.pairwise(range(grid.size)):
        if counts[a] == counts[b] and not any(grid[a] <= W <= grid[b] for W in folds):
            tests = [_determinants(slow, grid[i]) for i in (a, b)]
            for (h0, c0), (h1, c1) in zip(*tests, strict=True):
                if h0 * h1 < 0 and c0 > 0 and c1 > 0:
                    assert any(grid[a] - 1e-9 <= W <= grid[b] + 1e-9 for W in hopfs)


def _determinants(slow, W):
    d2, d1, d0, s1, s0, _, _ = linear_parts(slow.code, W, *slow.host)
    deltas = [characteristic(d2, d1, d0, s1, s0, 0.75 * slow.kappa * N) for N in roots_at(slow, W)]
    return [(hurwitz(*d), d[2]) for d in deltas]


@pytest.mark.parametrize(
    ("kappa", "xi2", "detached"), [(367.38, 0.0085, [False, True]), (367.38, 0.0117, [False]), (97.97, 0.0085, [False])]
)
def test_detached_curve_of_the_seed_paper(kappa, xi2, detached):
    found = slow_branches(seed(kappa, xi2), OMEGA - 0.4, OMEGA + 0.4, 400)
    assert list(found.detached) == detached


@at_most(40)
@given(
    st.floats(0.5, 3.7),
    st.floats(-3, -1),
    st.floats(0.1, 3),
    st.floats(-0.3, 0.1),
    st.floats(0.02, 0.4),
    st.integers(2, 300),
)
def test_branches_hold_every_root_once(log_kappa, log_xi2, load, start, width, points):
    slow = seed(10**log_kappa, 10**log_xi2, force=load * FORCE)
    lo, hi = OMEGA + start, OMEGA + start + width
    found = slow_branches(slow, lo, hi, points)
    for W in np.linspace(lo, hi, points):
        here = np.isclose(found.frequency, W, rtol=0, atol=1e-13)
        expected = np.sqrt(roots_at(slow, W))
        assert sorted(found.relative_amplitude[here]) == pytest.approx(list(expected), rel=1e-9)
    first = np.argmin(np.where(np.isclose(found.frequency, lo, atol=1e-13), found.relative_amplitude, np.inf))
    assert found.branch[first] == 0


def test_points_follow_the_branch_without_jumps_and_the_closed_curve_closes():
    found = slow_branches(seed(), OMEGA - 0.4, OMEGA + 0.4, 4000)
    scale = np.array([0.8, found.relative_amplitude.max()])
    for number in (0, 1):
        on = found.branch == number
        path = np.column_stack([found.frequency[on], found.relative_amplitude[on]]) / scale
        assert np.max(np.linalg.norm(np.diff(path, axis=0), axis=1)) < 0.02
        if found.detached[number]:
            assert path[0] == pytest.approx(path[-1], abs=1e-12)


def test_a_window_that_cuts_the_detached_curve_keeps_it_in_one_branch():
    found = slow_branches(seed(), OMEGA - 0.12, OMEGA + 0.12, 500)
    assert list(found.detached) == [False, True]
    pieces = [len(np.unique(found.piece[found.branch == number])) for number in (0, 1)]
    assert pieces == [2, 1]  # the main branch leaves the window at the right and comes back


def test_result_does_not_depend_on_the_grid():
    reference = slow_branches(seed(), OMEGA - 0.4, OMEGA + 0.4, 1000).points
    for points in (2, 80, 81):
        other = slow_branches(seed(), OMEGA - 0.4, OMEGA + 0.4, points).points
        assert [p.frequency for p in other] == [p.frequency for p in reference]


@pytest.mark.parametrize(
    ("lam", "low", "high"), [(0.2, 0.35397, 0.97936), (0.1, 0.33837, 0.99496), (0.4, 0.42630, 0.90704)]
)
def test_folds_of_the_slow_manifold(lam, low, high):
    slow = seed(xi2=lam * 0.02 * OMEGA)
    folds = slow_manifold(slow).folds
    assert folds.nu == pytest.approx((low, high), abs=5e-6)
    Z = np.linspace(0, 2 * folds.relative[1], 200001)
    X = slow_manifold(slow).pipe_amplitude(Z)
    turning = np.flatnonzero(np.diff(np.sign(np.diff(X)))) + 1
    assert Z[turning] == pytest.approx(folds.relative, rel=1e-4)
    assert slow_manifold(slow).pipe_amplitude(folds.landing) == pytest.approx(folds.pipe, rel=1e-12)


def test_slow_manifold_has_no_folds_above_the_critical_damping():
    assert slow_manifold(seed(xi2=0.0601 * OMEGA / math.sqrt(3) / 3)).folds is None


@pytest.mark.parametrize(("kappa", "ceiling"), [(97.97, 0.0314), (367.38, 0.0162)])
def test_ceiling_of_the_modulated_response(kappa, ceiling):
    assert slow_manifold(seed(kappa)).folds.pipe_ceiling == pytest.approx(ceiling, abs=5e-5)


@pytest.mark.parametrize(
    ("plane", "bounds"),
    [
        (("detuning", "kappa"), ((-0.4, 0.4), (0, 1000))),
        (("force", "detuning"), ((0, 2), (-0.4, 0.4))),
        (("detuning", "xi2"), ((-0.4, 0.4), (0, 0.03))),
        (("rho2", "detuning"), ((0.002, 0.05), (-0.2, 0.2))),
        (("xi2", "rho2"), ((0.001, 0.03), (0.005, 0.05))),
        (("kappa", "force"), ((10, 1000), (0.2, 2))),
    ],
)
def test_boundaries_are_special_points_of_the_curves_they_cross(plane, bounds):
    slow = seed()
    curves = boundary_curves(slow, plane, bounds, 0.0, 120)
    assert curves
    for curve in curves:
        for x, y in list(zip(curve.x, curve.y, strict=True))[:: max(1, curve.x.size // 6)]:
            values = {plane[0]: x, plane[1]: y}
            W = OMEGA + values.pop("detuning", 0.0)
            values["force"] = values.get("force", 1.0) * FORCE
            points = locate_points(slow.with_values(**values), curve.kind, W - 2e-3, W + 2e-3)
            assert min((abs(p.frequency - W) for p in points), default=1) < 1e-8


def test_boundaries_cross_the_seed_design_where_its_special_points_are():
    curves = boundary_curves(seed(), ("detuning", "kappa"), ((-0.4, 0.4), (0, 1000)), 0.0, 400)
    crossings = {"hopf": [], "saddle-node": []}
    for curve in curves:
        for i in np.flatnonzero(np.diff(np.sign(curve.y - 367.38))):
            t = (367.38 - curve.y[i]) / (curve.y[i + 1] - curve.y[i])
            crossings[curve.kind].append(curve.x[i] + t * (curve.x[i + 1] - curve.x[i]))
    assert sorted(crossings["hopf"]) == pytest.approx([-0.01307, 0.05901], abs=1e-4)
    assert sorted(crossings["saddle-node"]) == pytest.approx([-0.16809, -0.09737, 0.05099, 0.12949], abs=1e-4)
