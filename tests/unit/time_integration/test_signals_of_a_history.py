import dataclasses

import numpy as np
import pytest

import frahm


@pytest.fixture(scope="module")
def linear():
    system = frahm.System(
        np.diag([2.0, 0.1]), np.diag([0.4, 0.0]), np.diag([18.0, 0.0]), [1.5, 0.0],
        [frahm.Element((-1, 1), frahm.Linear(0.8, 0.05))],
    )  # fmt: skip
    omega = 2.5
    return system, omega


@pytest.fixture(scope="module")
def steady(linear):
    """History of the linear system, long after its transients, and its exact phasors."""
    system, omega = linear
    history = frahm.integrate(system, frequency=omega, periods=150, tolerance=1e-11).last(20)
    n = system.elements[0].direction
    K = system.stiffness + 0.8 * np.outer(n, n)
    C = system.damping + 0.05 * np.outer(n, n)
    X = np.linalg.solve(K - omega**2 * system.mass + 1j * omega * C, system.forcing)
    return history, X, n @ X


def with_signal(history, x):
    x = np.stack([x, x], axis=1)
    return dataclasses.replace(history, x=x, z=x[:, 0])


def test_envelope_of_a_steady_state_is_its_phasor(steady):
    history, X, Z = steady
    envelope = history.envelope()
    assert envelope.sizes["time"] == 20
    np.testing.assert_allclose(envelope.pipe_amplitude * np.exp(1j * envelope.pipe_phase), X[0], rtol=1e-7)
    np.testing.assert_allclose(envelope.relative_amplitude * np.exp(1j * envelope.relative_phase), Z, rtol=1e-7)


def test_envelope_does_not_mind_where_a_history_is_cut(steady):
    history, X, _ = steady
    envelope = history.last(7 + 5 / 64).envelope()
    np.testing.assert_allclose(envelope.pipe_amplitude * np.exp(1j * envelope.pipe_phase), X[0], rtol=1e-7)


def test_poincare_section_of_a_steady_state_is_one_point(steady, linear):
    history, X, _ = steady
    section = history.last(10 + 3 / 64).poincare()
    assert section.sizes["period"] == 11  # both ends count
    turns = section.time * linear[1] / (2 * np.pi)
    np.testing.assert_allclose(turns, np.round(turns), atol=1e-9)
    np.testing.assert_allclose(section.displacement, np.tile(X.real, (11, 1)), rtol=1e-7)
    np.testing.assert_allclose(section.velocity, np.tile((1j * linear[1] * X).real, (11, 1)), rtol=1e-7)


def test_peaks_and_rms_of_a_steady_state(steady):
    history, X, Z = steady
    assert history.peaks(last=5).pipe == pytest.approx(abs(X[0]), rel=1e-6)
    assert history.peaks().relative == pytest.approx(abs(Z), rel=1e-6)
    assert history.rms == pytest.approx(abs(X[0]) / np.sqrt(2), rel=1e-8)
    assert history.relative_rms == pytest.approx(abs(Z) / np.sqrt(2), rel=1e-8)


def test_peaks_are_found_between_coarse_samples(linear):
    history = frahm.integrate(linear[0], frequency=linear[1], periods=150, samples_per_period=16).last(3)
    fine = frahm.integrate(linear[0], frequency=linear[1], periods=150, samples_per_period=1024).last(3)
    assert history.peaks().pipe == pytest.approx(np.max(np.abs(fine.pipe)), rel=1e-4)


@pytest.mark.parametrize("window", ["hann", "boxcar"])
def test_spectrum_gives_a_cosine_its_amplitude(steady, window):
    history = steady[0]
    turns = np.arange(history.time.size) / 64
    line = history.frequency / (2 * np.pi)
    signal = 0.3 + np.cos(2 * np.pi * turns + 0.4) + 0.02 * np.cos(2 * np.pi * 3 * turns)
    spectrum = with_signal(history, signal).spectrum(window=window)
    amplitude = spectrum.pipe_amplitude
    for frequency, expected in ((0.0, 0.3), (line, 1.0), (3 * line, 0.02)):
        assert amplitude.sel(frequency_hz=frequency, method="nearest").item() == pytest.approx(expected, abs=1e-12)
    assert amplitude.idxmax().item() == pytest.approx(line, rel=1e-12)
    assert spectrum.frequency_hz.attrs["units"] == "Hz"
    np.testing.assert_array_equal(amplitude, spectrum.relative_amplitude)


def test_spectrum_refuses_an_unknown_window(steady):
    with pytest.raises(frahm.ParameterError, match="hann"):
        steady[0].spectrum(window="han")


def test_datasets_carry_units_and_what_made_them(steady, tmp_path):
    history = steady[0]
    for dataset in (history.to_dataset(), history.poincare(), history.envelope(), history.spectrum()):
        for variable in dataset.variables.values():
            assert {"units", "long_name"} <= set(variable.attrs)
        assert dataset.attrs["outcome"] == "DONE"
        dataset.to_netcdf(tmp_path / "history.nc", engine="h5netcdf")
    np.testing.assert_array_equal(history.to_dataset().relative_displacement, history.x2 - history.x1)


def test_a_history_is_read_only(steady):
    with pytest.raises(ValueError, match="read-only"):
        steady[0].x[0, 0] = 1.0


def test_a_system_without_elements_has_no_relative_displacement():
    history = frahm.integrate(frahm.System([[1.0]], [[0.1]], [[1.0]], [1.0]), frequency=1.0, periods=3)
    assert np.all(np.isnan(history.z))
    assert np.isnan(history.peaks().relative)
    with pytest.raises(frahm.ParameterError, match="x2"):
        history.x2  # noqa: B018
