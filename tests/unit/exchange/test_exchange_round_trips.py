"""What goes out comes back equal, and other programs can read it."""

import csv
import json
import math

import h5py
import numpy as np
import pytest
import scipy.io
import xarray as xr

import frahm
from frahm.exchange import csv_text, time_history_text

CASE = frahm.load_case("jacket-pipe").with_absorber(xi2=0.0085)
ENDINGS = (".nc", ".csv", ".mat", ".json")


@pytest.fixture(scope="module")
def curve():
    return frahm.frequency_response(CASE, detuning=(-0.4, 0.4), method="slow-flow", points=101)


@pytest.fixture(scope="module")
def history():
    return frahm.integrate(CASE, detuning=0.0, periods=5, samples_per_period=16)


def awkward():
    """Every type, NaN and infinity, text, no values, names no program likes, coordinates and plain dimensions."""
    return xr.Dataset(
        {
            "a.b c": (("x", "k"), np.array([[1.0, np.nan, np.inf], [-np.inf, 1 / 3, 1e-300]]), {"units": "m"}),
            "a.b_c": (("x", "k"), np.arange(6).reshape(2, 3), {"units": "1", "long_name": "a, with comma"}),
            "flag": ("x", np.array([True, False])),
            "word": ("x", np.array(['naïve, "quoted"', ""], dtype=object)),
            "none": ("nothing", np.empty(0)),
            "scalar": ((), 2.5, {"units": "s", "list": np.array([1.0, 2.0])}),
        },
        {"x": ("x", [0.1, 0.2], {"units": "rad/s", "long_name": "detuning"})},
        {"title": "awkward", "number": 3, "limits": np.array([0.5, 1.5])},
    )


def same(a, b):
    xr.testing.assert_equal(a, b)
    assert set(a.coords) == set(b.coords)
    for name, variable in a.variables.items():
        assert variable.dims == b[name].dims
        assert {k: np.asarray(v).tolist() for k, v in variable.attrs.items()} == {
            k: np.asarray(v).tolist() for k, v in b[name].attrs.items()
        }, name
    assert {k: np.asarray(v).tolist() for k, v in a.attrs.items()} == {
        k: np.asarray(v).tolist() for k, v in b.attrs.items()
    }


@pytest.mark.parametrize("ending", ENDINGS)
def test_a_response_curve_comes_back_equal(tmp_path, curve, ending):
    files = frahm.write_data(curve, tmp_path / f"curve{ending}")
    assert all(file.is_file() for file in files)
    back = frahm.read_data(files[0])
    same(back, curve.to_dataset())
    assert back["stable"].dtype == bool
    assert back["branch"].dtype.kind == "i"


@pytest.mark.parametrize("ending", ENDINGS)
def test_histories_spectra_and_maps_come_back_equal(tmp_path, history, ending):
    maps = frahm.slow_flow_map(
        CASE, detuning=np.array([-0.1, 0.0, 0.1])[None, :], kappa=np.array([50.0, 400.0])[:, None]
    )
    for number, dataset in enumerate((history.to_dataset(), history.spectrum(), maps)):
        file = frahm.write_data(dataset, tmp_path / f"data{number}{ending}")[0]
        same(frahm.read_data(file), dataset)


@pytest.fixture(scope="module")
def datasets(history):
    """One of every kind of result."""
    exact = frahm.frequency_response(CASE, detuning=(-0.02, 0.02), harmonics=3)
    found = frahm.find_attractors(CASE, detuning=0.2, samples=3, periods=100)
    elastic = frahm.load_case("jacket-pipe-elastic")
    return {
        "exact response": exact.to_dataset(),
        "attractors": found.to_dataset(),
        "basin map": frahm.basin_map(CASE, detuning=0.2, resolution=(4, 3)),
        "stability boundaries": frahm.stability_boundaries(
            CASE, plane=("detuning", "kappa"), bounds=((-0.1, 0.1), (50.0, 400.0))
        ),
        "modulated": frahm.modulated_branches(CASE, detuning=(-0.001, 0.002), looks=2, checks=0).to_dataset(),
        "gusts": frahm.unsteady_response(
            CASE.with_wind(turbulence={"intensity": 0.05, "length_scale": 50}), duration=60.0
        ).to_dataset(),
        "fatigue": frahm.fatigue_damage(elastic, bins=4, samples=1).to_dataset(),
    }


