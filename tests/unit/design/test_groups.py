"""Several absorbers at one place: every one-harmonic response, against independent searches and the single absorber."""

import math
import warnings

import numpy as np
import pytest
from scipy.optimize import fsolve

import frahm
from frahm.design import verified_designs
from frahm.design.absorber import DesignedAbsorber, parameters_text, together, with_design, without_designed
from frahm.design.disturbance import Disturbance
from frahm.design.groups import group_births, group_responses
from frahm.design.groups.crossings import responses
from frahm.design.groups.curves import curves, room_for
from frahm.design.hardware import hardware
from frahm.design.host import host_of
from frahm.design.kernels import births, screened
from frahm.design.problem import Problem
from frahm.design.settings import DesignSettings
from frahm.design.space import design_space
from frahm.systems import build_system

CASE = frahm.load_case("jacket-pipe")
HOST = host_of(build_system(CASE))
MASS, OMEGA = CASE.pipe.mass, CASE.pipe.frequency
MODE = np.array([[OMEGA, HOST.modal_damping, HOST.modal_mass]])
THREE = [(200.0, 0.004, 0.007), (367.38, 0.0039, 0.0067), (900.0, 0.006, 0.0063)]  # kappa, xi2, rho2


def _conditions(detunings: list[float]):
    W = OMEGA + np.array([detunings])
    return HOST.conditions_at([Disturbance()], W)


def _rows(sinks: list[tuple[float, float, float]]) -> np.ndarray:
    return MASS * np.array([[[rho2, 0.0, kappa, xi2, 0.0] for kappa, xi2, rho2 in sinks]])


def _found(designs: np.ndarray, detuning: float) -> tuple[float, float]:
    """Largest pipe amplitude and stroke over all responses at one detuning."""
    count = designs.shape[1]
    found, peaks = np.empty((1, 2)), np.empty((1, 1))
    group_responses(*_conditions([detuning]).arrays, MODE, np.ones(1), designs, np.ones(count), found, peaks)
    return float(peaks[0, 0]), float(found[0, 0])


def _largest_by_newton(sinks: list[tuple[float, float, float]], detuning: float, starts: int) -> float:
    """Largest |X| of the first-harmonic balance of all coordinates, by Newton's method from many starts."""
    W = OMEGA + detuning
    (a,), (u,), _, _ = (v for v in HOST.receptances(np.array([W])))
    m = MASS * np.array([rho2 for *_, rho2 in sinks])
    k = 0.75 * MASS * np.array([kappa for kappa, *_ in sinks])
    c = MASS * np.array([xi2 for _, xi2, _ in sinks])

    def residual(packed: np.ndarray) -> np.ndarray:
        Z = 1e-2 * (packed[: len(sinks)] + 1j * packed[len(sinks) :])
        g = (1j * W * c + k * np.abs(Z) ** 2) * Z
        X = u + a * np.sum(g)
        value = (m * W * W * (X + Z) - g) / (m * W * W * 1e-2)
        return np.concatenate([value.real, value.imag])

    rng, largest = np.random.default_rng(3), 0.0
    for _ in range(starts):
        packed, _, status, _ = fsolve(residual, rng.uniform(-8, 8, 2 * len(sinks)), full_output=True, maxfev=250)
        if status == 1 and np.max(np.abs(residual(packed))) < 1e-9:
            Z = 1e-2 * (packed[: len(sinks)] + 1j * packed[len(sinks) :])
            largest = max(largest, abs(u + a * np.sum((1j * W * c + k * np.abs(Z) ** 2) * Z)))
    return largest


@pytest.mark.parametrize("seed", range(3))
@pytest.mark.parametrize("count", [2, 3, 5])
def test_the_largest_response_of_random_sinks_is_that_of_newtons_method_from_many_starts(count, seed):
    rng = np.random.default_rng(100 * count + seed)
    sinks = [
        (10 ** rng.uniform(1.5, 3.3), 10 ** rng.uniform(-2.6, -1.7), rng.uniform(0.3, 1) * 0.03 / count)
        for _ in range(count)
    ]
    detuning = rng.uniform(-0.3, 0.3)
    closed, _ = _found(_rows(sinks), detuning)
    newton = _largest_by_newton(sinks, detuning, 25 * count)
    assert closed >= newton * (1 - 3e-4)  # Newton's method may miss the largest, the closed form must not
    assert closed == pytest.approx(newton, rel=3e-4) or closed > newton


