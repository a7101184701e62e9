"""Facchinetti, de Langre and Biolley, J. Fluids Struct. 19 (2004) 123-140, doi 10.1016/j.jfluidstructs.2003.12.004."""

import pytest

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
