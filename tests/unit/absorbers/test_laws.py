"""Force laws against their definitions."""

import math

import numpy as np
import pytest
from scipy.integrate import quad

import frahm


@pytest.mark.parametrize("coefficients", [(0, 0, 5.0), (2.0, 0, -1.0, 0, 0.5), (1.0, 2.0, 3.0, 4.0)])
def test_describing_stiffness_is_the_first_harmonic_of_the_force(coefficients):
    law = frahm.Polynomial(coefficients)
    b = 0.7
    projected = quad(lambda t: float(law.force(b * math.cos(t))) * math.cos(t), 0, 2 * math.pi)[0] / (math.pi * b)
    assert float(law.describing_stiffness(b)) == pytest.approx(projected, rel=1e-12)


def test_stiffness_is_the_slope_of_the_force():
    law = frahm.Polynomial((1.0, -2.0, 3.0, 0.5), damping=0.3)
    z, h = np.linspace(-1, 1, 7), 1e-6
    assert law.stiffness(z) == pytest.approx((law.force(z + h) - law.force(z - h)) / (2 * h), abs=1e-8)
    assert law.force(0.0, 2.0) == pytest.approx(0.6)


def test_what_a_law_says_of_itself():
    assert frahm.Cubic(3.0).cubic_only == 3.0
    assert frahm.Linear(3.0).cubic_only is None
    assert frahm.Linear(0.0).cubic_only == 0.0
    assert frahm.Linear(3.0).is_linear
    assert not frahm.Polynomial((1.0, 2.0)).is_odd
    assert frahm.Cubic(1.0).is_odd


@pytest.mark.parametrize("coefficients", [[], [[1.0]], [math.nan], ["a"], list(range(16))])
def test_bad_coefficients_are_refused(coefficients):
    with pytest.raises(frahm.ParameterError, match="coefficients"):
        frahm.Polynomial(coefficients)
