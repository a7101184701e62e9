"""Closed forms of the Euler-Bernoulli beam, and the jacket pipe as a cantilever."""

import math

import numpy as np
import pytest
from scipy.integrate import simpson
from scipy.optimize import brentq

import frahm
from frahm.structure import Beam, PointMass, Support, beam_modes

HELD = math.inf
ENDS = {
    "pinned": (Support(0, HELD), Support(1, HELD)),
    "clamped-pinned": (Support(0, HELD, HELD), Support(1, HELD)),
    "clamped": (Support(0, HELD, HELD), Support(1, HELD, HELD)),
    "cantilever": (Support(0, HELD, HELD),),
}


def unit_beam(supports, point_masses=()):
    """E I = m = l = 1: natural frequencies are beta^2."""
    return Beam(1.0, 1.0, 1.0, tuple(supports), tuple(point_masses))


@pytest.mark.parametrize(
    ("ends", "square", "curvature", "participation", "gamma"),
    [  # first mode: beta^2, l^2 |phi''| at its largest, int |phi| / int phi^2, and sqrt(int phi^2 / int phi^4)
        ("pinned", 9.8696, 9.870, 1.273, 1.155),
        ("clamped-pinned", 15.4182, 20.432, 1.298, None),
        ("clamped", 22.3733, 28.175, 1.320, 1.167),
        ("cantilever", 3.5160, 3.516, 1.566, 1.305),
    ],
)
def test_first_mode_of_a_beam(ends, square, curvature, participation, gamma):
    modes = beam_modes(unit_beam(ENDS[ends]), 1)
    assert modes.frequencies[0] == pytest.approx(square, abs=5e-5)
    assert abs(modes.curvature(modes.stressed_sections[0])[0]) == pytest.approx(curvature, abs=5e-4)
    assert modes.participations[0] == pytest.approx(participation, abs=7e-4)
    if gamma is not None:
        s = np.linspace(0, 1, 4001)
        phi = modes.shape(s)[:, 0]
        squares, fourth = simpson(phi**2, x=s), simpson(phi**4, x=s)
        assert math.sqrt(squares / fourth) == pytest.approx(gamma, abs=1e-3)


@pytest.mark.parametrize(
    ("ends", "equation"),
    [
        ("pinned", math.sin),
        ("clamped-pinned", lambda x: math.tan(x) - math.tanh(x)),
        ("clamped", lambda x: math.cos(x) - 1 / math.cosh(x)),
        ("cantilever", lambda x: math.cos(x) + 1 / math.cosh(x)),
    ],
)
def test_twenty_modes_solve_the_frequency_equation(ends, equation):
    found = np.sqrt(beam_modes(unit_beam(ENDS[ends]), 20).frequencies)
    exact = [brentq(equation, x - 0.01, x + 0.01, xtol=1e-15) for x in found]
    np.testing.assert_allclose(found, exact, rtol=1e-10)
    assert np.all(np.diff(found) > 2.5)  # none is left out: they are about pi apart


def test_springs_tend_to_the_ends_they_stand_for():
    pinned, clamped = (beam_modes(unit_beam(ENDS[name]), 3).frequencies for name in ("pinned", "clamped"))
    soft, stiff = (beam_modes(unit_beam((Support(0, HELD, k), Support(1, HELD, k))), 3) for k in (1e-9, 1e10))
    np.testing.assert_allclose(soft.frequencies, pinned, rtol=1e-8)
    np.testing.assert_allclose(stiff.frequencies, clamped, rtol=1e-8)
    loose = beam_modes(unit_beam((Support(0, 1e12), Support(1, 1e12))), 3)
    np.testing.assert_allclose(loose.frequencies, pinned, rtol=1e-8)
    between = [beam_modes(unit_beam((Support(0, HELD, k), Support(1, HELD, k))), 1).frequencies[0]
               for k in (0.1, 1, 10, 100)]  # fmt: skip
    assert np.all(np.diff([pinned[0], *between, clamped[0]]) > 0)


