"""The worst over a range: too narrow a window is not vouched for, and linear peaks are those of closed forms."""

import math
from dataclasses import replace

import numpy as np
import pytest
from scipy.optimize import minimize_scalar

import frahm
from frahm.assessment import with_stress
from frahm.attractors import joined
from frahm.loads import operating_range, other_ranges

BARE = frahm.load_case("jacket-pipe").without_absorbers()
PIPE = {"kind": "tube", "diameter": "8 inch", "wall": "6 mm", "length": "30 m", "damping_ratio": 0.002,
        "supports": [{"at": 0, "kind": "pinned"}, {"at": "30 m", "kind": "pinned"}], "mode_count": 3}  # fmt: skip
SLENDER = frahm.load_case({
    "name": "slender", "pipe": PIPE, "absorbers": [],
    "wind": {"speed": 1.2, "strouhal": 0.2, "lift_coefficient": 0.3, "range": [0.5, 6]},
})  # fmt: skip


def split_pipe():
    """A host with a lightly damped absorber: resonances of different height at about 0.9 and 1.1 rad/s."""
    spring, mass = 0.05, 0.05
    return frahm.System([[1, 0], [0, mass]], np.diag([0.004, 0.0]), np.diag([1.05, 0.0]), [1, 0],
                        [frahm.Element((-1, 1), frahm.Linear(spring, damping=5e-4))])  # fmt: skip


def own_amplitude(W, mass=0.05, spring=0.05):
    g = spring + 5e-4j * W
    dynamic = np.array([[1.05 + g - W**2 + 0.004j * W, -g], [-g, g - mass * W**2]])
    return abs(np.linalg.solve(dynamic, [1, 0])[0])


@pytest.mark.parametrize(("window", "end"), [((-0.2, -0.01), "upper"), ((0.01, 0.3), "lower")])
def test_a_window_cut_on_the_flank_is_unverified(window, end):
    worst = frahm.worst_case(BARE, detuning=window)
    assert worst.detuning == pytest.approx(window[0 if end == "lower" else 1])
    assert not worst.verified
    (doubt,) = worst.unverified  # one cause, one sentence
    assert doubt.startswith(f"The worst motion sits at the {end} end of the range")
    assert "and beyond it, at detuning" in doubt
    assert doubt.endswith("m is larger.")


@pytest.mark.parametrize("absorbers", [[], frahm.load_case("jacket-pipe").to_dict()["absorbers"]], ids=len)
def test_where_nothing_excites_the_pipe_no_end_of_the_range_is_in_doubt(absorbers):
    case = frahm.load_case(BARE.to_dict() | {"absorbers": absorbers, "analysis": {}}).with_wind(lift_coefficient=0)
    worst = frahm.worst_case(case, samples=2)
    assert (worst.pipe_peak, worst.unverified) == (0, ())
    assert "nothing excites the pipe" in worst.motion.tier


def test_a_motion_larger_beyond_the_range_of_a_nonlinear_pipe_is_told_once():
    worst = frahm.worst_case("jacket-pipe", detuning=(0.2, 0.4), samples=4)
    assert len([doubt for doubt in worst.unverified if "beyond" in doubt.lower()]) == 1


def test_a_window_that_holds_the_peak_is_verified():
    assert frahm.worst_case(BARE, detuning=(-0.2, 0.3)).verified


def test_a_larger_peak_in_the_window_widened_by_half_is_a_doubt():
    system = split_pipe()
    peaks = [minimize_scalar(lambda W: -own_amplitude(W), bounds=ends, method="bounded", options={"xatol": 1e-12})
             for ends in ((0.8, 1), (1.05, 1.3))]  # fmt: skip
    heights = [-peak.fun for peak in peaks]
    # both peaks hold for themselves; the window with the lower one alone is in doubt, that with both is not
    low = int(np.argmin(heights))
    assert max(heights) > 1.05 * min(heights)
    window = (0.6, 1.06) if low == 0 else (1.0, 1.6)
    assert window[0] < peaks[low].x < window[1]
    worst = frahm.worst_case(system, frequency=window)
    assert worst.pipe_peak == pytest.approx(heights[low], rel=1e-9)
    (doubt,) = worst.unverified
    assert doubt.startswith("Beyond the range")
    assert f"{max(heights):.3g}" in doubt
    both = frahm.worst_case(system, frequency=(0.6, 1.6))
    assert both.verified
    assert both.pipe_peak == pytest.approx(max(heights), rel=1e-9)
    assert both.frequency == pytest.approx(peaks[1 - low].x, rel=1e-6)