@pytest.mark.parametrize(("detuning", "largest"), [(0.05, 0.009429), (0.1, 0.005672)])
def test_three_different_sinks_have_the_response_that_starts_missed(detuning, largest):
    assert _found(_rows(THREE), detuning)[0] == pytest.approx(largest, abs=2e-6)


def test_one_absorber_is_the_closed_form_of_one():
    rng = np.random.default_rng(5)
    designs = np.zeros((120, 5))
    designs[:, 0] = 0.02 * MASS
    designs[:, 2] = MASS * 10 ** rng.uniform(1, 3.5, 120)
    designs[:, 3] = MASS * 10 ** rng.uniform(-2.8, -1.4, 120)
    designs[::3, 1] = MASS * 0.02 * OMEGA**2 * rng.uniform(0.3, 1.3, 40)
    designs[1::6, 4] = MASS * 10 ** rng.uniform(5, 7, 20)
    conditions = HOST.conditions([Disturbance()], (OMEGA - 0.4, OMEGA + 0.4), 121)
    alone, group = np.empty((2, 120, 2))
    one, many = np.empty((2, 120, 1))
    screened(*conditions.arrays, MODE, designs, alone, one)
    group_responses(*conditions.arrays, MODE, np.ones(1), designs[:, None], np.ones(1), group, many)
    np.testing.assert_allclose(many, one, rtol=5e-4)
    np.testing.assert_allclose(group[:, 0], alone[:, 0], rtol=5e-4)
    wide = HOST.conditions([Disturbance()], (0.7 * OMEGA, 1.3 * OMEGA), 241)
    born, bred = np.empty((2, 120))
    births(wide.frequency, wide.a, wide.u, wide.absorber, designs, born)
    group_births(wide.frequency, wide.a, wide.u, wide.absorber, designs[:, None], bred)
    near = (born > 0.6) & (born < 1.9)
    assert np.sum(near) > 8
    np.testing.assert_allclose(bred[near], born[near], rtol=1e-4)
    assert np.all(bred[np.isinf(born)] > 1.9)


def test_growth_rates_are_those_of_the_slow_flow_of_one_mode():
    conditions = HOST.conditions([Disturbance()], (OMEGA - 0.2, OMEGA + 0.2), 121)
    designs = MASS * np.array([[0.02, 0.0, 97.97, 0.0085, 0.0], [0.02, 0.0, 367.38, 0.0117, 0.0]])
    alone, group = np.empty((2, 2, 2))
    peaks = np.empty((2, 1))
    screened(*conditions.arrays, MODE, designs, alone, peaks)
    group_responses(*conditions.arrays, MODE, np.ones(1), designs[:, None], np.ones(1), group, peaks)
    # the slow flow of `kernels` averages the pipe, that of groups its own accelerations: alike to a few per cent
    np.testing.assert_allclose(group[:, 1], alone[:, 1], rtol=0.06)


def test_half_sinks_at_one_place_have_the_single_sinks_response_and_more():
    single = MASS * np.array([[[0.02, 0.0, 367.38, 0.0117, 0.0]]])
    halves = np.repeat(0.5 * single, 2, axis=1)
    for detuning in (-0.3, -0.1, 0.02, 0.1, 0.25):
        one, both = _found(single, detuning), _found(halves, detuning)
        assert both[0] >= one[0] * (1 - 3e-4)
        assert both[1] >= one[1] * (1 - 3e-4)


def test_linear_absorbers_answer_as_the_matrices_say():
    dampers = [DesignedAbsorber(0.01, 0.2523, 0.0, 0.0061), DesignedAbsorber(0.008, 0.17, 0.0, 0.0041)]
    system = build_system(with_design(CASE, together(dampers)))
    rows = MASS * np.array([[one.row for one in dampers]])
    for detuning in (-0.2, 0.0, 0.1):
        W = OMEGA + detuning
        K, C = system.stiffness.astype(complex), system.damping.astype(complex)
        for element in system.elements:
            K = K + element.law.coefficients[0] * np.outer(element.direction, element.direction)
            C = C + element.law.damping * np.outer(element.direction, element.direction)
        x = np.linalg.solve(K - W * W * system.mass + 1j * W * C, system.forcing)
        assert _found(rows, detuning)[0] == pytest.approx(abs(system.output @ x), rel=1e-4)


