"""Springs, stops, friction and weight against differences, closed forms and quadrature."""

import math

import numba
import numpy as np
import pytest
from scipy.integrate import quad

import frahm
from frahm.absorbers import cubic_stroke_limit, equilibria, sag, wells
from frahm.absorbers.packed import law_curvatures, law_force, law_force_and_slopes, pack_laws
from frahm.lanes import LANES, address, load, store

STOPS, FRICTION = frahm.Stops(0.4, 7.0, 0.05), frahm.Friction(0.3, 0.1)
LAWS = {
    "springs": frahm.TransverseSprings(5.0, 0.7, 0.2),
    "pulled": frahm.TransverseSprings(5.0, 0.7, 0.2, pretension=1.5),
    "pushed": frahm.TransverseSprings(5.0, 0.7, 0.2, pretension=-1.5),
    "bistable": frahm.Bistable(3.0, 0.8, 0.1),
    "stops": frahm.Cubic(2.0, 0.1, stops=STOPS),
    "friction": frahm.Linear(2.0, 0.1, friction=FRICTION),
    "weight": frahm.Polynomial([1.0, -0.5, 2.0], 0.1, weight=0.6),
    "everything": frahm.TransverseSprings(5.0, 0.7, 0.2, pretension=0.5, stops=STOPS, friction=FRICTION, weight=-0.6),
}
Z = np.array([-1.3, -0.452, -0.425, -0.4, -0.2, 0.0, 1e-4, 0.31, 0.41, 0.46, 2.0])
W = np.array([0.3, -0.05, 0.0, 0.02, -2.0, 0.1, -0.001, 0.06, 0.2, -0.15, 5.0])
cases = pytest.mark.parametrize("law", LAWS.values(), ids=LAWS)


@cases
def test_slopes_and_curvature_agree_with_differences(law):
    h = 1e-6

    def along(function, x):
        return (function(x + h) - function(x - h)) / (2 * h)

    off = Z + 1e-3  # away from the corners of the stops' curvature
    assert law.stiffness(off) == pytest.approx(along(lambda z: law.force(z, W), off), rel=1e-7, abs=1e-7)
    assert law.damping_at(W) == pytest.approx(along(lambda w: law.force(Z, w), W), rel=1e-6, abs=1e-7)
    assert law.curvature(off) == pytest.approx(along(law.stiffness, off), rel=1e-6, abs=1e-5)


@cases
def test_energy_is_the_work_done_against_the_static_force(law):
    for z in (-1.3, -0.42, 0.3, 0.43, 2.0):
        corners = [math.copysign(corner, z) for corner in (0.4, 0.45) if corner < abs(z)]
        work = quad(lambda s: float(law.static_force(s)), 0, z, points=corners or None, epsabs=1e-13)[0]
        assert float(law.energy(z)) == pytest.approx(work, rel=1e-11, abs=1e-13)


@cases
def test_packed_laws_are_the_laws(law):
    codes, table = pack_laws([frahm.Cubic(1.0), law])
    for z, w in zip(Z.tolist(), W.tolist(), strict=True):
        force, slope, damping = law_force_and_slopes(*codes[1], table, z, w)
        bends = law_curvatures(*codes[1], table, z, w)
        assert law_force(*codes[1], table, z, w) == force == pytest.approx(float(law.force(z, w)), rel=1e-13, abs=1e-15)
        assert slope == pytest.approx(float(law.stiffness(z)), rel=1e-13, abs=1e-15)
        assert damping == pytest.approx(float(law.damping_at(w)), rel=1e-12, abs=1e-15)
        assert bends[0] == pytest.approx(float(law.curvature(z)), rel=1e-12, abs=1e-13)
        h = 1e-6
        ahead, behind = (law_force_and_slopes(*codes[1], table, z, w + step)[2] for step in (h, -h))
        assert bends[1] == pytest.approx((ahead - behind) / (2 * h), rel=1e-6, abs=1e-7)


@numba.njit
def lane_forces(kind, start, count, table, z, w, out):
    store(out, 0, law_force(kind, start, count, table, load(z, 0), load(w, 0)))


@cases
def test_all_lanes_give_the_same_forces(law):
    codes, table = pack_laws([law])
    lanes = np.repeat(table, LANES)
    for first in (0, 3):
        at = np.arange(first, first + LANES) % Z.size
        z, w, out = Z[at], W[at], np.empty(LANES)
        lane_forces(*codes[0], address(lanes), address(z), address(w), address(out))
        assert out == pytest.approx(law.force(z, w), rel=2e-14, abs=1e-14)


