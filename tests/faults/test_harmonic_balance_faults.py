"""Systems and requests the exact response must handle, or refuse with one clear reason."""

import numpy as np
import pytest

import frahm
from frahm.harmonic_balance import branches, following
from frahm.harmonic_balance.follow import STEP_TOO_SMALL

WINDOW = (0.6, 1.5)


def host_and_sink(law, *, damping=0.02, stiffness=1.0, forcing=(1.0, 0.0), **more):
    return frahm.System(
        np.diag([1, 0.1]),
        np.diag([damping, 0]),
        np.diag([stiffness, 0]),
        forcing,
        [frahm.Element((-1, 1), law)],
        **more,
    )


def sink(kappa, **more):
    return host_and_sink(frahm.Cubic(kappa, 0.05), **more)


def duffing(cubic, *, force=0.1):
    return frahm.System([[1.0]], [[0.05]], [[1.0]], [force], [frahm.Element([1], frahm.Polynomial([0, 0, cubic]))])


def returns_to_itself(system, response, tolerance=1e-6):
    history = frahm.integrate(
        system, frequency=response.frequency, periods=1, initial_state=response.state, tolerance=1e-12
    )
    end = np.column_stack([history.x[-1], history.v[-1]]).ravel()
    return np.max(np.abs(end - response.state)) < tolerance * np.max(np.abs(response.state))


def same_special_points(a, b, tolerance):
    assert [p.kind for p in a.special_points] == [p.kind for p in b.special_points]
    frequencies = [[p.frequency for p in curve.special_points] for curve in (a, b)]
    np.testing.assert_allclose(*frequencies, rtol=tolerance)


@pytest.mark.parametrize(
    "coefficients", [(0, 0.01, 0.001), (0.1, 0.01, 0.001), (0.1, 0, 0, 0.0001), (0.05, 0, 0.001, 0, 1e-5)]
)
def test_laws_with_even_powers_and_higher_degree(coefficients):
    system = host_and_sink(frahm.Polynomial(coefficients, 0.05))
    assert len(frahm.frequency_response(system, frequency=WINDOW).frequency) > 50
    for W in (0.7, 1.2):
        responses = frahm.periodic_responses(system, frequency=W)
        assert responses
        assert all(returns_to_itself(system, response) for response in responses)
        even = any(coefficients[1::2])
        assert all((0 in response.harmonics) == even for response in responses if response.symmetric or even)


def test_a_spring_that_only_pushes_one_way_has_no_periodic_motion():
    # g = z^2 without linear spring: its mean pushes the free sink away for ever
    curve = frahm.frequency_response(host_and_sink(frahm.Polynomial((0, 0.001), 0.05)), frequency=WINDOW)
    assert len(curve.frequency) == 0
    assert len(curve.unverified) == 1


def test_undamped_host_at_resonance():
    system = sink(1e-4, damping=0.0, forcing=(0.2, 0))
    responses = frahm.periodic_responses(system, frequency=1.0)
    assert responses
    assert all(returns_to_itself(system, response) for response in responses)


def test_undamped_linear_system_has_no_response_at_resonance():
    system = host_and_sink(frahm.Linear(0.0, 0.0), damping=0.0)
    with pytest.raises(frahm.ParameterError, match=r"damping: .*resonance"):
        frahm.frequency_response(system, frequency=WINDOW)


def test_without_force_the_response_is_rest():
    system = sink(0.01, forcing=(0, 0))
    curve = frahm.frequency_response(system, frequency=WINDOW)
    (rest,) = frahm.periodic_responses(system, frequency=1.0)
    assert not np.any(curve.pipe_peak)
    assert not np.any(rest.state)
    assert rest.stable
    assert np.all(curve.stable)


@pytest.mark.parametrize("kappa", [0.0, 1e-30, 1e-9])
def test_no_and_tiny_stiffness_give_the_linear_response(kappa):
    # two rows of complex algebra: the sink's damper alone ties it to the host
    curve = frahm.frequency_response(sink(kappa), frequency=WINDOW)
    W = curve.frequency
    tie = 0.05j * W
    host = 1 - W**2 + 0.02j * W + tie * (-0.1 * W**2) / (tie - 0.1 * W**2)
    np.testing.assert_allclose(curve.pipe_peak, np.abs(1 / host), rtol=1e-5)
    assert curve.special_points == ()
    assert curve.unverified == ()
    assert list(curve.detached) == [False]


