"""Responses of several absorbers at one frequency, continued from those of one harmonic, against other searches."""

import itertools

import numpy as np
import pytest
import scipy.integrate

import frahm
from frahm.harmonic_balance import responses as module
from frahm.harmonic_balance.branches import find_branches
from frahm.harmonic_balance.condensation import condense, unknowns
from frahm.harmonic_balance.continued import continued
from frahm.harmonic_balance.follow import MIRRORED
from frahm.harmonic_balance.over_force import follow_over_force
from frahm.harmonic_balance.responses import periodic_responses_of, responses_on
from frahm.harmonic_balance.search import search_over

PIPE = frahm.build_system("jacket-pipe")
HOST, OMEGA = PIPE.mass[0, 0], PIPE.reference_frequency
THREE = [(200, 0.004, 0.007), (367.38, 0.0039, 0.0067), (900, 0.006, 0.0063)]


def random_star(number):
    """A pipe with 2, 3 or 4 random sinks and a detuning."""
    random = np.random.default_rng(1000 + number)
    count = 2 + number % 3
    sinks = 10 ** random.uniform([1.8, -2.7, -2.5], [3.3, -2.0, -1.7], (count, 3))
    return star(sinks, 10 ** random.uniform(-0.5, 0.5)), random.uniform(-0.3, 0.5)


def star(sinks, force=1.0):
    n = len(sinks) + 1
    M, C, K = np.diag([1.0, *(rho2 for *_, rho2 in sinks)]), np.zeros((n, n)), np.zeros((n, n))
    C[0, 0], K[0, 0] = PIPE.damping[0, 0], PIPE.stiffness[0, 0]
    directions = np.eye(n)[1:] - np.eye(n)[0]
    elements = [
        frahm.Element(direction, frahm.Cubic(kappa * HOST, xi2 * HOST))
        for direction, (kappa, xi2, _) in zip(directions, sinks, strict=True)
    ]
    return frahm.System(HOST * M, C, K, force * PIPE.forcing[0] * np.eye(n)[0], elements, reference_frequency=OMEGA)


def repeats(system, response):
    """How far the equations, integrated over a period, lead from the state of a response, relative to it."""
    n, W = system.size, response.frequency

    def rates(t, s):
        x, v = s[:n], s[n:]
        force = system.forcing * np.cos(W * t) - system.damping @ v - system.stiffness @ x
        for e in system.elements:
            z, w = e.direction @ x, e.direction @ v
            force = force - e.direction * (e.law.cubic_stiffness * z**3 + e.law.damping * w)
        return np.concatenate([v, np.linalg.solve(system.mass, force)])

    start = np.concatenate([response.state[::2], response.state[1::2]])
    end = scipy.integrate.solve_ivp(rates, (0, response.period), start, method="DOP853", rtol=1e-11, atol=1e-14).y[
        :, -1
    ]
    return np.max(np.abs(end - start)) / np.max(np.abs(start))


@pytest.mark.parametrize("number", [12, 18, 21])
def test_no_response_on_a_branch_of_the_window_is_missing(number):
    """Two sinks with 3 to 5 responses: branches followed over the frequency know nothing of the force."""
    system, detuning = random_star(number)
    W = OMEGA + detuning
    found = frahm.periodic_responses(system, detuning=detuning)
    assert "continued" in found.searched
    search = search_over(system, W * 0.88, W * 1.12, None)
    on_branches = responses_on(search, find_branches(search, at=W), W)
    assert len(on_branches) >= 3
    for response in on_branches:
        assert min(np.max(np.abs(response.state - other.state)) for other in found) < 1e-7 * response.pipe_peak


def test_a_pair_that_higher_harmonics_bring_about_is_found():
    """The equations of one harmonic have neither response: the force of an extreme just misses there."""
    system, detuning = random_star(26)
    found = frahm.periodic_responses(system, detuning=detuning)
    assert "continued" in found.searched
    peaks = [(0.009660, 0.036819), (0.010467, 0.037502)]  # from branches over the frequency
    pair = [min(found, key=lambda r: abs(r.pipe_peak - x) + abs(r.relative_peak - z)) for x, z in peaks]
    np.testing.assert_allclose([(r.pipe_peak, r.relative_peak) for r in pair], peaks, rtol=1e-4)
    assert [r.stable for r in pair] == [False, True]
    assert max(repeats(system, r) for r in pair) < 1e-7
    one = frahm.periodic_responses(system, detuning=detuning, harmonics=1)
    nearest = [min(abs(o.pipe_amplitude / r.pipe_amplitude - 1) for o in one) for r in pair]
    assert max(nearest) > 1e-2


