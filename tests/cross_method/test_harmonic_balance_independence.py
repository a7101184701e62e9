"""What the exact response finds does not depend on how it was looked for."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

import frahm
from frahm.harmonic_balance import branches, find_branches, following, search_over, starts
from frahm.harmonic_balance.bifurcations import unstable_count
from frahm.harmonic_balance.starts import Starts
from frahm.systems import with_parameters
from searching import at_most

LO, HI = 0.7, 1.35
quickly = at_most(12, more=4)


@st.composite
def systems(draw, modes=(1, 2)):
    """A host with one sink between nearly linear and strongly modulated."""
    count = draw(st.sampled_from(modes))
    zeta = 10 ** draw(st.floats(-2.6, -1.5))
    mass = 10 ** draw(st.floats(-2, -1))
    damping = draw(st.floats(0.08, 0.5)) * mass
    kappa = mass * 10 ** draw(st.floats(-1.5, 1)) / (0.3 / (2 * zeta)) ** 2
    omega = np.array([1.0, 1 + draw(st.floats(0.5, 2.5))])[:count]
    shape = np.array([1.0, draw(st.floats(-1, 1))])[:count]
    return frahm.System(
        np.diag([*np.ones(count), mass]), np.diag([*(2 * zeta * omega), 0]), np.diag([*omega**2, 0]), [*shape, 0],
        [frahm.Element([*-shape, 1], frahm.Cubic(kappa, damping))], output=[*shape, 0],
    )  # fmt: skip


def points_of(*curves):
    return sorted((p.frequency, p.kind, p.relative_peak) for curve in curves for p in curve.special_points)


def assert_same_points(found, expected, tolerance=1e-8):
    """The same special points, in any order where two lie at one frequency (a mirrored pair, or a double resonance)."""
    assert len(found) == len(expected), (found, expected)
    left = list(expected)
    for frequency, kind, peak in found:
        match = [p for p in left if p[1] == kind and abs(p[0] - frequency) < tolerance and abs(p[2] / peak - 1) < 1e-4]
        assert match, (frequency, kind, peak, expected)
        left.remove(match[0])


def responses_at(curve, W):
    """How many responses of a curve there are at one frequency, and how many of them are stable."""
    total = stable = 0
    for branch in curve.branches:
        for piece in np.unique(branch.piece):
            on = branch.piece == piece
            f, growth = branch.frequency[on], branch.growth_rate[on]
            crossing = np.flatnonzero((f[:-1] - W) * (f[1:] - W) < 0)
            total += crossing.size
            stable += int(np.sum(growth[crossing] + growth[crossing + 1] < 0))  # one end may be a special point
    return total, stable


def assert_same_responses(curves, others):
    special = np.array([p[0] for p in points_of(*curves)])
    for W in np.linspace(LO, HI, 38)[1:-1]:
        if special.size and np.min(np.abs(special - W)) < 2e-3:
            continue
        counts = [np.sum([responses_at(c, W) for c in side], axis=0) for side in (curves, others)]
        np.testing.assert_array_equal(counts[0], counts[1], err_msg=f"at {W}")


@given(systems(), st.floats(0.85, 1.2))
@quickly
def test_one_window_or_two_halves(system, split):
    whole = frahm.frequency_response(system, frequency=(LO, HI))
    halves = [frahm.frequency_response(system, frequency=window) for window in ((LO, split), (split, HI))]
    if any(abs(p[0] - split) < 1e-6 for p in points_of(whole)):
        return
    assert_same_points(points_of(*halves), points_of(whole))
    assert_same_responses([whole], halves)


@given(systems())
@quickly
def test_from_which_end_the_search_starts(system):
    original = branches.starts_of

    def reversed_starts(search):
        found = original(search)
        return Starts(found.everywhere[::-1], found.third[::-1], found.extremes[::-1])

    expected = frahm.frequency_response(system, frequency=(LO, HI))
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(branches, "starts_of", reversed_starts)
        found = frahm.frequency_response(system, frequency=(LO, HI))
    assert_same_points(points_of(found), points_of(expected))
    assert_same_responses([found], [expected])
    assert found.detached == expected.detached


@pytest.mark.parametrize(
    "setting",
    [
        (following, "_LONGEST", 0.007),
        (following, "_LONGEST", 0.031),
        (starts, "_SEED_FREQUENCIES", 80),
        (starts, "_SEED_FREQUENCIES", 81),
        (starts, "_GRID", 282),
    ],
)
@given(system=systems())
@at_most(6, more=4)
def test_steps_and_grids(setting, system):
    expected = frahm.frequency_response(system, frequency=(LO, HI))
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(*setting)
        found = frahm.frequency_response(system, frequency=(LO, HI))
    assert_same_points(points_of(found), points_of(expected))
    assert_same_responses([found], [expected])


@given(systems(modes=(1,)))
@at_most(8, more=4)
def test_number_of_harmonics(system):
    expected = frahm.frequency_response(system, frequency=(LO, HI))
    found = frahm.frequency_response(system, frequency=(LO, HI), harmonics=45)
    assert_same_points(points_of(found), points_of(expected), tolerance=1e-7)
    assert_same_responses([found], [expected])


@given(systems())
@quickly
def test_special_points_account_for_every_change_of_the_number_of_unstable_multipliers(system):
    sizes = {"saddle-node": 1, "branch-point": 1, "period-doubling": 1, "neimark-sacker": 2}
    found = find_branches(search_over(system, LO, HI, None))
    located = [(branch, event) for branch in found for event in branch.bifurcations if event.located]
    for branch in found:
        special = {}
        for owner, event in located:  # an asymmetric branch begins at a point of the symmetric one
            rows = np.flatnonzero(np.all(branch.points.columns == event.columns, axis=1))
            assert rows.size or owner is not branch
            special |= {int(row): sizes[event.kind] for row in rows[:1]}
        counts = unstable_count(branch.points.multipliers)
        W, before, passed = branch.points.frequency, None, 0
        for i, count in enumerate(counts):
            if i > 0 and W[i] == W[i - 1]:
                before, passed = None, 0  # the branch was outside the window in between
            if i in special:
                passed += special[i]
                continue
            if before is not None:
                assert abs(count - before) <= passed
                assert (count - before - passed) % 2 == 0
            before, passed = count, 0


@pytest.mark.parametrize("window", [(3.43, 6.37), (4.5, 5.3)])
def test_a_small_detached_curve_is_found_whatever_the_window(window):
    # born at 1.0386 times the force; the one-harmonic equations have theirs a little beside it
    case = frahm.load_case("jacket-pipe").with_absorber(kappa=3016.2478, xi2=0.0574099, rho2=0.02)
    system = with_parameters(frahm.build_system(case), force=1.05)
    curve = frahm.frequency_response(system, frequency=window)
    assert curve.detached == (False, True)
    assert curve.largest()[0] == pytest.approx(0.03109, rel=1e-3)