@pytest.mark.parametrize("kappa", [1e4, 1e12])
def test_absurdly_hard_springs(kappa):
    # the sink is nearly welded to the host; where no finite number of harmonics describes the motion, that is said
    system = sink(kappa)
    curve = frahm.frequency_response(system, frequency=(0.6, 0.7))
    if curve.frequency.size:
        welded = np.abs(1 / (1 - 1.1 * curve.frequency**2 + 0.02j * curve.frequency))
        lowest = curve.branch == 0
        np.testing.assert_allclose(curve.pipe_amplitude[lowest], welded[lowest], rtol=0.2)
    else:
        assert len(curve.unverified) == 1


def test_softening_host():
    curve = frahm.frequency_response(duffing(-0.1, force=0.06), frequency=(0.5, 1.5))
    folds = [p for p in curve.special_points if p.kind == "saddle-node"]
    assert len(folds) == 2
    # the resonance bends to lower frequency: backbone Omega^2 = 1 - 3/4 0.1 A^2, at the peak A = F/(c Omega)
    top = np.argmax(curve.pipe_amplitude[curve.branch == 0])
    A, W = curve.pipe_amplitude[top], curve.frequency[top]
    assert pytest.approx(np.sqrt(1 - 0.075 * A**2), rel=2e-2) == W
    assert pytest.approx(0.06 / (0.05 * W), rel=2e-2) == A


def test_negative_cubic_stiffness_of_the_sink():
    system = sink(-0.001, forcing=(0.1, 0))
    for response in frahm.periodic_responses(system, frequency=1.1):
        assert returns_to_itself(system, response)


def test_force_on_the_sink():
    system = sink(0.01, forcing=(0, 1))
    responses = frahm.periodic_responses(system, frequency=1.2)
    assert responses
    assert all(returns_to_itself(system, response) for response in responses)


def test_a_bare_system():
    system = frahm.System([[2.0]], [[0.1]], [[8.0]], [3.0])
    curve = frahm.frequency_response(system, frequency=(1, 3))
    W = curve.frequency
    np.testing.assert_allclose(curve.pipe_peak, 3 / np.abs(8 - 2 * W**2 + 0.1j * W), rtol=1e-12)
    (response,) = frahm.periodic_responses(system, frequency=2.0)
    assert response.pipe_peak == pytest.approx(3 / 0.2)
    np.testing.assert_allclose(np.abs(response.multipliers), np.exp(-0.025 * np.pi), rtol=1e-12)


def test_a_host_on_no_support():
    system = sink(0.01, stiffness=0.0)
    with pytest.raises(frahm.ParameterError, match=r"reference_frequency: .*positive number"):
        frahm.frequency_response(system, detuning=(-0.1, 0.1))
    curve = frahm.frequency_response(system, frequency=(0.5, 1.0))
    assert np.all(np.isnan(curve.detuning))
    assert np.all(np.isfinite(curve.growth_rate))
    given = sink(0.01, stiffness=0.0, reference_frequency=0.8)
    np.testing.assert_allclose(frahm.frequency_response(given, detuning=(-0.3, 0.2)).pipe_peak[0], curve.pipe_peak[0])


@pytest.mark.parametrize("window", [(0, 0.5), (-1, 0.5), (0.5, 0.5), (1, 0.5), (0.5, np.inf), (np.nan, 1)])
def test_windows_that_are_none(window):
    with pytest.raises(frahm.ParameterError, match="frequency"):
        frahm.frequency_response(sink(0.01), frequency=window)
    with pytest.raises(frahm.ParameterError, match="detuning"):
        frahm.frequency_response(sink(0.01), detuning=(window[0] - 1, window[1] - 1))


def test_a_window_that_nearly_touches_zero():
    curve = frahm.frequency_response(sink(0.01), frequency=(1e-3, 0.3))
    assert np.all(np.isfinite(curve.pipe_peak))
    assert curve.pipe_peak[0] == pytest.approx(1.0, rel=1e-3)  # F/k, slowly
    assert curve.branches[0].frequency[0] == pytest.approx(1e-3)