@pytest.mark.parametrize(("number", "symmetric", "count"), [(25, 5, 17), (300, 1, 3)])
def test_asymmetric_responses_are_found_with_their_mirror_images(number, symmetric, count):
    """Of the first system branches over the frequency led to 13 of 17 within their limit of work."""
    system, detuning = random_star(number)
    found = frahm.periodic_responses(system, detuning=detuning)
    assert [sum(r.symmetric for r in found), len(found)] == [symmetric, count]
    assert found.unverified == ()
    assert "continued" in found.searched
    assert max(repeats(system, r) for r in found) < 1e-6  # multipliers up to 7.6 enlarge what the integration misses
    halves = [r for r in found if not r.symmetric]
    for r in halves:
        mirrored = -np.ravel(np.column_stack([r.x(r.period / 2)[0], velocity(r, r.period / 2)]))
        assert min(np.max(np.abs(o.state - mirrored)) for o in halves) < 1e-7 * r.pipe_peak


def velocity(response, time):
    W = response.frequency
    return sum((1j * k * W * X * np.exp(1j * k * W * time)).real for k, X in response.harmonics.items())


def test_where_the_indices_do_not_add_up_the_search_begins(monkeypatch):
    system, detuning = random_star(12)
    whole = frahm.periodic_responses(system, detuning=detuning)

    def without_one(search, W):
        symmetric, asymmetric = continued(search, W)
        return symmetric[1:], asymmetric

    monkeypatch.setattr(module, "continued", without_one)
    searched = periodic_responses_of(system, OMEGA + detuning, None)
    assert "Branches were followed" in searched.searched
    assert len(searched) == len(whole)
    for one, other in zip(whole, searched, strict=True):
        np.testing.assert_allclose(other.state, one.state, rtol=1e-6, atol=1e-9 * one.relative_peak)


def test_the_curve_over_the_force_leads_from_each_response_of_one_sink_to_the_others():
    system = star([(367.38, 0.0085, 0.02)])
    W, H = OMEGA - 0.144, 19
    found = frahm.periodic_responses(system, detuning=-0.144)
    assert len(found) == 3
    problem = condense(system)
    n = unknowns(problem, H, True)
    unknown = []
    for response in found:
        z = np.array(
            [
                response.harmonics[k] @ system.elements[0].direction
                for k in range(1, H + 1, 2)
                if k in response.harmonics
            ]
        )
        X = np.zeros(n)
        X[: 2 * z.size] = np.column_stack([z.real, z.imag]).ravel()[:n]
        unknown.append(X)
    scale = np.max(np.abs(unknown))
    for X in unknown:
        met = [X]
        for side in (-1.0, 1.0):
            out = np.empty((16, n))
            count, _, ended = follow_over_force(
                problem, True, H, W, np.append(X / scale, 1.0), np.eye(n + 1)[n], 0.01, 20.0, side, scale, 0.1, 500,
                out, np.empty((16, n + 1)),
            )  # fmt: skip
            assert ended
            met += list(out[:count])
        for other in unknown:
            assert min(np.max(np.abs(other - m)) for m in met) < 2e-3 * scale


def test_an_asymmetric_branch_ends_where_its_mirror_image_begins():
    search = search_over(star(THREE[:2]), OMEGA - 0.1, OMEGA - 0.02, None)
    halves = [branch for branch in find_branches(search) if not branch.odd]
    assert halves
    assert any(MIRRORED in branch.endings for branch in halves)
    for branch in halves:  # nowhere does it cross over to the other one of the pair
        points, r = branch.points, search.problem.M11.shape[0]
        even = [points.ys[i, : 8 * r].reshape(-1, 2 * r)[::2].ravel() for i in range(len(points.Hs))]
        assert all(a @ b >= 0 for a, b in itertools.pairwise(even))
