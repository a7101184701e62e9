"""Step `motions`: the exact equations integrated from rest at the detunings that matter."""

from __future__ import annotations

import dataclasses
import math
from collections.abc import Iterable
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np

from frahm import readable
from frahm.analysis.linear import bare_amplitude
from frahm.analysis.points import DESIGN_WIND, PointOfInterest, points_of_interest
from frahm.analysis.ranges import growth_rates_at
from frahm.analysis.section import FAIL, PASS, UNVERIFIED, Check, Section, Work
from frahm.analysis.settling import KINDS, envelope_of, judge
from frahm.analysis.tended import Lasting, lasting
from frahm.arrays import Floats, labelled
from frahm.errors import Outcome
from frahm.harmonic_balance import is_linear
from frahm.systems import System
from frahm.time_integration import TimeHistory, integrate, integrate_batch
from frahm.time_integration.signals import sliding_amplitude

if TYPE_CHECKING:
    import xarray as xr

SAMPLES_PER_PERIOD = 32
SLOW_SAMPLES = 8  # per period, of the slowly varying amplitudes
_MOST_KEPT = 4000  # periods
_MOST_POINTS = 12
_TAIL = 0.25  # of the run
_HARMONICS_SHOWN = 5.5
_GROWN = 12.0  # exponent of a disturbance that has grown from rounding to something that shows


@dataclass(frozen=True)
class Motion:
    """One integrated motion and what its tail shows.

    Attributes
    ----------
    point : PointOfInterest
        Where and why.
    history, tail : TimeHistory
        What was kept of the run, and the last quarter of it.
    start : float
        Time of the first sample kept [s].
    kind : str
        "periodic", "modulated", "chaotic" or "unsettled": that of the lasting motion it tends to, where that is known.
    multiple : int
        Periods after which it repeats; 0 if it does not, or if nobody knows.
    settled : bool
        Whether the tail itself shows the lasting motion.
    sizes : dict
        Peaks, rms and envelope [m]: of the tail, or of the motion it tends to where the tail is a transient.
    spread : float
        Spread of the Poincare section, see `frahm.analysis.settling.section_spread`.
    bare : float
        Amplitude without absorbers at the same frequency [m].
    """

    point: PointOfInterest
    history: TimeHistory
    tail: TimeHistory
    start: float
    kind: str
    multiple: int
    settled: bool
    sizes: dict[str, Any]
    spread: float
    bare: float


def motions(work: Work) -> Section:
    """Motions from rest at every point of interest."""
    points = points_of_interest(work)
    found = [_motion(work, point) for point in points[:_MOST_POINTS]]
    notes = tuple(_transient(motion, work.case.analysis.periods) for motion in found if not motion.settled)
    return Section(
        results={"motions": [_summary(motion) for motion in found]},
        data={"motions": _motions_dataset(found), "spectra": _spectra_dataset(found)},
        checks=(_finished(found), *_expected(work, found)),
        notes=(
            *notes,
            "These motions were integrated from rest: another start can lead to another motion.",
            *_left_out(points[_MOST_POINTS:]),
        ),
    )


def _transient(motion: Motion, periods: int) -> str:
    known = motion.kind != "unsettled"
    return (
        f"The motion from rest {motion.point.place} has not settled within {periods} periods: its figure ends in a"
        f" transient, which is no part of the answer{', and its numbers are of the motion it tends to' * known}."
    )


def _left_out(points: list[PointOfInterest]) -> Iterable[str]:
    if points:
        where = ", ".join(point.place for point in points)
        yield f"There are more places of interest than were integrated at; left out: {where}."


def _motion(work: Work, point: PointOfInterest) -> Motion:
    system = work.system if point.key == DESIGN_WIND else work.driven(work.system.reference_frequency + point.detuning)
    history, start = _followed(system, point.detuning, work.case.analysis.periods)
    tail = history.last(max(1, math.floor(_TAIL * history.periods)))
    judged, spread = judge(history)
    if judged == "modulated" and is_linear(system):  # what beats there is free motion that still dies out
        judged = "unsettled"
    known = lasting(work, point.key, history, judged) or Lasting(judged, int(judged == "periodic"), {})
    settled = "unsettled" not in (judged, known.kind)
    sizes = _sizes(history, tail) | ({} if settled else known.sizes)
    within = None if point.key == DESIGN_WIND else work.range  # the range may leave the design wind out
    bare = float(bare_amplitude(work.case, history.frequency, within)[0])
    return Motion(point, history, tail, start, known.kind, known.multiple, settled, sizes, spread, bare)


