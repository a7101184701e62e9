"""The verb: what is in a store, which executor or batch size made it, and what stops it."""

import inspect
import json
import threading
import warnings
from concurrent.futures import Executor, Future, ThreadPoolExecutor
from pathlib import Path

import numpy as np
import pytest
import xarray as xr

import frahm
from frahm.sweep import load_study, processes, summary_of
from frahm.sweep.batch import evaluated

AXES = {"kappa": {"from": 60, "to": 400, "count": 3, "spacing": "log"}, "xi2": [0.006, 0.02]}
QUANTITIES = {"slow_flow": {"detuning": 0.02}, "response": {"detuning": [-0.1, 0.1]},
              "attractors": {"detuning": 0.02, "samples": 4}}  # fmt: skip
STUDY = load_study({"name": "small", "case": "jacket-pipe", "axes": AXES, "quantities": QUANTITIES})
FAILING = {"case": "jacket-pipe", "axes": {"detuning": [-6.0, -5.0, 0.0, 0.1]}, "quantities": {"slow_flow": {}}}
CHEAP = load_study({"case": "jacket-pipe", "axes": {"kappa": [50, 100, 200], "detuning": [-0.1, 0.0, 0.1, 0.2]},
                    "quantities": {"slow_flow": {}}})  # fmt: skip


class Inline(Executor):
    """Everything at once, in the order of the numbers a generator gives; some tasks fail as lost workers do."""

    def __init__(self, lose=()):
        self.lose, self.calls = list(lose), 0

    def submit(self, function, /, *arguments, **options):
        future, self.calls = Future(), self.calls + 1
        if self.calls in self.lose:
            future.set_exception(ConnectionError("the worker is gone"))
        else:
            future.set_result(function(*arguments, **options))
        return future


@pytest.fixture(scope="module")
def reference(tmp_path_factory):
    path = tmp_path_factory.mktemp("sweep") / "reference.zarr"
    frahm.sweep(STUDY, store=path, executor=Inline(), batch=1000)
    return path


def files_of(path):
    return {str(file.relative_to(path)): file.read_bytes() for file in sorted(Path(path).rglob("*")) if file.is_file()}


def test_the_store_opens_plainly_with_units_and_names_and_no_warning(reference):
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        data = xr.open_zarr(reference)
        data.load()
    assert dict(data.sizes) == {"kappa": 3, "xi2": 2, "root": 3}
    for name, variable in data.variables.items():
        assert variable.attrs["units"], name
        assert variable.attrs["long_name"], name
        assert variable.dtype.kind in "fi", name
    assert data.kappa.attrs["units"] == "1/(m^2 s^2)"
    assert data.response_pipe_peak.attrs["units"] == "m"
    assert "0 pending" in data.status.attrs["codes"]
    assert "quasi-periodic" in data.attractors_kind.attrs["codes"]
    assert np.all(data.status == 1)
    assert np.all(data.reason == 0)


def test_the_store_says_how_to_make_it_again(reference):
    attributes = xr.open_zarr(reference).attrs
    assert load_study(json.loads(attributes["study"])) == STUDY
    assert attributes["frahm_version"] == frahm.__version__


@pytest.mark.parametrize("ending", ["nc", "mat", "json", "csv"])
def test_a_store_goes_out_and_comes_back_like_other_results(reference, tmp_path, ending):
    data = frahm.sweep.opened(reference).load()
    frahm.write_data(data, tmp_path / f"sweep.{ending}")
    again = frahm.read_data(tmp_path / f"sweep.{ending}")
    xr.testing.assert_equal(again, data)
    assert again.attrs == data.attrs


@pytest.mark.parametrize(("workers", "batch"), [(1, 5), (3, 1), (2, None)])
def test_threads_and_batches_leave_the_very_same_files(reference, tmp_path, workers, batch):
    with ThreadPoolExecutor(workers) as threads:
        frahm.sweep(STUDY, store=tmp_path / "s", executor=threads, batch=batch)
    assert files_of(tmp_path / "s") == files_of(reference)


