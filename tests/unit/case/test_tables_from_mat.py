"""Wind records and climates from MAT files: the case is that of the same numbers written out."""

import numpy as np
import pytest
import scipy.io

import frahm

CASE = frahm.load_case("jacket-pipe")
TIME, SPEED = np.array([0.0, 1.5, 3.25]), np.array([2.7, 2.9, 2.5])


def loaded(folder, text):
    (folder / "case.yaml").write_text(text, encoding="utf-8")
    return frahm.load_case(folder / "case.yaml")


def with_record(value):
    return CASE.to_yaml().replace("record: []", f"record: {value}")


@pytest.mark.parametrize("shape", [(3,), (3, 1), (1, 3)])
def test_a_wind_record_comes_in(tmp_path, shape):
    vectors = {"Time": TIME.reshape(shape), "speed": SPEED.reshape(shape), "remark": "from the mast"}
    scipy.io.savemat(tmp_path / "gusts.mat", vectors)
    found = loaded(tmp_path, with_record("gusts.mat"))
    assert found.wind.record == tuple(zip(TIME.tolist(), SPEED.tolist(), strict=True))
    (tmp_path / "gusts.mat").unlink()  # the case is complete without the file
    assert loaded(tmp_path, found.to_yaml()).digest == found.digest


def test_a_table_of_winds_comes_in(tmp_path):
    scipy.io.savemat(tmp_path / "wind.mat", {"speed": [2.0, 4.0, 6.0], "probability": [0.5, 0.3, 0.2]})
    climate = "climate: {duration: 20 year, table: NAME}"
    text = CASE.to_yaml().replace("climate: null", climate)
    (tmp_path / "wind.csv").write_text("speed,probability\n2,0.5\n4,0.3\n6,0.2\n", encoding="utf-8")
    one, other = (loaded(tmp_path, text.replace("NAME", name)) for name in ("wind.mat", "wind.csv"))
    assert one.climate is not None
    assert one.digest == other.digest


@pytest.mark.parametrize(
    ("vectors", "words"),
    [
        ({"time": [0.0, 1.0], "speed": [2.0]}, "no column speed. Left out, because 2 rows are the most: speed has 1"),
        ({"time": [0.0, 1.0], "sped": [2.0, 3.0]}, "Did you mean 'speed'"),
        ({"time": [0.0, np.nan], "speed": [2.0, 3.0]}, "a finite number"),
        ({"remark": "nothing"}, "no vector of numbers"),
        (None, "gusts.mat"),
        (b"no MAT file at all, only text" * 9, "gusts.mat"),
    ],
)
def test_what_is_wrong_is_said(tmp_path, vectors, words):
    if isinstance(vectors, bytes):
        (tmp_path / "gusts.mat").write_bytes(vectors)
    elif vectors is not None:
        scipy.io.savemat(tmp_path / "gusts.mat", vectors)
    with pytest.raises(frahm.ParameterError) as refused:
        loaded(tmp_path, with_record("gusts.mat"))
    assert words in str(refused.value)
    assert "wind.record" in str(refused.value)
