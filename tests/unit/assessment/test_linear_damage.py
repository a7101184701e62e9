import itertools

import numpy as np
import pytest
from scipy.integrate import quad

import frahm
from frahm.assessment.detail import detail_of
from frahm.assessment.linear_damage import linear_damage, linear_pipe
from frahm.loads import wind_climate
from frahm.published.dnv_rp_c203 import sn_curve

SECTIONS = {
    "climate": {"duration": "20 year", "weibull": {"scale": 7, "shape": 2}},
    "fatigue": {"curve": "D", "stress_per_displacement": "283.5 MPa/m"},
}


@pytest.fixture(scope="module")
def case():
    return frahm.load_case({**frahm.load_case("jacket-pipe").to_dict(), **SECTIONS})


def test_integral_over_the_resonance_by_hand(case):
    """The oscillator written out, and an adaptive integrator that is told where the resonance is."""
    bare = case.without_absorbers()
    edges = np.array([2.5, 2.6, 2.65, 2.8])
    found, largest = linear_damage(linear_pipe(bare), detail_of(bare), wind_climate(bare), edges)
    D, m, omega, zeta = 0.762, 247.0, 0.78 * 2 * np.pi, 0.0015
    curve, T = sn_curve("D"), 20 * 365.25 * 86400

    def stress(U):
        W, F = 2 * np.pi * 0.225 * U / D, 0.5 * 0.4535 * 1.225 * U * U * D
        return 2 * 283.5e6 * F / m / np.hypot(omega**2 - W**2, 2 * zeta * omega * W)

    def density(U):
        return 2 / 7 * (U / 7) * np.exp(-((U / 7) ** 2)) * 0.225 * U / D / float(curve.cycles(stress(U)))

    peak = omega * D / (2 * np.pi * 0.225)
    near = [peak + w for w in (-0.02, -0.005, -0.001, 0, 0.001, 0.005, 0.02)]
    for i, (a, b) in enumerate(itertools.pairwise(edges)):
        inside = [p for p in near if a < p < b] or None
        assert found[i] == pytest.approx(T * quad(density, a, b, points=inside, limit=400)[0], rel=2e-4)
    assert largest[1] == pytest.approx(stress(peak), rel=1e-4)


def test_stress_range_of_the_seed_pipe(case):
    """49.2 MPa without absorber, at the lift of 2.7 m/s in resonance."""
    resonant = case.without_absorbers().with_wind(strouhal=0.78 * 0.762 / 2.7)
    found = linear_pipe(resonant).stress_range(np.array([2.7]), detail_of(resonant))
    assert found[0] == pytest.approx(49.2e6, rel=1e-3)


def test_a_tuned_mass_damper_stays_in_closed_form(case):
    law = {"kind": "linear", "stiffness": 4.94 * (0.98 * 4.9009) ** 2, "damping": 2 * 0.0858 * 4.94 * 4.8}
    tuned = frahm.load_case({**case.to_dict(), "absorbers": [{"mass": 4.94, "law": law}]})
    found = frahm.fatigue_damage(tuned, bins=20)
    assert set(found.kinds) == {"linear"}
    assert found.damage_with < 1e-3 * found.damage_without
    assert found.damage_with == found.damage_with_weighted
    # The sum does not depend on the bins: the closed form is integrated, not sampled.
    assert frahm.fatigue_damage(tuned, bins=7).damage_with == pytest.approx(found.damage_with, rel=1e-5)


def test_a_pipe_without_absorbers_has_one_damage(case):
    found = frahm.fatigue_damage(case.without_absorbers(), bins=9)
    assert found.damage_with == found.damage_without > 0
    assert found.verified
    assert found.life_years == pytest.approx(20 / found.damage_with)


def test_no_damping_means_no_bound(case):
    found = frahm.fatigue_damage(case.without_absorbers().with_pipe(damping_ratio=0), bins=5)
    assert found.damage_without == np.inf
    assert found.life_years == 0.0
    assert any("Without damping" in sentence for sentence in found.unverified)


def test_no_lift_means_no_damage(case):
    found = frahm.fatigue_damage(case.with_wind(lift_coefficient=0), bins=4)
    assert (found.damage_with, found.damage_without, found.life_years) == (0.0, 0.0, np.inf)
