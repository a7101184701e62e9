"""What speaks against the worst motion of a range: its place at an end, a larger one beside it, what did not settle."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence

import numpy as np

from frahm.attractors.attractor import Attractor, AttractorSet
from frahm.errors import Outcome
from frahm.loads import OperatingRange
from frahm.response import ResponseCurve
from frahm.tolerances import AS_LARGE

_ENDS = ("lower", "upper")

Place = tuple[float, float]  # Omega [rad/s] and the pipe peak of a motion there [m]


def doubts_of(
    within: OperatingRange, wide: OperatingRange, curve: ResponseCurve, surveys: Mapping[float, AttractorSet],
    worst: tuple[float, Attractor], min_basin: float, beyond: Sequence[Place], fine: float,
) -> tuple[list[str], dict[str, float]]:  # fmt: skip
    """What speaks against the worst; and of that what lies at or beyond an end, with the largest motion there [m].

    Parameters
    ----------
    within, wide : OperatingRange
        What was asked about, and the same widened, over which `curve` is.
    curve : ResponseCurve
    surveys : mapping of float to AttractorSet
        Motions at the frequencies looked at.
    worst : float and Attractor
        The worst, and where it is.
    min_basin : float
    beyond : sequence
        Motions searched beyond the range, by place.
    fine : float
        How near an end the worst counts as sitting at it, of its frequency.
    """
    W, attractor = worst
    doubts = [*within.doubts, *curve.unverified]
    if any(survey.outcome is Outcome.INTERRUPTED for survey in surveys.values()):
        doubts.append(Outcome.INTERRUPTED.value)
    for at in sorted(surveys):
        doubts += surveys[at].unsettled(min_basin, f" at Omega = {at:.6g} rad/s")
    stable = curve.stable_or_limit & np.isfinite(curve.pipe_peak)
    met = [*beyond, *zip(curve.frequency[stable].tolist(), curve.pipe_peak[stable].tolist(), strict=True)]
    ends: dict[str, float] = {}
    for end in range(2):
        ends |= _at_an_end(end, within, wide, (W, attractor.pipe_peak), met, fine)
    inside = stable & (curve.frequency >= within.frequency[0]) & (curve.frequency <= within.frequency[1])
    return list(dict.fromkeys([*doubts, *ends, *_rarely_reached(curve, inside, wide, attractor, min_basin)])), ends


def _at_an_end(
    end: int, within: OperatingRange, wide: OperatingRange, worst: Place, met: Sequence[Place], fine: float
) -> dict[str, float]:
    """The worst at an end of the range, and what is larger beyond it [m]: one cause, one sentence."""
    edge, sign = within.frequency[end], (-1, 1)[end]
    W, peak = worst
    beyond = [place for place in met if sign * (place[0] - edge) > 0]
    where, larger = max(beyond, key=lambda place: place[1], default=(edge, 0.0))
    is_larger = larger > AS_LARGE * peak
    sits = abs(W - edge) <= fine * W and not within.closed(end)
    text = f"at {wide.place(where)}, a motion of {larger:.4g} m is larger"
    if not sits:
        return {f"Beyond the range, {text} than the worst inside.": larger} if is_larger else {}
    start = f"The worst motion sits at the {_ENDS[end]} end of the range, {within.place(edge)}"
    if is_larger:
        return {f"{start}, and beyond it, {text}.": larger}
    return {f"{start}: beyond it may be larger.": math.inf}


def _rarely_reached(
    curve: ResponseCurve, inside: np.ndarray, wide: OperatingRange, worst: Attractor, min_basin: float
) -> list[str]:
    """A stable response inside that is larger than every attractor that counts."""
    if not np.any(inside):
        return []
    at_most = int(np.argmax(np.where(inside, curve.pipe_peak, -1.0)))
    peak = float(curve.pipe_peak[at_most])
    if not peak > AS_LARGE * worst.pipe_peak:
        return []
    return [
        f"A stable response of {peak:.4g} m at {wide.place(float(curve.frequency[at_most]))} is larger; "
        f"less than {100 * min_basin:.3g} % of the sampled states end on it."
    ]


def frequencies_beyond(curve: ResponseCurve, lo: float, hi: float) -> list[float]:
    """Frequencies beyond a range at which a larger motion is most likely: largest responses, stable and unstable."""
    found = []
    for side in (curve.frequency < lo, curve.frequency > hi):
        for state in (curve.stable, ~curve.stable):
            here = np.flatnonzero(side & state & np.isfinite(curve.pipe_peak))
            if here.size:
                found.append(float(curve.frequency[here[np.argmax(curve.pipe_peak[here])]]))
    return sorted(set(found))
