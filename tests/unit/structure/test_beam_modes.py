import math

import numpy as np
import pytest
import scipy.linalg
from scipy.integrate import simpson

import frahm
from frahm.structure import Beam, PointMass, Support, beam_modes

HELD = math.inf


@pytest.fixture(scope="module")
def awkward():
    """Two unequal spans, springs, an overhanging end and two masses."""
    return Beam(
        length=10.0, bending_stiffness=3e6, mass_per_length=40.0,
        supports=(Support(0.0, HELD, 2e6), Support(3.7, HELD), Support(8.0, 5e5, 1e5)),
        point_masses=(PointMass(5.5, 60.0), PointMass(10.0, 25.0)), stress_per_curvature=2.1e10,
    )  # fmt: skip


def finite_elements(beam, elements):
    """Natural frequencies and section displacements by cubic elements: another method."""
    h = beam.length / elements
    ei, m = beam.bending_stiffness, beam.mass_per_length
    k = ei / h**3 * np.array([[12, 6*h, -12, 6*h], [6*h, 4*h*h, -6*h, 2*h*h],
                              [-12, -6*h, 12, -6*h], [6*h, 2*h*h, -6*h, 4*h*h]])  # fmt: skip
    c = m * h / 420 * np.array([[156, 22*h, 54, -13*h], [22*h, 4*h*h, 13*h, -3*h*h],
                                [54, 13*h, 156, -22*h], [-13*h, -3*h*h, -22*h, 4*h*h]])  # fmt: skip
    n = 2 * (elements + 1)
    K, M = np.zeros((n, n)), np.zeros((n, n))
    for e in range(elements):
        at = slice(2 * e, 2 * e + 4)
        K[at, at] += k
        M[at, at] += c
    held = []
    for support in beam.supports:
        node = round(support.at / h)
        for which, spring in ((0, support.translation), (1, support.rotation)):
            if spring == HELD:
                held.append(2 * node + which)
            else:
                K[2 * node + which, 2 * node + which] += spring
    for point in beam.point_masses:
        M[2 * round(point.at / h), 2 * round(point.at / h)] += point.mass
    free = np.setdiff1d(np.arange(n), held)
    squares, vectors = scipy.linalg.eigh(K[np.ix_(free, free)], M[np.ix_(free, free)], subset_by_index=(0, 5))
    full = np.zeros((n, 6))
    full[free] = vectors
    return np.sqrt(squares), full[::2]


def test_an_awkward_beam_against_finite_elements(awkward):
    modes = beam_modes(awkward, 6)
    omega, shapes = finite_elements(awkward, 200)
    np.testing.assert_allclose(modes.frequencies, omega, rtol=2e-6)
    phi = modes.shape(np.linspace(0, 10, 201))
    for k in range(6):
        scaled = shapes[:, k] / shapes[np.argmax(np.abs(phi[:, k])), k] * phi[np.argmax(np.abs(phi[:, k])), k]
        np.testing.assert_allclose(phi[:, k], scaled, atol=2e-5)


def test_shapes_are_orthogonal_and_scaled(awkward):
    modes = beam_modes(awkward, 6)
    s = np.linspace(0, 10, 8001)
    phi = modes.shape(s)
    gram = awkward.mass_per_length * simpson(phi[:, :, None] * phi[:, None, :], x=s, axis=0)
    for point in awkward.point_masses:
        gram += point.mass * np.outer(*[modes.shape(point.at)] * 2)
    np.testing.assert_allclose(np.diag(gram), modes.modal_masses, rtol=1e-8)
    np.testing.assert_allclose(gram - np.diag(np.diag(gram)), 0, atol=1e-7 * gram.max())
    assert np.abs(phi).max(axis=0) == pytest.approx(np.ones(6), abs=1e-6)
    np.testing.assert_allclose(modes.shape(modes.peak_sections).diagonal(), 1.0, rtol=1e-12)
    np.testing.assert_allclose(modes.shape([0.0, 3.7]), 0.0, atol=1e-13)


