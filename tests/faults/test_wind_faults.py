import pytest

import frahm
from frahm.loads import excitation_over_wind, speed_window, vortex_shedding

CASE = frahm.load_case("jacket-pipe")
TABLE = CASE.with_wind(lift_coefficient=[[1e5, 0.5], [1.6e5, 0.4]])  # 1.97 ... 3.15 m/s


@pytest.mark.parametrize("field", ["strouhal", "lift_coefficient"])
@pytest.mark.parametrize(
    ("value", "says"),
    [
        ([[1e5, 0.2]], "2 to 200 pairs"),
        ([], "2 to 200 pairs"),
        ([[1e5, 0.2], [1e5, 0.3]], "Entry 1: 100000 does not ascend"),
        ([[2e5, 0.2], [1e5, 0.3]], "does not ascend"),
        ([[1e5, 0.2], [2e5, -0.3]], "Entry 1: -0.3"),
        ([[1e5, 0.2], [2e5, float("nan")]], "Entry 1"),
        ([[0, 0.2], [2e5, 0.2]], "Entry 0"),
        ([[1e5, 0.2], [2e5]], "Entry 1 is .* not a pair"),
        ([1e5, 0.2], "Entry 0 is .* not a pair"),
        ({"many": 0.2, "2e5": 0.2}, "Entry 0"),
        ("en1992", "Did you mean 'en1991'"),
        ("fast", "one of facchinetti2004, en1991"),
        (None, "list of pairs"),
        (True, "list of pairs"),
    ],
)
def test_bad_coefficients(field, value, says):
    with pytest.raises(frahm.ParameterError, match=says) as caught:
        CASE.with_wind(**{field: value})
    assert caught.value.name == f"wind.{field}"


@pytest.mark.parametrize("speed", [1.9, 3.2])
def test_a_speed_beyond_a_table_is_refused(speed):
    with pytest.raises(frahm.ParameterError, match=r"1.9685 ... 3.14961 m/s.*wind.lift_coefficient"):
        TABLE.with_wind(speed=speed)
    with pytest.raises(frahm.ParameterError, match="not extrapolated"):
        vortex_shedding(TABLE, speed)
    with pytest.raises(frahm.ParameterError, match="not extrapolated"):
        excitation_over_wind(TABLE, [2.5, speed])
    with pytest.raises(frahm.ParameterError, match="not extrapolated"):
        speed_window(TABLE, sorted((2.5, speed)))


def test_the_seed_speed_is_inside_the_published_strouhal_curve_but_not_a_stronger_wind():
    assert CASE.with_wind(strouhal="facchinetti2004").wind.strouhal == "facchinetti2004"
    with pytest.raises(frahm.ParameterError, match=r"2.95276 m/s.*wind.strouhal"):
        CASE.with_wind(strouhal="facchinetti2004", speed=3.1)


@pytest.mark.parametrize("speeds", [[], [0.0], [-1, 2], [float("nan")], "fast", [[1, 2]]])
def test_bad_speeds(speeds):
    with pytest.raises(frahm.ParameterError, match="speeds"):
        excitation_over_wind(CASE, speeds)


@pytest.mark.parametrize("window", [None, (1,), (3, 2), (2, 2), (0, 1), ("a", 2), (1, float("inf"))])
def test_bad_windows(window):
    with pytest.raises(frahm.ParameterError, match="wind"):
        speed_window(CASE, window)


@pytest.mark.parametrize(
    ("record", "says"),
    [
        (([0.0], [2.7]), "two at least"),
        (([0.0, 1.0], [2.7]), "as many speeds as times"),
        (([0.0, 2.0, 1.0], [2.7, 2.7, 2.7]), "times that ascend"),
        (([0.0, 1.0, 1.0], [2.7, 2.7, 2.7]), "times that ascend"),
        (([0.0, 1.0], [2.7, -0.1]), "speeds >= 0"),
        (([0.0, float("nan")], [2.7, 2.7]), "record.time"),
        (([0.0, 1.0], ["fast", 2.7]), "record.speed"),
        (5.0, "a WindRecord, a CSV file, or a pair"),
        ("no-such-file.csv", "There is no such file"),
        (None, "wind.record or wind.turbulence"),
    ],
)
def test_bad_records(record, says):
    with pytest.raises(frahm.ParameterError, match=says):
        frahm.unsteady_response(CASE, record=record)


