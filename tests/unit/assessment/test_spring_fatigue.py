import numpy as np
import pytest

import frahm
from frahm.assessment import transverse_spring_cycles


def test_a_wire_is_stretched_twice_a_cycle():
    """Stress E z^2/(2 L^2) at the ends of the stroke, for z small against L."""
    E, L, z = 2.06e11, 2.0, 0.05
    t = np.linspace(0, 2 * np.pi * 10, 10 * 64 + 1)
    cycles = transverse_spring_cycles(z * np.sin(t), L, E / L)
    large = cycles.ranges > 0.5 * cycles.ranges.max()
    assert cycles.ranges[large] == pytest.approx(E * z**2 / (2 * L**2), rel=2e-4)
    assert cycles.counts[large].sum() == pytest.approx(20)


def test_an_offset_wire_has_one_long_and_one_short_stretch():
    E, L = 2.06e11, 1.0
    cycles = transverse_spring_cycles([0.0, 0.06, -0.04, 0.06, -0.04, 0.06, 0.0], L, E / L)
    stretch = {z: E * (np.hypot(1, z) - 1) for z in (0.06, 0.04)}
    found = np.unique(np.round(cycles.ranges / 1e3)).tolist()
    assert found == pytest.approx([round(stretch[0.04] / 1e3), round(stretch[0.06] / 1e3)])


@pytest.mark.parametrize(
    ("arguments", "name"),
    [
        (([0.0, np.inf], 1.0, 1.0), "relative"),
        (([0.0], 0.0, 1.0), "length"),
        (([0.0], 1.0, -1.0), "stress_per_extension"),
    ],
)
def test_bad_input(arguments, name):
    with pytest.raises(frahm.ParameterError, match=name):
        transverse_spring_cycles(*arguments)