@pytest.mark.parametrize("ending", ENDINGS)
def test_every_kind_of_result_comes_back_equal(tmp_path, datasets, ending):
    for name, dataset in datasets.items():
        same(frahm.read_data(frahm.write_data(dataset, tmp_path / f"{name}{ending}")[0]), dataset)


@pytest.mark.parametrize("ending", [".csv", ".mat", ".json"])
def test_awkward_data_come_back_equal(tmp_path, ending):
    dataset = awkward()
    same(frahm.read_data(frahm.write_data(dataset, tmp_path / f"awkward{ending}")[0]), dataset)


def test_mat_files_hold_branches_and_labelled_special_points_as_struct_arrays(tmp_path, curve):
    content = scipy.io.loadmat(frahm.write_data(curve, tmp_path / "curve.mat")[0], simplify_cells=True)
    branches = content["branches"] if isinstance(content["branches"], list | np.ndarray) else [content["branches"]]
    assert len(branches) == len(curve.branches)
    for found, branch in zip(branches, curve.branches, strict=True):
        assert int(found["number"]) == branch.number
        assert bool(found["detached"]) == branch.detached
        np.testing.assert_array_equal(found["detuning"], branch.detuning)
        np.testing.assert_array_equal(found["pipe_peak"], branch.pipe_peak)
    points = content["special_points"]
    assert [point["label"] for point in points] == ["SN1", "SN2", "H1", "SN3", "H2", "SN4"]
    assert [float(point["detuning"]) for point in points] == [point.detuning for point in curve.special_points]
    assert content["units"]["detuning"] == "rad/s"
    assert content["long_names"]["detuning"].startswith("detuning sigma")


def test_csv_has_a_row_of_names_a_row_of_units_and_all_digits(curve):
    rows = list(csv.reader(line for line in csv_text(curve.to_dataset()).splitlines() if not line.startswith("#")))
    assert rows[0][:3] == ["frequency", "detuning", "pipe_amplitude"]
    assert rows[1][:3] == ["rad/s", "rad/s", "m"]
    table = dict(zip(rows[0], zip(*rows[2:], strict=True), strict=True))
    assert [float(cell) for cell in table["pipe_peak"]] == curve.pipe_peak.tolist()
    assert [cell == "1" for cell in table["stable"]] == curve.stable.tolist()


def test_json_is_strict_and_netcdf_plain_hdf5(tmp_path, curve):
    def refuse(constant):
        raise AssertionError(constant)

    frahm.write_data(awkward(), tmp_path / "a.json")
    text = (tmp_path / "a.json").read_text(encoding="utf-8")
    found = json.loads(text, parse_constant=refuse)
    assert found["variables"]["a.b c"]["data"][0] == [1.0, None, "inf"]
    with h5py.File(frahm.write_data(curve, tmp_path / "curve.nc")[0]) as file:
        np.testing.assert_array_equal(file["detuning"][:], curve.detuning)
        assert file["detuning"].attrs["units"] == "rad/s"


def test_a_tab_delimited_history_reads_back_to_the_last_digit(tmp_path, history):
    text = time_history_text(history)
    assert text.splitlines()[0].split("\t")[:4] == ["time [s]", "pipe [m]", "z [m]", "z velocity [m/s]"]
    frahm.write_time_history(history, tmp_path / "history.txt")
    back = frahm.read_time_series(tmp_path / "history.txt")
    np.testing.assert_array_equal(back["time"], history.time)
    np.testing.assert_array_equal(back["pipe"], history.x1)
    np.testing.assert_array_equal(back["z"], history.z)
    np.testing.assert_array_equal(back["x2 velocity"], history.v[:, 1])
    assert back["z velocity"].attrs["units"] == "m/s"
    np.testing.assert_array_equal(np.loadtxt(tmp_path / "history.txt", skiprows=1)[:, 1], history.x1)