def _followed(system: System, detuning: float, periods: int) -> tuple[TimeHistory, float]:
    """The run from rest; of a very long one the end only, and the time it begins at [s]; the start if it failed."""
    skipped, state, lead = max(0, periods - _MOST_KEPT), None, Outcome.DONE
    if skipped:
        batch = integrate_batch(system, detuning=detuning, periods=skipped, window=0)
        lead = batch.outcomes[0]
        state = batch.final_states[0] if lead.ok else None
    history = integrate(
        system, detuning=detuning, periods=periods - skipped, initial_state=state, samples_per_period=SAMPLES_PER_PERIOD
    )
    if not lead.ok:
        return dataclasses.replace(history, outcome=lead), 0.0
    return history, 2 * np.pi / history.frequency * skipped


def _summary(motion: Motion) -> dict[str, Any]:
    return {
        "key": motion.point.key,
        "reason": motion.point.reason,
        "detuning": motion.point.detuning,
        "frequency": motion.history.frequency,
        "wind_speed": motion.point.wind_speed,
        "kind": motion.kind,
        "period_multiple": motion.multiple,
        **motion.sizes,
        "section_spread": motion.spread,
        "pipe_peak_whole_run": motion.history.peaks().pipe,
        "pipe_peak_without_absorber": motion.bare,
        "outcome": motion.history.outcome.name.lower(),
    }


def _sizes(history: TimeHistory, tail: TimeHistory) -> dict[str, Any]:
    """Peaks, rms, and smallest and largest peak |x1| of a period within the tail [m]; NaN if the run failed."""
    peaks = tail.peaks()
    low, high = envelope_of(tail.pipe, SAMPLES_PER_PERIOD)
    each = np.maximum(high, -low)
    known = each.size > 0 and history.outcome.ok
    envelope = [float(each.min()), float(each.max())] if known else [math.nan, math.nan]
    return {"pipe_peak": peaks.pipe, "relative_peak": peaks.relative, "pipe_rms": tail.rms, "pipe_envelope": envelope}


def _finished(found: list[Motion]) -> Check:
    name = "Every integration reached its end"
    bad = [m for m in found if not m.history.outcome.ok]
    if bad:
        where = "; ".join(f"{m.point.place}: {m.history.outcome.value}" for m in bad)
        return Check(name, FAIL, where)
    tolerance, steps = found[0].history.tolerance, sum(m.history.steps[0] for m in found)
    return Check(name, PASS, f"{len(found)} runs, {steps} steps, local error below {tolerance:g} of the motion.")


def _expected(work: Work, found: list[Motion]) -> Iterable[Check]:
    """Where every periodic response is clearly unstable, the exact motion must be another one."""
    if "response" not in work.done.data:
        return
    curve = work.done.data["response"]
    inside = [m for m in found if _leaves(growth_rates_at(curve, m.point.detuning), m)]
    if not inside:
        return
    name = "Where no response of the excitation's period is stable, no motion repeats every period"
    text = "; ".join(f"{readable.motion(m.kind, m.multiple)} {m.point.place}" for m in inside)
    repeats = any(m.kind == "periodic" and m.multiple == 1 for m in inside)
    known = all(m.kind != "unsettled" for m in inside)
    yield Check(name, FAIL if repeats else PASS if known else UNVERIFIED, f"Integrated: {text}.")


def _leaves(growth: Floats, motion: Motion) -> bool:
    """Whether within half the run a motion must have left every periodic response it may have come near."""
    half = 0.5 * motion.history.periods * 2 * np.pi / motion.history.frequency
    return bool(growth.size and np.min(growth) * half > _GROWN)


