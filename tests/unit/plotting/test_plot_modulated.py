"""Envelopes of modulated branches and the basin map: what is drawn is what the dataset holds."""

import numpy as np
import pytest
import xarray as xr

import frahm
from frahm.plotting.basins import basin_entries, basin_indices, basin_map_figure
from frahm.plotting.interactive import basin_map_plot, response_plot
from frahm.plotting.lines import envelopes
from frahm.plotting.static import response_figure

CASE = frahm.load_case("jacket-pipe").with_absorber(kappa=97.97, xi2=0.0085, rho2=0.02)


def branch(detuning, stable, number):
    values = np.asarray(detuning, dtype=float)
    names = ("pipe_min", "pipe_max", "relative_min", "relative_max")
    columns = {name: ("point", values + 10 * (i + 1)) for i, name in enumerate(names)}
    return xr.Dataset({
        "detuning": ("point", values), "stable": ("point", np.asarray(stable, dtype=bool)),
        "branch": ("point", np.asarray(number)), **columns,
    })  # fmt: skip


def test_a_stretch_has_one_branch_one_stability_and_one_direction():
    data = branch([0, 1, 2, 1.5, 1, 0.5, 5, 6], [1, 1, 1, 0, 0, 0, 1, 1], [0, 0, 0, 0, 0, 0, 1, 1])
    found = envelopes(data, "pipe_peak")
    assert [(e.x.tolist(), e.stable) for e in found] == [
        ([0, 1, 2], True), ([0.5, 1, 1.5, 2], False), ([5, 6], True),
    ]  # fmt: skip
    assert all(
        np.all(np.diff(e.x) > 0) and np.allclose(e.low, e.x + 10) and np.allclose(e.high, e.x + 20) for e in found
    )
    np.testing.assert_allclose(envelopes(data, "relative_peak")[0].high, [40, 41, 42])


@pytest.mark.parametrize("count", [0, 1])
def test_nothing_to_draw(count):
    assert envelopes(branch(np.arange(count), np.ones(count), np.zeros(count)), "pipe_peak") == []


def test_the_modulated_range_is_in_both_response_figures():
    curve = frahm.frequency_response(CASE, detuning=(-0.05, 0.05), method="slow-flow").to_dataset()
    modulated = frahm.modulated_branches(CASE, detuning=(-0.001, 0.004), looks=3, checks=0).to_dataset()
    (axes,) = response_figure(curve, "relative_peak", modulated=modulated).axes
    assert "modulated (slow flow)" in [handle.get_label() for handle in axes.collections]
    assert axes.get_ylim()[1] > 1e3 * float(modulated["relative_max"].max())  # [mm]
    plot = response_plot(curve, "relative_peak", [], modulated=modulated)
    shaded = [trace for trace in plot.data if trace.get("fill") == "tonexty"]
    np.testing.assert_allclose(max(np.max(t["y"]) for t in shaded), 1e3 * modulated["relative_max"].max(), rtol=1e-6)


def test_the_map_names_every_attractor_and_what_was_lost():
    data = frahm.basin_map(CASE, detuning=0.0, resolution=(12, 9))
    data["label"].values[0, 0] = -2
    entries, index = basin_entries(data), basin_indices(data)
    assert [entry.label for entry in entries] == [0, 1, -2]
    assert np.array_equal(np.array([entry.label for entry in entries])[index], data["label"].values)
    texts = [text.get_text() for text in basin_map_figure(data).legends[0].get_texts()]
    assert texts[:3] == [entry.text for entry in entries]
    assert "escaped" in texts
    assert any(text.startswith("periodic, pipe 30.") for text in texts)
    heat = basin_map_plot(data).data[0]
    assert np.array_equal(heat["z"], index.T)