@pytest.mark.parametrize(
    "text",
    [
        "t,x,load\ns,mm,kN\n0,1.5,2\n0.5,-2,3e-1\n1,0,1\n",
        "# from a logger\nt [s];x [mm];load [kN]\n0;1,5;2\n0,5;-2;3e-1\n1;0;1\n",
        "t (s)\tx (mm)\tload (kN)\n0\t1.5\t2\n0.5\t-2\t0.3\n1\t0\t1\n",
        "% matlab style\nt x load\ns mm kN\n 0   1.5  2\n 0.5 -2  0.3\n 1    0  1\n",
        "t [ms],x [mm],load [kN]\n0,1.5,2\n500,-2,0.3\n1000,0,1\n",
    ],
)
def test_time_series_of_other_programs_come_in_as_si(tmp_path, text):
    (tmp_path / "series.csv").write_text(text, encoding="utf-8")
    found = frahm.read_time_series(tmp_path / "series.csv")
    np.testing.assert_allclose(found["time"], [0, 0.5, 1], rtol=1e-15)
    np.testing.assert_allclose(found["x"], [0.0015, -0.002, 0], rtol=1e-15)
    np.testing.assert_allclose(found["load"], [2000, 300, 1000], rtol=1e-15)
    assert (found["x"].attrs["units"], found["load"].attrs["units"]) == ("m", "N")


def test_time_series_come_in_from_mat(tmp_path):
    time = np.linspace(0, 1, 11)
    scipy.io.savemat(tmp_path / "a.mat", {"t": time, "acc": time**2, "note": "text", "one": 3.0})
    found = frahm.read_time_series(tmp_path / "a.mat")
    assert list(found.data_vars) == ["acc"]
    np.testing.assert_array_equal(found["acc"], time**2)
    scipy.io.savemat(tmp_path / "b.mat", {"log": {"t": time, "acc": time**3}})
    np.testing.assert_array_equal(frahm.read_time_series(tmp_path / "b.mat")["acc"], time**3)


def test_wind_tables_come_in(tmp_path):
    (tmp_path / "wind.csv").write_text("speed [km/h],share [%]\n9,25\n18,75\n", encoding="utf-8")
    found = frahm.read_table(tmp_path / "wind.csv")
    np.testing.assert_allclose(found["speed"], [2.5, 5.0])
    np.testing.assert_allclose(found["share"], [0.25, 0.75])
    scipy.io.savemat(tmp_path / "wind.mat", {"speed": [2.5, 5.0], "share": [0.25, 0.75]})
    np.testing.assert_array_equal(frahm.read_table(tmp_path / "wind.mat")["share"], [0.25, 0.75])


@pytest.mark.parametrize(
    ("name", "text", "words"),
    [
        ("a.csv", "t,x\n0,1\n1,two\n", ("a.csv:3", "'two'", "a number")),
        ("a.csv", "t,x\n0,1\n0,2\n", ("ascends", "'t'")),
        ("a.csv", "t,x\n0,1\n1\n2,3\n", ("a.csv:3", "2 cells")),
        ("a.csv", "", ("at least one row",)),
        ("a.xyz", "t,x\n0,1\n", (".mat", ".csv")),
        ("a.mat", "no mat file at all, only text", ("MAT file",)),
    ],
)
def test_bad_files_are_refused_with_the_line(tmp_path, name, text, words):
    (tmp_path / name).write_text(text, encoding="utf-8")
    with pytest.raises(frahm.ParameterError) as caught:
        frahm.read_time_series(tmp_path / name)
    assert all(word in str(caught.value) for word in words), str(caught.value)


def test_unknown_endings_missing_and_damaged_files_are_refused(tmp_path, curve):
    with pytest.raises(frahm.ParameterError, match=r"\.nc, \.csv"):
        frahm.write_data(curve, tmp_path / "curve.xls")
    with pytest.raises(frahm.ParameterError, match="exists"):
        frahm.read_data(tmp_path / "none.nc")
    for ending, text in ((".json", "{"), (".json", "[]"), (".csv", "a,b\n1,2\n"), (".nc", "x"), (".mat", "x" * 200)):
        (tmp_path / f"bad{ending}").write_text(text, encoding="utf-8")
        with pytest.raises(frahm.ParameterError):
            frahm.read_data(tmp_path / f"bad{ending}")
    with pytest.raises(frahm.ParameterError, match="to_dataset"):
        frahm.write_data([1, 2], tmp_path / "a.nc")
    assert math.isnan(float(frahm.read_data(frahm.write_data(awkward(), tmp_path / "ok.json")[0])["a.b c"][0, 1]))


def foreign(**attributes):
    return xr.Dataset({"x": ("t", [1.0, 2.0], attributes)}, {"t": ("t", [0.0, 1.0])}, attributes)


@pytest.mark.parametrize("ending", [".csv", ".mat", ".json"])
def test_attributes_that_say_nothing_come_back(tmp_path, ending):
    dataset = foreign(units=None, long_name=None)
    same(frahm.read_data(frahm.write_data(dataset, tmp_path / f"a{ending}")[0]), dataset)