def test_slope_and_curvature_are_derivatives(awkward):
    modes = beam_modes(awkward, 4)
    s, h = np.array([0.3, 2.2, 4.4, 6.6, 9.1]), 1e-4
    slope = (modes.shape(s + h) - modes.shape(s - h)) / (2 * h)
    bend = (modes.slope(s + h) - modes.slope(s - h)) / (2 * h)
    np.testing.assert_allclose(modes.slope(s), slope, rtol=1e-6, atol=1e-8)
    np.testing.assert_allclose(modes.curvature(s), bend, rtol=1e-6, atol=1e-8)
    np.testing.assert_allclose(modes.stress_per_displacement(s), 2.1e10 * modes.curvature(s))


def test_integrals_of_the_shapes(awkward):
    modes = beam_modes(awkward, 5)
    s = np.linspace(0, 10, 100_001)
    phi = modes.shape(s)
    np.testing.assert_allclose(modes.squares, simpson(phi**2, x=s, axis=0), rtol=1e-9)
    for mode in (0, 2):
        middle = modes.shape(0.5 * (s[1:] + s[:-1]))
        expected = np.sum(np.sign(middle[:, [mode]]) * middle, axis=0) * 1e-4
        np.testing.assert_allclose(modes.lift_lengths(mode), expected, atol=1e-4)
        np.testing.assert_allclose(modes.products(mode), simpson(phi[:, [mode]] * phi, x=s, axis=0), atol=1e-9)


def test_scruton_number_and_equivalent_mass():
    # 2 m_e delta / (rho D^2) of the seed pipe: 6.55 with 247 kg/m, zeta 0.0015, 0.762 m
    beam = Beam(31.2, 4.5e8, 247.0, (Support(0, HELD, HELD),))
    modes = beam_modes(beam, 3)
    np.testing.assert_allclose(modes.equivalent_masses, 247.0, rtol=1e-9)
    np.testing.assert_allclose(modes.scruton_numbers(0.0015, 1.225, 0.762), 6.55, rtol=1e-3)


def test_dataset_of_the_modes(awkward):
    data = beam_modes(awkward, 3).to_dataset()
    for name, variable in data.variables.items():
        assert variable.attrs["units"], name
        assert variable.attrs["long_name"], name
    assert float(np.abs(data["shape"]).max()) == pytest.approx(1.0, abs=1e-4)


@pytest.mark.parametrize(
    ("supports", "says"),
    [
        ((), "Nothing holds the pipe"),
        ((Support(0.0, HELD),), "turn freely about its only support, at 0 m"),
        ((Support(2.0, 1e3),), "turn freely about its only support, at 2 m"),
        ((Support(0.0, 0.0, HELD), Support(3.0, 0.0, 1.0)), "Nothing holds the pipe against sideways motion"),
    ],
)
def test_mechanisms_are_named(supports, says):
    with pytest.raises(frahm.ParameterError, match=says):
        Beam(4.0, 1.0, 1.0, supports)


def test_sections_off_the_beam_are_refused(awkward):
    with pytest.raises(frahm.ParameterError, match=r"section: .*0 to 10 m"):
        beam_modes(awkward, 2).shape(10.5)
    with pytest.raises(frahm.ParameterError, match=r"supports\[0\].at"):
        Beam(1.0, 1.0, 1.0, (Support(1.5, HELD, HELD),))
    with pytest.raises(frahm.ParameterError, match="one support at a section"):
        Beam(1.0, 1.0, 1.0, (Support(0.0, HELD, HELD), Support(0.0, HELD)))
    with pytest.raises(frahm.ParameterError, match="clearly apart"):
        Beam(1.0, 1.0, 1.0, (Support(0.0, HELD, HELD), Support(1e-9, HELD)))
    with pytest.raises(frahm.ParameterError, match="count"):
        beam_modes(awkward, 1000)
