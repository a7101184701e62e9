"""The derived slow flow against routes that share nothing with the derivation."""

from __future__ import annotations

import itertools

import numpy as np
import pytest
import sympy as sp
from scipy.optimize import fsolve

from frahm.errors import ParameterError
from frahm.slow_flow import expansion as ex
from frahm.slow_flow import kernels
from frahm.slow_flow.derivation import (
    FORMS,
    PARAMETERS,
    STATE,
    characteristic_polynomial,
    derive,
    lam,
    multiple_scales,
)
from frahm.slow_flow.polar_form import a, b, equilibrium_relations, polar_equations

# Section 4.1 of doi 10.3390/app12147272 at kappa 367.38, xi2 .0085, a detuning with one equilibrium.
PIPE = {
    "omega": 2 * np.pi * 0.78,
    "sigma": -0.03,
    "xi1": 2 * 0.0015 * 2 * np.pi * 0.78,
    "xi2": 0.0085,
    "kappa": 367.38,
    "rho2": 0.02,
    "F": 0.00624696,
}


def random_parameters(seed: int) -> dict[str, float]:
    rng = np.random.default_rng(seed)
    return dict(
        zip(PARAMETERS, rng.uniform([1, -0.3, 0.1, 0.1, 1, 0.1, 0.5], [3, 0.3, 0.5, 0.5, 9, 0.9, 2]), strict=True)
    )


def first_harmonic(signal):
    """Coefficient c of the part Re c e^{i phase} of a signal sampled over one period."""
    return 2 * np.mean(signal * np.exp(-1j * np.linspace(0, 2 * np.pi, signal.size, endpoint=False)))


def motion_residuals(x, z, w, par, *, slow_rates=(0, 0), second=True):
    """First harmonics of both equations of motion for x1 = Re x e^{i w t}, z = Re z e^{i w t}, sampled in time.

    `slow_rates` are X' and Z'; they enter as derivatives of the amplitudes in the accelerations only.
    """
    wave = np.exp(1j * np.linspace(0, 2 * np.pi, 64, endpoint=False))
    accelerations = [-(w**2) * c + 2j * w * rate for c, rate in zip((x, z), slow_rates, strict=True)]
    x_acc, z_acc = (np.real(c * wave) for c in accelerations)
    x_pos, z_pos = np.real(x * wave), np.real(z * wave)
    x_vel, z_vel = np.real(1j * w * x * wave), np.real(1j * w * z * wave)
    force = par["xi2"] * z_vel + par["kappa"] * z_pos**3
    host = x_acc + par["xi1"] * x_vel + par["omega"] ** 2 * x_pos - force - par["F"] * wave.real
    sink = par["rho2"] * (x_acc + z_acc) + force
    return first_harmonic(host), first_harmonic(sink)


def equilibrium(form, par):
    rates, jacobian = derive(form).numeric()
    state = fsolve(rates, [0.004, -0.004, 0.004, -0.004], args=(par,), fprime=jacobian, xtol=1e-12)
    assert np.abs(rates(state, par)).max() < 1e-15
    return state


def complex_state(state):
    return complex(*state[:2]), complex(*state[2:])


@pytest.mark.parametrize("seed", range(3))
def test_averaged_rates_annul_the_sampled_equations_of_motion(seed):
    par = random_parameters(seed)
    state = np.random.default_rng(seed + 10).normal(size=4)
    rates, _ = derive("averaged").numeric()
    x, z = complex_state(state)
    slow = complex_state(rates(state, par))
    host, sink = motion_residuals(x, z, par["omega"] + par["sigma"], par, slow_rates=slow)
    assert abs(host) < 1e-12
    assert abs(sink) < 1e-12


def test_averaged_equilibria_balance_one_harmonic_of_the_exact_equations():
    x, z = complex_state(equilibrium("averaged", PIPE))
    assert np.abs(motion_residuals(x, z, PIPE["omega"] + PIPE["sigma"], PIPE)) == pytest.approx([0, 0], abs=1e-15)


