"""Equations of motion of elastic pipes, their stress, and absorbers anywhere along them."""

import math

import numpy as np
import pytest

import frahm

JACKET = frahm.load_case("jacket-pipe")
ELASTIC = frahm.load_case("jacket-pipe-elastic")


def as_table(**more):
    """The one-mode pipe as a table of modes, with the rigid participation."""
    mode = {"mass": 247.0, "frequency": JACKET.pipe.frequency, "damping_ratio": 0.0015, "lift_length": 1.0}
    pipe = {"kind": "modes", "diameter": 0.762, "length": 1.0, "sections": [0.0], "modes": [mode | more]}
    pipe["modes"][0].setdefault("displacements", [1.0])
    return frahm.load_case(JACKET.to_dict() | {"pipe": pipe})


def test_one_mode_of_a_table_is_the_one_mode_pipe():
    a, b = frahm.build_system(JACKET), frahm.build_system(as_table())
    for name in ("mass", "damping", "stiffness", "forcing", "output"):
        np.testing.assert_allclose(getattr(a, name), getattr(b, name), rtol=1e-14)
    curves = [frahm.frequency_response(case, detuning=(-0.2, 0.2)) for case in (JACKET, as_table())]
    np.testing.assert_allclose(curves[0].pipe_peak, curves[1].pipe_peak, rtol=1e-9)


def test_a_lift_that_is_felt_less_is_a_smaller_force():
    system = frahm.build_system(as_table(lift_length=0.5))
    assert system.forcing[0] == pytest.approx(0.5 * frahm.build_system(JACKET).forcing[0], rel=1e-14)


def test_the_governing_mode_comes_first():
    case = ELASTIC.with_pipe(governing_mode=2)
    system, first = frahm.build_system(case), frahm.build_system(ELASTIC)
    omega = np.sqrt(np.diag(system.stiffness)[:3] / np.diag(system.mass)[:3])
    assert omega == pytest.approx(case.pipe.beam_modes.frequencies[[1, 0, 2]])
    assert system.reference_frequency == pytest.approx(omega[0]) == case.pipe.frequency
    assert frahm.stress_row(case, 3.0)[:3] == pytest.approx(frahm.stress_row(ELASTIC, 3.0)[[1, 0, 2]])
    assert np.all(system.forcing[3:] == 0)
    assert system.forcing[0] > first.forcing[0] * 0.3


def test_an_absorber_at_a_section_feels_that_section():
    case = ELASTIC.with_absorber(position=20.0)
    direction = frahm.build_system(case).elements[0].direction
    assert direction[:3] == pytest.approx(-case.pipe.beam_modes.shape(20.0))
    assert direction[3] == 1
    assert frahm.build_system(ELASTIC.with_absorber(position="31.2 m")).elements[0].direction[0] == pytest.approx(-1)


def test_a_place_of_smaller_motion_is_a_smaller_absorber():
    # one mode: mass and damping count with phi^2, cubic stiffness with phi^4, and the stroke with 1/phi
    case = ELASTIC.with_pipe(mode_count=1)
    phi = float(case.pipe.beam_modes.shape(20.0)[0])
    there = case.with_absorber(position=20.0)
    law = case.absorbers[0].law
    tip = case.with_absorber(
        rho2=case.absorbers[0].mass * phi**2 / case.pipe.mass,
        xi2=law.damping * phi**2 / case.pipe.mass, kappa=law.stiffness * phi**4 / case.pipe.mass,
    )  # fmt: skip
    for detuning in (-0.2, 0.3):
        a, b = (frahm.periodic_responses(c, detuning=detuning) for c in (there, tip))
        assert [r.pipe_peak for r in a] == pytest.approx([r.pipe_peak for r in b], rel=1e-8)
        assert [r.relative_peak for r in a] == pytest.approx([phi * r.relative_peak for r in b], rel=1e-8)


def test_stress_is_that_of_the_bent_shape():
    row, system = frahm.stress_row(ELASTIC, 7.0), frahm.build_system(ELASTIC)
    x = np.array([0.02, -0.003, 0.001, 0.05])
    h, modes = 1e-3, ELASTIC.pipe.beam_modes
    bent = (modes.shape(7 + h) - 2 * modes.shape(7.0) + modes.shape(7 - h)) / h**2 @ x[:3]
    assert row @ x == pytest.approx(2.06e11 * 0.381 * bent, rel=1e-5)
    assert row.shape == system.output.shape
    sections, rows = frahm.systems.stress_rows(ELASTIC)
    assert rows[sections == 0.0][0] == pytest.approx(frahm.stress_row(ELASTIC))
    with pytest.raises(frahm.ParameterError, match="no curvature and no stress"):
        frahm.stress_row(JACKET)


