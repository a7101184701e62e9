"""After how many periods a motion nearly repeats, and whether it does so better and better."""

import numpy as np
import pytest

from frahm.attractors.repetition import approaching, repeats


@pytest.mark.parametrize(
    ("amplitude", "shrinking", "expected"),
    [(0.02, 0.999, [3]), (0.005, 1.0, []), (0.02, 0.9999, []), (0.0, 1.0, [3])],
    ids=["settling", "beating", "settling too slowly to tell", "settled"],
)
def test_a_motion_that_comes_nearer_to_an_orbit_is_told_from_a_beat(amplitude, shrinking, expected):
    k = np.arange(600)[:, None]
    strobes = np.cos(2 * np.pi * k / 3 + np.arange(4)) + amplitude * shrinking**k * np.cos(0.3 * k)
    assert repeats(strobes[None])[0][0] == 3
    assert approaching(strobes, [3]) == expected
