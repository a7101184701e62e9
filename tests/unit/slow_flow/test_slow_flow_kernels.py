"""Closed forms against numerical linear algebra at random parameters."""

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from frahm.polynomials import growth_rate
from frahm.slow_flow import SlowFlow
from frahm.slow_flow.kernels import (
    EVEN,
    ODD,
    STABLE,
    characteristic,
    equilibria,
    hurwitz,
    linear_parts,
    pipe_amplitude,
    stability_class,
)
from frahm.slow_flow.motion import slow_jacobian, slow_velocity
from searching import at_most

OMEGA = 2 * math.pi * 0.78


@st.composite
def slow_flows(draw):
    log = lambda lo, hi: 10 ** draw(st.floats(lo, hi))  # noqa: E731
    return SlowFlow(
        omega=OMEGA,
        xi1=log(-3, -0.5),
        xi2=log(-3.5, -0.5),
        kappa=log(0, 4.5),
        rho2=log(-2.5, -0.5),
        force=log(-4, -1),
        form=draw(st.sampled_from(["averaged", "paper"])),
    )


def equilibrium_states(slow, W):
    """X, Z at every equilibrium, with the phase from (d0 + n s0) Z = e F."""
    _, _, d0, _, s0, e, g2 = linear_parts(slow.code, W, *slow.host)
    count, *roots = equilibria(d0, s0, e, slow.force, slow.kappa)
    for N in roots[:count]:
        n = 0.75 * slow.kappa * N
        Z = e * slow.force / (d0 + n * s0)
        yield n, (g2 + n - e) * Z / e, Z


@at_most(200)
@given(slow_flows(), st.floats(-0.4, 0.4))
def test_every_root_is_an_equilibrium_and_none_is_missing(slow, sigma):
    W = OMEGA + sigma
    _, _, d0, _, s0, e, g2 = linear_parts(slow.code, W, *slow.host)
    k = 0.75 * slow.kappa
    cubic = [k * k * abs(s0) ** 2, 2 * k * (d0 * s0.conjugate()).real, abs(d0) ** 2, -((e * slow.force) ** 2)]
    roots = np.roots(cubic)
    separation = min(abs(a - b) for i, a in enumerate(roots) for b in roots[:i]) / np.max(np.abs(roots))
    found = list(equilibrium_states(slow, W))
    for n, X, Z in found:
        dX, dZ = slow_velocity(slow.code, *slow.host, slow.force, slow.kappa, W, X, Z)
        rate = OMEGA * (abs(X) + abs(Z)) + slow.force
        assert abs(dX) + abs(dZ) < 1e-7 * rate
        assert pipe_amplitude(abs(Z) ** 2, n, e, g2) == pytest.approx(abs(X), rel=1e-12)
    if separation > 1e-5:
        real = np.sort(roots[(np.abs(roots.imag) < 1e-9 * np.abs(roots)) & (roots.real > 0)].real)
        assert [abs(Z) ** 2 for _, _, Z in found] == pytest.approx(list(real), rel=1e-6)


@at_most(200)
@given(slow_flows(), st.floats(-0.4, 0.4))
def test_characteristic_polynomial_routh_hurwitz_and_eigenvalues_agree(slow, sigma):
    W = OMEGA + sigma
    d2, d1, d0, s1, s0, _, _ = linear_parts(slow.code, W, *slow.host)
    for n, _, Z in equilibrium_states(slow, W):
        J = slow_jacobian(slow.code, *slow.host, slow.kappa, W, Z)
        deltas = characteristic(d2, d1, d0, s1, s0, n)
        expected = np.poly(J)[1:]
        size = np.max(np.abs(np.linalg.eigvals(J)))
        assert np.array(deltas) / size ** np.arange(1, 5) == pytest.approx(expected / size ** np.arange(1, 5), abs=1e-8)
        eigenvalues = np.linalg.eigvals(J)
        assert growth_rate(*deltas) == pytest.approx(np.max(eigenvalues.real), abs=1e-5 * size)
        if np.min(np.abs(eigenvalues.real)) > 1e-5 * size:
            unstable = int(np.sum(eigenvalues.real > 0))
            expected_class = STABLE if unstable == 0 else (ODD if unstable % 2 else EVEN)
            assert stability_class(*deltas) == expected_class


@at_most(100)
@given(slow_flows(), st.floats(-0.4, 0.4), st.tuples(*[st.floats(-1, 1)] * 4))
def test_jacobian_of_the_slow_flow_equals_differences(slow, sigma, direction):
    W = OMEGA + sigma
    X, Z = 0.02 + 0.01j, -0.03 + 0.02j
    dX, dZ = complex(*direction[:2]), complex(*direction[2:])
    h = 1e-6
    head = (slow.code, *slow.host, slow.force, slow.kappa, W)
    plus = np.array(slow_velocity(*head, X + h * dX, Z + h * dZ))
    minus = np.array(slow_velocity(*head, X - h * dX, Z - h * dZ))
    difference = (plus - minus) / (2 * h)
    J = slow_jacobian(slow.code, *slow.host, slow.kappa, W, Z)
    product = J @ np.array(direction)
    scale = np.max(np.abs(J)) + 1
    assert product[0::2] + 1j * product[1::2] == pytest.approx(difference, abs=2e-7 * scale)


def test_hurwitz_determinant_vanishes_for_an_imaginary_pair():
    deltas = np.poly([2j, -2j, -1.0, -3.0])[1:].real
    assert hurwitz(*deltas) == pytest.approx(0, abs=1e-12)


@pytest.mark.parametrize("kappa", [0.0, -40.0])
def test_linear_and_softening_springs_keep_to_the_equation(kappa):
    slow = SlowFlow(OMEGA, 0.0147, 0.0085, kappa, 0.02, 1e-4)
    for n, X, Z in equilibrium_states(slow, OMEGA + 0.05):
        assert n <= 0
        dX, dZ = slow_velocity(slow.code, *slow.host, slow.force, kappa, OMEGA + 0.05, X, Z)
        assert abs(dX) + abs(dZ) < 1e-15