def _motions_dataset(found: list[Motion]) -> xr.Dataset:
    import xarray as xr

    def each(values: Iterable[Any], long_name: str, unit: str, **more: Any) -> tuple[Any, ...]:
        return labelled("motion", np.array(list(values)), long_name, unit, **more)

    def rows(values: list[Floats], dim: str, long_name: str) -> tuple[Any, ...]:
        return labelled(("motion", dim), _padded(values), long_name, "s" if long_name.startswith("time") else "m")

    points, histories = [m.point for m in found], [m.history for m in found]
    absorbed = bool(found[0].history.system.elements)
    variables = {
        "detuning": each((p.detuning for p in points), "detuning sigma = Omega - omega", "rad/s"),
        "frequency": each((h.frequency for h in histories), "excitation frequency Omega", "rad/s"),
        "kind": each((KINDS.index(m.kind) for m in found), "kind of motion", "1", codes=_codes()),
        "tail_start": each((m.start + m.tail.time[0] for m in found), "time the tail begins", "s"),
        "slow_time": rows([m.start + _sliding(m.history) for m in found], "slow", "time of the sliding amplitude"),
        "time": rows([m.start + m.history.time for m in found], "sample", "time"),
        "x1": rows([h.pipe for h in histories], "sample", "pipe displacement"),
        "envelope_time": rows([m.start + _middles(m.history) for m in found], "period", "time of the envelope"),
    }
    signals = {"x1": ("pipe", lambda h: h.pipe)}
    if absorbed:
        variables["z"] = rows([h.z for h in histories], "sample", "relative displacement of the first absorber")
        variables["x2"] = rows([h.x2 for h in histories], "sample", "displacement of the first absorber")
        signals["z"] = ("relative", lambda h: h.z)
    for name, (text, values) in signals.items():
        pairs = [envelope_of(values(h), SAMPLES_PER_PERIOD) for h in histories]
        variables[f"{name}_low"] = rows([a for a, _ in pairs], "period", f"smallest {text} displacement of a period")
        variables[f"{name}_high"] = rows([b for _, b in pairs], "period", f"largest {text} displacement of a period")
        slow = [_first_harmonic(h, values(h)) for h in histories]
        variables[f"{name}_amplitude"] = rows(slow, "slow", f"first-harmonic {text} amplitude over a sliding period")
    attributes = {
        "keys": "; ".join(p.key for p in points),
        "samples_per_period": SAMPLES_PER_PERIOD,
        "slow_samples_per_period": SLOW_SAMPLES,
    }
    return xr.Dataset(variables, attrs=attributes)


def _spectra_dataset(found: list[Motion]) -> xr.Dataset:
    """One-sided amplitude spectra of the tails, up to the fifth harmonic."""
    import xarray as xr

    spectra = [m.tail.spectrum() for m in found]
    kept = [s.isel(frequency_hz=s["frequency_hz"].values < _HARMONICS_SHOWN * m.history.frequency / (2 * np.pi))
            for s, m in zip(spectra, found, strict=True)]  # fmt: skip
    dims = ("motion", "line")
    variables = {
        "frequency_hz": labelled(dims, _padded([s["frequency_hz"].values for s in kept]), "frequency", "Hz"),
    }
    names = {"pipe_amplitude": "amplitude of the pipe", "relative_amplitude": "amplitude of the first absorber"}
    for name, text in names.items():
        if found[0].history.system.elements or name == "pipe_amplitude":
            variables[name] = labelled(dims, _padded([s[name].values for s in kept]), text, "m")
    return xr.Dataset(variables, attrs={"window": "hann", "keys": "; ".join(m.point.key for m in found)})


def _padded(rows: list[Floats]) -> Floats:
    """Rows of unequal length as one array, NaN behind the shorter ones."""
    out = np.full((len(rows), max(row.size for row in rows)), np.nan)
    for target, row in zip(out, rows, strict=True):
        target[: row.size] = row
    return out


def _middles(history: TimeHistory) -> Floats:
    period = 2 * np.pi / history.frequency
    return np.asarray(period * (0.5 + np.arange((history.time.size - 1) // SAMPLES_PER_PERIOD)), dtype=float)


def _sliding(history: TimeHistory) -> Floats:
    """Middles of the sliding period."""
    half = SAMPLES_PER_PERIOD // 2
    return np.asarray(history.time[half : -half + 1 : SAMPLES_PER_PERIOD // SLOW_SAMPLES])


def _first_harmonic(history: TimeHistory, values: Floats) -> Floats:
    return sliding_amplitude(values, history.time, history.frequency, SAMPLES_PER_PERIOD, SLOW_SAMPLES)


def _codes() -> str:
    return ", ".join(f"{code} {kind}" for code, kind in enumerate(KINDS))
