"""Evidence for the claims about motions, from the exact equations by integration."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from frahm.arrays import Floats
from frahm.published.yang2022 import Claim, Sink
from frahm.reproduction.claims_of_curves import unstable_range_beside
from frahm.reproduction.computations import Computations, State
from frahm.reproduction.curve_facts import detunings, falling, peak, unstable_range
from frahm.reproduction.judging import Beside, Evidence

_EXACT = "exact equations, integrated with error control"
_SLOW = "slow flow in the paper's form"
THREES: State = (3.0, 3.0, 3.0, 3.0)
_LAST = 300  # periods looked at once a motion has settled
_MUCH_LARGER = 2.0  # times: what "much" or "significantly" larger must at least mean
_NEAR = 0.02  # how near a stable response a settled motion must be, relative to it
_BAND = 0.1  # of the pipe's frequency: what counts as near it


def _from_rest(claim: Claim, computed: Computations) -> Evidence:
    peaks = computed.history(claim.sinks[0], _sigma(claim)).last(_LAST).peaks()
    slow = computed.equilibria(claim.sinks[0], _sigma(claim))[0]
    return Evidence(
        f"{_EXACT}, from rest",
        {"pipe": peaks.pipe, "relative": peaks.relative},
        beside=(Beside(f"pipe, {_SLOW}", slow.pipe, "m"), Beside(f"relative, {_SLOW}", slow.relative, "m")),
    )


def _upper_branch(claim: Claim, computed: Computations) -> Evidence:
    peaks = computed.history(claim.sinks[0], _sigma(claim), THREES).last(_LAST).peaks()
    slow = computed.equilibria(claim.sinks[0], _sigma(claim))[-1]
    return Evidence(
        f"{_EXACT}, from {THREES}",
        {"pipe": peaks.pipe, "relative": peaks.relative},
        beside=(Beside(f"pipe, {_SLOW}", slow.pipe, "m"), Beside(f"relative, {_SLOW}", slow.relative, "m")),
        remark="The relative amplitude exceeds that of the slow flow by its higher harmonics."
        if peaks.relative > slow.relative
        else "",
    )


def _initial_state(claim: Claim, computed: Computations) -> Evidence:
    (sink,), sigma = claim.sinks, _sigma(claim)
    history = computed.history(sink, sigma, THREES)
    last = history.last(_LAST).peaks()
    states = computed.on_branches(sink).at(sigma)
    upper = float(np.max(states.pipe_peak))
    return Evidence(
        f"{_EXACT}, from {THREES}; upper branch: the largest stable response at this detuning",
        statements={"the upper branch is reached": abs(last.pipe - upper) < _NEAR * upper},
        beside=(
            Beside("pipe, reached", last.pipe, "m"),
            Beside("pipe, largest stable response", upper, "m"),
            Beside("relative, largest on the way", history.peaks().relative, "m"),
        ),
    )


def _suppression(claim: Claim, computed: Computations) -> Evidence:
    (sink,), sigma = claim.sinks, _sigma(claim)
    bare = computed.bare_amplitude(sink)
    motion = computed.history(sink, sigma).last(_LAST).peaks().pipe
    equilibrium = computed.equilibria(sink, sigma)[0].pipe
    return Evidence(
        f"{_EXACT}, from rest, largest displacement, over F / (xi1 omega)",
        {"ratio": motion / bare},
        beside=(
            Beside("pipe, modulated from rest", motion, "m"),
            Beside("pipe without a sink", bare, "m"),
            Beside(f"ratio at the equilibrium, {_SLOW}", equilibrium / bare, "-"),
        ),
    )


def _more_damped(claim: Claim, computed: Computations) -> Evidence:
    (sink,) = claim.sinks
    curve = computed.curve(sink)
    low, high = unstable_range(curve)
    motion = max(computed.from_rest(sink).largest_pipe(), computed.on_branches(sink).largest_pipe())
    left = detunings(curve, "left", "saddle-node")
    return Evidence(
        f"{_SLOW} for the ranges; {_EXACT}, from rest and from every stable equilibrium, for the pipe",
        {"unstable from": low, "unstable to": high, "pipe, at most": motion},
        {"no saddle-node left of resonance": not left},
        (
            Beside(f"largest pipe amplitude, {_SLOW}", peak(curve)[0], "m"),
            *unstable_range_beside(computed, sink),
            Beside(
                "largest periodic response of the pipe, exact equations", computed.exact_curve(sink).largest()[0], "m"
            ),
        ),
    )


def _beating(claim: Claim, computed: Computations) -> Evidence:
    (sink,), sigma = claim.sinks, _sigma(claim)
    last = computed.history(sink, sigma).last(_LAST)
    motions = computed.from_rest(sink).at(sigma)
    least, largest, relative = (
        float(v[0]) for v in (motions.pipe_least_peak, motions.pipe_peak, motions.relative_peak)
    )
    spectrum = last.spectrum()
    frequency, pipe = spectrum["frequency_hz"].values, spectrum["pipe_amplitude"].values
    dominant = float(frequency[np.argmax(pipe)])
    share = _share_near(frequency, pipe, claim.printed[0].value)
    slow = np.abs(computed.slow_motion(sink, sigma).X[-last.time.size :])
    return Evidence(
        f"{_EXACT}, from rest; much larger means at least {_MUCH_LARGER:g} times",
        {"dominant frequency": dominant},
        {
            "the motion beats": bool(motions.modulated[0]),
            "the relative motion is much larger than the pipe's": relative > _MUCH_LARGER * largest,
        },
        (
            Beside("pipe, smallest peak of a period", least, "m"),
            Beside("pipe, largest", largest, "m"),
            Beside("relative, largest", relative, "m"),
            Beside(f"pipe, largest amplitude, {_SLOW}", float(np.max(slow)), "m"),
            Beside("share of the pipe's spectral energy within 10 % of its frequency", share, "-"),
        ),
    )


def _stiffness_trend(claim: Claim, computed: Computations) -> Evidence:
    largest = [computed.from_rest(sink).largest_pipe() for sink in claim.sinks]
    branches = [computed.on_branches(sink) for sink in claim.sinks]
    anywhere = [max(rest, motions.largest_pipe()) for rest, motions in zip(largest, branches, strict=True)]
    remark = ""
    if not falling(anywhere):
        i = int(np.argmax(branches[-1].pipe_peak))
        remark = (
            f"From rest it holds. It does not hold for every stable motion: at kappa {claim.sinks[-1].kappa:g} one of"
            f" {branches[-1].pipe_peak[i]:.4f} m exists at sigma {branches[-1].detuning[i]:.3f} rad/s."
        )
    return Evidence(
        f"{_EXACT}, from rest, largest displacement over all detunings",
        statements={"the stiffer the sink, the less the pipe moves": falling(largest)},
        beside=(
            *(Beside(f"pipe, {_named(s)}, from rest", v, "m") for s, v in zip(claim.sinks, largest, strict=True)),
            *(Beside(f"pipe, {_named(s)}, any start", v, "m") for s, v in zip(claim.sinks, anywhere, strict=True)),
        ),
        remark=remark,
    )


def _less_damped_resonance(claim: Claim, computed: Computations) -> Evidence:
    (sink,), sigma = claim.sinks, _sigma(claim)
    every = computed.equilibria(sink, sigma)
    rest, branches = computed.from_rest(sink), computed.on_branches(sink)
    return Evidence(
        f"{_SLOW} for the equilibria; {_EXACT}, from rest and from every stable equilibrium, for the pipe",
        {"pipe, at most": max(rest.largest_pipe(low=0.0), branches.largest_pipe(low=0.0))},
        {"one equilibrium": len(every) == 1, "it is unstable": not any(equilibrium.stable for equilibrium in every)},
        (
            Beside(f"pipe at the equilibrium, {_SLOW}", every[0].pipe, "m"),
            Beside("pipe, modulated from rest, largest", float(rest.at(sigma).pipe_peak[0]), "m"),
        ),
    )


def _share_near(frequency: Floats, amplitude: Floats, centre: float) -> float:
    near = np.abs(frequency - centre) <= _BAND * centre
    return float(np.sum(amplitude[near] ** 2) / np.sum(amplitude**2))


def _named(sink: Sink) -> str:
    return f"kappa {sink.kappa:g}"


def _sigma(claim: Claim) -> float:
    assert claim.detuning is not None
    return claim.detuning


MOTION_CLAIMS: dict[int, Callable[[Claim, Computations], Evidence]] = {
    8: _from_rest,
    9: _upper_branch,
    10: _initial_state,
    11: _suppression,
    14: _more_damped,
    16: _beating,
    17: _stiffness_trend,
    18: _less_damped_resonance,
}
