"""Objectives and what scatters: against numbers worked out by hand, and against the systems they stand for."""

import numpy as np
import pytest

import frahm
from frahm.case import Scatter
from frahm.design import DesignedAbsorber, DesignSettings, Objective, with_design
from frahm.design.disturbance import Disturbance, disturbances
from frahm.design.springs import coil_springs

CASE = frahm.load_case("jacket-pipe")


def test_a_quantile_is_one_of_the_values_and_never_below_its_share():
    values = np.arange(1.0, 21.0)[::-1]
    assert Objective("peak").over_scatter(values) == 20
    assert Objective("peak", 0.9).over_scatter(values) == 19  # 18 of 20 values lie below it
    assert Objective("peak", 0.5).over_scatter(values) == 11


def test_the_frequency_alone_is_a_grid_with_both_ends():
    grid = disturbances(Scatter(pipe_frequency=0.12), None, 16, 1)
    assert [one.pipe_frequency for one in grid] == pytest.approx([0.88, 0.92, 0.96, 1.0, 1.04, 1.08, 1.12])
    assert disturbances(Scatter(), None, 16, 1) == [Disturbance()]


def test_the_worst_over_several_looks_at_the_corners_and_a_quantile_only_at_samples():
    scatter = Scatter(pipe_frequency=0.05, xi2=0.2, force=0.1)
    worst, quantile = disturbances(scatter, None, 16, 1), disturbances(scatter, 0.9, 16, 1)
    assert len(worst) == 1 + 8 + 16
    assert len(quantile) == 16
    corners = {(one.pipe_frequency, one.xi2, one.force) for one in worst[1:9]}
    assert corners == {(r, c, f) for r in (0.95, 1.05) for c in (0.8, 1.2) for f in (0.9, 1.1)}
    for one in quantile:
        assert abs(one.pipe_frequency - 1) <= 0.05
        assert abs(one.xi2 - 1) <= 0.2
        assert one.kappa == 1
    assert disturbances(scatter, 0.9, 16, 1) == quantile
    assert disturbances(scatter, 0.9, 16, 2) != quantile


def test_a_disturbed_system_is_the_system_of_the_changed_case():
    off = Disturbance(pipe_frequency=0.9, pipe_damping=1.5, kappa=1.2, xi2=0.7, force=1.1)
    design = DesignedAbsorber(0.02, 0.1, 700.0, 0.03, 2e5)
    changed = CASE.with_pipe(frequency=0.9 * CASE.pipe.frequency, damping_ratio=1.5 * CASE.pipe.damping_ratio)
    by_hand = frahm.build_system(with_design(changed, DesignedAbsorber(0.02, 0.12, 840.0, 0.021, 2.4e5)))
    system = off.of(frahm.build_system(with_design(CASE, design)))
    assert system.damping == pytest.approx(by_hand.damping)
    assert system.stiffness == pytest.approx(by_hand.stiffness)
    assert system.forcing == pytest.approx(1.1 * 0.9**2 * by_hand.forcing)
    assert system.elements[0].law.coefficients == pytest.approx(by_hand.elements[0].law.coefficients)
    assert system.elements[0].law.damping == pytest.approx(by_hand.elements[0].law.damping)
    assert system.reference_frequency == pytest.approx(by_hand.reference_frequency)
    still = Disturbance(pipe_frequency=0.9, lock_in=False).of(frahm.build_system(CASE))
    assert still.forcing == pytest.approx(frahm.build_system(CASE).forcing)


@pytest.mark.parametrize(
    "law",
    [frahm.TransverseSprings(500.0, 0.2, 3.0, pretension=4.0), frahm.Polynomial([2.0, 1.0, 3.0], 0.5)],
)
def test_a_scaled_law_has_the_scaled_force(law):
    z = np.linspace(-0.3, 0.3, 31)
    other = law.scaled(1.3, 0.6)
    assert other.force(z) == pytest.approx(1.3 * law.force(z))
    assert other.force(0.0, 2.0) - other.force(0.0) == pytest.approx(0.6 * (law.force(0.0, 2.0) - law.force(0.0)))


def test_settings_come_from_the_case_and_single_ones_take_their_place():
    from frahm.design.settings import settings_for

    case = CASE.with_design(objective="rms", scatter={"kappa": "5 %"}, stroke="15 mm")
    found = settings_for(case, changes={"stroke": 0.02})
    assert (found.objective, found.scatter.kappa, found.stroke) == ("rms", 0.05, 0.02)
    assert found.mass_ratio == pytest.approx(0.02)
    assert settings_for(CASE.without_absorbers()).mass_ratio == 0.02
    assert DesignSettings(scatter=0.1).scatter == Scatter(pipe_frequency=0.1)
    back = frahm.load_case(case.to_dict())
    assert back.design == case.design


def test_coil_springs_have_the_stiffness_and_stress_asked_for_and_their_solid_length():
    springs = coil_springs(20.0, 7e5, 0.013, room=0.08, stress=3e8)
    C = float(springs.spring_index)
    d, D, n = float(springs.wire), C * float(springs.wire), float(springs.coils)
    assert 7.9e10 * d**4 / (8 * D**3 * n) == pytest.approx(7e5 * 0.08**2 + 10.0)
    assert float(springs.free) == pytest.approx(0.08 - 0.8 / (7e5 * 0.08**2 + 10.0))
    wahl = (4 * C - 1) / (4 * C - 4) + 0.615 / C
    assert 8 * float(springs.force) * D * wahl / (np.pi * d**3) == pytest.approx(3e8)
    assert float(springs.solid) == pytest.approx((n + 2) * d)
    assert float(springs.pretension) == pytest.approx(0.5 * 20.0 * 0.08)