@pytest.mark.parametrize("ending", ENDINGS)
@pytest.mark.parametrize(
    "dataset",
    [
        foreign(units=None),
        foreign(note={"a": 1}),
        xr.Dataset({"x": ("t", np.array([1j, 2.0]))}),
        xr.Dataset({"x": ("t", np.array(["2024-01-01"], dtype="datetime64[ns]"))}),
        xr.Dataset({"x": ("t", np.array(["\ud800"], dtype=object))}),
        xr.Dataset({"x": ("t", np.array([object(), 1], dtype=object))}),
        xr.Dataset({("a", 1): ("t", [1.0])}),
        xr.Dataset({"x/y": ("t", [1.0])}),
    ],
)
def test_a_dataset_of_another_program_is_written_or_refused_for_what_it_is(tmp_path, ending, dataset):
    message = None
    try:
        files = frahm.write_data(dataset, tmp_path / f"a{ending}")
    except frahm.ParameterError as error:
        message = str(error)
    if message is None:
        assert set(frahm.read_data(files[0]).data_vars) == set(map(str, dataset.data_vars))
    else:
        assert "directory that can be written" not in message
        assert list(tmp_path.iterdir()) == []


def test_names_no_program_likes_come_back_from_mat(tmp_path):
    long = "a" * 80
    names = ["größe", "величина", "grøße", "gr e", "gr-e", "gr.e", "gr+e", *(f"{long}{i}" for i in range(12))]
    dataset = xr.Dataset({name: ("t", [float(i)]) for i, name in enumerate(names)})
    same(frahm.read_data(frahm.write_data(dataset, tmp_path / "a.mat")[0]), dataset)
    assert all(name.isascii() for name in scipy.io.loadmat(tmp_path / "a.mat")["data"].dtype.names)


def _layout(**changes):
    facts = {"dims": ["t"], "dtype": "float64", "coord": False, "attrs": {}, "data": [1.0]} | changes.pop("x", {})
    return {"format": "frahm-dataset-1", "dims": {"t": 1}, "attrs": {}, "variables": {"x": facts}} | changes


@pytest.mark.parametrize(
    "text",
    [
        "[" * 100_000,
        "null",
        "1" * 5000,
        '{"format": "frahm-dataset-1"}',
        *(
            json.dumps(_layout(**changes))
            for changes in (
                {"dims": None}, {"dims": {"t": "one"}}, {"dims": {"t": -1}}, {"dims": {}}, {"attrs": []},
                {"variables": None}, {"variables": {"x": None}}, {"variables": {"x": {}}},
                {"x": {"dims": None}}, {"x": {"dims": [[]]}}, {"x": {"dims": ["u"]}}, {"x": {"dtype": None}},
                {"x": {"dtype": "S99999999999"}}, {"x": {"dtype": "object"}}, {"x": {"attrs": None}},
                {"x": {"attrs": {"a": {}}}}, {"x": {"attrs": {"a": {"number": []}}}}, {"x": {"coord": 1}},
                {"x": {"data": None}}, {"x": {"data": {"a": 1}}}, {"x": {"data": [[1.0, 2.0], [3.0]]}},
                {"x": {"data": ["one"]}}, {"x": {"data": [1.0, 2.0]}}, {"dims": {"t": 10**15}},
            )
        ),
    ],
)  # fmt: skip
def test_json_of_any_other_kind_is_refused(tmp_path, text):
    (tmp_path / "a.json").write_text(text, encoding="utf-8")
    with pytest.raises(frahm.ParameterError, match=r"a\.json"):
        frahm.read_data(tmp_path / "a.json")
    if text.startswith("{"):
        layout = json.loads(text)
        (tmp_path / "a.csv").write_text("# layout: " + json.dumps({"layout": layout, "files": None}) + "\nx\nm\n1\n")
        with pytest.raises(frahm.ParameterError, match=r"a\.csv"):
            frahm.read_data(tmp_path / "a.csv")


def test_a_table_is_read_from_the_files_beside_it_only(tmp_path):
    head = {"layout": _layout(), "files": ["../a.csv"]}
    (tmp_path / "a.csv").write_text("# layout: " + json.dumps(head) + "\nx\nm\n1\n")
    with pytest.raises(frahm.ParameterError):
        frahm.read_data(tmp_path / "a.csv")
