"""Facchinetti, de Langre and Biolley, J. Fluids Struct. 19 (2004) 123-140, doi 10.1016/j.jfluidstructs.2003.12.004."""

import math

import numpy as np
import pytest

import frahm
from frahm.loads import WakeOscillator

WAKE = WakeOscillator()


def test_critical_skop_griffin_number_of_displacement_coupling():
    assert WAKE.displacement_coupling_limit == pytest.approx(1.7, abs=0.05)  # as printed
    assert WAKE.displacement_coupling_limit == pytest.approx(1.737, abs=5e-4)  # in closed form


def test_equation_35_at_the_printed_skop_griffin_number():
    assert WAKE.lock_in_amplitude(2.325) == pytest.approx(0.0566, abs=5e-5)


def test_lock_in_state_at_reduced_velocity_5():
    (state,) = WAKE.states(5.0, mass_ratio=250.0, damping_ratio=3.1e-3, mass_number=2e-4)
    assert state.frequency == pytest.approx(1.0, abs=5e-4)
    assert state.pipe_amplitude == pytest.approx(0.0579, abs=5e-5)
    assert state.wake_amplitude == pytest.approx(2.721, abs=5e-4)


def test_equation_35_of_the_jacket_pipe():
    # mu = 348 with the added mass, zeta = 0.0015: A/D = 0.0734, 0.0559 m
    skop_griffin = 8 * 3.14159265**2 * WAKE.strouhal**2 * 0.0015 * 348
    assert WAKE.lock_in_amplitude(skop_griffin) == pytest.approx(0.0734, abs=5e-5)
    assert WAKE.lock_in_amplitude(skop_griffin) * 0.762 == pytest.approx(0.0559, abs=5e-5)


def test_equation_35_is_the_state_of_equations_24_and_25_at_resonance():
    wake = WakeOscillator(strouhal=0.21, lift_coefficient=0.4, stall=0.7, coupling=10.0, nonlinearity=0.2)
    mu, zeta = 120.0, 0.004
    skop_griffin = 8 * 3.141592653589793**2 * wake.strouhal**2 * zeta * mu
    states = wake.states(1 / wake.strouhal, mu, zeta)
    assert max(state.pipe_amplitude for state in states) == pytest.approx(
        wake.lock_in_amplitude(skop_griffin), rel=1e-9
    )


def test_integrated_lock_in_state_at_reduced_velocity_5():
    # known from integration: y = 0.0575, q = 2.705
    case = frahm.Case(
        pipe={"mass": 250.0, "frequency": 1.0, "damping_ratio": 3.1e-3, "diameter": 1.0},
        wind={"speed": 1.0, "air_density": 1.0, "lift_coefficient": 0.3},
    )
    wake = WakeOscillator(lift_coefficient=2e-4 * 16 * math.pi**2 * 0.2**2 * 250)
    speed = 5 / (2 * math.pi)
    found = frahm.wake_response(case, wind=(speed, speed * 1.00001), speeds=2, wake=wake)
    assert np.all(found.bare.settled)
    np.testing.assert_allclose(found.bare.pipe_peak, 0.0575, atol=5e-5)
    np.testing.assert_allclose(found.bare.wake_peak, 2.705, atol=5e-4)
    np.testing.assert_allclose(found.bare.frequency, 1.0, atol=1e-3)


def test_integrated_lock_in_maximum_of_the_jacket_pipe():
    # known from integration: about 0.078 diameters, above the 0.0734 of Eq. 35
    found = frahm.wake_response("jacket-pipe", wind=(3.0, 3.16), speeds=5)
    largest, _ = found.bare.largest
    assert largest / 0.762 == pytest.approx(0.078, abs=1e-3)
    assert found.curve.largest[0] < 0.3 * largest
