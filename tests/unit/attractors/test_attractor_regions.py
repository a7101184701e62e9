import numpy as np
import pytest

import frahm
from frahm.attractors.regions import checked_region, default_region, lift, sample_region, states_of
from frahm.harmonic_balance import periodic_responses_of

PIPE = frahm.build_system("jacket-pipe")


def two_sinks_and_a_second_mode():
    return frahm.System(
        np.eye(4), 0.01 * np.eye(4), np.diag([1.0, 9.0, 0.0, 0.0]), (1.0, 0.5, 0.0, 0.0),
        [frahm.Element((-1, -0.5, 1, 0), frahm.Cubic(1.0)), frahm.Element((-1, 0.3, 0, 1), frahm.Cubic(2.0))],
        output=(1.0, 0.5, 0.0, 0.0),
    )  # fmt: skip


def test_states_are_absolute_and_interleaved():
    (state,) = states_of(PIPE, {"x1": 0.1, "v1": 0.2, "z": 0.03, "w": -0.5})
    np.testing.assert_allclose(state, (0.1, 0.2, 0.13, -0.3))


def test_what_is_not_named_is_zero():
    (state,) = states_of(PIPE, {"z": 2.0})
    np.testing.assert_allclose(state, (0.0, 0.0, 2.0, 0.0), atol=1e-15)


def test_other_elements_rest_relative_to_what_they_hang_on():
    system = two_sinks_and_a_second_mode()
    (state,) = states_of(system, {"x1": 0.4, "z": 0.1})
    x = state[0::2]
    np.testing.assert_allclose(
        [system.output @ x, system.elements[0].direction @ x, system.elements[1].direction @ x], [0.4, 0.1, 0.0],
        atol=1e-14,
    )  # fmt: skip


def test_an_element_on_the_ground_moves_with_the_output():
    duffing = frahm.System([[1.0]], [[0.1]], [[1.0]], [1.0], [frahm.Element([1.0], frahm.Cubic(1.0))])
    assert not lift(duffing)[1]
    with pytest.raises(frahm.ParameterError, match="one of x1, v1"):
        checked_region(duffing, {"z": (0, 1)})


def test_a_sample_is_uniform_and_reproducible():
    region = {"v1": (-1.0, 3.0), "w": (0.0, 1.0)}
    states = sample_region(PIPE, region, 300, seed=5)
    np.testing.assert_array_equal(states, sample_region(PIPE, region, 300, seed=5))
    v1, w = states[:, 1], states[:, 3] - states[:, 1]
    assert not np.any(states[:, [0, 2]])
    for values, (lo, hi) in ((v1, (-1, 3)), (w, (0, 1))):
        counts = np.histogram(values, 10, (lo, hi))[0]
        assert counts.sum() == 300
        assert counts.min() > 20


def test_the_first_samples_of_a_longer_sample_are_the_same():
    region = {"x1": (-1.0, 1.0)}
    np.testing.assert_array_equal(
        sample_region(PIPE, region, 100, 1), sample_region(PIPE, region, 1000, 1)[:100]
    )  # fmt: skip


def test_the_default_region_holds_every_response_and_the_resonance_of_the_bare_pipe():
    frequency = PIPE.reference_frequency - 0.144
    responses = periodic_responses_of(PIPE, frequency, None)
    region = default_region(PIPE, frequency, responses)
    bare = 0.00624696 / (2 * 0.0015 * PIPE.reference_frequency**2)
    assert bare < region["x1"][1] < 1.1 * bare
    assert region["z"][1] >= max(response.relative_peak for response in responses)
    assert set(region) == {"x1", "v1", "z", "w"}