def test_processes_leave_the_same_store(reference, tmp_path):
    """To the last digits: a process that compiled the kernels rounds otherwise than one that found them compiled."""
    with processes(1) as executor:
        frahm.sweep(STUDY, store=tmp_path / "s", executor=executor, batch=2)
    assert files_of(tmp_path / "s").keys() == files_of(reference).keys()
    here, there = xr.open_zarr(tmp_path / "s").load(), xr.open_zarr(reference).load()
    xr.testing.assert_allclose(here, there, rtol=1e-6, atol=1e-9)
    assert here.attrs == there.attrs


def test_the_default_is_threads(reference, tmp_path):
    frahm.sweep(STUDY, store=tmp_path / "s")
    assert files_of(tmp_path / "s") == files_of(reference)
    assert not [thread for thread in threading.enumerate() if thread.name.startswith("frahm-sweep")]


def test_the_room_is_called_like_its_verb(tmp_path):
    import frahm.sweep as room

    assert room is frahm.sweep is frahm.__getattr__("sweep")  # imported before or on first use
    assert "executor" in inspect.signature(frahm.sweep).parameters
    assert room(CHEAP, store=tmp_path / "s").sizes["detuning"] == 4


def test_progress_is_told_as_it_comes(tmp_path):
    said = []
    frahm.sweep(CHEAP, store=tmp_path / "s", executor=Inline(), batch=5, progress=lambda *what: said.append(what))
    assert said[0] == ("points of study", 0, 12)
    assert said[-1] == ("points of study", 12, 12)


def test_a_failed_point_keeps_its_reason_and_the_others_go_on(tmp_path):
    with pytest.warns(frahm.SweepWarning) as caught:
        data = frahm.sweep(FAILING, store=tmp_path / "s")
    assert len(caught) == 1
    message = str(caught[0].message)
    assert message.startswith("4 points: 2 verified, 2 failed. 2 failed, first at detuning -6 rad/s: slow_flow: ")
    assert "given -6.0; allowed: " in message
    assert data.status.values.tolist() == [3, 3, 1, 1]
    assert data.reason.values.tolist() == [1, 1, 0, 0]
    assert list(json.loads(data.attrs["reasons"])) == ["1"]
    assert np.isnan(data.slow_flow_pipe_peak.values).tolist() == [True, True, False, False]
    assert data.slow_flow_equilibria.values.tolist()[:2] == [-1, -1]


def test_an_unforeseen_error_is_one_of_its_point_and_quantity(tmp_path, monkeypatch):
    from frahm.sweep import quantities

    whole = quantities.periodic_responses

    def breaks(system, **options):
        if options["detuning"] == 0.1:
            raise ZeroDivisionError("division by\nzero")
        return whole(system, **options)

    monkeypatch.setattr(quantities, "periodic_responses", breaks)
    study = {"case": "jacket-pipe", "axes": {"detuning": [0.0, 0.1]}, "quantities": {"response": {}, "slow_flow": {}}}
    with pytest.warns(frahm.SweepWarning, match="1 failed, at detuning 0.1 rad/s: response: ZeroDivisionError: div"):
        data = frahm.sweep(study, store=tmp_path / "s")
    assert data.status.values.tolist() == [1, 3]
    assert np.all(data.slow_flow_pipe_peak.values > 0)
    assert data.response_responses.values[1] == -1


def test_what_is_unverified_is_named_once_for_all_alike(tmp_path, monkeypatch):
    import dataclasses

    from frahm.sweep import quantities

    whole = quantities.frequency_response

    def doubtful(system, **options):
        curve = whole(system, **options)
        doubts = tuple(f"Branch {i} stops near {curve.frequency[i]:.6g} rad/s." for i in range(3))
        return dataclasses.replace(curve, unverified=doubts)

    monkeypatch.setattr(quantities, "frequency_response", doubtful)
    study = {"case": "jacket-pipe", "axes": {"kappa": [50, 100]}, "quantities": {"slow_flow": {}}}
    with pytest.warns(frahm.SweepWarning) as caught:
        data = frahm.sweep(study, store=tmp_path / "s")
    assert len(caught) == 1
    assert "2 unverified, first at kappa 50 1/(m^2 s^2): slow_flow: Branch 0 stops" in str(caught[0].message)
    assert "And 2 like it." in str(caught[0].message)
    assert data.status.values.tolist() == [2, 2]
    assert data.slow_flow_verified.values.tolist() == [0, 0]
    summary = summary_of(tmp_path / "s")
    assert (summary.unverified, summary.good) == (2, False)
    assert not summary.extremes[0].best_verified


