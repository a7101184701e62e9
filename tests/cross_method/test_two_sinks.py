"""Two equal sinks at one place: together they are the single one, and apart they are more."""

import numpy as np
import pytest

import frahm

ONE, TWO = frahm.load_case("jacket-pipe"), frahm.load_case("two-sinks")


@pytest.fixture(scope="module")
def curves():
    return [frahm.frequency_response(case, detuning=(-0.4, 0.4)) for case in (ONE, TWO)]


def as_one(response):
    """Whether both sinks move alike, and how far apart they are at most over the first harmonic."""
    _, a, b = response.harmonics[1]
    return abs(a - b) < 1e-9 * abs(a)


@pytest.mark.parametrize("detuning", [-0.3, -0.1, 0.0, 0.07, 0.1083])
def test_sinks_that_move_alike_are_the_single_one(detuning):
    single = frahm.periodic_responses(ONE, detuning=detuning)
    both = [r for r in frahm.periodic_responses(TWO, detuning=detuning) if as_one(r)]
    assert len(both) == len(single)
    for a, b in zip(single, both, strict=True):
        assert (b.pipe_peak, b.relative_peak) == pytest.approx((a.pipe_peak, a.relative_peak), rel=1e-9)
        single_multipliers = a.multipliers[np.abs(a.multipliers) > 0.05]
        for value in single_multipliers:  # the other ones belong to disturbances that drive the sinks apart
            assert np.min(np.abs(b.multipliers - value)) < 1e-5
        assert a.stable or not b.stable


def test_the_motion_alike_can_lose_to_one_in_which_the_sinks_part(curves):
    _, both = curves
    parted = [r for r in frahm.periodic_responses(TWO, detuning=-0.1) if not as_one(r) and r.stable]
    assert parted  # searched, not proven complete: its mirror image may be missed
    response = parted[0]
    last = frahm.integrate(TWO, detuning=-0.1, periods=400, initial_state=response.state * (1 + 1e-4)).last(20)
    assert last.peaks().pipe == pytest.approx(response.pipe_peak, rel=1e-4)
    z = np.abs(last.x[:, 1:] - last.x[:, :1]).max(axis=0)
    assert z.max() > 1.2 * z.min()
    assert both.unverified == ()


def test_where_the_sinks_part_is_located(curves):
    single, both = curves
    first = [p for p in both.special_points if p.branch == 0]
    for point in single.special_points:
        near = min(first, key=lambda p: abs(p.frequency - point.frequency))
        assert near.kind == point.kind
        assert near.frequency == pytest.approx(point.frequency, rel=1e-8)
    births = [p for p in first if p.kind == "branch-point"]
    assert len(births) == len(first) - len(single.special_points) == 2
    for point in births:  # on either side the number of unstable multipliers of the motion alike differs by one
        counts = [
            sum(np.abs(r.multipliers) > 1 + 1e-9)
            for side in (-1e-4, 1e-4)
            for r in [min(
                (r for r in frahm.periodic_responses(TWO, frequency=point.frequency + side) if as_one(r)),
                key=lambda r: abs(r.pipe_peak - point.pipe_peak),
            )]
        ]  # fmt: skip
        assert abs(counts[0] - counts[1]) == 1
    assert [b.detached for b in both.branches].count(False) == 2  # the motion alike, and the one born from it
    assert "all first-harmonic solutions" in both.settings["inventory"]
    assert both.unverified == ()
