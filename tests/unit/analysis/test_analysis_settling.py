import numpy as np
import pytest

import frahm
from frahm.analysis.settling import envelope_of, judge, section_spread

CASE = frahm.load_case("jacket-pipe")


@pytest.mark.parametrize(
    ("detuning", "periods", "kind"),
    [(0.2, 1000, "periodic"), (0.0, 1000, "modulated"), (0.2, 150, "unsettled"), (0.2, 10, "unsettled")],
)
def test_kinds_of_motion(detuning, periods, kind):
    assert judge(frahm.integrate(CASE, detuning=detuning, periods=periods, samples_per_period=16))[0] == kind


def test_spread_of_a_motion_started_on_its_orbit_is_small():
    settled = frahm.integrate(CASE, detuning=0.2, periods=1500, samples_per_period=16)
    state = np.stack([settled.x[-1], settled.v[-1]], axis=1).ravel()
    again = frahm.integrate(CASE, detuning=0.2, periods=50, initial_state=state, samples_per_period=16)
    assert section_spread(again) < 1e-4


def test_envelope_of_a_beat():
    t = np.arange(0, 100 * 32 + 1) / 32
    slow = 1 + 0.5 * np.cos(2 * np.pi * t / 50)
    low, high = envelope_of(slow * np.cos(2 * np.pi * t), 32)
    assert high == pytest.approx(slow[:-1:32], abs=0.05)
    assert low == pytest.approx(-slow[16:-1:32], abs=0.05)
