"""Legends under figures: as many columns as there is room for."""

import pytest
from matplotlib.backends.backend_agg import FigureCanvasAgg

from frahm.plotting.style import figure_style, legend_below, new_figure


@pytest.mark.parametrize(("text", "columns"), [("short", 4), ("an entry of middling length", 3), ("long " * 20, 1)])
def test_a_legend_is_not_wider_than_its_figure(text, columns):
    with figure_style():
        figure = new_figure(160, 60)
        axes = figure.subplots()
        for k in range(4):
            axes.plot([0, 1], [k, k], label=text)
        legend_below(figure, 4)
        (legend,) = figure.legends
        assert legend._ncols == columns
        if columns > 1:
            assert legend.get_window_extent(FigureCanvasAgg(figure).get_renderer()).width <= figure.bbox.width
