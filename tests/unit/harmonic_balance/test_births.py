"""Detached curves beside their births, and responses beside the points where branches meet."""

import numpy as np
import pytest

import frahm
from frahm.harmonic_balance import search_over
from frahm.harmonic_balance.births import needed_force
from frahm.harmonic_balance.condensation import unknowns
from frahm.systems import with_parameters

# The first birth of a detached curve of this sink, in the force: `detached_curve_events` locates it.
SINK = frahm.build_system(
    frahm.load_case("jacket-pipe").with_absorber(kappa=570.7842260366, xi2=0.00867860812972, rho2=0.0169299115837)
)


@pytest.fixture(scope="module")
def birth():
    (event,) = (e for e in frahm.detached_curve_events(SINK, "force", (0.6, 0.75), slices=2) if e.kind == "birth")
    return event


@pytest.mark.parametrize(
    ("beside", "there"), [(-1e-2, False), (-1e-5, False), (1e-5, True), (5e-4, True), (1e-2, True)]
)
def test_a_detached_curve_is_found_however_near_its_birth(birth, beside, there):
    system, window = with_parameters(SINK, force=birth.value * (1 + beside)), (0.92, 1.08)
    curve = frahm.frequency_response(system, frequency=tuple(share * birth.frequency for share in window))
    assert any(curve.detached) == there
    assert curve.unverified == ()
    for branch in curve.branches:
        if branch.detached and beside < 1e-4:
            np.testing.assert_allclose(branch.frequency, birth.frequency, rtol=1e-4)
            np.testing.assert_allclose(branch.pipe_peak, birth.pipe_peak, rtol=0.02)


def test_too_near_a_birth_it_is_told_that_nothing_can_be_told(birth):
    curve = frahm.frequency_response(with_parameters(SINK, force=birth.value * (1 + 1e-8)), detuning=(-0.4, 0.4))
    (sentence,) = curve.unverified
    assert f"near {birth.frequency:.6g} rad/s" in sentence


def test_the_worst_case_takes_a_detached_curve_just_born(birth):
    system = with_parameters(SINK, force=birth.value * 1.0005)
    worst = frahm.worst_case(system, frequency=(4.79, 4.805), samples=12, region=REGION)
    assert worst.pipe_peak == pytest.approx(birth.pipe_peak, rel=0.05)


# of initial states about the detached response
REGION = {"x1": (-0.03, 0.03), "v1": (-0.15, 0.15), "z": (-0.05, 0.05), "w": (-0.25, 0.25)}


def test_slopes_of_the_needed_force_against_differences():
    search = search_over(SINK, 4.7, 5.0, 5)
    H, W, a = 5, 4.8, 0.035
    X = np.zeros(unknowns(search.problem, H, True) + 1)

    def size(log_a, log_W):
        X[:] = 0.0
        X[0] = a * np.exp(log_a)
        ok, _, _, value, *slopes = needed_force(search.problem, H, True, W * np.exp(log_W), 0, X, 0j)
        assert ok
        return value, slopes

    _, slopes = size(0.0, 0.0)
    h = 1e-6
    assert slopes[0] == pytest.approx((size(h, 0)[0] - size(-h, 0)[0]) / (2 * h), rel=1e-6)
    assert slopes[1] == pytest.approx((size(0, h)[0] - size(0, -h)[0]) / (2 * h), rel=1e-6)


def test_both_asymmetric_responses_are_found_however_near_they_part():
    case = frahm.load_case("jacket-pipe").with_absorber(kappa=2076.2, xi2=0.0146, rho2=0.0119)
    system = with_parameters(frahm.build_system(case), force=2.2)
    curve = frahm.frequency_response(system, detuning=(-0.12, -0.08))
    (point,) = (p for p in curve.special_points if p.kind == "branch-point")
    apart = []
    for beside in (1e-7, 4e-7, 4e-6, 1.6e-5):
        found = frahm.periodic_responses(system, frequency=point.frequency + beside)
        assert [(r.stable, r.symmetric) for r in found if r.symmetric] == [(False, True)]
        one, other = (r for r in found if not r.symmetric)
        assert one.stable
        assert other.stable
        apart.append(np.linalg.norm(one.state - other.state))
        assert len(frahm.periodic_responses(system, frequency=point.frequency - beside)) == 1
    ratios = np.array(apart[1:]) / apart[:-1]  # they part as the square root of the distance
    np.testing.assert_allclose(ratios, np.sqrt([4, 10, 4]), rtol=0.02)


@pytest.mark.parametrize("half", [0.31, 0.6, 0.8])
def test_where_equal_sinks_part_is_located_from_every_window(half):
    curve = frahm.frequency_response("two-sinks", detuning=(-half, 1.03 * half))
    assert curve.unverified == ()
    points = [p for p in curve.special_points if p.kind == "branch-point"]
    for crossing in (4.8895666454, 4.9567492904):  # of the branches, as both of them tell it
        near = [p for p in points if abs(p.frequency - crossing) < 1e-6]
        assert {0} < {p.branch for p in near}
        assert all(p.interval[0] <= crossing <= p.interval[1] for p in near if p.branch == 0)
        assert all(p.interval[1] - p.interval[0] < 1e-6 for p in near)


def two_unequal_sinks(force):
    """The sink of above in two unequal parts, whose first detached curve is born at 0.65930816165 times the force.

    `detached_curve_events(system, "force", (0.6, 0.9), slices=2)` locates it, in most of a minute.
    """
    host, parts = SINK.mass[0, 0], ((0.45, 1.1), (0.55, 1.0))
    law, pipe = SINK.elements[0].law, np.diag([1.0, 0, 0])
    elements = [
        frahm.Element(np.eye(3)[1 + i] - np.eye(3)[0], law.scaled(share * stiffer, share))
        for i, (share, stiffer) in enumerate(parts)
    ]
    mass = np.diag([host, *(share * SINK.mass[1, 1] for share, _ in parts)])
    damping, stiffness = SINK.damping[0, 0] * pipe, SINK.stiffness[0, 0] * pipe
    forcing = force * 0.6593081616512304 * SINK.forcing[0] * np.eye(3)[0]
    return frahm.System(mass, damping, stiffness, forcing, elements, reference_frequency=SINK.reference_frequency)


@pytest.mark.parametrize(("force", "rings"), [(1 - 1e-5, 0), (1 + 1e-5, 1), (1 + 1e-3, 1)])
def test_a_detached_curve_of_two_unequal_sinks_is_found_however_near_its_birth(force, rings):
    curve = frahm.frequency_response(two_unequal_sinks(force), detuning=(-0.4, 0.4))
    near = [b for b in curve.branches if b.detached and np.all(np.abs(b.frequency - 4.797367267) < 0.01)]
    assert len(near) == rings
    assert curve.unverified == ()
