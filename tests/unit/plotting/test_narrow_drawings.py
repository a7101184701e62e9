"""A drawing for a narrow screen: everything is inside it, and its text is as large as on paper."""

import re

import numpy as np
import pytest
import xarray as xr

from frahm.plotting.decision import DEVICES, Marks, decision_figure
from frahm.plotting.design_figures import frequency_error_figure
from frahm.plotting.style import NARROW, figure_style, save_figure

NAMES = ", ".join(DEVICES)
MARKS = Marks(12.0, 1.6, (9.3, 13.9), (-3.0, 5.0), "secondary")


def lasting():
    speed = np.tile(np.linspace(9, 14, 40), len(DEVICES))
    device = np.repeat(np.arange(len(DEVICES)), 40)
    peak = (1 + device) * 1e-3 / (0.1 + abs(speed - 11))
    columns = {"wind_speed": speed, "device": device, "pipe_peak": peak, "part": 0 * device,
               "searched_pipe_peak": np.where(speed > 13, 2 * peak, 0)}  # fmt: skip
    data = xr.Dataset({name: ("point", values) for name, values in columns.items()})
    data["device"].attrs["names"] = NAMES
    return data


def errors():
    peaks = 1e-3 * np.arange(1, 1 + 3 * len(DEVICES), dtype=float).reshape(len(DEVICES), 3)
    data = xr.Dataset({"error": ("error_index", [-0.1, 0, 0.1]), "error_pipe_peak": (("device", "error_index"), peaks),
                       "error_verified": (("device", "error_index"), np.ones_like(peaks))})  # fmt: skip
    data["error_pipe_peak"].attrs["names"] = NAMES
    return data


@pytest.mark.parametrize(
    "draw",
    [lambda: decision_figure(lasting(), MARKS), lambda: frequency_error_figure(errors())],
    ids=["head", "errors"],
)
def test_a_narrow_drawing_holds_its_legend_and_its_labels(tmp_path, draw):
    with figure_style():
        figure = draw()
        entries = [text.get_text() for text in figure.legends[0].get_texts()]
        paths = save_figure(figure, tmp_path / "one", narrow=True)
        assert [path.name for path in paths] == ["one.svg", "one.png", f"one{NARROW}.svg"]
        narrow = paths[-1].read_text(encoding="utf-8")
        assert float(re.search(r'<svg[^>]* width="([\d.]+)pt"', narrow)[1]) * 96 / 72 < 364  # of a telephone of 390
        (legend,) = figure.legends
        assert [text.get_text() for text in legend.get_texts()] == entries
        renderer = figure._get_renderer()
        whole = figure.bbox
        labels = [axis.label for axis in (figure.axes[0].xaxis, figure.axes[0].yaxis)]
        for part in (*legend.get_texts(), *labels):
            box = part.get_window_extent(renderer)
            assert whole.x0 - 2 < box.x0 < box.x1 < whole.x1 + 2, part.get_text()  # letters are rounded to pixels
            assert whole.y0 - 2 < box.y0 < box.y1 < whole.y1 + 2, part.get_text()
        rows = sorted(text.get_window_extent(renderer).y0 for text in legend.get_texts())
        assert min(np.diff(rows)) > 0  # one entry a line
