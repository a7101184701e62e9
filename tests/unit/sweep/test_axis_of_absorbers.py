"""The axis `count`: equal absorbers in place of one."""

import numpy as np
import pytest

import frahm

ASKED = {"case": "jacket-pipe", "quantities": {"response": {"detuning": [-0.1, 0.1]}}}


def test_equal_parts_have_the_peaks_of_the_one_they_take_the_place_of(tmp_path):
    found = frahm.sweep(ASKED | {"axes": {"count": [1, 2], "kappa": [24.425]}}, store=tmp_path / "s.zarr")
    alone, parts = found.response_pipe_peak.values[:, 0]
    assert parts == pytest.approx(
        alone, rel=1e-4
    )  # this sink is too soft to break the symmetry; both peaks lie between points
    assert np.all(found.status.values == 1)


def test_a_split_absorber_keeps_its_sums():
    case = frahm.load_case("jacket-pipe")
    split = case.with_equal_parts(3)
    assert [absorber.name for absorber in split.absorbers] == ["sink", "sink 2", "sink 3"]
    for field in ("stiffness", "damping"):
        assert sum(getattr(one.law, field) for one in split.absorbers) == pytest.approx(
            getattr(case.absorbers[0].law, field)
        )
    assert case.with_equal_parts(1) == case
    with pytest.raises(frahm.ParameterError, match="count"):
        case.with_equal_parts(0)


@pytest.mark.parametrize(
    ("values", "where"), [([1, 2.5], "axes.count[1]"), ([0, 2], "axes.count[0]"), ([7], "axes.count[0]")]
)
def test_a_number_of_absorbers_is_whole(values, where):
    with pytest.raises(frahm.ParameterError) as told:
        frahm.load_study(ASKED | {"axes": {"count": values}})
    assert where in str(told.value)
