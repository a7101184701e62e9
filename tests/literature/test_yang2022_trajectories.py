"""Time histories of Yang et al., Appl. Sci. 2022, 12, 7272: Figs. 3, 8 and 9, and values of the exact equations."""

import numpy as np
import pytest

import frahm

OMEGA = 2 * np.pi * 0.78


def pipe(kappa):
    return frahm.System(
        np.diag([247.0, 4.94]), np.diag([247.0 * 0.0147027, 0.0]), np.diag([247.0 * OMEGA**2, 0.0]),
        (247.0 * 0.00624696, 0.0), [frahm.Element((-1, 1), frahm.Cubic(247.0 * kappa, 247.0 * 0.0085))],
    )  # fmt: skip


def test_beating_at_kappa_98_from_rest():
    tail = frahm.integrate(pipe(97.97), detuning=0.0, periods=1500).last(1000)
    peaks = tail.peaks()
    assert peaks.pipe == pytest.approx(0.0315, abs=0.0002)
    assert peaks.relative == pytest.approx(0.112, abs=0.001)
    assert 0.0008 < tail.envelope().pipe_amplitude.min() < 0.0013
    spectrum = tail.spectrum()
    assert spectrum.pipe_amplitude.idxmax() == pytest.approx(0.78, abs=0.01)


def test_modulated_response_at_kappa_367():
    assert frahm.integrate(pipe(367.38), detuning=0.0, periods=1500).peaks(last=1000).pipe == pytest.approx(
        0.0170, abs=0.0001
    )


@pytest.mark.parametrize(
    ("state", "x1", "z"),
    [
        (None, 0.0045, 0.0045),
        ((3, 3, 3, 3), 0.0256, 0.0520),
        ((0, 0, 3, 3), 0.0045, 0.0045),  # z = z' = 3 instead
    ],
)
def test_two_states_at_one_detuning(state, x1, z):
    history = frahm.integrate(pipe(367.38), detuning=-0.144, periods=1500, initial_state=state)
    peaks = history.peaks(last=100)
    assert peaks.pipe == pytest.approx(x1, abs=1e-4)
    assert peaks.relative == pytest.approx(z, abs=1e-4)
