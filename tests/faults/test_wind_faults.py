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
