"""Jacobians of the defining equations of special points against differences."""

import numpy as np
import pytest

import frahm
from frahm.harmonic_balance import find_branches, search_over
from frahm.harmonic_balance.condensation import CondensedChange, coordinates, linear_part, unknowns
from frahm.harmonic_balance.detached import _second_derivatives
from frahm.harmonic_balance.fold_equations import FoldEquations
from frahm.harmonic_balance.seeds import stiffness_at
from frahm.harmonic_balance.torus_equations import TorusEquations
from frahm.systems import derivative_of, parameter_value, with_parameters

AXES = [
    ("frequency", "force"),
    ("frequency", "kappa"),
    ("rho2", "xi2"),
    ("frequency", "pipe_frequency"),
    ("kappa", "rho2"),
]


def sliding_pipe():
    """The jacket pipe with transverse springs, stops and friction instead of the cubic spring."""
    plain = frahm.build_system(frahm.load_case("jacket-pipe").with_absorber(kappa=367.38, xi2=0.0085))
    law = frahm.TransverseSprings(
        247 * 367.38 * 0.09, 0.3, 247 * 0.008, pretension=0.1, stops=frahm.Stops(0.04, 300.0, 0.04),
        friction=frahm.Friction(0.02, 0.05),
    )  # fmt: skip
    element = frahm.Element(plain.elements[0].direction, law)
    return frahm.System(plain.mass, plain.damping, plain.stiffness, plain.forcing, [element])


@pytest.fixture(scope="module", params=["cubic", "sliding"])
def found(request):
    system = frahm.build_system(frahm.load_case("jacket-pipe").with_absorber(kappa=367.38, xi2=0.0085))
    if request.param == "sliding":
        system = sliding_pipe()
    omega = system.reference_frequency
    search = search_over(system, omega - 0.2, omega + 0.2, None)
    return system, search, find_branches(search)


def first_point(found, kind):
    _, search, branches = found
    for branch in branches:
        for event in branch.bifurcations:
            if event.kind == kind:
                return search, branch, event.point
    raise AssertionError(kind)


def values_of(system, axes, W):
    return [W if axis == "frequency" else parameter_value(system, axis) for axis in axes]


def differences(function, y, h=1e-6):
    columns = []
    for j in range(y.size):
        step = np.zeros(y.size)
        step[j] = h
        columns.append((function(y + step) - function(y - step)) / (2 * h))
    J = np.column_stack(columns)
    return J / np.max(np.abs(J), axis=1)[:, None]


@pytest.mark.parametrize("axes", AXES)
def test_saddle_node_equations(found, axes):
    system = found[0]
    search, branch, point = first_point(found, "saddle-node")
    y, H = point.y, point.H
    n = unknowns(search.problem, H, branch.odd)
    values = values_of(system, axes, y[n])
    at = np.append(y[:n] / search.x_scale, [1.0, 1.0])
    equations = FoldEquations(system, axes, y[n], H, branch.odd, search.x_scale, tuple(values), at)
    R, J = equations.residual(at)
    assert np.max(np.abs(R)) < 1e-8
    weight = 1 / np.max(np.abs(equations.orbit(at).J), axis=1)
    b, c = equations.border

    def plain(y):
        orbit = equations.orbit(y)
        A = np.block([[weight[:, None] * orbit.J, b[:, None]], [c[None], np.zeros((1, 1))]])
        return np.append(weight * orbit.R, np.linalg.solve(A, np.eye(n + 1)[n])[n])

    assert pytest.approx(differences(plain, at), abs=1e-7) == J


@pytest.mark.parametrize("axes", AXES)
def test_neimark_sacker_equations(found, axes):
    system = found[0]
    search, branch, point = first_point(found, "neimark-sacker")
    y, H = point.y, point.H
    n = unknowns(search.problem, H, branch.odd)
    values = values_of(system, axes, y[n])
    y0 = y[n]
    at = np.append(y[:n] / search.x_scale, [1.0, 1.0, 0.3749 / y[n]])
    equations = TorusEquations(system, axes, y[n], H, branch.odd, search.x_scale, tuple(values), at)
    _, J = equations.residual(at)
    A, _ = equations._hill(equations.orbit(at), at[-1] * y0)
    weight = 1 / np.max(np.abs(A), axis=1)
    b, c = equations.border

    def plain(y):
        orbit = equations.orbit(y)
        A, _ = equations._hill(orbit, y[-1] * y0)
        M = np.block([[weight[:, None] * A, b[:, None]], [c.conj()[None], np.zeros((1, 1))]])
        g = np.linalg.solve(M, np.eye(len(M))[-1])[-1]
        return np.concatenate([orbit.R, [g.real, g.imag]])

    assert pytest.approx(differences(plain, at), abs=1e-7) == J


@pytest.mark.parametrize(("kind", "cls"), [("saddle-node", FoldEquations), ("neimark-sacker", TorusEquations)])
def test_a_residual_does_not_depend_on_which_point_was_asked_first(found, kind, cls):
    axes = ("frequency", "force")
    search, branch, point = first_point(found, kind)
    n = unknowns(search.problem, point.H, branch.odd)
    W = point.y[n]
    values = tuple(values_of(found[0], axes, W))
    at = np.append(point.y[:n] / search.x_scale, [1.0, 1.0] if kind == "saddle-node" else [1.0, 1.0, 0.3749 / W])
    first, second = (cls(found[0], axes, W, point.H, branch.odd, search.x_scale, values, at) for _ in range(2))
    away = at * np.append(np.full(n, -0.3), np.ones(at.size - n))
    first.residual(away)
    assert np.array_equal(first.residual(at)[0], second.residual(at)[0])
    assert np.array_equal(first.residual(away)[0], second.residual(away)[0])


@pytest.mark.parametrize("name", ["kappa", "xi2", "rho2", "force", "pipe_frequency"])
@pytest.mark.parametrize("s", [4.7j, 0.1 + 14j])
def test_condensed_derivatives_by_a_parameter(found, name, s):
    original = found[0]
    p = parameter_value(original, name)
    h = 1e-5 * p
    T, directions = coordinates(original)

    def condensed(value):
        system = with_parameters(original, **{name: value})
        C, K = linear_part(system)
        D = T.T @ (s * s * system.mass + s * C + K) @ T
        f = T.T @ system.forcing
        r = directions.shape[0]
        X = np.linalg.solve(D[r:, r:], np.column_stack([D[r:, :r], f[r:]]))
        return np.append(D[:r, :r] - D[:r, r:] @ X[:, :r], f[:r] - D[:r, r:] @ X[:, r])

    expected = (condensed(p + h) - condensed(p - h)) / (2 * h)
    system = with_parameters(original, **{name: p})
    dS, dF = CondensedChange(system, derivative_of(system, original, name), T, directions.shape[0]).at(s)
    scale = np.max(np.abs(condensed(p))) / p
    assert np.append(dS, dF) == pytest.approx(expected, abs=1e-6 * scale)


def test_second_derivative_by_the_frequency(found):
    _, search, _ = found
    W, h = 4.8, 1e-4
    S2, F2 = _second_derivatives(search.problem, 1j * W)
    (Sa, Fa), (Sb, Fb), (Sc, Fc) = (stiffness_at(search.problem, 1, w) for w in (W - h, W, W + h))
    assert pytest.approx((Sa - 2 * Sb + Sc) / h**2, rel=1e-4) == -S2
    assert pytest.approx((Fa - 2 * Fb + Fc) / h**2, rel=1e-3, abs=1e-5) == -F2
