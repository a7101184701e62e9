import math

import pytest

import frahm
from frahm.loads import lift_amplitude, reduced_velocity, reynolds_number, shedding_frequency, vortex_shedding


def test_seed_pipe_at_2_7_metres_per_second():
    # printed: shedding at 0.797 Hz; reduced velocity 4.54; lift over mass 0.00624696 m/s^2
    shedding = vortex_shedding(frahm.load_case("jacket-pipe"))
    assert shedding.frequency_hz == pytest.approx(0.7972, abs=5e-5)
    assert shedding.lift / 247 == pytest.approx(0.00624696, abs=5e-9)
    assert shedding.reduced_velocity == pytest.approx(4.54, abs=5e-3)
    assert shedding.reynolds_number == pytest.approx(2.7 * 0.762 / 1.5e-5)
    assert shedding.detuning == pytest.approx(2 * math.pi * (0.7972441 - 0.78), abs=1e-6)


def test_laws_of_similarity():
    assert shedding_frequency(5.4, 0.762, 0.225) == pytest.approx(2 * shedding_frequency(2.7, 0.762, 0.225))
    assert lift_amplitude(5.4, 0.5, 0.3) == pytest.approx(4 * lift_amplitude(2.7, 0.5, 0.3))
    assert lift_amplitude(2.0, 0.5, 1.0, 1.2, length=3.0) == pytest.approx(0.5 * 1.2 * 4.0 * 0.5 * 3.0)
    # the shedding frequency meets the natural frequency at a reduced velocity of 1/St
    omega = shedding_frequency(2.0, 0.3, 0.2)
    assert reduced_velocity(2.0, omega, 0.3) == pytest.approx(5.0)
    assert reynolds_number(1.0, 1.5, viscosity=1e-3) == pytest.approx(1500.0)


@pytest.mark.parametrize(
    ("call", "says"),
    [
        (lambda: shedding_frequency(-1, 1, 0.2), "speed: given -1"),
        (lambda: shedding_frequency(1, 0, 0.2), "diameter: given 0"),
        (lambda: lift_amplitude(1, 1, math.nan), "lift_coefficient: given nan"),
        (lambda: reduced_velocity(1, 0, 1), "frequency: given 0"),
        (lambda: reynolds_number(1, 1, 0), "viscosity: given 0"),
    ],
)
def test_bad_values_are_named(call, says):
    with pytest.raises(frahm.ParameterError) as caught:
        call()
    assert says in str(caught.value)
