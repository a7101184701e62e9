"""Screening in closed form against polynomial roots, full matrices, the slow flow and exact births."""

import math

import numpy as np
import pytest

import frahm
from frahm.design import DesignedAbsorber, with_design
from frahm.design.disturbance import Disturbance
from frahm.design.host import host_of
from frahm.design.screening import Screening, fold_ceilings
from frahm.slow_flow import slow_flow_of
from frahm.slow_flow.manifold import slow_manifold

CASE = frahm.load_case("jacket-pipe")
SYSTEM = frahm.build_system(CASE)
HOST = host_of(SYSTEM)
OMEGA = HOST.frequency


def screening(host=HOST, errors=(1.0,), window=(0.92, 1.08), count=161):
    omega = host.frequency
    errors = [Disturbance(pipe_frequency=error) for error in errors]
    conditions = host.conditions(errors, (window[0] * omega, window[1] * omega), count)
    return Screening(host, conditions, host.conditions(errors, (0.7 * omega, 1.3 * omega), 481))


def row(kappa, xi2, linear=0.0, rho2=0.02, mass=247.0, quintic=0.0):
    return np.array([[rho2 * mass, linear * mass, kappa * mass, xi2 * mass, quintic * mass]])


def amplitudes_by_roots(W, error, kappa, xi2, linear, rho2=0.02):
    """|X| of all one-harmonic responses from numpy's roots, written down afresh."""
    omega, xi1 = error * 2 * math.pi * 0.78, error * 2 * 0.0015 * 2 * math.pi * 0.78
    force = error**2 * 0.5 * 0.4535 * 1.225 * 2.7**2 * 0.762 / 247
    h, g = omega**2 - W**2 + 1j * W * xi1, linear + 1j * W * xi2
    # rho2 W^2 (X + Z) = G Z and h X = F + G Z with G = g + 3/4 kappa N: F = Z (h (G/(rho2 W^2) - 1) - G)
    d, s = h * (g / (rho2 * W**2) - 1) - g, h / (rho2 * W**2) - 1
    k = 0.75 * kappa
    roots = np.roots([k**2 * abs(s) ** 2, 2 * k * (d * np.conj(s)).real, abs(d) ** 2, -(force**2)])
    N = roots[(np.abs(roots.imag) < 1e-7 * np.abs(roots)) & (roots.real > 0)].real
    return np.sqrt(N) * np.abs((g + k * N) / (rho2 * W**2) - 1)


@pytest.mark.parametrize("design", [(367.38, 0.0117, 0.0), (2000.0, 0.04, 0.0), (735.0, 0.0321, 0.297)])
@pytest.mark.parametrize("error", [1.0, 0.9])
def test_largest_amplitude_is_that_of_polynomial_roots(design, error):
    room = screening(errors=(error,), count=41)
    expected = max(np.max(amplitudes_by_roots(W, error, *design)) for W in room.conditions.frequency[0])
    kappa, xi2, linear = design
    designs = row(kappa, xi2, linear)
    assert room.largest_pipe_amplitudes(designs)[0] == pytest.approx(expected, rel=1e-7)
    assert room.responses(designs)[0][0, 0] == pytest.approx(expected, rel=1e-7)


def test_a_limit_only_cuts_what_exceeds_it():
    room = screening(errors=(0.95, 1.0, 1.05))
    designs = np.concatenate([row(kappa, 0.05) for kappa in (500.0, 2000.0, 2800.0, 9000.0)])
    free, cut = room.largest_pipe_amplitudes(designs), room.largest_pipe_amplitudes(designs, limit=0.012)
    assert np.array_equal(free <= 0.012, cut <= 0.012)
    assert np.array_equal(free[free <= 0.012], cut[cut <= 0.012])