def test_transverse_springs_are_two_springs():
    # Hooke's law along each spring, its component along the motion, by vectors
    for k, L, T0 in ((5.0, 0.7, 0.0), (3.0, 0.4, 0.9), (3.0, 0.4, -0.9)):
        law = frahm.TransverseSprings(k, L, pretension=T0)
        assert law.free_length == pytest.approx(L - T0 / k)
        for z in (0.05, -0.3, 1.2):
            force = 0.0
            for side in (-1, 1):
                spring = np.array([side * L, 0.0]) - np.array([0.0, z])
                length = np.linalg.norm(spring)
                force -= k * (length - law.free_length) * spring[1] / length
            assert float(law.force(z)) == pytest.approx(force, rel=1e-13)
        assert float(law.stiffness(0.0)) == pytest.approx(2 * T0 / L, abs=1e-14)


def test_the_ratio_of_exact_to_cubic_springs():
    k, L = 900.0, 0.3
    law = frahm.TransverseSprings(k, L)
    assert law.cubic_stiffness == pytest.approx(k / L**2)
    for y, ratio in ((0.25, 0.955), (0.5, 0.845)):  # printed with the design rule
        assert float(law.force(y * L)) / (k / L**2 * (y * L) ** 3) == pytest.approx(ratio, abs=6e-4)
    assert cubic_stroke_limit(law) == 0.25 * L
    assert cubic_stroke_limit(frahm.Cubic(1.0)) == math.inf


def test_long_springs_are_cubic():
    z = np.linspace(-0.2, 0.2, 9)
    law = frahm.TransverseSprings(3.0 * 1e8, 1e4)
    assert law.force(z) == pytest.approx(3.0 * z**3, rel=1e-9)
    assert law.stiffness(z) == pytest.approx(9.0 * z**2, rel=1e-9)


def test_stops_do_nothing_inside_their_gap_and_tend_to_the_corner():
    plain, stopped = frahm.Cubic(2.0, 0.1), frahm.Cubic(2.0, 0.1, stops=STOPS)
    z = np.linspace(-STOPS.gap, STOPS.gap, 101)
    assert np.array_equal(stopped.force(z, 0.3), plain.force(z, 0.3))
    sharp = frahm.Stops(0.4, 7.0, 1e-9)
    assert float(sharp.force(0.9)) == pytest.approx(7.0 * 0.5, rel=1e-8)
    assert float(sharp.force(-0.9)) == -float(sharp.force(0.9))
    assert frahm.Stops(0.4, 7.0).depth == pytest.approx(0.04)


def test_friction_is_coulombs_when_sliding():
    assert float(FRICTION.at(3 * FRICTION.speed)) == pytest.approx(FRICTION.force, rel=5e-3)
    assert float(FRICTION.at(-1.0)) == pytest.approx(-FRICTION.force, rel=1e-8)
    # work of one period z = a cos(t) against dry friction is 4 a F once it slides all the time
    sharp = frahm.Friction(0.3, 1e-4)
    work = quad(lambda t: float(sharp.at(-math.sin(t))) * -math.sin(t), 0, math.pi, points=[1e-3, math.pi - 1e-3])[0]
    assert 2 * work == pytest.approx(4 * 0.3, rel=1e-5)


def test_where_elements_rest():
    assert equilibria(frahm.Cubic(3.0)) == pytest.approx([0.0])
    assert equilibria(frahm.Cubic(3.0, weight=0.024)) == pytest.approx([0.2])
    assert wells(frahm.Cubic(3.0)) == pytest.approx([0.0])
    bistable = frahm.Bistable(3.0, 0.75)
    assert equilibria(bistable) == pytest.approx([-0.5, 0.0, 0.5])
    assert wells(bistable) == pytest.approx([-0.5, 0.5])
    pushed = LAWS["pushed"]
    assert wells(pushed) == pytest.approx(np.array([-1, 1]) * math.sqrt(pushed.free_length**2 - 0.7**2))
    assert wells(frahm.Bistable(3.0, 0.75, weight=10.0)).size == 1