@pytest.mark.parametrize("family", ["sink", "tuned", "mixed"])
@pytest.mark.parametrize("shares", ["equal", "free", (0.7, 0.3)])
def test_a_space_of_several_absorbers_maps_there_and_back_and_shares_the_mass(family, shares):
    settings = DesignSettings(mass_ratio=(0.01, 0.03), count=2, mass_shares=shares)
    space = design_space(HOST, MASS, family, settings, 2)
    units = np.random.default_rng(2).uniform(0.05, 0.95, (20, space.size))
    designs = space.designs(units)
    np.testing.assert_allclose(space.units(designs), units, atol=1e-12)
    masses = designs.reshape(20, 2, 5)[:, :, 0]
    assert np.all(masses.sum(axis=1) > 0.0099 * MASS)
    assert np.all(masses.sum(axis=1) < 0.0301 * MASS)
    if shares != "free":
        share = 0.5 if shares == "equal" else 0.7
        np.testing.assert_allclose(masses[:, 0], share * masses.sum(axis=1))


def test_equal_devices_are_one_drawing():
    settings = DesignSettings(mass_ratio=0.02, count=3, devices="equal")
    space = design_space(HOST, MASS, "mixed", settings, 3)
    assert space.size == 3
    design = space.absorber(space.designs(np.full((1, 3), 0.4))[0])
    assert design.count == 3
    assert len({one.row for one in design.absorbers}) == 1


def test_a_design_of_several_knows_its_parts():
    design = together([DesignedAbsorber(0.01, 0.2, 0.0, 0.004), DesignedAbsorber(0.02, 0.0, 300.0, 0.01)])
    assert (design.count, design.family, design.nonlinear) == (2, "mixed", True)
    assert design.parameters["kappa_2"] == 300.0
    assert design.changed("kappa_2", 1.1).absorbers[1].kappa == pytest.approx(330.0)
    assert design.changed("linear", 1.1).linear == pytest.approx(0.22)
    assert "absorber 2: rho2 0.02" in parameters_text(design)
    case = with_design(CASE, design)
    assert [absorber.name for absorber in case.absorbers] == ["sink", "sink 2"]
    assert math.isclose(sum(absorber.mass for absorber in case.absorbers), 0.03 * MASS)


@pytest.mark.parametrize(
    ("given", "field"),
    [
        ({"count": 0}, "design.count"),
        ({"count": [3, 1]}, "design.count"),
        ({"count": 7}, "design.count"),
        ({"count": 2, "mass_shares": [0.5, 0.4]}, "design.mass_shares"),
        ({"count": 3, "mass_shares": [0.5, 0.5]}, "design.mass_shares"),
        ({"count": 2, "mass_shares": "fre"}, "design.mass_shares"),
        ({"count": 2, "mass_shares": [0.6, 0.4], "devices": "equal"}, "design.mass_shares"),
        ({"count": 2, "mass_shares": "free", "devices": "equal"}, "design.mass_shares"),
    ],
)
def test_what_cannot_be_designed_together_is_refused_by_field(given, field):
    with pytest.raises(frahm.ParameterError) as told:
        frahm.load_case(CASE.to_dict() | {"design": given})
    assert field in str(told.value)


def test_two_tuned_dampers_are_better_than_one_of_their_mass():
    settings = DesignSettings(mass_ratio=0.02, count=(1, 2), family="tuned", errors=())
    (best,) = verified_designs(CASE, settings, ("tuned",))
    (alone,) = verified_designs(CASE, settings.changed(count=1), ("tuned",))
    assert (best.count, alone.count) == (2, 1)
    assert best.verified
    assert best.value < 0.92 * alone.value
    # by the matrices, over the whole window
    system = build_system(with_design(CASE, best.design))
    largest = 0.0
    for W in OMEGA + np.linspace(*CASE.analysis.detuning, 2001):
        K, C = system.stiffness.astype(complex), system.damping.astype(complex)
        for element in system.elements:
            K = K + element.law.coefficients[0] * np.outer(element.direction, element.direction)
            C = C + element.law.damping * np.outer(element.direction, element.direction)
        x = np.linalg.solve(K - W * W * system.mass + 1j * W * C, system.forcing)
        largest = max(largest, abs(system.output @ x))
    assert best.worst_pipe_peak == pytest.approx(largest, rel=1e-5)


def _with_beside(*more: dict) -> frahm.Case:
    """The case with further absorbers."""
    sink = CASE.to_dict()["absorbers"][0]
    return frahm.load_case(CASE.to_dict() | {"absorbers": [sink, *({"mass": 2.0, **one} for one in more)]})


