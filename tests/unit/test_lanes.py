import numpy as np
import pytest

from frahm.compiled import kernel
from frahm.lanes import (
    LANES,
    address,
    any_positive,
    cos_turns,
    lane_room,
    load,
    magnitude,
    maximum,
    square_root,
    store,
    where_at_most,
)


@kernel
def arithmetic(at_a, at_b, at_out):
    a, b = load(at_a, 0), load(at_b, 0)
    store(at_out, 0, (a + 2.0 * b) / 3.0 - a * b)
    store(at_out, 1 * LANES, square_root(magnitude(b)))
    store(at_out, 2 * LANES, maximum(a, b))
    store(at_out, 3 * LANES, where_at_most(a, 0.0, a, 1.0))
    store(at_out, 4 * LANES, cos_turns(a))
    return any_positive(a), any_positive(a - 100.0)


def test_operations_act_on_every_lane():
    a, b, out = lane_room(1), lane_room(1), lane_room(5)
    a[:], b[:] = np.linspace(-3.2, 1e3, LANES), np.random.default_rng(0).normal(size=LANES)
    assert arithmetic(address(a), address(b), address(out)) == (True, True)
    out = out.reshape(5, LANES)
    np.testing.assert_allclose(out[0], (a + 2 * b) / 3 - a * b, rtol=1e-13)
    np.testing.assert_allclose(out[1], np.sqrt(np.abs(b)), rtol=1e-15)
    np.testing.assert_array_equal(out[2], np.maximum(a, b))
    np.testing.assert_array_equal(out[3], np.where(a <= 0, a, 1.0))
    np.testing.assert_allclose(out[4], np.cos(2 * np.pi * (a - np.round(a))), atol=5e-16)


@pytest.mark.parametrize("lane", range(LANES))
def test_one_positive_lane_is_seen_wherever_it_is(lane):
    a, b, out = lane_room(1), lane_room(1), lane_room(5)
    a[:] = -1.0
    a[lane] = 1.0
    assert arithmetic(address(a), address(b), address(out)) == (True, False)
    assert list(np.nonzero(out.reshape(5, LANES)[3] == 1.0)[0]) == [lane]


def test_a_nan_stays_in_its_lane():
    a, b, out = lane_room(1), lane_room(1), lane_room(5)
    a[3] = np.nan
    assert arithmetic(address(a), address(b), address(out)) == (False, False)
    bad = np.isnan(out.reshape(5, LANES))
    assert list(np.nonzero(bad[0])[0]) == [3]
    assert out.reshape(5, LANES)[3, 3] == 1.0


def test_lanes_are_aligned_and_only_whole_arrays_have_an_address():
    assert address(lane_room(3)) % 64 == 0
    with pytest.raises(ValueError):
        address(np.zeros(8)[::2])