def test_static_deflection_of_a_cantilever():
    # P l^3 / (3 E I), by as many modes as there may be: statics the modes know nothing of
    case = ELASTIC.with_pipe(mode_count=20).without_absorbers()
    system, beam = frahm.build_system(case), case.pipe.beam()
    tip = system.output @ np.linalg.solve(system.stiffness, 1000.0 * system.output)
    assert tip == pytest.approx(1000 * 31.2**3 / (3 * beam.bending_stiffness), rel=1e-5)
    stress = frahm.stress_row(case, 0.0) @ np.linalg.solve(system.stiffness, system.output)
    assert stress == pytest.approx(31.2 * 0.381 * 2.06e11 / beam.bending_stiffness, rel=0.03)


@pytest.fixture(scope="module")
def converged():
    return {n: frahm.frequency_response(ELASTIC.with_pipe(mode_count=n), detuning=(-0.2, 0.2)) for n in (1, 2, 4)}


def test_the_response_converges_with_the_number_of_modes(converged):
    peaks = {n: float(curve.pipe_peak[curve.stable].max()) for n, curve in converged.items()}
    assert abs(peaks[2] / peaks[4] - 1) < 0.2 * abs(peaks[1] / peaks[4] - 1) < 1e-3
    kinds = [[p.kind for p in curve.special_points] for curve in converged.values()]
    assert kinds[0] == kinds[1] == kinds[2]


def test_every_verb_takes_an_elastic_pipe():
    case = ELASTIC.with_pipe(mode_count=2, lift="mode-shape")
    settled = frahm.integrate(case, detuning=-0.2, periods=900, samples_per_period=32).last(5)
    (response,) = frahm.periodic_responses(case, detuning=-0.2)
    assert settled.peaks().pipe == pytest.approx(response.pipe_peak, rel=2e-3)
    found = frahm.find_attractors(case, detuning=-0.2, samples=8, seed=1)
    assert [a.kind for a in found] == ["periodic"]
    assert found[0].pipe_peak == pytest.approx(response.pipe_peak, rel=1e-3)
    worst = frahm.worst_case(case, detuning=(-0.25, -0.2), samples=8, seed=1)
    assert worst.pipe_peak >= response.pipe_peak
    labels = frahm.basin_map(case, detuning=-0.2, plane=("x1", "v1"), extent=((-0.02, 0.02), (-0.1, 0.1)), resolution=3)
    assert set(np.unique(labels["label"])) == {0}
    with pytest.raises(frahm.ParameterError, match="one mode with one cubic sink"):
        frahm.frequency_response(case, detuning=(-0.1, 0.1), method="slow-flow")


def test_loci_and_detached_curves_of_an_elastic_pipe():
    case = ELASTIC.with_pipe(mode_count=2, lift="mode-shape")
    curve = frahm.frequency_response(case, detuning=(-0.1, 0.2))
    fold = max(p.detuning for p in curve.special_points if p.kind == "saddle-node")
    kappa = case.absorbers[0].normalised(case.pipe.mass)["kappa"]
    loci = frahm.bifurcation_curve(
        case, kind="saddle-node", plane=("detuning", "kappa"), bounds=((0.0, 0.2), (300.0, 450.0))
    )
    sigma, values, number = (loci[name].values for name in ("detuning", "kappa", "curve"))
    crossings = []
    for i in np.flatnonzero(((values[:-1] < kappa) != (values[1:] < kappa)) & (np.diff(number) == 0)):
        share = (kappa - values[i]) / (values[i + 1] - values[i])
        crossings.append(sigma[i] + share * (sigma[i + 1] - sigma[i]))
    assert min(abs(np.array(crossings) - fold)) < 1e-4
    events = frahm.detached_curve_events(case, "force", (1.0, 1.3), detuning=(-0.3, 0.1))
    assert all(math.isfinite(event.value) for event in events)
