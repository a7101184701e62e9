"""The curve of the largest lasting motions: it has the worst motion on it, and only what lasts."""

import numpy as np
import pytest

import frahm
from frahm.analysis.ranges import ranges_without_stable_response
from frahm.attractors import lasting_motions


@pytest.fixture(scope="module")
def linear():
    case = frahm.load_case("jacket-pipe").without_absorbers()
    return frahm.worst_case(case), case


def test_the_largest_of_the_curve_is_the_worst_motion(linear):
    worst, _ = linear
    curve = lasting_motions([worst])
    assert float(curve["pipe_peak"].max()) == worst.pipe_peak
    assert curve["frequency"].values.min() == worst.range.frequency[0]
    assert curve["frequency"].values.max() == worst.range.frequency[1]
    assert np.all(np.diff(curve["frequency"].values) > 0)


def test_a_linear_pipe_lasts_at_its_closed_form(linear):
    worst, case = linear
    curve = lasting_motions([worst])
    system, W = frahm.build_system(case), curve["frequency"].values
    dynamic = system.stiffness[0, 0] - W**2 * system.mass[0, 0] + 1j * W * system.damping[0, 0]
    assert curve["pipe_peak"].values == pytest.approx(np.abs(system.forcing[0] / dynamic), rel=1e-5)


def test_where_no_periodic_response_is_stable_the_attractors_stand():
    case = frahm.load_case("jacket-pipe")  # modulated about the resonance
    worst = frahm.worst_case(case, detuning=(-0.05, 0.15), samples=4, periods=400)
    curve = lasting_motions([worst])
    assert "wind_speed" not in curve
    largest = max(curve["pipe_peak"].values.max(), np.nanmax(curve["searched_pipe_peak"].values))
    finite = [a.pipe_peak for survey in worst.surveys for a in survey]
    assert largest == pytest.approx(max(finite), rel=0.01)
    gaps = ranges_without_stable_response(worst.curve.to_dataset())
    assert gaps  # in which only what was searched is known
    guessed = curve["detuning"].values[~np.isfinite(curve["searched_pipe_peak"].values)]
    assert not any(np.any((guessed > lo + 1e-6) & (guessed < hi - 1e-6)) for lo, hi in gaps)


def test_several_ranges_stand_one_after_the_other(linear):
    worst, _ = linear
    curve = lasting_motions([worst, worst])
    assert curve["part"].values.tolist() == sorted(curve["part"].values.tolist())
    assert set(curve["part"].values.tolist()) == {0, 1}