@pytest.mark.parametrize(("kappa", "xi2"), [(2643.9, 0.05358), (3000.0, 0.0557), (2000.0, 0.04)])
def test_birth_of_a_detached_curve_is_near_the_exact_one(kappa, xi2):
    exact = frahm.detached_curve_events(CASE.with_absorber(kappa=kappa, xi2=xi2), "force", (1.0, 1.1), slices=2)
    birth = next(event.value for event in exact if event.kind == "birth")
    assert screening().births(row(kappa, xi2))[0] == pytest.approx(birth, rel=0.015)


def test_no_birth_where_there_is_no_cubic_spring_or_too_much_damping():
    assert np.all(np.isinf(screening().births(np.concatenate([row(0.0, 0.01, 0.46), row(2000.0, 0.5)]))))


def test_growth_rate_is_negative_exactly_where_the_slow_flow_is_stable():
    for kappa, xi2 in ((2800.0, 0.058), (2000.0, 0.04), (367.38, 0.0117)):
        room = screening(count=101)
        found = frahm.slow_flow_map(CASE, detuning=room.conditions.frequency[0] - OMEGA, kappa=kappa, xi2=xi2)
        assert (room.responses(row(kappa, xi2))[1][0, 1] > 0) == bool(np.any(found.stability.values == 2))


def test_ceiling_is_that_of_the_slow_manifold():
    slow = slow_flow_of(frahm.build_system(CASE))
    ceiling = fold_ceilings(screening(), np.concatenate([row(367.38, 0.0117), row(2800.0, 0.058)]))
    assert ceiling[0] == pytest.approx(slow_manifold(slow).folds.pipe_ceiling, rel=1e-9)
    assert np.isnan(ceiling[1])


def test_an_elastic_pipe_is_screened_with_all_its_modes():
    case = frahm.load_case("jacket-pipe-elastic")
    system = frahm.build_system(case)
    host = host_of(system)
    room = screening(host, count=31)
    assert host.modal_mass == pytest.approx(case.pipe.mass)
    law = system.elements[0].law
    design = np.array([[case.absorbers[0].mass, 0.0, law.coefficients[2], law.damping, 0.0]])
    n, out = system.elements[0].direction, system.output
    largest = 0.0
    for W in room.conditions.frequency[0]:
        D = system.stiffness + 1j * W * system.damping - W**2 * system.mass + 1j * W * law.damping * np.outer(n, n)
        free, unit = np.linalg.solve(D, system.forcing + 0j), np.linalg.solve(D, n + 0j)
        # Z = n.x, x = free - unit (3/4 k |Z|^2 Z): a cubic in N = |Z|^2
        k, p, q = 0.75 * law.coefficients[2], n @ free, n @ unit
        roots = np.roots([k**2 * abs(q) ** 2, 2 * k * q.real, 1.0, -(abs(p) ** 2)])
        for N in roots[np.abs(roots.imag) < 1e-8 * np.abs(roots)].real:
            Z = p / (1 + k * N * q)
            largest = max(largest, abs(out @ (free - unit * k * N * Z)))
    assert room.largest_pipe_amplitudes(design)[0] == pytest.approx(largest, rel=1e-7)


def test_designs_in_and_out_of_a_case():
    from frahm.design.absorber import absorber_of

    for design in (DesignedAbsorber(0.03, 0.0, 2000.0, 0.04), DesignedAbsorber(0.03, 0.4, 0.0, 0.02),
                   DesignedAbsorber(0.03, 0.3, 700.0, 0.03)):  # fmt: skip
        back = absorber_of(with_design(CASE, design))
        assert (back.rho2, back.linear, back.kappa, back.xi2) == pytest.approx(
            (design.rho2, design.linear, design.kappa, design.xi2)
        )
        assert back.family == design.family