@pytest.mark.parametrize("count", [1, 2])
def test_what_is_designed_scatters_and_what_stays_beside_it_does_not(count):
    linear = {"kind": "linear", "stiffness": 40.0, "damping": 0.5}
    case = _with_beside({"name": "second", "law": linear}, {"name": "third", "law": linear})
    problem = Problem.of(case, DesignSettings(mass_ratio=0.02, count=(1, 2), scatter={"kappa": 0.1, "xi2": 0.2}))
    off = problem.disturbances[1]
    designed = problem.modes_of(together([DesignedAbsorber(0.02 / count, 0.2, 30.0, 0.01)] * count))[0].system
    *changed, last = zip(off.of(designed).elements, designed.elements, strict=True)
    assert len(changed) == count
    assert all(new.law.damping == pytest.approx(0.8 * old.law.damping) for new, old in changed)
    assert last[0].law.damping == last[1].law.damping
    assert last[0].law.coefficients == last[1].law.coefficients
    (bare,) = problem.modes(without_designed(case, 2))
    assert [element.law.damping for element in off.of(bare.system).elements] == [0.5]


def test_the_sheet_tells_what_every_absorber_replaced_had():
    law = {"kind": "linear", "stiffness": 40.0, "damping": 0.5}
    case = _with_beside({"name": "second", "law": law, "friction": {"force": 0.05, "speed": 0.01}})
    sheet = hardware(case, DesignedAbsorber(0.02, 0.0, 367.38, 0.0117), 0.05, OMEGA, replaced=2)
    assert any("dry friction" in warning for warning in sheet.warnings)


def test_a_mixture_without_one_of_its_springs_is_a_point_of_the_space():
    space = design_space(HOST, MASS, "mixed", DesignSettings(mass_ratio=0.02, count=2), 2)
    damper = space.split(MASS * np.array([0.02, 0.46, 0.0, 0.0166, 0.0]))
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        units = space.units(damper[None])
    assert np.all(np.isfinite(units))
    assert units[0, 1] == units[0, 4] == pytest.approx(0.0)


def test_the_sheet_of_several_says_which_absorber_a_warning_is_about():
    pair = together([DesignedAbsorber(0.01, 0.24684, 25.63, 0.0059), DesignedAbsorber(0.01, 0.21288, 2.2147, 0.0052)])
    sheet = hardware(CASE, pair, 0.0186, OMEGA)
    about = [warning for warning in sheet.warnings if "sag" in warning or "wound" in warning]
    assert sorted(warning[:12] for warning in about) == ["Absorber 1: ", "Absorber 1: ", "Absorber 2: ", "Absorber 2: "]
    assert sum("two directions" in warning for warning in sheet.warnings) == 1
    strokes = [item.basis for item in sheet.items if item.name.endswith("largest stroke")]
    assert len(strokes) == 2
    assert all("any of the absorbers" in basis for basis in strokes)


@pytest.mark.parametrize("seed", range(8))
@pytest.mark.parametrize("count", [2, 3, 5])
def test_all_responses_are_those_of_the_search_of_harmonic_balance(count, seed):
    rng = np.random.default_rng(10 * count + seed)
    sinks = [(10 ** rng.uniform(2, 3.3), 10 ** rng.uniform(-2.7, -2), rng.uniform(0.5, 1) * 0.03 / count)
             for _ in range(count)]  # fmt: skip
    detuning = rng.uniform(-0.1, 0.2)
    (W,), (a,), (u,), (b,), (x,) = (row[0] for row in _conditions([detuning]).arrays[:5])
    group, work = _rows(sinks)[0], room_for(count)
    hits, squares = np.empty((4 * 3**count, 3)), np.empty((4 * 3**count, count))
    number = curves(W, a, abs(u) ** 2, abs(u) ** 2, group, 1.0, 1.0, work)
    found = hits[: responses(number, abs(u) ** 2, a, work, hits, squares)]
    total = found[:, 1] + 1j * found[:, 2]
    closed = np.sort(abs(x + b * total * u / (1 - a * total)))
    design = together([DesignedAbsorber(rho2, 0.0, kappa, xi2) for kappa, xi2, rho2 in sinks])
    known = frahm.periodic_responses(with_design(CASE, design), detuning=detuning, harmonics=1)
    np.testing.assert_allclose(closed, sorted(one.pipe_peak for one in known), rtol=2e-3)
