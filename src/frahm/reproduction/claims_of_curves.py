"""Evidence for the claims about response curves: peaks, ranges with several or with unstable responses."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from frahm.published.yang2022 import CLAIMS, READ_OFF, Claim, Sink
from frahm.reproduction.computations import Computations
from frahm.reproduction.curve_facts import (
    detunings,
    falling,
    peak,
    relative_peak,
    several_responses,
    unstable_range,
    unstable_ranges,
)
from frahm.reproduction.judging import Beside, Evidence

_SLOW = "slow flow in the paper's form, every branch in closed form, special points located"
_AVERAGED = "slow flow with the exact frequency"
_EXACT = "exact equations"
_BALANCE = "exact equations by harmonic balance"


def _shedding(claim: Claim, computed: Computations) -> Evidence:
    return Evidence("St U / D", {"shedding frequency": computed.shedding_hz})


def _soft_peak(claim: Claim, computed: Computations) -> Evidence:
    (sink,) = claim.sinks
    curve, rest = computed.curve(sink), computed.from_rest(sink)
    largest, sigma = peak(curve)
    return Evidence(
        _SLOW,
        {"pipe": largest, "relative": relative_peak(curve)},
        {
            "one response at every detuning": not detunings(curve, "left", "saddle-node")
            and not detunings(curve, "right", "saddle-node"),
            "it is stable everywhere": bool(np.all(curve.stable)),
        },
        (
            Beside("detuning of the peak", sigma, "rad/s"),
            Beside(f"pipe, {_EXACT} from rest", rest.largest_pipe(), "m"),
            Beside(f"relative, {_EXACT} from rest", float(np.max(rest.relative_peak)), "m"),
        ),
    )


def _middle_unstable(claim: Claim, computed: Computations) -> Evidence:
    (sink,) = claim.sinks
    low, high = unstable_range(computed.curve(sink))
    rest_low, _ = computed.from_rest(sink).modulated_range
    remark = _motion_remark(claim, computed)
    exact_low, _ = unstable_range(computed.exact_curve(sink))
    if rest_low < exact_low:
        remark += f" Between {rest_low:.3f} and {exact_low:.4f} rad/s a stable periodic response exists beside it."
    return Evidence(
        _SLOW,
        {"unstable from": low, "unstable to": high},
        beside=_ranges_beside(computed, sink),
        remark=remark,
    )


def _peak_ratio(claim: Claim, computed: Computations) -> Evidence:
    soft, middle = claim.sinks
    (printed,) = claim.printed
    lower = peak(computed.curve(middle))[0]
    ratio = peak(computed.curve(soft))[0] / lower
    exact = computed.from_rest(soft).largest_pipe() / computed.from_rest(middle).largest_pipe()
    printed_peak = next(value.value for other in CLAIMS if other.sinks == (soft,) for value in other.printed)
    remark = f"The difference is {100 * abs(ratio / printed.value - 1):.1f} %."
    if printed.tolerance.allows(printed.value, printed_peak / lower):
        remark += (
            f" The amplitude printed for the pipe at kappa {soft.kappa:g}, {printed_peak:g} m, gives"
            f" {printed_peak / lower:.3f} and would agree."
        )
    return Evidence(
        _SLOW, {printed.name: ratio}, beside=(Beside(f"peak ratio, {_EXACT} from rest", exact, "-"),), remark=remark
    )


def _left_range(claim: Claim, computed: Computations) -> Evidence:
    (sink,) = claim.sinks
    low, high = several_responses(computed.curve(sink), "left")
    return Evidence(
        _SLOW,
        {"several responses from": low, "several responses to": high},
        beside=_several_beside(computed, sink),
        remark=_exactly("several responses exist", several_responses(computed.exact_curve(sink), "left")),
    )


def _stiff_unstable(claim: Claim, computed: Computations) -> Evidence:
    (sink,) = claim.sinks
    low, high = unstable_range(computed.curve(sink))
    return Evidence(
        _SLOW,
        {"unstable from": low, "unstable to": high},
        beside=_ranges_beside(computed, sink),
        remark=_motion_remark(claim, computed),
    )


def _motion_remark(claim: Claim, computed: Computations) -> str:
    """Whether a range printed for a sink is the one in which its motion is modulated."""
    low, high = computed.from_rest(claim.sinks[0]).modulated_range
    pairs = zip(claim.printed, (low, high), strict=True)
    verb = "agrees" if all(value.tolerance.allows(value.value, end) for value, end in pairs) else "does not agree"
    return (
        f"From rest the exact motion is modulated for sigma from {low:.3f} to {high:.3f} rad/s: taken as a statement"
        f" about the motion, not about stability, the printed range {verb}."
    )


def _right_saddle_node(claim: Claim, computed: Computations) -> Evidence:
    (sink,) = claim.sinks
    rest_high = computed.from_rest(sink).modulated_range[1]
    return Evidence(
        _SLOW,
        {"saddle-node": detunings(computed.curve(sink), "right", "saddle-node")[0]},
        beside=(
            Beside(
                f"saddle-node, {_AVERAGED}",
                detunings(computed.curve(sink, "averaged"), "right", "saddle-node")[0],
                "rad/s",
            ),
            Beside(
                f"saddle-node, {_BALANCE}", detunings(computed.exact_curve(sink), "right", "saddle-node")[0], "rad/s"
            ),
            Beside(f"{_EXACT} from rest modulated up to", rest_high, "rad/s"),
        ),
        remark=f"From rest the exact motion stays modulated up to {rest_high:.3f} rad/s.",
    )


def _less_damped_left(claim: Claim, computed: Computations) -> Evidence:
    (sink,) = claim.sinks
    low, high = several_responses(computed.curve(sink), "left")
    largest, sigma = peak(computed.curve(sink))
    return Evidence(
        _SLOW,
        {"several responses from": low, "several responses to": high, "pipe": largest, "detuning of the peak": sigma},
        beside=(
            *_several_beside(computed, sink),
            Beside(f"pipe, {_BALANCE}", computed.exact_curve(sink).largest()[0], "m"),
            Beside(f"pipe, {_EXACT} on the grid of detunings", computed.on_branches(sink).largest_pipe(), "m"),
        ),
    )


def _less_damped_right(claim: Claim, computed: Computations) -> Evidence:
    (sink,) = claim.sinks
    found = detunings(computed.curve(sink), "right")
    averaged, exact = (detunings(c, "right") for c in (computed.curve(sink, "averaged"), computed.exact_curve(sink)))
    return Evidence(
        _SLOW,
        {"special points from": found[0], "special points to": found[-1]},
        beside=(
            *_range_beside("special points", (averaged[0], averaged[-1])),
            *_range_beside("special points", (exact[0], exact[-1]), _BALANCE),
        ),
    )


def _damping_trend(claim: Claim, computed: Computations) -> Evidence:
    stiff, soft = claim.sinks[:3], claim.sinks[3:]
    ranges = [unstable_range(computed.curve(sink)) for sink in stiff]
    widths = [high - low for low, high in ranges]
    peaks = [peak(computed.curve(sink))[0] for sink in soft]
    narrow = {sink: sum(high - low for low, high in unstable_ranges(computed.curve(sink))) for sink in soft}
    seen = READ_OFF.absolute
    exceptions = ", ".join(f"{width:.1e} rad/s at xi2 {sink.xi2:g}" for sink, width in narrow.items() if width > 0)
    return Evidence(
        f"{_SLOW}; an unstable range narrower than {seen:g} rad/s counts as not visible",
        statements={
            "the unstable range shrinks at kappa 367.38": falling(widths),
            "the peak falls at kappa 24.425": falling(peaks),
            "the response is stable at kappa 24.425": all(width < seen for width in narrow.values()),
        },
        beside=(
            *(Beside(f"unstable range, {_named(s)}", w, "rad/s") for s, w in zip(stiff, widths, strict=True)),
            *(Beside(f"pipe peak, {_named(s)}", p, "m") for s, p in zip(soft, peaks, strict=True)),
            *(Beside(f"unstable range, {_named(s)}", w, "rad/s") for s, w in narrow.items()),
        ),
        remark=f"Strictly, at kappa 24.425 a response is unstable over {exceptions}." if exceptions else "",
    )


def _right_range(claim: Claim, computed: Computations) -> Evidence:
    more, less = claim.sinks
    widths = {}
    for sink in (more, less):
        low, high = several_responses(computed.curve(sink), "right")
        widths[sink] = high - low
    return Evidence(
        _SLOW,
        statements={"the range is smaller": widths[more] < widths[less]},
        beside=tuple(Beside(f"range, {_named(s)}", w, "rad/s") for s, w in widths.items()),
    )


def _named(sink: Sink) -> str:
    return f"kappa {sink.kappa:g}, xi2 {sink.xi2:g}"


def _range_beside(name: str, bounds: tuple[float, float], method: str = _AVERAGED) -> tuple[Beside, ...]:
    ends = zip(("from", "to"), bounds, strict=True)
    return tuple(Beside(f"{name} {end}, {method}", value, "rad/s") for end, value in ends)


def _several_beside(computed: Computations, sink: Sink) -> tuple[Beside, ...]:
    """Range left of resonance with several responses, by the averaged form and exactly."""
    return (
        *_range_beside("several responses", several_responses(computed.curve(sink, "averaged"), "left")),
        *_range_beside("several responses", several_responses(computed.exact_curve(sink), "left"), _BALANCE),
    )


def _ranges_beside(computed: Computations, sink: Sink) -> tuple[Beside, ...]:
    """Range with unstable responses by the averaged form and exactly, and the range with modulated motion."""
    return (
        *_range_beside("unstable", unstable_range(computed.curve(sink, "averaged"))),
        *unstable_range_beside(computed, sink),
        *_modulated_range(computed, sink),
    )


def unstable_range_beside(computed: Computations, sink: Sink) -> tuple[Beside, ...]:
    """Range with unstable responses of the exact equations: between Neimark-Sacker points and saddle-nodes."""
    return _range_beside("unstable", unstable_range(computed.exact_curve(sink)), _BALANCE)


def _exactly(what: str, bounds: tuple[float, float]) -> str:
    return f"Exactly {what} from {bounds[0]:.4f} to {bounds[1]:.4f} rad/s."


def _modulated_range(computed: Computations, sink: Sink) -> tuple[Beside, ...]:
    return _range_beside("modulated", computed.from_rest(sink).modulated_range, f"{_EXACT} from rest")


CURVE_CLAIMS: dict[int, Callable[[Claim, Computations], Evidence]] = {
    1: _shedding,
    2: _soft_peak,
    3: _middle_unstable,
    4: _peak_ratio,
    5: _left_range,
    6: _stiff_unstable,
    7: _right_saddle_node,
    12: _less_damped_left,
    13: _less_damped_right,
    15: _damping_trend,
    19: _right_range,
}
