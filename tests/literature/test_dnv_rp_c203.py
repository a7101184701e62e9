"""S-N curves of DNV-RP-C203 in air, the ASTM E1049 example, and the closed form for a long-term Weibull range."""

import numpy as np
import pytest
from scipy.special import gamma, gammainc, gammaincc

from frahm.assessment import rainflow_cycles, weibull_damage
from frahm.case import SN_CURVE_NAMES
from frahm.published.dnv_rp_c203 import KNEE_CYCLES, SN_CURVES, sn_curve


@pytest.mark.parametrize(("stress", "cycles"), [(100, 1.459e6), (52.63, 1.0e7), (20, 1.261e9)])
def test_points_of_the_d_curve(stress, cycles):
    assert sn_curve("D").cycles(stress * 1e6) == pytest.approx(cycles, rel=1e-3)


def test_every_curve_a_case_may_name_is_there():
    assert tuple(SN_CURVES) == SN_CURVE_NAMES


@pytest.mark.parametrize("name", SN_CURVE_NAMES)
def test_both_lines_reach_1e7_cycles_at_the_printed_limit(name):
    curve = sn_curve(name)
    S = curve.limit / 1e6
    ends = np.array([10**curve.log_a1 / S**curve.m1, 10**curve.log_a2 / S**curve.m2])
    assert ends == pytest.approx(KNEE_CYCLES, rel=8e-3)
    assert float(curve.cycles(curve.limit)) == pytest.approx(ends[0], rel=1e-12)
    assert float(curve.cycles(curve.limit * (1 - 1e-9))) == pytest.approx(ends[1], rel=1e-7)


def test_the_step_of_the_t_curve_is_kept():
    curve = sn_curve("T")
    above, below = curve.cycles([67.09e6, 67.0899999e6])
    assert 1 - below / above == pytest.approx(0.008, abs=5e-4)


def test_thickness():
    curve = sn_curve("D")
    assert curve.thickness_factor(0.050) == pytest.approx(2**0.2)
    assert curve.thickness_factor(0.0134) == 1.0
    assert sn_curve("T").thickness_factor(0.032, 0.016, concentration=10.0) == pytest.approx(2**0.25)
    assert sn_curve("T").thickness_factor(0.032, 0.016, concentration=10.1) == pytest.approx(2**0.30)
    assert sn_curve("B1").thickness_factor(0.1) == 1.0


def test_a_range_of_zero_does_no_damage():
    assert sn_curve("D").cycles(0.0) == np.inf


def test_example_of_astm_e1049():
    cycles = rainflow_cycles([-2, 1, -3, 5, -1, 3, -4, 4, -2])
    found = {size: float(cycles.counts[cycles.ranges == size].sum()) for size in (3, 4, 6, 8, 9)}
    assert found == {3: 0.5, 4: 1.5, 6: 0.5, 8: 1.0, 9: 0.5}
    assert np.sum(cycles.counts == 1) == 1  # the one cycle that closes, of range 4
    assert cycles.power_sum(3) == pytest.approx(1094.0)


@pytest.mark.parametrize(("name", "extreme", "shape"), [("D", 250e6, 0.8), ("T", 120e6, 1.0), ("B1", 400e6, 1.4)])
def test_long_term_weibull_ranges(name, extreme, shape):
    """The closed form of the standard, written out here, and a direct sum over the distribution of the ranges."""
    curve, n0 = sn_curve(name), 1e8
    q = extreme / 1e6 / np.log(n0) ** (1 / shape)
    x = (curve.limit / 1e6 / q) ** shape
    upper = q**curve.m1 / 10**curve.log_a1 * gamma(1 + curve.m1 / shape) * gammaincc(1 + curve.m1 / shape, x)
    lower = q**curve.m2 / 10**curve.log_a2 * gamma(1 + curve.m2 / shape) * gammainc(1 + curve.m2 / shape, x)
    damage = weibull_damage(curve, extreme, n0, shape)
    assert damage == pytest.approx(n0 * (upper + lower), rel=1e-12)
    exceedance = np.linspace(0, 60, 400_001)  # ln of 1/probability
    mass = -np.diff(np.exp(-exceedance))
    S = q * 1e6 * (0.5 * (exceedance[1:] + exceedance[:-1])) ** (1 / shape)
    assert damage == pytest.approx(n0 * np.sum(mass / curve.cycles(S)), rel=2e-5)