def test_a_lost_task_is_tried_again(tmp_path):
    executor = Inline(lose=[2])
    data = frahm.sweep(CHEAP, store=tmp_path / "s", executor=executor, batch=3)
    assert executor.calls == 5
    assert np.all(data.status == 1)


def test_points_of_workers_that_are_gone_wait_for_another_time(tmp_path):
    lost = Inline(lose=range(2, 100))
    with pytest.warns(frahm.SweepWarning, match="9 points could not be computed: ConnectionError: the worker is gone"):
        data = frahm.sweep(CHEAP, store=tmp_path / "s", executor=lost, batch=3)
    assert data.status.values.ravel().tolist() == [1] * 3 + [0] * 9
    again = frahm.sweep(CHEAP, store=tmp_path / "s", executor=Inline(), resume=True)
    whole = frahm.sweep(CHEAP, store=tmp_path / "t", executor=Inline())
    xr.testing.assert_identical(again.load(), whole.load())


def test_workers_of_another_version_are_refused(tmp_path):
    class Older(Inline):
        def submit(self, function, text, version, *arguments):
            return super().submit(lambda: evaluated(text, "0.0.1", *arguments))

    class Failing(Older):
        def submit(self, *arguments):
            try:
                return super().submit(*arguments)
            except RuntimeError as error:
                future = Future()
                future.set_exception(error)
                return future

    with pytest.raises(frahm.ParameterError, match=f"executor: .*workers with frahm {frahm.__version__}"):
        frahm.sweep(CHEAP, store=tmp_path / "s", executor=Failing())


def test_an_interruption_keeps_what_is_finished(tmp_path):
    class Interrupted(Inline):
        def submit(self, *arguments):
            if self.calls == 2:
                raise KeyboardInterrupt
            return super().submit(*arguments)

    with pytest.raises(KeyboardInterrupt):
        frahm.sweep(CHEAP, store=tmp_path / "s", executor=Interrupted(), batch=3)
    assert np.count_nonzero(xr.open_zarr(tmp_path / "s").status == 1) == 6
    resumed = frahm.sweep(CHEAP, store=tmp_path / "s", resume=True)
    frahm.sweep(CHEAP, store=tmp_path / "t", executor=Inline())
    assert np.all(resumed.status == 1)
    assert files_of(tmp_path / "s") == files_of(tmp_path / "t")


def test_a_look_leaves_alone_what_a_writer_is_at_and_resumption_cleans_up(tmp_path):
    frahm.sweep(CHEAP, store=tmp_path / "s", executor=Inline())
    before = files_of(tmp_path / "s")
    half = tmp_path / "s" / "status" / "c" / "0.0123456789abcdef.partial"
    half.write_bytes(b"half")
    assert summary_of(tmp_path / "s").good
    assert half.exists()
    frahm.sweep(CHEAP, store=tmp_path / "s", resume=True)
    assert files_of(tmp_path / "s") == before


def test_reasons_are_the_same_after_an_interruption_in_another_order(tmp_path):
    axes = {"detuning": [0.0, -6.0, 0.1, -5.5, -5.0], "kappa": [50.0]}
    study = {"case": "jacket-pipe", "axes": axes, "quantities": {"slow_flow": {}, "response": {}}}

    class Backwards(Inline):
        def submit(self, function, text, version, indices):
            if self.calls == 3:
                raise KeyboardInterrupt
            return super().submit(function, text, version, [4 - index for index in indices])

    with pytest.raises(KeyboardInterrupt):
        frahm.sweep(study, store=tmp_path / "s", executor=Backwards(), batch=1)
    with pytest.warns(frahm.SweepWarning):
        frahm.sweep(study, store=tmp_path / "s", resume=True)
    with pytest.warns(frahm.SweepWarning):
        frahm.sweep(study, store=tmp_path / "t", executor=Inline())
    assert files_of(tmp_path / "s") == files_of(tmp_path / "t")
