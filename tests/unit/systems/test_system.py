"""The general system: what it accepts, and what follows from its matrices."""

import math

import numpy as np
import pytest

import frahm
from frahm.systems import derivative_of, excitation_frequency, parameter_value, with_parameters

EYE = np.eye(2)


def system(**changes):
    arguments = {
        "mass": EYE,
        "damping": 0 * EYE,
        "stiffness": np.diag([4.0, 0.0]),
        "forcing": [1.0, 0.0],
        "elements": [frahm.Element((-1, 1), frahm.Cubic(2.0, 0.1))],
    }
    return frahm.System(**(arguments | changes))


def test_reference_is_the_lowest_frequency_above_zero_without_elements():
    assert system().reference_frequency == pytest.approx(2.0)
    assert system(reference_frequency=3.0).reference_frequency == 3.0
    assert excitation_frequency(system(), detuning=0.5) == pytest.approx(2.5)


def test_no_reference_is_refused_only_when_it_is_needed():
    free = system(stiffness=0 * EYE)
    assert excitation_frequency(free, frequency=1.0) == 1.0
    with pytest.raises(frahm.ParameterError, match="reference_frequency"):
        excitation_frequency(free, detuning=0.1)


def test_acceleration_states_the_equations():
    s = system(damping=np.diag([0.2, 0.0]))
    x, v = np.array([0.3, -0.1]), np.array([0.05, 0.4])
    z, w = x[1] - x[0], v[1] - v[0]
    g = 2 * z**3 + 0.1 * w
    expected = [math.cos(0.7) - 0.2 * v[0] - 4 * x[0] + g, -g]
    assert s.acceleration(x, v, 0.7) == pytest.approx(expected)


@pytest.mark.parametrize(
    ("changes", "name"),
    [
        ({"mass": np.diag([1.0, -1.0])}, "mass"),
        ({"mass": [[1.0, 0.5], [0.0, 1.0]]}, "mass"),
        ({"mass": "heavy"}, "mass"),
        ({"damping": np.eye(3)}, "damping"),
        ({"stiffness": [[1.0, math.nan], [0.0, 1.0]]}, "stiffness"),
        ({"forcing": [1.0]}, "forcing"),
        ({"forcing": [1.0 + 1.0j, 0.0]}, "forcing"),
        ({"elements": [3]}, r"elements\[0\]"),
        ({"elements": [frahm.Element((1, 2, 3), frahm.Cubic(1.0))]}, r"elements\[0\]"),
        ({"output": 2}, "output"),
        ({"reference_frequency": 0.0}, "reference_frequency"),
    ],
)
def test_bad_arrays_are_named(changes, name):
    with pytest.raises(frahm.ParameterError, match=name):
        system(**changes)


@pytest.mark.parametrize("name", ["kappa", "xi2", "rho2", "force", "pipe_frequency"])
def test_parameters_change_what_they_name_and_their_derivatives_are_exact(name):
    original = system(damping=np.diag([0.2, 0.0]))
    p = parameter_value(original, name)
    assert parameter_value(with_parameters(original, **{name: 1.5 * p}), name) == pytest.approx(
        1.0 if name == "force" else 1.5 * p
    )
    h = 1e-6 * p
    up, down = (with_parameters(original, **{name: p + step}) for step in (h, -h))
    exact = derivative_of(with_parameters(original, **{name: p}), original, name)

    def damper(s):
        return s.damping + s.elements[0].law.damping * np.outer([-1, 1], [-1, 1])

    assert (up.mass - down.mass) / (2 * h) == pytest.approx(exact.mass, abs=1e-8)
    assert (damper(up) - damper(down)) / (2 * h) == pytest.approx(exact.damping, abs=1e-8)
    assert (up.stiffness - down.stiffness) / (2 * h) == pytest.approx(exact.stiffness, abs=1e-7)
    assert (up.forcing - down.forcing) / (2 * h) == pytest.approx(exact.forcing, abs=1e-8)
    springs = [s.elements[0].law.coefficients[2] for s in (up, down)]
    by_law = 0.0 if exact.law is None else exact.law.force(1.0)
    assert (springs[0] - springs[1]) / (2 * h) == pytest.approx(by_law, abs=1e-8)
