"""Wind of a reanalysis and of stations, as netCDF 3 and 4 have it."""

import numpy as np
import pytest
import xarray as xr

import frahm

HOURS = np.array(["2024-01-01T00", "2024-01-01T01", "2024-01-01T02"], dtype="datetime64[ns]")
U, V = np.array([3.0, -6.0, 0.0]), np.array([4.0, 8.0, 2.5])
GRID = np.ones((3, 2, 2))


def reanalysis(units="m s**-1", grid=True):
    """As the climate data store hands it out: packed components of the wind over time, latitude and longitude."""
    scale = GRID * np.array([[1.0, 2.0], [3.0, 4.0]])
    dims = ("valid_time", "latitude", "longitude")
    places = {"latitude": ("latitude", [57.25, 57.0]), "longitude": ("longitude", [2.0, 2.25])}
    data = xr.Dataset(
        {
            "u10": (dims, U[:, None, None] * scale, {"units": units, "long_name": "10 metre U wind component"}),
            "v10": (dims, V[:, None, None] * scale, {"units": units, "long_name": "10 metre V wind component"}),
        },
        {"valid_time": ("valid_time", HOURS), "number": 0, **places},
    )
    return data if grid else data.isel(latitude=[0], longitude=[1])


def write(data, path):
    packing = {"dtype": "i2", "scale_factor": 0.001, "add_offset": 0.5, "_FillValue": -32767}
    kinds = {".nc": {"engine": "h5netcdf"}, ".cdf": {"engine": "scipy", "format": "NETCDF3_CLASSIC"}}
    data.to_netcdf(path, encoding={"u10": packing, "v10": packing}, **kinds[path.suffix])
    return path


@pytest.mark.parametrize("ending", [".nc", ".cdf"])
def test_the_wind_of_a_reanalysis_comes_in_at_a_place(tmp_path, ending):
    path = write(reanalysis(), tmp_path / f"era5{ending}")
    found = frahm.read_time_series(path, at={"latitude": 57.05, "longitude": 2.2})
    np.testing.assert_array_equal(found["time"], [0.0, 3600.0, 7200.0])
    assert found["time"].attrs["start"].startswith("2024-01-01T00:00:00")
    np.testing.assert_allclose(found["u10"], 4 * U, atol=1e-3)
    np.testing.assert_allclose(found["speed"], 4 * np.hypot(U, V), atol=2e-3)
    assert found["u10"].attrs["units"] == found["speed"].attrs["units"] == "m/s"


@pytest.mark.parametrize("ending", [".nc", ".cdf"])
def test_a_case_takes_its_record_from_the_file_of_one_place(tmp_path, ending):
    write(reanalysis(units="km h-1", grid=False), tmp_path / f"era5{ending}")
    text = frahm.load_case("jacket-pipe").to_yaml().replace("record: []", f"record: era5{ending}")
    (tmp_path / "case.yaml").write_text(text, encoding="utf-8")
    record = np.array(frahm.load_case(tmp_path / "case.yaml").wind.record)
    np.testing.assert_allclose(record[:, 0], [0.0, 3600.0, 7200.0])
    np.testing.assert_allclose(record[:, 1], 2 * np.hypot(U, V) / 3.6, atol=1e-3)


def test_the_speed_a_station_measures_is_the_speed(tmp_path):
    data = xr.Dataset(
        {"wspd": ("time", [1.0, 2.0, 3.0], {"standard_name": "wind_speed", "units": "knot"})},
        {"time": ("time", [0.0, 600.0, 1200.0], {"units": "s", "standard_name": "time"})},
    )
    data.to_netcdf(tmp_path / "mast.nc", engine="h5netcdf")
    found = frahm.read_time_series(tmp_path / "mast.nc")
    np.testing.assert_array_equal(found["time"], [0.0, 600.0, 1200.0])
    np.testing.assert_allclose(found["speed"], np.array([1, 2, 3]) * 1852 / 3600)
    record = frahm.unsteady_response("jacket-pipe", record=tmp_path / "mast.nc", duration=1.0)
    assert record.outcome.ok


@pytest.mark.parametrize(
    ("at", "words"),
    [
        (None, "at={...}"),
        ({"latitude": 57.1}, "at={...}"),
        ({"latitude": 50.0, "longitude": 2.0}, "57 ... 57.25"),
        ({"latitude": float("nan"), "longitude": 2.0}, "at.latitude"),
        ({"lattitude": 57.0, "longitude": 2.0}, "Did you mean 'latitude'"),
    ],
)
def test_a_place_that_is_not_said_or_not_on_the_grid_is_refused(tmp_path, at, words):
    path = write(reanalysis(), tmp_path / "era5.nc")
    with pytest.raises(frahm.ParameterError) as refused:
        frahm.read_time_series(path, at=at)
    assert words in str(refused.value)


def test_text_has_no_grid(tmp_path):
    (tmp_path / "a.csv").write_text("t,x\n0,1\n1,2\n", encoding="utf-8")
    with pytest.raises(frahm.ParameterError, match="only a netCDF file has a grid"):
        frahm.read_table(tmp_path / "a.csv", at={"latitude": 1.0})


def test_dates_of_another_calendar_are_refused(tmp_path):
    time = ("time", [0.0, 1.0], {"units": "days since 2024-02-29", "calendar": "360_day"})
    xr.Dataset({"u": ("time", [1.0, 2.0])}, {"time": time}).to_netcdf(tmp_path / "a.nc", engine="h5netcdf")
    with pytest.raises(frahm.ParameterError):
        frahm.read_table(tmp_path / "a.nc")