@pytest.mark.parametrize("quintic", [1e4, 3e6, 1e8])
@pytest.mark.parametrize(("kappa", "xi2", "several"), [(0.0, 0.04, None), (2000.0, 0.04, None), (1e4, 0.01, True)])
def test_a_fifth_power_is_screened_with_all_roots(kappa, xi2, several, quintic):
    """Against numpy's roots of the polynomial of the fifth degree in |Z|^2, written down afresh."""
    room = screening(count=41)
    omega, xi1, force, rho2 = OMEGA, 2 * 0.0015 * OMEGA, 0.5 * 0.4535 * 1.225 * 2.7**2 * 0.762 / 247, 0.02
    largest, counts = 0.0, set()
    for W in room.conditions.frequency[0]:
        h, g = omega**2 - W**2 + 1j * W * xi1, 1j * W * xi2
        d, s = h * (g / (rho2 * W**2) - 1) - g, h / (rho2 * W**2) - 1
        n = np.polynomial.Polynomial([0, 0.75 * kappa, 0.625 * quintic])
        load = np.polynomial.Polynomial([0, 1]) * ((d.real + s.real * n) ** 2 + (d.imag + s.imag * n) ** 2)
        roots = (load - force**2).roots()
        N = roots[(np.abs(roots.imag) < 1e-6 * np.abs(roots)) & (roots.real > 0)].real
        counts.add(len(N))
        largest = max(largest, np.max(np.sqrt(N) * np.abs((g + n(N)) / (rho2 * W**2) - 1)))
    designs = row(kappa, xi2, quintic=quintic)
    assert room.largest_pipe_amplitudes(designs)[0] == pytest.approx(largest, rel=1e-6)
    assert room.responses(designs)[0][0, 0] == pytest.approx(largest, rel=1e-6)
    assert counts <= {1, 3}  # Descartes' rule: never five
    assert not several or counts == {1, 3}


def test_births_and_growth_with_a_vanishing_fifth_power_are_those_of_the_cubic_spring():
    room = screening(count=101)
    cubic, almost = row(2871.84, 0.0572429), row(2871.84, 0.0572429, quintic=1e-3)
    assert room.births(almost) == pytest.approx(room.births(cubic), rel=1e-6)
    (peaks, others), (peaks_almost, others_almost) = room.responses(cubic), room.responses(almost)
    assert peaks_almost == pytest.approx(peaks, rel=1e-8)
    assert others_almost == pytest.approx(others, rel=1e-6)


def test_growth_with_a_fifth_power_is_that_of_the_exact_equations():
    """The slow flow of one harmonic against Floquet exponents where the motion is small and nearly harmonic."""
    quintic, kappa, xi2 = 3e6, 500.0, 0.05
    room = screening(window=(1.02, 1.03), count=5)
    case = CASE.to_dict()
    powers = [0, 0, 247 * kappa, 0, 247 * quintic]
    case["absorbers"][0]["law"] = {"kind": "polynomial", "coefficients": powers, "damping": 247 * xi2}
    curve = frahm.frequency_response(case, frequency=(1.02 * OMEGA, 1.03 * OMEGA))
    growth = room.responses(row(kappa, xi2, quintic=quintic))[1][0, 1]
    assert growth == pytest.approx(np.max(curve.growth_rate), rel=0.02)


def test_disturbances_of_absorber_and_pipe_are_screened_as_the_exact_system_has_them():
    off = Disturbance(pipe_frequency=0.97, pipe_damping=1.3, kappa=1.2, xi2=0.8, force=1.1)
    window = (0.9 * OMEGA, 1.05 * OMEGA)
    conditions = HOST.conditions([off], window, 301, moving=False)
    room = Screening(HOST, conditions, conditions)
    design = DesignedAbsorber(0.02, 0.05, 600.0, 0.05)
    exact = frahm.frequency_response(off.of(frahm.build_system(with_design(CASE, design))), frequency=window)
    found = room.largest_pipe_amplitudes(row(600.0, 0.05, linear=0.05))[0]
    assert found == pytest.approx(exact.pipe_amplitude.max(), rel=0.01)
    plain = frahm.frequency_response(frahm.build_system(with_design(CASE, design)), frequency=window)
    assert abs(plain.pipe_amplitude.max() / found - 1) > 0.05
