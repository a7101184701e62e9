import numpy as np
import pytest
from scipy.integrate import quad

import frahm
from frahm.loads import read_record, spectral_density, turbulent_record
from frahm.loads.record import _cumulative

SPECTRA = ("kaimal", "en1991", "von-karman")


@pytest.mark.parametrize("spectrum", SPECTRA)
def test_spectra_integrate_to_one(spectrum):
    # over ln n, in which the spectra are smooth
    total = quad(lambda s: np.exp(s) * float(spectral_density(np.exp(s), 10.0, 100.0, spectrum)), -25, 40, limit=400)
    assert total[0] == pytest.approx(1.0, abs=1.5e-4 if spectrum == "von-karman" else 1e-6)
    below = quad(lambda n: float(spectral_density(n, 10.0, 100.0, spectrum)), 0.0, 0.3, limit=400)[0]
    assert float(_cumulative(np.array([0.3]), 10.0, 100.0, spectrum)[0]) == pytest.approx(below, rel=1e-9)


@pytest.mark.parametrize("spectrum", SPECTRA)
def test_synthetic_wind_has_the_variance_of_its_spectrum(spectrum):
    record = turbulent_record(8.0, 0.12, 80.0, 4000.0, highest_frequency=0.5, spectrum=spectrum, seed=2)
    share = float(_cumulative(np.array([0.5]), 8.0, 80.0, spectrum)[0])
    assert record.mean_speed == pytest.approx(8.0, rel=1e-12)
    assert record.intensity == pytest.approx(0.12 * np.sqrt(share), rel=0.01)
    assert f"{1 - share:.1%}" in record.notes[0] or abs(share - 1) < 2e-2
    # the periodogram of the record, in bands, is the spectrum
    speed, dt = record.speed[:-1], record.time[1]
    density = 2 * dt / speed.size * np.abs(np.fft.rfft(speed - 8.0)) ** 2
    n = np.fft.rfftfreq(speed.size, dt)
    for low, high in ((0.01, 0.02), (0.05, 0.1), (0.2, 0.4)):
        band = (n >= low) & (n < high)
        expected = (0.12 * 8.0) ** 2 * quad(lambda f: float(spectral_density(f, 8.0, 80.0, spectrum)), low, high)[0]
        assert np.sum(density[band]) * n[1] == pytest.approx(expected, rel=0.05)


def test_seed_makes_the_record():
    first, same, other = (
        turbulent_record(8.0, 0.1, 80.0, 200.0, highest_frequency=0.5, seed=seed).speed for seed in (1, 1, 2)
    )
    np.testing.assert_array_equal(first, same)
    assert np.std(first - other) > 0.1


def test_wind_that_would_reverse_is_calm_and_told():
    record = turbulent_record(2.0, 0.8, 80.0, 2000.0, highest_frequency=0.5)
    assert record.speed.min() == 0.0
    assert "reverses" in record.notes[1]


def test_mean_and_intensity_of_irregular_samples():
    record = frahm.WindRecord([0.0, 1.0, 5.0, 6.0], [1.0, 3.0, 3.0, 1.0])
    fine = np.linspace(0, 6, 600_001)
    speed = np.interp(fine, record.time, record.speed)
    assert record.mean_speed == pytest.approx(np.mean(speed), rel=1e-5)
    assert record.intensity == pytest.approx(np.std(speed) / np.mean(speed), rel=1e-4)


def test_csv_with_units(tmp_path):
    file = tmp_path / "gusts.csv"
    file.write_text("# anemometer\ntime [min]; speed [km/h]\n0; 9\n0.5; 10.8\n2; 7.2\n", encoding="utf-8")
    record = read_record(file)
    np.testing.assert_allclose(record.time, [0, 30, 120])
    np.testing.assert_allclose(record.speed, [2.5, 3.0, 2.0])
    found = frahm.unsteady_response("jacket-pipe", record=file, duration=20.0)
    assert found.speed[-1] == pytest.approx(2.5 + 0.5 * found.history.time[-1] / 30)


def test_a_case_keeps_the_record_of_its_file(tmp_path):
    (tmp_path / "gusts.csv").write_text("time,speed\n0,2.5\n30,3\n", encoding="utf-8")
    case = frahm.load_case("jacket-pipe")
    text = case.to_yaml().replace("absorbers:", "absorbers:", 1).replace("  record: []", "  record: gusts.csv")
    (tmp_path / "case.yaml").write_text(text, encoding="utf-8")
    loaded = frahm.load_case(tmp_path / "case.yaml")
    assert loaded.wind.record == ((0.0, 2.5), (30.0, 3.0))
    assert frahm.load_case(loaded.to_dict()) == loaded
    assert frahm.unsteady_response(loaded).record.duration == 30.0
