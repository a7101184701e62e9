"""Elastic pipes: CPU time of complete responses, warm.

Goals: 20 modes with one sink within 50 ms, with two sinks within 500 ms.
"""

import pytest

import frahm

ELASTIC = frahm.load_case("jacket-pipe-elastic").with_pipe(mode_count=20)


def with_two_sinks():
    data = ELASTIC.with_pipe(lift="mode-shape").to_dict()
    (sink,) = data["absorbers"]
    law = sink["law"] | {"stiffness": sink["law"]["stiffness"] / 2, "damping": sink["law"]["damping"] / 2}
    half = sink | {"mass": sink["mass"] / 2, "law": law}
    return frahm.load_case(data | {"absorbers": [half, half | {"name": "second", "position": 25.0}]})


@pytest.mark.parametrize("lift", ["mode-shape", "uniform"])
def test_twenty_modes_with_one_sink(benchmark, lift):
    system = frahm.build_system(ELASTIC.with_pipe(lift=lift))
    curve = benchmark.pedantic(
        lambda: frahm.frequency_response(system, detuning=(-0.4, 0.4)), rounds=5, warmup_rounds=1
    )
    assert curve.unverified == ()


def test_twenty_modes_with_two_sinks(benchmark):
    system = frahm.build_system(with_two_sinks())
    curve = benchmark.pedantic(
        lambda: frahm.frequency_response(system, detuning=(-0.4, 0.4)), rounds=3, warmup_rounds=1
    )
    benchmark.extra_info["branches"] = len(curve.branches)
    assert len(curve.branches) >= 1


def test_modes_of_a_tube(benchmark):
    tube = ELASTIC.pipe
    benchmark.pedantic(lambda: frahm.beam_modes.__wrapped__(tube.beam(), 20), rounds=5, warmup_rounds=1)
