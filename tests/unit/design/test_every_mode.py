"""A device is judged in every mode that winds of the site excite, from the closed form to the promise."""

from pathlib import Path

import numpy as np
import pytest

import frahm
from frahm.assessment import damage_of_modes
from frahm.attractors import worst_over
from frahm.design import DesignSettings, verified_designs, with_design
from frahm.design.disturbance import Disturbance
from frahm.design.exact import conditions_of, exact_birth, exact_judgement
from frahm.design.finalists import finalists
from frahm.design.objective import Objective
from frahm.design.problem import Problem
from frahm.design.search import BIRTH, ClosedFormSearch
from frahm.design.settings import settings_for
from frahm.design.verification import verification

TABLE = frahm.load_case(Path(__file__).parents[2] / "cases" / "table.yaml")
SINK = frahm.DesignedAbsorber(0.02, 0.0, 20000.0, 0.0819)
BORN_IN_MODE_2 = frahm.DesignedAbsorber(0.02, 0.0, 382160.0, 0.36885)
PARAMETERS = ("rho2", "linear", "kappa", "xi2", "quintic")


def problem_of(**changes):
    return Problem.of(TABLE, settings_for(TABLE, 0.02, changes=changes))


def stiff_in_mode_2():
    """The mast with its first mode well damped and the second hardly: this one moves most."""
    case = TABLE.to_dict()
    first, second = case["pipe"]["modes"]
    case["pipe"]["modes"] = [{**first, "damping_ratio": 0.03, "lift_length": 3.0},
                             {**second, "damping_ratio": 0.001, "lift_length": 8.0}]  # fmt: skip
    return frahm.load_case(case)


def test_the_closed_form_has_the_amplitudes_of_every_mode():
    problem = problem_of()
    tier = problem.tier("tuned")
    device = tier.space.absorber(tier.space.designs(np.full((1, 2), 0.5))[0])
    judged = tier.judge(tier.space.designs(np.full((1, 2), 0.5)))[0, tier.peak_columns]
    exact = exact_judgement(problem.modes_of(device), problem.disturbances)
    assert len(exact.peaks) == len(problem.modes_of(device)) == 2
    np.testing.assert_allclose(judged, exact.peaks, rtol=0.03)  # the grid passes a sharp resonance by
    assert tier.peak_ratios(exact.peaks, tier.judge(tier.space.designs(np.full((1, 2), 0.5)))[0]).shape == judged.shape


def test_a_birth_in_another_mode_ends_the_margin():
    case = stiff_in_mode_2()
    problem = Problem.of(case, settings_for(case, 0.02))
    row = np.array([[case.pipe.mass * getattr(BORN_IN_MODE_2, name) for name in PARAMETERS]])
    tier = problem.tier("sink")
    first, second = tier.screening.births_by_condition(row[0])
    assert second < first
    assert tier.judge(row)[0, BIRTH] == second
    conditions = conditions_of(problem.modes_of(BORN_IN_MODE_2), problem.disturbances)
    free, taken = exact_birth(conditions, float(second), 1.3)
    assert free < taken < free + 2e-3
    assert taken == pytest.approx(second, rel=0.07)
    alone, _ = exact_birth(conditions[:1], 1.3, 1.3)
    assert alone == 1.3


def test_what_is_verified_is_the_worst_of_all_modes():
    problem, case = problem_of(samples=8), with_design(TABLE, SINK)
    found = verification(problem.modes(case), [Disturbance(lock_in=False)], Objective(), samples=8, seed=1)
    worst = frahm.worst_case(case, samples=8, min_basin=0.0)
    assert worst.others
    assert found.pipe_peak == found.value == pytest.approx(worst.motion.pipe_peak, rel=1e-9)
    assert [one.pipe_peak for one in found.nominal][found.mode] == found.pipe_peak


def test_a_damper_is_sized_for_the_mode_that_moves_most():
    case = stiff_in_mode_2()
    (best,) = verified_designs(case, DesignSettings(samples=8, mass_ratio=0.02), ("tuned",))
    assert best.verified
    tuned = np.sqrt(best.design.linear / best.design.rho2) / (2 * np.pi)
    assert tuned == pytest.approx(5.2, rel=0.03)
    assert best.value == pytest.approx(frahm.worst_case(with_design(case, best.design), samples=8).pipe_peak, rel=1e-6)


def test_every_design_judged_is_counted_whatever_the_limits_it_was_judged_under(monkeypatch):
    judged, judge = [], ClosedFormSearch.judge

    def counted(self, designs):
        judged.append(len(designs))
        return judge(self, designs)

    monkeypatch.setattr(ClosedFormSearch, "judge", counted)
    problem = problem_of()
    finalists(problem.tier("sink"), problem.modes_of, problem.disturbances, problem.limits)
    assert problem.screened == sum(judged) > 72 * 72


def test_the_damage_that_is_made_small_is_that_of_all_modes():
    sections = {
        "climate": {"duration": "20 year", "weibull": {"scale": 6.0, "shape": 1.9}},
        "fatigue": {"curve": "E", "samples": 4, "bins": 12},
    }
    pipe = TABLE.to_dict()["pipe"]
    bent = [[600e6, 200e6, 0.0], [3000e6, -1500e6, 0.0]]
    pipe["modes"] = [mode | {"stresses": row} for mode, row in zip(pipe["modes"], bent, strict=True)]
    case = frahm.load_case(TABLE.to_dict() | sections | {"pipe": pipe})
    (best,) = verified_designs(case, DesignSettings(objective="damage", samples=4, mass_ratio=0.02), ("tuned",))
    parts = damage_of_modes(with_design(case, best.design))
    assert len(parts) == 2
    assert best.value == pytest.approx(sum(part.damage_with for part in parts), rel=1e-4)
    assert parts[1].damage_with > 0.01 * best.value


def test_a_maximum_where_symmetry_breaks_is_looked_at_from_beside():
    """Exactly there motions come nearer as the square root of time: none settles, however long it is waited."""
    case = frahm.load_case(Path(__file__).parents[2] / "cases" / "brace.yaml")
    problem = Problem.of(case, settings_for(case, 0.02))
    mass, stiffness, damping = np.array([48.9129070598039, 183253094.70546868, 589.4599658712729]) / case.pipe.mass
    (mode, *_) = problem.modes_of_errors(with_design(case, frahm.DesignedAbsorber(mass, 0.0, stiffness, damping)))
    off = Disturbance(pipe_frequency=0.9, lock_in=False)
    system = off.of(mode.system)
    curve = mode.windows.curve(mode.system, off)
    breaking = [point.frequency for point in curve.special_points if point.kind == "branch-point"]
    within = mode.windows.range(off, system.reference_frequency)
    worst = worst_over(system, within, samples=16, min_basin=0.0, seed=1)
    surveyed = np.array([survey.frequency for survey in worst.surveys])
    assert breaking
    assert all(np.min(np.abs(surveyed - at)) > 2e-4 * at for at in breaking)
    assert worst.verified
