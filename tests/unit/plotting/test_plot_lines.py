import numpy as np
import pytest
import xarray as xr

import frahm
from frahm.plotting.lines import (
    Line,
    beyond_the_top,
    lines_by_name,
    response_lines,
    special_marks,
    stretches,
    thinned,
)
from frahm.plotting.style import decade_label

CURVE = frahm.frequency_response(
    frahm.load_case("jacket-pipe").with_absorber(xi2=0.0085), detuning=(-0.3, 0.3), method="slow-flow"
).to_dataset()


def test_stretches_share_their_ends_but_never_across_branches():
    stable = np.array([1, 1, 0, 0, 1, 1], dtype=bool)
    branch = np.array([0, 0, 0, 0, 0, 1])
    assert stretches(stable, branch) == [
        (slice(0, 3), True), (slice(2, 5), False), (slice(4, 5), True), (slice(5, 6), True),
    ]  # fmt: skip


def test_lines_hold_every_point_and_mark_the_detached_branch():
    lines = response_lines(CURVE, "pipe_peak")
    assert {x for line in lines for x in line.x} == set(CURVE["detuning"].values)
    detached = [line for line in lines if line.detached]
    assert {line.stable for line in detached} == {True, False}
    assert min(line.x.min() for line in detached) == pytest.approx(-0.16809, abs=1e-4)
    assert max(line.x.max() for line in detached) == pytest.approx(-0.09737, abs=1e-4)


def test_lines_of_one_name_are_one_line_with_gaps():
    x = np.array([0.0, 1.0])
    lines = [
        Line(x, x, False, False),
        Line(x, x + 1, True, True),
        Line(x + 2, x, False, False),
        Line(x, x, True, False),
    ]
    named = lines_by_name(lines)
    assert list(named) == ["stable", "unstable", "detached branch, stable"]
    np.testing.assert_equal(named["unstable"].x, [0, 1, np.nan, 2, 3])


def test_marks_are_numbered_kind_by_kind():
    marks = special_marks(CURVE, "relative_peak")
    assert [mark.label for mark in marks] == ["SN1", "SN2", "H1", "SN3", "H2", "SN4"]
    assert np.all(np.diff([mark.x for mark in marks]) > 0)


def test_thinning_keeps_the_extremes():
    x = np.linspace(0, 1, 100_000)
    y = np.sin(300 * x)
    y[[777, 88_888]] = 5, -7
    few_x, few_y = thinned(x, y, 500)
    assert few_x.size <= 500
    assert (few_y.max(), few_y.min()) == (5, -7)
    assert np.all(np.diff(few_x) > 0)


def bare(peaks):
    return xr.Dataset({"detuning": ("point", [-0.1, 0.0, 0.1, 0.2]), "pipe_peak": ("point", peaks)})


def test_a_curve_that_leaves_the_figure_is_named_with_its_height():
    assert beyond_the_top(bare([0.1, 0.2, 0.1, 0.1]), 0.3) is None
    beyond = beyond_the_top(bare([0.1, 0.9, 0.4, 0.1]), 0.3)
    assert beyond.x == 0.1
    assert "up to 900 mm" in beyond.text
    assert "without bound" in beyond_the_top(bare([0.1, np.inf, 0.2, 0.1]), 0.3).text


@pytest.mark.parametrize(("value", "text"), [(1e-4, "10⁻⁴"), (1.0, "10⁰"), (100.0, "10²"), (2e-3, "0.002"), (0.0, "0")])
def test_decades_are_labelled_in_plain_text(value, text):
    assert decade_label(value) == text