def two_time_residual(order, par, amplitude, rates):
    """e^{i omega t0} component of the sink's equation at `order` of epsilon, by differences in epsilon and an FFT.

    The ansatz x1 = x11 + e x12, z = z11 + e z12 is evaluated as numbers; nothing symbolic enters.
    """
    w, sigma, kappa, xi2, rho2 = (par[k] for k in ("omega", "sigma", "kappa", "xi2", "rho2"))
    A, B1, B2 = amplitude
    dA, dB1 = rates
    wave = np.exp(1j * np.linspace(0, 2 * np.pi, 64, endpoint=False))
    third = -kappa * B1**3 / (8 * w**2)

    def sampled(eps):
        # Amplitude and second derivative of c(t1) e^{i n w t0}: (i n w + e D1)^2 c, and e^{i sigma t1} = 1 at t1 = 0.
        turning = dB1 + 1j * sigma * B1
        x_acc = (-(w**2) * A + 2j * w * eps * dA) * wave + eps * (-9 * w**2) * third * wave**3
        z_acc = (-(w**2) * (B1 + eps * B2) + 2j * w * eps * turning) * wave
        z_vel = (1j * w * (B1 + eps * B2) + eps * turning) * wave
        z_pos = 2 * np.real((B1 + eps * B2) * wave)
        sink = rho2 * 2 * np.real(x_acc + z_acc) + xi2 * 2 * np.real(z_vel) + kappa * z_pos**3
        return first_harmonic(sink) / 2

    if order == 0:
        return sampled(0.0)
    h = 1e-3
    return (sampled(h) - sampled(-h)) / (2 * h)


@pytest.mark.parametrize("order", [0, 1])
def test_both_orders_of_the_sink_equation_match_the_sampled_ansatz(order):
    par = random_parameters(4)
    rng = np.random.default_rng(5)
    A, B1, B2, dA, dB1 = rng.normal(size=5) + 1j * rng.normal(size=5)
    scales = multiple_scales()
    expression = (scales.slow_manifold, scales.second_order)[order]
    numbers = {
        ex.A: A, ex.B1: B1, ex.B1_bar: B1.conjugate(), ex.B2: B2, ex.B2_bar: B2.conjugate(),
        ex.A_rate: dA, ex.B1_rate: dB1, ex.carrier: 1,
    }  # fmt: skip
    values = {s: par[s.name] for s in expression.free_symbols if s.name in par}
    expected = complex(expression.subs({**numbers, **values}))
    assert two_time_residual(order, par, (A, B1, B2), (dA, dB1)) == pytest.approx(expected, rel=1e-5)


def test_host_rate_is_the_secular_term_of_the_sampled_force():
    par = random_parameters(6)
    A, B = 0.4 - 0.3j, -0.2 + 0.7j
    wave = np.exp(1j * np.linspace(0, 2 * np.pi, 64, endpoint=False))
    z, z_vel, x_vel = (
        2 * np.real(B * wave),
        2 * np.real(1j * par["omega"] * B * wave),
        2 * np.real(1j * par["omega"] * A * wave),
    )
    push = par["kappa"] * z**3 + par["xi2"] * z_vel - par["xi1"] * x_vel + par["F"] * wave.real
    expected = first_harmonic(push) / 2 / (2j * par["omega"])
    expression = multiple_scales().host_rate
    values = {s: par[s.name] for s in expression.free_symbols if s.name in par}
    values |= {ex.A: A, ex.B1: B, ex.B1_bar: B.conjugate(), ex.carrier: 1}
    assert complex(expression.subs(values)) == pytest.approx(expected, rel=1e-12)


def test_third_harmonic_of_the_pipe_answers_the_third_harmonic_of_the_spring():
    par = random_parameters(7)
    B, wave = -0.2 + 0.7j, np.exp(1j * np.linspace(0, 2 * np.pi, 64, endpoint=False))
    spring = par["kappa"] * (2 * np.real(B * wave)) ** 3
    third = np.mean(spring * wave**-3)
    expected = third / (par["omega"] ** 2 - (3 * par["omega"]) ** 2)
    expression = multiple_scales().correction
    values = {s: par[s.name] for s in expression.free_symbols if s.name in par}
    assert complex(expression.subs({**values, ex.B1: B, ex.carrier: 1})) == pytest.approx(expected, rel=1e-12)


def test_equation_16_holds_the_sum_of_both_orders_and_no_second_amplitude():
    sink = multiple_scales().sink
    assert not sink.free_symbols & {ex.B1, ex.B2, ex.B1_bar, ex.B2_bar}
    assert sink.coeff(ex.A) == -ex.rho2 * ex.omega**2


def test_paper_form_is_the_averaged_form_to_first_order_in_detuning_and_damping():
    h = sp.Symbol("h")
    small = {ex.Omega: ex.omega + h * ex.sigma, ex.sigma: h * ex.sigma, ex.xi1: h * ex.xi1, ex.xi2: h * ex.xi2}
    paper, averaged = derive("paper").coefficients, derive("averaged").coefficients
    for name in ("a", "e", "c1", "c2"):
        difference = sp.expand((averaged[name] - paper[name]).subs(small, simultaneous=True))
        assert (difference.coeff(h, 0), difference.coeff(h, 1)) == (0, 0)


@pytest.mark.parametrize("form", FORMS)
def test_jacobian_against_complex_steps(form):
    par, state, step = random_parameters(1), np.array([0.3, -0.2, 0.5, 0.4]), 1e-30
    rates, jacobian = derive(form).numeric()
    columns = [rates(state + 1j * step * unit, par).imag / step for unit in np.eye(4)]
    np.testing.assert_allclose(jacobian(state, par), np.transpose(columns), rtol=1e-12)