@pytest.mark.parametrize("window", [(50, 60), (5000, 6000)])
def test_a_window_far_from_everything(window):
    curve = frahm.frequency_response(sink(0.01), frequency=window)
    np.testing.assert_allclose(curve.pipe_peak, 1 / curve.frequency**2, rtol=1e-3)
    assert curve.special_points == ()
    assert curve.unverified == ()


def test_a_window_of_no_width_to_speak_of():
    curve = frahm.frequency_response(sink(0.01), frequency=(0.7, 0.7 + 1e-9))
    (response,) = frahm.periodic_responses(sink(0.01), frequency=0.7)
    assert curve.pipe_peak == pytest.approx(response.pipe_peak, rel=1e-6)


@pytest.mark.parametrize("harmonics", [0, -1, 2.5, 202, True, None, "seven", "AUTO", np.nan])
def test_numbers_of_harmonics_that_are_none(harmonics):
    for call in (
        lambda: frahm.frequency_response(sink(0.01), frequency=WINDOW, harmonics=harmonics),
        lambda: frahm.periodic_responses(sink(0.01), frequency=1.0, harmonics=harmonics),
    ):
        with pytest.raises(frahm.ParameterError, match=r"harmonics: given .*whole number|harmonics: given .*finite"):
            call()


def test_units_do_not_matter():
    # the same motion in other units of mass and length
    plain = sink(1e-3)
    small = frahm.System(
        1e-12 * plain.mass, 1e-12 * plain.damping, 1e-12 * plain.stiffness, 1e-18 * plain.forcing,
        [frahm.Element((-1, 1), frahm.Cubic(1e-3, 0.05e-12))],
    )  # fmt: skip
    a, b = (frahm.frequency_response(system, frequency=WINDOW) for system in (plain, small))
    assert [p.kind for p in a.special_points] == [p.kind for p in b.special_points]
    np.testing.assert_allclose(
        [p.frequency for p in a.special_points], [p.frequency for p in b.special_points], rtol=1e-9
    )
    np.testing.assert_allclose(1e-6 * a.pipe_peak.max(), b.pipe_peak.max(), rtol=1e-3)


def test_one_element_or_two_halves_of_it():
    law, half = frahm.Cubic(0.002, 0.05), frahm.Cubic(0.001, 0.025)
    one = host_and_sink(law)
    two = frahm.System(one.mass, one.damping, one.stiffness, one.forcing, [frahm.Element((-1, 1), half)] * 2)
    a, b = (frahm.frequency_response(system, frequency=WINDOW) for system in (one, two))
    assert [p.kind for p in a.special_points] == [p.kind for p in b.special_points]
    np.testing.assert_allclose(
        [p.frequency for p in a.special_points], [p.frequency for p in b.special_points], rtol=1e-8
    )


def test_a_branch_that_cannot_be_followed_is_named_and_the_rest_stays(monkeypatch):
    case = frahm.load_case("jacket-pipe").with_absorber(kappa=367.38, xi2=0.0085, rho2=0.02)
    whole = frahm.frequency_response(case, detuning=(-0.4, 0.4))
    follow = following.follow

    def give_up(*arguments):
        count, ending = follow(*arguments)
        return (count, ending) if ending == 1 else (count // 2, STEP_TOO_SMALL)  # closed curves stay

    monkeypatch.setattr(following, "follow", give_up)
    curve = frahm.frequency_response(case, detuning=(-0.4, 0.4))
    assert any("could not be followed to its end" in sentence for sentence in curve.unverified)
    folds = [p.detuning for p in curve.special_points]
    for point in whole.special_points:
        if whole.detached[point.branch]:
            assert np.min(np.abs(np.array(folds) - point.detuning)) < 1e-8


def test_no_start_converges(monkeypatch):
    monkeypatch.setattr(branches, "solve_seed", lambda *_: None)
    curve = frahm.frequency_response("jacket-pipe", detuning=(-0.1, 0.1))
    assert len(curve.frequency) == 0
    assert any("No periodic response was found" in sentence for sentence in curve.unverified)
