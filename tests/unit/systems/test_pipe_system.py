import numpy as np
import pytest

import frahm
from frahm.systems import as_system


def test_seed_pipe():
    # xi1, F and the resonant amplitude as checked in the published example (doi 10.3390/app12147272)
    system = frahm.build_system(frahm.load_case("jacket-pipe"))
    m1 = 247.0
    assert system.reference_frequency == pytest.approx(4.900885, abs=5e-7)
    xi1, F = system.damping[0, 0] / m1, system.forcing[0] / m1
    assert xi1 == pytest.approx(0.0147027, abs=5e-8)
    assert pytest.approx(0.00624696, abs=5e-9) == F
    assert F / (xi1 * system.reference_frequency) == pytest.approx(0.08670, abs=5e-6)
    np.testing.assert_allclose(np.diag(system.mass), [247.0, 4.94])
    assert system.name == "jacket-pipe"


def test_equations_of_motion_of_pipe_and_sink():
    # x1'' + xi1 x1' + omega^2 x1 - xi2 z' - kappa z^3 = F cos;  rho2 (z'' + x1'') + xi2 z' + kappa z^3 = 0
    case = frahm.load_case("jacket-pipe").with_absorber(kappa=97.97, xi2=0.0085, rho2=0.02)
    system = frahm.build_system(case)
    x1, v1, x2, v2, phase = 0.03, -0.1, -0.08, 0.25, 0.7
    z, w = x2 - x1, v2 - v1
    spring = 0.0085 * w + 97.97 * z**3
    a1 = 0.00624696296 * np.cos(phase) - 0.0147026536 * v1 - 4.90088454**2 * x1 + spring
    a2 = -spring / 0.02
    np.testing.assert_allclose(system.acceleration([x1, x2], [v1, v2], phase), [a1, a2], rtol=1e-8)


def test_several_absorbers_of_every_kind():
    case = frahm.load_case(
        {
            "pipe": {"mass": 10, "length": 2, "frequency": 3, "damping_ratio": 0.1, "diameter": 0.5},
            "wind": {"speed": 2, "air_density": 1.0, "lift_coefficient": 0.5},
            "absorbers": [
                {"name": "a", "mass": 1, "law": {"kind": "linear", "stiffness": 5, "damping": 0.5}},
                {"name": "b", "mass": 2, "law": {"kind": "polynomial", "coefficients": [1, 2, 3], "damping": 0.25}},
                {"name": "c", "mass": 3, "law": {"kind": "cubic", "stiffness": 7, "damping": 0.125}},
            ],
        }
    )
    system = frahm.build_system(case)
    x, v = np.array([0.1, 0.2, -0.3, 0.4]), np.array([1.0, 2.0, 3.0, 4.0])
    z, w = x[1:] - x[0], v[1:] - v[0]
    g = np.array([5 * z[0], z[1] + 2 * z[1] ** 2 + 3 * z[1] ** 3, 7 * z[2] ** 3]) + np.array([0.5, 0.25, 0.125]) * w
    lift = 0.5 * 0.5 * 1.0 * 4.0 * 0.5 * 2.0
    host = (lift - 2 * 0.1 * 10 * 3 * v[0] - 10 * 9 * x[0] + g.sum()) / 10
    np.testing.assert_allclose(system.acceleration(x, v, 0.0), [host, *(-g / [1, 2, 3])], rtol=1e-13)
    np.testing.assert_array_equal(system.output, [1, 0, 0, 0])


def test_bare_pipe():
    system = frahm.build_system(frahm.load_case("jacket-pipe").without_absorbers())
    assert system.size == 1
    assert system.elements == ()
    assert system.natural_frequencies == pytest.approx([4.900885], abs=5e-7)


def test_as_system_takes_what_load_case_reads(tmp_path):
    case = frahm.load_case("jacket-pipe")
    case.to_yaml(tmp_path / "a.yaml")
    system = frahm.build_system(case)
    assert as_system(system) is system
    for source in (case, "jacket-pipe", case.to_dict(), tmp_path / "a.yaml", str(tmp_path / "a.yaml")):
        np.testing.assert_array_equal(as_system(source).stiffness, system.stiffness)


@pytest.mark.parametrize("source", [None, 3, [1], object(), b"jacket-pipe"])
def test_as_system_refuses_anything_else(source):
    with pytest.raises(frahm.ParameterError, match=r"case_or_system: given .*frahm.System"):
        as_system(source)
