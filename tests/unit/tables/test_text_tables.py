"""Tables as loggers and spreadsheets write them come in as they are meant, or not at all."""

import os
import subprocess
import sys
import tracemalloc

import numpy as np
import pytest

import frahm
from frahm.tables import read_table_file


@pytest.fixture
def written(tmp_path):
    def write(text, name="a.csv", encoding="utf-8"):
        path = tmp_path / name
        path.write_bytes(text if isinstance(text, bytes) else text.encode(encoding))
        return path

    return write


@pytest.mark.parametrize(
    ("text", "encoding"),
    [
        ("t,x\n0,1.5\n0.5,-2\n", "utf-8"),
        ("t,x\r\n0,1.5\r\n0.5,-2\r\n", "utf-8-sig"),
        ("t;x\n0;1,5\n0,5;-2\n", "utf-8"),
        ("sep=;\nt;x\n0;1,5\n0,5;-2\n", "utf-8"),
        ("sep=,\nt,x\n0,1.5\n0.5,-2\n", "utf-8"),
        ("t x\n0,0 1,5\n0,5 -2\n", "utf-8"),
        ("t x\n0,0   1,5\n 0,5  -2,0\n", "utf-8"),
        ("t, x\n0, 1.5\n0.5, -2\n", "utf-8"),
        ("t,x,\n0,1.5,\n0.5,-2,\n", "utf-8"),
        ("t,x\n0,1.5,\n0.5,-2,\n", "utf-8"),
        ("t;x;;\n0;1,5;;\n0,5;-2;;\n;;;\n\n", "utf-8"),
        ("t\tx\n0\t1.5\n0.5\t\N{MINUS SIGN}2\n", "utf-8"),
        ('"t","x"\n"0","1.5"\n"0.5","-2"\n', "utf-8"),
        ("t\tx\n0\t1,5\n0,5\t-2\n", "utf-16"),
        ("t;x\n# naïve remark\n0;1,5\n0,5;-2\n", "cp1252"),
        ("0,1.5\n0.5,-2\n", "utf-8"),
        ("t,x\ns,m\n0,1.5\n0.5,-2\n", "utf-8"),
        ("t,x\n[s],[m]\n0,1.5\n0.5,-2\n", "utf-8"),
        ("t,x\n2024-03-01T12:00:00,1.5\n2024-03-01T12:00:00.5,-2\n", "utf-8"),
        ("t;x\n2024-03-01 12:00:00;1,5\n2024-03-01 12:00:00,500;-2,0\n", "utf-8"),
        ("t,x\n2024-03-01T12:00:00Z,1.5\n2024-03-01T13:00:00.5+01:00,-2\n", "utf-8"),
    ],
)
def test_every_way_to_write_a_table_gives_the_same_numbers(written, text, encoding):
    found = frahm.read_time_series(written(text, encoding=encoding))
    np.testing.assert_array_equal(found["time"], [0, 0.5])
    (name,) = found.data_vars
    np.testing.assert_array_equal(found[name], [1.5, -2])
    assert name == ("column 2" if text[0] == "0" else "x")