def test_the_peak_of_a_bare_pipe_over_the_wind_is_that_of_the_closed_form():
    case = frahm.load_case(BARE.to_dict() | {"analysis": {}})
    m, w, zeta = case.pipe.mass, case.pipe.frequency, case.pipe.damping_ratio
    D, St = case.pipe.diameter, 0.225

    def peak(W):
        U = W * D / (2 * math.pi * St)
        lift = 0.5 * case.wind.air_density * U**2 * D * case.pipe.length * 0.4535
        return lift / (m * abs(w**2 - W**2 + 2j * zeta * w * W))

    best = minimize_scalar(lambda W: -peak(W), bounds=(0.99 * w, 1.01 * w), method="bounded", options={"xatol": 1e-12})
    worst = frahm.worst_case(case)
    assert worst.verified
    assert worst.pipe_peak == pytest.approx(-best.fun, rel=1e-9)
    assert worst.wind_speed == pytest.approx(best.x * D / (2 * math.pi * St), rel=1e-6)
    assert worst.pipe_rms == pytest.approx(-best.fun / math.sqrt(2), rel=1e-9)


def test_the_stress_range_of_one_mode_is_twice_its_stress_at_the_peak():
    fatigue = {"curve": "D", "stress_per_displacement": "283.5 MPa/m"}
    climate = {"duration": "1 year", "weibull": {"scale": 6, "shape": 2}}
    case = frahm.load_case(BARE.to_dict() | {"fatigue": fatigue, "climate": climate})
    motion = with_stress(case, frahm.worst_case(case))
    assert motion.stress_range == pytest.approx(2 * 283.5e6 * motion.pipe_peak, rel=1e-9)
    assert motion.stress_frequency == pytest.approx(motion.frequency, rel=1e-3)
    assert math.isnan(with_stress(BARE, frahm.worst_case(BARE)).stress_range)


def test_the_stress_range_of_a_pinned_tube_is_that_of_its_curvature():
    E, radius, span = 2.06e11, 4 * 0.0254, 30.0
    case = SLENDER.with_pipe(youngs_modulus=E, mode_count=1)
    motion = with_stress(case, frahm.worst_case(case))
    assert motion.stress_range == pytest.approx(2 * E * radius * (math.pi / span) ** 2 * motion.pipe_peak, rel=1e-4)
    assert motion.stress_section == pytest.approx(15.0)


def test_every_mode_an_elastic_pipe_is_excited_in_has_its_own_resonance():
    worst = frahm.worst_case(SLENDER)
    cases = [SLENDER, *(other for other, _ in other_ranges(SLENDER))]
    assert len(cases) > 1
    parts = [worst, *worst.others]
    assert len(parts) == len(cases)
    assert worst.pipe_peak == max(part.attractor.pipe_peak for part in parts)
    peaks = []
    for case in cases:
        m, w, zeta = case.pipe.mass, case.pipe.frequency, case.pipe.damping_ratio
        speed = w / (2 * math.pi) * case.pipe.diameter / 0.2
        length = case.pipe.modal.lift_lengths[0]
        if speed <= 6:
            lift = 0.5 * case.wind.air_density * speed**2 * case.pipe.diameter * length * 0.3
            peaks.append(lift / (2 * m * zeta * w**2))
    assert len(peaks) > 1
    found = sorted(part.attractor.pipe_peak for part in parts)
    for peak in peaks:
        assert min(abs(value / peak - 1) for value in found) < 5e-3
    assert frahm.worst_case(SLENDER, wind=operating_range(SLENDER).wind).others == ()


def test_what_lies_beyond_a_range_of_small_motions_does_not_speak_against_a_larger_one():
    small = frahm.worst_case("jacket-pipe", detuning=(-0.4, -0.3), samples=4).motion
    (doubt,) = small.unverified
    assert "sits at the upper end" in doubt
    assert small.pipe_peak < small.beyond[doubt] < 0.01
    large = replace(small, pipe_peak=1.0, unverified=(), beyond={})
    near = replace(small, pipe_peak=1.001 * small.pipe_peak, unverified=(), beyond={})
    assert joined([large, small]).unverified == joined([small, large]).unverified == ()
    assert joined([near, small]).unverified == (doubt,)
    assert joined([large, replace(small, unverified=(doubt, "another"))]).unverified == ("another",)
