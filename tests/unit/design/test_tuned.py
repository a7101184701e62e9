"""Closed forms of the tuned mass damper against numbers printed elsewhere and against a numerical minimum."""

import numpy as np
import pytest
import scipy.optimize

import frahm
from frahm.design.tuned import den_hartog, equal_peak


@pytest.mark.parametrize(
    ("mu", "ratio", "damping", "peak"), [(0.05, 0.952372, 0.133938, 6.4079), (0.02, 0.980391, 0.085829, 10.053)]
)
def test_equal_peak_gives_the_published_numbers(mu, ratio, damping, peak):
    assert equal_peak(mu) == pytest.approx((ratio, damping, peak), rel=5e-5)


def test_equal_peak_is_the_minimum_over_frequency_and_damping():
    mu, W = 0.03, np.linspace(0.7, 1.3, 4001)

    def largest(p):
        f, zeta = p
        damper = mu * W**2 * (f**2 + 2j * zeta * f * W) / (f**2 - W**2 + 2j * zeta * f * W)
        return np.max(np.abs(1 / (1 - W**2 - damper)))

    ratio, damping, peak = equal_peak(mu)
    found = scipy.optimize.minimize(largest, (ratio * 1.01, damping * 0.9), method="Nelder-Mead",
                                    options={"xatol": 1e-7, "fatol": 1e-9})  # fmt: skip
    assert found.x == pytest.approx((ratio, damping), rel=2e-3)
    assert found.fun == pytest.approx(peak, rel=1e-5)


def test_den_hartog_is_near_and_refuses_no_mass():
    assert den_hartog(0.02) == pytest.approx((0.980392, 0.084067, np.sqrt(101)), rel=1e-4)
    with pytest.raises(frahm.ParameterError, match="mass_ratio"):
        equal_peak(0.0)
