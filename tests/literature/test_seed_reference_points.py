"""Special points of the jacket pipe with sink by AUTO-07p (collocation), and the absorber study of NLvib-py.

AUTO's peak is the largest |x1| over its mesh and collocation points, frahm's the exact maximum over a period. With
points at most pi/80 apart AUTO's is lower by at most (pi/160)^2/2 = 2e-4 of its value; the test by integration shows
which of the two is the maximum.
"""

import numpy as np
import pytest

import frahm

# kappa: kind, detuning [rad/s], max |x1| over AUTO's mesh [m]; xi2 0.0085, rho2 0.02
AUTO = {
    367.38: [
        ("saddle-node", -0.16923, None),
        ("saddle-node", -0.09507, None),
        ("neimark-sacker", -0.01347, 0.016055),
        ("saddle-node", 0.05115, 0.014799),
        ("neimark-sacker", 0.05906, 0.016291),
        ("saddle-node", 0.13107, 0.010654),
    ],
    97.97: [
        ("neimark-sacker", 0.01149, 0.031254),
        ("saddle-node", 0.02778, 0.027134),
        ("neimark-sacker", 0.03479, 0.031398),
        ("saddle-node", 0.04013, 0.030544),
    ],
    24.425: [],
}
MESH_LOSS = (np.pi / 160) ** 2 / 2


def pipe(kappa):
    return frahm.load_case("jacket-pipe").with_absorber(kappa=kappa, xi2=0.0085, rho2=0.02)


@pytest.fixture(scope="module")
def curves():
    return {kappa: frahm.frequency_response(pipe(kappa), detuning=(-0.4, 0.4)) for kappa in AUTO}


@pytest.mark.parametrize("kappa", AUTO)
def test_special_points_to_the_printed_digits(curves, kappa):
    points = curves[kappa].special_points
    assert [p.kind for p in points] == [kind for kind, _, _ in AUTO[kappa]]
    for point, (_, detuning, peak) in zip(points, AUTO[kappa], strict=True):
        assert point.status == "located"
        assert point.detuning == pytest.approx(detuning, abs=5.1e-6)
        assert point.interval[1] - point.interval[0] < 2e-8
        if peak is not None:
            assert peak - 5.1e-7 <= point.pipe_peak <= peak * (1 + MESH_LOSS) + 5.1e-7
    assert curves[kappa].unverified == ()


def test_peaks_by_integration(curves):
    # from the states of the periodic response beside a special point, 4000 samples over one period
    for kappa, sigma, printed in ((367.38, -0.01347, 0.016055), (97.97, 0.01149, 0.031254)):
        responses = frahm.periodic_responses(pipe(kappa), detuning=sigma + 1e-9)
        response = min(responses, key=lambda r: abs(r.pipe_peak - printed))
        history = frahm.integrate(
            pipe(kappa), detuning=sigma + 1e-9, periods=1, initial_state=response.state, samples_per_period=4000,
            tolerance=1e-12,
        )  # fmt: skip
        assert response.pipe_peak == pytest.approx(np.max(np.abs(history.x1)), rel=1e-6)
        assert printed * (1 - 1e-3) < response.pipe_peak < printed * (1 + 1e-3)


def test_detached_curve(curves):
    curve = curves[367.38]
    assert list(curve.detached) == [False, True]
    folds = [p.detuning for p in curve.special_points if curve.detached[p.branch]]
    assert folds == pytest.approx([-0.16923, -0.09507], abs=5.1e-6)
    for kappa in (97.97, 24.425):
        assert list(curves[kappa].detached) == [False]


def test_responses_beside_the_detached_curve():
    low, middle, high = frahm.periodic_responses(pipe(367.38), detuning=-0.144)
    assert (low.stable, middle.stable, high.stable) == (True, False, True)
    assert low.pipe_peak == pytest.approx(0.0045, abs=5e-5)
    assert low.relative_peak == pytest.approx(0.0045, abs=5e-5)
    assert high.pipe_peak == pytest.approx(0.0256, abs=5e-5)
    assert high.relative_peak == pytest.approx(0.0520, abs=5e-5)