@pytest.mark.parametrize(
    ("text", "says"),
    [
        ("time,speed\n", "at least one row of numbers"),
        ("time,velocity\n0,1\n1,2\n", "Did you mean|has a column 'velocity'"),
        ("time [s],speed [kg]\n0,1\n1,2\n", "does not measure"),
        ("time,speed\n0,1\n1,\n", "speed: given ''"),
        ("time,speed\n0,1\n1,2,3\n", "cells in every row"),
        ("speed\n1\n2\n", "no column time"),
    ],
)
def test_bad_record_files(tmp_path, text, says):
    file = tmp_path / "wind.csv"
    file.write_text(text, encoding="utf-8")
    with pytest.raises(frahm.ParameterError, match=says):
        frahm.unsteady_response(CASE, record=file)


def test_a_record_beyond_a_table_is_refused_before_anything_runs():
    with pytest.raises(frahm.ParameterError, match="not extrapolated"):
        frahm.unsteady_response(TABLE, record=([0.0, 10.0, 20.0], [2.5, 1.9, 2.5]))
    assert frahm.unsteady_response(TABLE, record=([0.0, 10.0, 20.0], [2.5, 2.5, 1.9]), duration=9.0).outcome.ok


@pytest.mark.parametrize(
    ("more", "says"),
    [
        ({"duration": 30.0}, "the length of the record"),
        ({"duration": 0.0}, "duration"),
        ({"duration": float("nan")}, "duration"),
        ({"seed": 3}, "seed"),
        ({"samples_per_period": 2}, "samples_per_period"),
        ({"tolerance": 0.1}, "tolerance"),
        ({"initial_state": [0.0, 0.0]}, "initial_state"),
    ],
)
def test_bad_settings_of_the_unsteady_response(more, says):
    with pytest.raises(frahm.ParameterError, match=says):
        frahm.unsteady_response(CASE, record=([0.0, 20.0], [2.7, 2.7]), **more)


@pytest.mark.parametrize(
    ("wind", "says"),
    [
        ({"turbulence": {"intensity": 2.0, "length_scale": 50}}, "wind.turbulence.intensity"),
        ({"turbulence": {"intensity": 0.1, "length_scale": 0}}, "wind.turbulence.length_scale"),
        ({"turbulence": {"intensity": 0.1}}, "wind.turbulence.length_scale"),
        ({"turbulence": {"intensity": 0.1, "length_scale": 50, "spectrum": "kaimel"}}, "Did you mean 'kaimal'"),
        ({"record": [[0, 1]]}, "wind.record"),
        ({"record": [[0, 1], [1, -1]]}, "Entry 1"),
        ({"record": [[0, 1], [0, 1]]}, "does not ascend"),
        ({"record": [[t, 2.7] for t in range(5001)]}, "A longer record goes to"),
        ({"record": "nowhere.csv"}, "There is no such file"),
    ],
)
def test_bad_unsteady_wind_of_a_case(wind, says):
    with pytest.raises(frahm.ParameterError, match=says):
        CASE.with_wind(**wind)


@pytest.mark.parametrize(
    ("more", "says"),
    [
        ({"wind": (3.0, 2.0)}, "lo < hi"),
        ({"wind": (0.0, 2.0)}, "wind"),
        ({"wind": 3.0}, "two wind speeds"),
        ({"speeds": 1}, "speeds"),
        ({"wake": "facchinetti"}, "WakeOscillator"),
        ({"most_periods": 10}, "most_periods"),
        ({"tolerance": -1}, "tolerance"),
    ],
)
def test_bad_settings_of_the_wake_response(more, says):
    with pytest.raises(frahm.ParameterError, match=says):
        frahm.wake_response(CASE, **more)


def test_the_wake_oscillator_wants_a_rigid_pipe():
    with pytest.raises(frahm.ParameterError, match=r"pipe\.kind"):
        frahm.wake_response("jacket-pipe-elastic")


def test_a_motion_that_diverges_is_a_value_with_a_sentence():
    # a softening spring beyond its range pushes the sink away for good
    runaway = CASE.to_dict() | {
        "absorbers": [{"mass": 4.94, "law": {"kind": "polynomial", "coefficients": [10.0, 0.0, -1e9], "damping": 0.0}}]
    }
    found = frahm.unsteady_response(runaway, record=([0.0, 200.0], [2.65, 2.65]))
    assert not found.history.outcome.ok
    assert found.bare.outcome.ok
    assert found.to_dataset()["pipe_displacement"].isnull().any()
    with pytest.raises(frahm.ConvergenceError):
        frahm.unsteady_response(runaway, record=([0.0, 200.0], [2.65, 2.65]), throw=True)
    curve = frahm.wake_response(runaway, wind=(2.9, 3.0), speeds=2)
    assert curve.unverified
    with pytest.raises(frahm.ConvergenceError):
        frahm.wake_response(runaway, wind=(2.9, 3.0), speeds=2, throw=True)
