import numpy as np
import pytest

import frahm
from frahm.time_integration import integrate_batch

SYSTEM = frahm.System(np.eye(2), np.eye(2), 4 * np.eye(2), [1, 0], [frahm.Element((-1, 1), frahm.Cubic(1.0))])


@pytest.mark.parametrize("periods", [0, -1, float("nan"), float("inf"), 1e12, 1.1e7, "ten", None, True])
def test_periods_must_be_positive_and_bounded(periods):
    with pytest.raises(frahm.ParameterError, match="periods"):
        frahm.integrate(SYSTEM, frequency=1.0, periods=periods)


@pytest.mark.parametrize(
    "state",
    [(1, 2, 3), (0, 0, 0, float("nan")), "rest", (1, 2, 3, float("inf")), [[0, 0, 0, 0]], (None,) * 4],
)
def test_initial_state_must_be_2n_finite_numbers(state):
    with pytest.raises(frahm.ParameterError, match="initial_state"):
        frahm.integrate(SYSTEM, frequency=1.0, periods=1, initial_state=state)


@pytest.mark.parametrize("samples", [0, -4, 2.5, float("nan"), 10**9])
def test_samples_per_period_is_a_count(samples):
    with pytest.raises(frahm.ParameterError, match="samples_per_period"):
        frahm.integrate(SYSTEM, frequency=1.0, periods=1, samples_per_period=samples)


def test_more_samples_than_memory_holds_are_refused_at_once():
    with pytest.raises(frahm.ParameterError, match=r"fewer samples per period"):
        frahm.integrate(SYSTEM, frequency=1.0, periods=1e7)


@pytest.mark.parametrize("tolerance", [0, -1e-8, 1e-17, 1.0, float("nan"), "tight"])
def test_tolerance_has_bounds(tolerance):
    with pytest.raises(frahm.ParameterError, match="tolerance"):
        frahm.integrate(SYSTEM, frequency=1.0, periods=1, tolerance=tolerance)


@pytest.mark.parametrize(
    "axis", [{}, {"frequency": 1.0, "detuning": 0.0}, {"frequency": 0.0}, {"frequency": -1.0}, {"detuning": -2.0}]
)
def test_exactly_one_positive_frequency(axis):
    with pytest.raises(frahm.ParameterError, match=r"frequency|detuning"):
        frahm.integrate(SYSTEM, periods=1, **axis)
    with pytest.raises(frahm.ParameterError, match=r"frequency|detuning"):
        integrate_batch(SYSTEM, periods=1, window=0, **axis)


@pytest.mark.parametrize(
    ("name", "bad"),
    [
        ("periods", {"periods": 2.5}),
        ("periods", {"periods": 0}),
        ("window", {"window": 11}),
        ("window", {"window": -1}),
        ("strobes", {"strobes": 11}),
        ("initial_states", {"initial_states": np.zeros((3, 3))}),
        ("initial_states", {"initial_states": np.full((1, 4), np.nan)}),
        ("initial_states", {"initial_states": np.zeros((0, 4))}),
        ("phase", {"phase": [0.0, 1.0], "initial_states": np.zeros((3, 4))}),
        ("phase", {"phase": float("nan")}),
        ("force_scale", {"force_scale": "strong"}),
        ("workers", {"workers": 0}),
        ("tolerance", {"tolerance": 0.0}),
        ("frequency", {"frequency": [1.0, -1.0]}),
        ("frequency", {"frequency": []}),
    ],
)
def test_bad_batches_name_what_is_wrong(name, bad):
    with pytest.raises(frahm.ParameterError, match=name):
        integrate_batch(SYSTEM, **{"frequency": 1.0, "periods": 10, "window": 5, **bad})


def test_systems_of_a_batch_must_match():
    other = frahm.System(np.eye(1), np.eye(1), np.eye(1), [1.0])
    with pytest.raises(frahm.ParameterError, match=r"system\[1\]"):
        integrate_batch([SYSTEM, other], frequency=1.0)
    with pytest.raises(frahm.ParameterError, match="case_or_system"):
        integrate_batch([], frequency=1.0)


def test_the_end_of_a_history_must_be_positive():
    history = frahm.integrate(SYSTEM, frequency=1.0, periods=1)
    for bad in (0, -1, float("nan")):
        with pytest.raises(frahm.ParameterError, match="periods"):
            history.last(bad)
