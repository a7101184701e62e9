"""Plain trees of figures: plotly's own library takes and reads them, and would have made the same."""

import base64
import json

import numpy as np
import plotly.graph_objects as go
import pytest
from plotly.subplots import make_subplots

import frahm
from frahm.analysis import analyse
from frahm.analysis import analysis as steps
from frahm.plotting.fatigue import fatigue_plot
from frahm.plotting.interactive import basin_map_plot, manifold_plot, motion_plot, response_plot
from frahm.plotting.over_wind import over_wind_plot
from frahm.plotting.plain import PlainFigure
from frahm.plotting.views import motion_views, trajectory_to_show
from frahm.plotting.wind import gusts_plot


@pytest.fixture(scope="module")
def analysis():
    """The built-in pipe, by the steps that take no time."""
    quick = ("without_absorber", "exact_response", "slow_flow_response", "over_wind", "manifold", "motions")
    kept = steps.STEPS
    steps.STEPS = tuple(step for step in kept if step.run.__name__ in quick)
    try:
        return analyse(frahm.load_case("jacket-pipe").with_analysis(periods=200))
    finally:
        steps.STEPS = kept


def figures(analysis):
    data, results = analysis.data, analysis.results
    views = motion_views(results, data)
    beside = data["without_absorber"], data["slow_flow"]
    yield response_plot(data["response"], "pipe_peak", views, *beside)
    yield response_plot(data["response"], "relative_peak", views, *beside)
    yield motion_plot(views[0])
    yield over_wind_plot(data["response_over_wind"], data["without_absorber_over_wind"])
    yield manifold_plot(data["slow_manifold"], trajectory_to_show(views), results["slow_manifold"]["folds"])
    case = analysis.case
    yield basin_map_plot(frahm.basin_map(case, detuning=0.0, resolution=(6, 4)))
    turbulent = case.with_wind(turbulence={"intensity": 0.05, "length_scale": 50})
    yield gusts_plot(frahm.unsteady_response(turbulent, duration=300.0).to_dataset())
    elastic = frahm.load_case("jacket-pipe-elastic")
    yield fatigue_plot(frahm.fatigue_damage(elastic, bins=4, samples=1).to_dataset())


def test_plotly_accepts_every_figure(analysis):
    """Its own library refuses what plotly.js does not know, and sees the numbers that were given."""
    for figure in figures(analysis):
        given = figure.to_dict()
        checked = go.Figure(json.loads(figure.to_json()))
        assert len(checked.data) == len(given["data"]) > 0
        for trace, mine in zip(go.Figure(given).data, given["data"], strict=True):
            np.testing.assert_array_equal(np.asarray(trace.x, float), np.asarray(mine["x"], float))


def test_panels_are_where_plotly_would_put_them():
    for shares, gap in (((1.0, 1.0, 1.0), 0.13), ((1.0, 2.0), 0.06), ((1.0, 1.0), 0.08)):
        theirs = make_subplots(rows=len(shares), cols=1, row_heights=list(shares), vertical_spacing=gap).layout
        mine = PlainFigure(shares, gap).layout
        for row in range(1, len(shares) + 1):
            name = f"yaxis{row}" if row > 1 else "yaxis"
            assert mine[name]["domain"] == pytest.approx(theirs[name].domain, abs=1e-12)
            assert mine[name]["anchor"] == theirs[name].anchor


def test_arrays_arrive_as_they_are_given():
    figure = PlainFigure()
    values = np.array([1.5, np.nan, np.inf, -2.25])
    figure.add_scatter(x=values, y=values.astype(np.float32), text=["a", None], extra=(np.float64(np.nan), np.int64(3)))
    figure.add_trace("heatmap", z=np.arange(6, dtype=np.int8).reshape(2, 3))
    line, heat = json.loads(figure.to_json())["data"]
    assert line["extra"] == [None, 3]
    for name, kind in (("x", "<f8"), ("y", "<f4")):
        np.testing.assert_array_equal(np.frombuffer(base64.b64decode(line[name]["bdata"]), kind), values)
    assert heat["z"]["shape"] == "2, 3"
    theirs = json.loads(go.Figure(go.Heatmap(z=np.arange(6, dtype=np.int8).reshape(2, 3))).to_json())["data"][0]["z"]
    assert heat["z"] == theirs


def test_parts_of_a_layout_are_set_and_taken_away():
    figure = PlainFigure((1.0, 1.0))
    figure.update_layout(height=300, legend={"x": 0, "y": 1})
    figure.update_layout(height=None, legend={"y": 2})
    figure.update_axes("x", title={"text": "both"})
    figure.update_axes("y", row=2, type="log")
    assert "height" not in figure.layout
    assert figure.layout["legend"] == {"x": 0, "y": 2}
    assert [figure.layout[name]["title"] for name in ("xaxis", "xaxis2")] == [{"text": "both"}] * 2
    assert "type" not in figure.layout["yaxis"]
    assert figure.layout["yaxis2"]["type"] == "log"
