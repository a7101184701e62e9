import numpy as np
import pytest

from frahm.assessment.wind_bins import first_edges, interpolated_damage, middles, refined


def test_first_bins_are_narrow_at_the_resonance_and_fill_the_band():
    edges = first_edges(2.4, 2.9, 20, [2.64])
    widths = np.diff(edges)
    assert (edges[0], edges[-1], edges.size) == (2.4, 2.9, 21)
    assert widths.min() == widths[np.searchsorted(edges, 2.64) - 1]
    assert widths.max() > 3 * widths.min()
    assert np.diff(first_edges(1.0, 3.0, 10, [])) == pytest.approx(0.2)


def test_splitting_keeps_every_middle_and_goes_where_the_loss_is():
    seen = set()
    edges = refined(
        first_edges(0.0, 1.0, 8, []), 20, seen.update, lambda ends: np.diff(ends) * (np.abs(middles(ends) - 0.3) < 0.2)
    )
    assert edges.size - 1 == 20
    assert set(middles(edges).tolist()) == seen
    widths = np.diff(edges)
    inside = np.abs(middles(edges) - 0.3) < 0.1
    assert widths[inside].max() < widths[~inside].max() / 2


def test_nothing_to_split_where_nothing_is_lost():
    assert refined(first_edges(0.0, 1.0, 8, []), 20, lambda speeds: None, lambda ends: 0 * ends[1:]).size == 9


def test_linear_rates_are_summed_exactly():
    edges = np.linspace(1.0, 3.0, 11)
    speeds, weights = middles(edges), np.full(10, 0.1)
    assert interpolated_damage(speeds, 2 * speeds, edges, weights) == pytest.approx(4.0, rel=1e-3)