@pytest.mark.parametrize("form", FORMS)
def test_coefficients_rebuild_the_complex_equations(form):
    par, state = random_parameters(2), np.array([0.3, -0.2, 0.5, 0.4])
    derivation = derive(form)
    k = derivation.coefficient_values(par)
    x, z = complex_state(state)
    dx, dz = complex_state(derivation.numeric()[0](state, par))
    spring = k["cubic"] * abs(z) ** 2
    assert k["p"] * dx + k["a"] * x == pytest.approx(par["F"] + (1j * k["c1"] + spring) * z, rel=1e-12)
    assert k["q"] * dx + k["r"] * dz + (1j * k["c2"] + spring) * z == pytest.approx(k["e"] * (x + z), rel=1e-12)


@pytest.mark.parametrize(("form", "seed"), list(itertools.product(FORMS, range(3))))
def test_characteristic_polynomial_is_the_determinant(form, seed):
    par = random_parameters(seed)
    state = np.random.default_rng(seed).normal(size=4)
    derivation = derive(form)
    k = derivation.coefficient_values(par)
    polynomial = characteristic_polynomial(k, abs(complex(*state[2:])))
    J = derivation.numeric()[1](state, par)
    scale = abs(k["p"] * k["r"]) ** 2
    for value in (-1.3, 0.0, 0.4, 2.0):
        expected = np.linalg.det(value * np.eye(4) - J) * scale
        assert complex(polynomial.subs(lam, value)) == pytest.approx(expected, rel=1e-9, abs=1e-9 * scale)


def test_polar_rows_hold_along_the_cartesian_flow():
    par, state = random_parameters(3), np.array([0.3, -0.2, 0.5, 0.4])
    x, z = complex_state(state)
    dx, dz = complex_state(derive("paper").numeric()[0](state, par))
    gamma1, gamma2 = np.angle(x) - np.angle(z), np.angle(x)
    values = dict(
        a=abs(x), b=abs(z), da=(dx / x).real * abs(x), db=(dz / z).real * abs(z),
        dalpha=(dx / x).imag + par["sigma"], dbeta=(dz / z).imag,
        cos1=np.cos(gamma1), sin1=np.sin(gamma1), cos2=np.cos(gamma2), sin2=np.sin(gamma2), **par,
    )  # fmt: skip
    for row in polar_equations():
        assert float(row.subs({s: values[s.name] for s in row.free_symbols})) == pytest.approx(0, abs=1e-12)


def test_equilibrium_relations_hold_at_an_equilibrium():
    x, z = complex_state(equilibrium("paper", PIPE))
    gamma1, gamma2 = np.angle(x) - np.angle(z), np.angle(x)
    expected = {"cos1": np.cos(gamma1), "sin1": np.sin(gamma1), "cos2": np.cos(gamma2), "sin2": np.sin(gamma2)}
    for name, expression in equilibrium_relations().items():
        values = {s: PIPE[s.name] for s in expression.free_symbols if s.name in PIPE}
        assert float(expression.subs({**values, a: abs(x), b: abs(z)})) == pytest.approx(expected[name], rel=1e-9)


@pytest.mark.parametrize("form", FORMS)
def test_relative_amplitude_of_an_equilibrium_solves_the_closed_cubic(form):
    _, z = complex_state(equilibrium(form, PIPE))
    k = derive(form).coefficient_values(PIPE)
    n, e, a_ = k["cubic"] * abs(z) ** 2, k["e"].real, k["a"]
    left = abs((e - a_) * n + 1j * e * k["c1"] + a_ * (e - 1j * k["c2"])) ** 2 * abs(z) ** 2
    assert left == pytest.approx((e * PIPE["F"]) ** 2, rel=1e-9)


@pytest.mark.parametrize("form", FORMS)
def test_compiled_kernels_hold_the_derived_coefficients(form):
    par = random_parameters(8)
    k = derive(form).coefficient_values(par)
    W = par["omega"] + par["sigma"]
    code = kernels.PAPER if form == "paper" else kernels.AVERAGED
    compiled = kernels.coefficients(code, W, par["omega"], par["xi1"], par["xi2"], 0.0, par["rho2"])
    assert compiled == pytest.approx([*(k[name] for name in "paqre"), 1j * k["c1"], 1j * k["c2"]])


def test_symbols_and_unknown_form():
    assert {"p1", "q1", "p2", "q2", "omega", "sigma", "kappa"} <= set(derive("paper").symbols)
    assert set(STATE) <= derive("averaged").cartesian.free_symbols
    with pytest.raises(ParameterError, match="averaged"):
        derive("avaraged")