@pytest.mark.parametrize(
    ("text", "line", "words"),
    [
        ("time,speed\n1,0,1,5\n2,0,1,6\n", 2, ("4 cells", "2 cells in every row", "semicolon")),
        ("t,x,y\n0,1\n1,2\n", 2, ("2 cells", "3 cells in every row")),
        ("t,x\n0,1\n1\n2,3\n", 3, ("1 cells",)),
        ("t,x\n0,1\n1,2,3\n", 3, ("3 cells",)),
        ("t,x,y\n0,1,\n1,2,\n", 2, ("y: given ''",)),
        ("t,x\n0,one\n1,2\n", 2, ("x: given 'one'",)),
        ("t,x\n1,two\n2,3\n", 2, ("x: given 'two'",)),
        ("t,x\nAvg,Smp\n1,2\n", 2, ("given 'Avg'",)),
        ("t,100\n0,1\n", 1, ("given 't'",)),
        ('t,x\n0,"1,234"\n', 2, ("given '1,234'", "full stop")),
        ("t;x\n0;1,5\n1;2.5\n", 3, ("given '2.5'", "one decimal sign")),
        ("t;x\n0;1.5\n1;2,5\n", 3, ("given '2,5'", "one decimal sign")),
        ("t;x\n0;1.234,5\n", 2, ("given '1.234,5'",)),
        ("t,x\n0,1_000\n", 2, ("given '1_000'",)),
        ("t,x\n0,١\n", 2, ("given '١'",)),
        ("t,x\n2024-01-01T00:00,1\n2024-13-01T00:00,2\n", 3, ("2024-13-01", "a date")),
        ("t,x\n2024-01-01T00:00,1\n5,2\n", 3, ("given '5'", "a date")),
        ("t,x\n2024-01-01T00:00,1\n2024-01-01T01:00Z,2\n", 3, ("time zone",)),
        ("t,x\n0,1\n1,1e999\n", 3, ("x: given '1e999'", "at most 1.8e+308")),
        ("t;x\n0;-1,5e400\n1;2\n", 2, ("x: given '-1,5e400'", "at most 1.8e+308")),
        (f"t,x\n0,{'9' * 5000}\n1,2\n", 2, ("x: given '999", "at most 1.8e+308")),
        ("t,x\n0,1\n1,2\n1,3\n", 4, ("ascends", "'t'")),
        ("t,x\n0,1\nnan,2\n2,3\n", 3, ("ascends",)),
        (f't,x\n0,"{"9" * 200_000}x"\n', 2, ("field larger",)),
        (f"t,x\n0,{'9' * 1_100_000}\n", 2, ("at most 1000000 characters",)),
        (b"t,x\n0,1\n1,\x00\n", 3, ("not text",)),
    ],
)
def test_what_is_wrong_is_said_with_its_line(written, text, line, words):
    with pytest.raises(frahm.ParameterError) as refused:
        frahm.read_time_series(written(text))
    message = str(refused.value)
    assert f"a.csv:{line}: " in message
    assert [word for word in words if word not in message] == [], message


def test_large_numbers_and_words_for_what_is_no_number_are_read(written):
    found = frahm.read_table(written("t,x\n1e308,1e308\n-inf,nan\n2,INFINITY\n"))
    np.testing.assert_array_equal(found["t"], [1e308, -np.inf, 2])
    np.testing.assert_array_equal(found["x"], [1e308, np.nan, np.inf])


@pytest.mark.parametrize(
    "head", ["time_ms", "t/ms", "time in ms", "timeMs", "TIME_MIN", "time:us", "t_h", "elapsed_hours", "ms"]
)
def test_a_time_whose_name_tells_another_unit_than_seconds_is_asked_about(written, head):
    with pytest.raises(frahm.ParameterError) as refused:
        frahm.read_time_series(written(f"{head};speed [m/s]\n1;2\n2;3\n"))
    assert head in str(refused.value)
    assert "in brackets" in str(refused.value)


@pytest.mark.parametrize("head", ["time", "t", "time_s", "seconds", "clock"])
def test_a_time_without_unit_says_that_seconds_are_assumed(written, head):
    found = frahm.read_time_series(written(f"{head};speed [m/s]\n1;2\n2;3\n"))
    assert found["time"].values.tolist() == [1.0, 2.0]
    assert found["time"].attrs["assumed"] == f"seconds: the column {head!r} gives no unit"
    assert "assumed" not in frahm.read_time_series(written("time [s];x\n1;2\n2;3\n"))["time"].attrs


def test_dates_tell_when_they_start(written):
    found = frahm.read_time_series(written("when;x\n2024-03-01 12:00;1\n2024-03-02 12:00;2\n"))
    assert found["time"].values.tolist() == [0.0, 86_400.0]
    assert found["time"].attrs["start"] == "2024-03-01T12:00:00"
    assert found["time"].attrs["units"] == "s"