def test_unstable_range_and_its_agreement_with_the_special_points(curves):
    # kappa 367.38: no stable response from the first Neimark-Sacker point to the fold where the low one is born
    curve = curves[367.38]
    inside = (curve.detuning > -0.0134) & (curve.detuning < 0.0511)
    assert not np.any(curve.stable[inside])
    assert np.all(curves[24.425].stable)
    largest, at = curves[24.425].largest()
    assert largest == pytest.approx(0.0497, abs=6e-5)
    assert at - 2 * np.pi * 0.78 == pytest.approx(0.006, abs=1e-3)


@pytest.fixture(scope="module")
def nlvib():
    """NLvib-py's optimum: d = .001, alpha = .010, reported with a peak rms of .663 over Omega in [.8, 1.4]."""
    sink = frahm.Element((-1, 1), frahm.Cubic(0.010, 0.001))
    return frahm.System(np.diag([1, 0.05]), np.diag([0.002, 0]), np.diag([1.0, 0]), (0.11, 0), [sink])


@pytest.fixture(scope="module")
def nlvib_curve(nlvib):
    return frahm.frequency_response(nlvib, frequency=(0.8, 1.4))


def test_the_reported_peak_lies_on_an_unstable_stretch(nlvib, nlvib_curve):
    # the branch from low frequency, until it leaves the window at 1.4
    branch = nlvib_curve.branches[0]
    first = branch.piece == 0
    frequency, rms = branch.frequency[first], branch.pipe_amplitude[first] / np.sqrt(2)
    assert frequency[0] == pytest.approx(0.8)
    assert np.max(rms) == pytest.approx(0.663, abs=2e-3)
    stretch = (frequency > 0.951) & (frequency < 0.973)
    assert np.sum(stretch) > 5
    assert not np.any(branch.stable[first][stretch])
    assert np.all(branch.stable[first][frequency < 0.948])
    (loss,) = [p for p in nlvib_curve.special_points if p.branch == 0 and 0.94 < p.frequency < 0.96]
    assert loss.kind == "neimark-sacker"


def test_a_detached_high_branch_is_found(nlvib_curve):
    high = [b for b in nlvib_curve.branches if b.detached and np.max(b.pipe_peak) > 50]
    assert high
    assert nlvib_curve.unverified == ()
    # the symmetric orbit loses its stability to a pair with even harmonics, which then doubles its period
    kinds = {(p.kind, bool(nlvib_curve.asymmetric[p.branch])) for p in nlvib_curve.special_points if p.pipe_peak > 40}
    assert {("branch-point", False), ("period-doubling", True)} <= kinds


def test_the_motion_from_rest_at_970_is_a_stable_response(nlvib):
    run = frahm.integrate(nlvib, frequency=0.970, periods=8000, samples_per_period=64)
    settled = np.max(np.abs(run.x1[-64 * 50 :]))
    assert settled == pytest.approx(31.4, abs=0.05)
    stable = [r for r in frahm.periodic_responses(nlvib, frequency=0.970) if r.stable]
    assert any(r.pipe_peak == pytest.approx(settled, rel=1.5e-3) for r in stable)


def test_the_motion_from_rest_at_9729_belongs_to_a_pair_past_its_period_doubling(nlvib, nlvib_curve):
    # it settles at about 52 without a period: near the mirrored pair, whose stretch of stability has ended
    run = frahm.integrate(nlvib, frequency=0.9729, periods=8000, samples_per_period=64)
    assert 47 < np.max(np.abs(run.x1[-64 * 500 :])) < 54
    responses = frahm.periodic_responses(nlvib, frequency=0.9729)
    high = [r for r in responses if not r.symmetric and r.pipe_peak == pytest.approx(52, abs=0.5)]
    assert len(high) == 2  # both of the pair
    for response in high:
        critical = response.multipliers[0]
        assert critical.real < -1
        assert abs(critical.imag) < 1e-9
    doublings = [p.frequency for p in nlvib_curve.special_points if p.kind == "period-doubling" and p.pipe_peak > 46]
    assert np.min(doublings) < 0.9729