def test_a_rotational_spring_solves_its_frequency_equation():
    # pinned beam with a spring k at one end: k/(EI/l) (coth x - cot x) + 2 x = 0
    k = 7.0
    found = beam_modes(unit_beam((Support(0, HELD, k), Support(1, HELD))), 4).frequencies
    for x in np.sqrt(found):
        assert k * (1 / math.tanh(x) - 1 / math.tan(x)) + 2 * x == pytest.approx(0, abs=1e-7)


def test_a_cantilever_with_a_tip_mass():
    # tip mass as heavy as the beam: 1 + cos x cosh x = x (sin x cosh x - cos x sinh x); x_1 = 1.24792
    modes = beam_modes(unit_beam(ENDS["cantilever"], [PointMass(1.0, 1.0)]), 3)
    for x in np.sqrt(modes.frequencies):
        left = 1 + math.cos(x) * math.cosh(x)
        right = x * (math.cos(x) * math.sinh(x) - math.sin(x) * math.cosh(x))
        assert left + right == pytest.approx(0, abs=1e-8 * math.cosh(x))
    assert math.sqrt(modes.frequencies[0]) == pytest.approx(1.24792, abs=5e-6)


def test_two_equal_spans_are_one_pinned_and_one_clamped_pinned():
    found = beam_modes(Beam(2.0, 1.0, 1.0, (Support(0, HELD), Support(1, HELD), Support(2, HELD))), 4).frequencies
    single = beam_modes(unit_beam(ENDS["pinned"]), 2).frequencies
    propped = beam_modes(unit_beam(ENDS["clamped-pinned"]), 2).frequencies
    np.testing.assert_allclose(found, np.sort([*single, *propped]), rtol=1e-10)


@pytest.fixture(scope="module")
def cantilever():
    return frahm.load_case("jacket-pipe-elastic")


def test_the_jacket_pipe_as_a_cantilever(cantilever):
    pipe = cantilever.pipe
    assert pipe.frequency / (2 * math.pi) == pytest.approx(0.78, abs=1e-3)
    assert pipe.mass == pytest.approx(pipe.mass_per_length * pipe.length / 4, rel=1e-9)
    row = frahm.stress_row(cantilever)
    assert row[0] == pytest.approx(283.5e6, abs=0.05e6)
    resonant = 0.08670  # doi 10.3390/app12147272 without absorber, as amplitude of the tip [m]
    assert 2 * row[0] * resonant == pytest.approx(49.2e6, abs=0.05e6)
    thin = 4.900885 * resonant * math.sqrt(2 * 2.06e11 * 7850) * 0.762 / (0.762 - 0.0134)
    assert row[0] * resonant == pytest.approx(thin, rel=2e-3)


def test_the_sink_of_the_paper_at_the_tip(cantilever):
    sink = cantilever.absorbers[0]
    assert sink.mass == pytest.approx(38.5, abs=0.1)
    assert sink.law.stiffness == pytest.approx(7.1e5, rel=2e-3)
    values = sink.normalised(cantilever.pipe.mass)
    assert (values["rho2"], values["kappa"], values["xi2"]) == pytest.approx((0.02, 367.38, 0.0117), rel=3e-4)


def test_a_lift_in_proportion_to_the_motion_is_the_rigid_participation(cantilever):
    rigid = frahm.load_case("jacket-pipe")
    bare = [frahm.build_system(case.without_absorbers()) for case in (rigid, cantilever.with_pipe(lift="mode-shape"))]
    amplitudes = [s.forcing[0] / (s.damping[0, 0] * s.reference_frequency) for s in bare]
    assert amplitudes[1] == pytest.approx(amplitudes[0], rel=2e-3)  # 0.7795 Hz and 247.4 kg/m against 0.78 and 247
    np.testing.assert_allclose(bare[1].forcing[1:], 0.0, atol=1e-9 * bare[1].forcing[0])
    uniform = frahm.build_system(cantilever.with_pipe(lift="uniform"))
    assert uniform.forcing[0] / bare[1].forcing[0] == pytest.approx(1.566, abs=5e-4)