@pytest.mark.parametrize(
    ("unit", "factor", "si"),
    [
        ("N m-3", 1, "N/m^3"), ("km h-1", 1 / 3.6, "m/s"), ("m s**-1", 1, "m/s"), ("kN/m", 1000, "N/m"),
        ("hPa", 100, "Pa"), ("g cm-3", 1000, "kg/m^3"), ("degC", 1, "degC"), ("zork", 1, "zork"), ("%", 0.01, "1"),
    ],
)  # fmt: skip
def test_units_become_si_or_stay_what_they_are(written, unit, factor, si):
    found = frahm.read_table(written(f"a [1],b [{unit}]\n1,2\n3,4\n"))
    np.testing.assert_allclose(found["b"], [2 * factor, 4 * factor], rtol=1e-12)
    assert found["b"].attrs["units"] == si


def test_the_tables_of_a_case_are_read_as_all_others(written, tmp_path):
    climate = "speed [km/h];probability [%]\n9;12,5\n18;87,5\n"
    case = frahm.load_case("jacket-pipe")
    text = case.to_yaml().replace("climate: null", "climate: {duration: 1 year, table: a.csv}")
    (tmp_path / "case.yaml").write_text(text, encoding="utf-8")
    for encoding in ("utf-8", "cp1252", "utf-16"):
        written("# Größe\n" + climate if encoding != "utf-16" else climate, encoding=encoding)
        rows = frahm.load_case(tmp_path / "case.yaml").climate.table
        assert [(row.speed, row.probability) for row in rows] == [(2.5, 0.125), (5.0, 0.875)]


def test_a_misspelt_file_is_told_its_neighbour(written, tmp_path):
    written("t,x\n0,1\n", "measured.csv")
    case = tmp_path / "pipe-of-mine.yaml"
    case.write_text(frahm.load_case("jacket-pipe").to_yaml(), encoding="utf-8")
    doors = {
        "measurd.csv": (frahm.read_table, frahm.read_time_series, frahm.read_data),
        "pipe-of-mne.yaml": (frahm.load_case,),
    }
    for name, readers in doors.items():
        for read in readers:
            with pytest.raises(frahm.ParameterError, match=r"Did you mean '.*(measured.csv|pipe-of-mine.yaml)'"):
                read(tmp_path / name)
    with pytest.raises(frahm.ParameterError, match="no folder"):
        frahm.read_table(tmp_path / "nowhere" / "a.csv")


@pytest.mark.skipif(not hasattr(os, "mkfifo"), reason="there are no named pipes here")
def test_a_named_pipe_is_refused_at_once(tmp_path):
    os.mkfifo(tmp_path / "p.csv")
    os.mkfifo(tmp_path / "summary.json")
    os.mkfifo(tmp_path / "p.json")
    (tmp_path / "a.yaml").write_text(
        frahm.load_case("jacket-pipe").to_yaml().replace("record: []", "record: p.csv"), encoding="utf-8"
    )
    code = (
        "import frahm, sys\n"
        "from frahm.analysis import load_analysis\n"
        "for read, name in ((frahm.read_table, 'p.csv'), (frahm.load_case, 'a.yaml'), (frahm.read_data, 'p.json'),\n"
        "                   (load_analysis, '.')):\n"
        "    try: read(name)\n"
        "    except frahm.ParameterError as error: assert 'no regular file' in str(error), error\n"
        "    else: sys.exit(name)\n"
    )
    run = [sys.executable, "-c", code]
    done = subprocess.run(run, cwd=tmp_path, timeout=60, capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stderr


def test_a_table_needs_a_few_bytes_of_memory_for_each_of_the_file(written):
    path = written("time,speed\n" + "".join(f"{i},{i % 7}.5\n" for i in range(60_000)))
    read_table_file(path)
    tracemalloc.start()
    table = read_table_file(path)
    _, peak = tracemalloc.get_traced_memory()
    tracemalloc.stop()
    assert len(table.columns[0]) == 60_000
    assert peak < 8 * path.stat().st_size