def test_sag_under_gravity():
    # the published sink: (rho2 g / kappa)^(1/3) = .081 m
    expected = (0.02 * 9.81 / 367.38) ** (1 / 3)
    assert sag(frahm.Cubic(247 * 367.38), 0.02 * 247, 9.81) == pytest.approx(expected, rel=1e-9)
    assert sag(frahm.Cubic(247 * 367.38), 0.02 * 247) == pytest.approx(0.081, abs=5e-4)
    assert sag(frahm.Linear(20.0), 2.0, 10.0) == pytest.approx(1.0)
    assert sag(frahm.Linear(0.0), 2.0) == math.inf
    assert sag(frahm.Linear(0.0, stops=frahm.Stops(0.1, 1e5, 1e-6)), 1.0, 10.0) == pytest.approx(0.1001, rel=1e-4)


def test_describing_stiffness_of_a_law_that_is_no_polynomial():
    law = frahm.TransverseSprings(5.0, 0.7, stops=STOPS)
    for a in (0.1, 0.6):
        projected = quad(lambda t, a=a: float(law.force(a * math.cos(t))) * math.cos(t), 0, math.pi, limit=200)[0]
        assert float(law.describing_stiffness(a)) == pytest.approx(2 * projected / (math.pi * a), rel=1e-6)
    assert float(law.describing_stiffness(0.0)) == float(law.stiffness(0.0))


@pytest.mark.parametrize("law", [LAWS["pulled"], LAWS["weight"], LAWS["stops"]])
def test_the_cubic_stiffness_scales_the_nonlinear_spring_only(law):
    k = law.cubic_stiffness
    changed = law.with_cubic_stiffness(1.5 * k)
    assert changed.cubic_stiffness == pytest.approx(1.5 * k)
    assert float(changed.stiffness(0.0)) == pytest.approx(float(law.stiffness(0.0)))
    expected = 0.5 * k * law.by_cubic_stiffness().force(Z)
    assert changed.force(Z) - law.force(Z) == pytest.approx(expected, rel=1e-9, abs=1e-12)


@pytest.mark.parametrize(
    ("make", "name"),
    [
        (lambda: frahm.TransverseSprings(0.0, 1.0), "stiffness"),
        (lambda: frahm.TransverseSprings(-1.0, 1.0), "stiffness"),
        (lambda: frahm.TransverseSprings(1.0, -1.0), "length"),
        (lambda: frahm.TransverseSprings(1.0, math.nan), "length"),
        (lambda: frahm.TransverseSprings(1.0, 1.0, pretension=1.0), "pretension"),
        (lambda: frahm.Bistable(1.0, -1.0), "negative_stiffness"),
        (lambda: frahm.Bistable(0.0, 1.0), "stiffness"),
        (lambda: frahm.Stops(0.0, 1.0), "gap"),
        (lambda: frahm.Stops(-0.1, 1.0), "gap"),
        (lambda: frahm.Stops(0.1, 0.0), "stiffness"),
        (lambda: frahm.Stops(0.1, 1.0, 0.0), "depth"),
        (lambda: frahm.Friction(-1.0, 0.1), "force"),
        (lambda: frahm.Friction(1.0, 0.0), "speed"),
        (lambda: frahm.Cubic(1.0, stops=0.1), "stops"),
        (lambda: frahm.Cubic(1.0, friction=0.1), "friction"),
        (lambda: frahm.Cubic(1.0, weight=math.inf), "weight"),
        (lambda: frahm.Element((1.0,), "cubic"), "law"),
    ],
)
def test_bad_numbers_are_named(make, name):
    with pytest.raises(frahm.ParameterError) as caught:
        make()
    assert caught.value.name == name


def test_rest_under_weight_is_no_response_of_a_linear_system():
    system = frahm.System(
        np.eye(2), np.zeros((2, 2)), np.diag([1.0, 0.0]), (0.0, 0.0),
        [frahm.Element((-1, 1), frahm.Cubic(1.0, 0.1, weight=0.2))],
    )  # fmt: skip
    for verb in (frahm.periodic_responses, frahm.frequency_response):
        with pytest.raises(frahm.ParameterError, match="sag"):
            verb(system, frequency=1.0 if verb is frahm.periodic_responses else (0.9, 1.1))


def test_a_law_shows_its_numbers():
    assert repr(frahm.Linear(2.0, weight=1.5)) == "Linear(coefficients=[2.0], damping=0.0, weight=1.5)"
    assert "gap=0.4" in repr(LAWS["everything"])
    assert "pretension=0.5" in repr(LAWS["everything"])


def test_a_law_does_not_change():
    with pytest.raises(AttributeError):
        LAWS["springs"].length = 2.0
