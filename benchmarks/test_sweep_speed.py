"""Studies: points a second into a store, and what a point costs beyond the bare call.

Closed forms are held against `slow_flow_map` on the same million numbers, exact responses against a loop over
`frequency_response` without any store, tasks or threads.
"""

from concurrent.futures import ThreadPoolExecutor

import numpy as np
import pytest

import frahm
from frahm.sweep.batch import evaluated

CASE = frahm.load_case("jacket-pipe")
KAPPA, XI2, SIGMA = np.geomspace(10, 1000, 50), np.linspace(0.004, 0.06, 20), np.linspace(-0.3, 0.3, 100)
CLOSED = frahm.load_study(
    {
        "case": "jacket-pipe",
        "axes": {"kappa": KAPPA.tolist(), "xi2": XI2.tolist(), "detuning": SIGMA.tolist()},
        "quantities": {"slow_flow": {}},
    }
)
EXACT = frahm.load_study(
    {
        "case": "jacket-pipe",
        "axes": {"kappa": KAPPA[::5].tolist(), "xi2": XI2[::4].tolist()},
        "quantities": {"response": {"detuning": [-0.3, 0.3]}},
    }
)


def fresh(tmp_path_factory):
    """A store that is not there yet, for every round."""
    return ((), {"path": tmp_path_factory.mktemp("sweep") / "s"})


def per_point(benchmark, size):
    benchmark.extra_info["microseconds a point"] = 1e6 * benchmark.stats.stats.min / size


def test_closed_forms_into_a_store(benchmark, tmp_path_factory):
    """100,000 points."""
    benchmark.pedantic(lambda path: frahm.sweep(CLOSED, store=path), setup=lambda: fresh(tmp_path_factory), rounds=3)
    per_point(benchmark, CLOSED.size)


def test_closed_forms_bare(benchmark):
    """The same points as one map."""
    arrays = {"detuning": SIGMA, "kappa": KAPPA[:, None, None], "xi2": XI2[:, None]}
    benchmark.pedantic(lambda: frahm.slow_flow_map(CASE, **arrays), rounds=3, warmup_rounds=1)
    per_point(benchmark, CLOSED.size)


def test_exact_responses_into_a_store(benchmark, tmp_path_factory):
    """50 points."""
    benchmark.pedantic(
        lambda path: frahm.sweep(EXACT, store=path), setup=lambda: fresh(tmp_path_factory), rounds=3, warmup_rounds=1
    )
    per_point(benchmark, EXACT.size)


def test_exact_responses_bare(benchmark):
    """The same points in a loop."""

    def loop():
        for index in range(EXACT.size):
            frahm.frequency_response(EXACT.case_at(index), detuning=(-0.3, 0.3))

    benchmark.pedantic(loop, rounds=3, warmup_rounds=1)
    per_point(benchmark, EXACT.size)


@pytest.mark.parametrize("workers", [1, 2])
def test_exact_responses_in_threads(benchmark, workers):
    """The same points in tasks of five; with the wall clock the gain of the second thread can be seen."""
    parts = np.array_split(np.arange(EXACT.size), 10)
    with ThreadPoolExecutor(workers) as threads:
        benchmark.pedantic(
            lambda: list(threads.map(lambda part: evaluated(EXACT.text, frahm.__version__, part), parts)),
            rounds=3, warmup_rounds=1,
        )  # fmt: skip
    per_point(benchmark, EXACT.size)
