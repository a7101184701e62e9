"""The few rows of a table that leave the smallest worst utilisation, against every choice there is."""

import itertools

import numpy as np
import pytest

from frahm.products.cover import best_rows


def worst(values, rows):
    return np.max(np.min(values[list(rows)], axis=0))


@pytest.mark.parametrize("count", [1, 2, 3])
@pytest.mark.parametrize("seed", range(4))
def test_no_other_choice_is_better(count, seed):
    rng = np.random.default_rng(seed)
    values = np.exp(rng.normal(size=(14, 7)))
    values[rng.random(values.shape) < 0.3] = np.inf  # too heavy, or with a detached curve
    found = best_rows(values, count)
    assert len(found) <= count
    assert worst(values, found) == min(worst(values, rows) for rows in itertools.combinations(range(14), count))


def test_fewer_rows_are_taken_where_more_are_no_better():
    values = np.array([[1.0, 1.0, 1.0], [0.5, 2.0, 2.0], [2.0, 0.5, 2.0]])
    assert best_rows(values, 1) == (0,)
    assert worst(values, best_rows(values, 3)) == 1.0


def test_more_columns_than_a_machine_word_has_bits():
    values = np.full((3, 130), 9.0)
    values[0, :70] = 1.0
    values[1, 70:] = 2.0
    assert set(best_rows(values, 2)) == {0, 1}
