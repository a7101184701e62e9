"""What a figure of one motion needs, taken from the datasets of an analysis."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np

from frahm import readable
from frahm.arrays import Floats

if TYPE_CHECKING:
    import xarray as xr

LABELS = {"x1": "pipe x₁", "z": "absorber relative to the pipe z"}
_LAST_PERIODS = 40
_SLOW_PERIODS = 250
_MOST_ENVELOPE = 1000
_SPECTRAL_AMPLITUDES = {"x1": "pipe_amplitude", "z": "relative_amplitude"}
_DECADES = 5
SHOWN_HARMONICS = 4.0  # of the excitation, in spectra


@dataclass(frozen=True)
class MotionView:
    """One integrated motion: `x1` of the pipe and, with an absorber, `z` relative to it.

    Attributes
    ----------
    facts : dict
        What the summary says about it: key, reason, detuning, kind, peaks.
    envelope : dict
        By signal: time [s], smallest and largest displacement of every period [m].
    last : dict
        By signal: time [s] and displacement [m] over the last periods.
    spectrum : dict
        By signal: frequency [Hz] and amplitude [m].
    slow : tuple of ndarray, optional
        First-harmonic amplitudes |Z|, |X| [m] over the last periods.
    """

    facts: dict[str, Any]
    envelope: dict[str, tuple[Floats, Floats, Floats]]
    last: dict[str, tuple[Floats, Floats]]
    spectrum: dict[str, tuple[Floats, Floats]]
    slow: tuple[Floats, Floats] | None

    @property
    def key(self) -> str:
        """Short name for files."""
        return str(self.facts["key"])

    @property
    def kind(self) -> str:
        """Periodic, modulated, chaotic or unsettled."""
        return str(self.facts["kind"])

    @property
    def detuning(self) -> float:
        """Detuning [rad/s]."""
        return float(self.facts["detuning"])

    @property
    def signals(self) -> list[str]:
        """What moves: "x1", and "z" if there is an absorber."""
        return list(self.envelope)

    @property
    def title(self) -> str:
        """One line that says which motion this is."""
        return f"{self.where}, from rest: {self.kind}"

    @property
    def where(self) -> str:
        """Wind speed, or the detuning where the lift is fixed."""
        speed = self.place("wind_speed")
        return readable.speed(speed) if np.isfinite(speed) else f"σ = {self.detuning:.4g} rad/s"

    def place(self, axis: str) -> float:
        """Place on the axis "detuning" [rad/s] or "wind_speed" [m/s], NaN where that is not known."""
        value = self.facts.get(axis)
        return float("nan") if value is None else float(value)

    @property
    def frequency_hz(self) -> float:
        """Excitation frequency [Hz]."""
        return float(self.facts["frequency"]) / (2 * np.pi)

    @property
    def moves(self) -> bool:
        """Whether anything moves at all: a spectrum without a positive amplitude has no logarithm."""
        return any(bool(np.any(amplitude > 0)) for _, amplitude in self.spectrum.values())

    @property
    def spectrum_range(self) -> tuple[float, float]:
        """Amplitudes [m] worth showing."""
        top = max((float(np.fmax.reduce(a, initial=0.0)) for _, a in self.spectrum.values()), default=0.0) or 1.0
        return top * 10.0**-_DECADES, 3 * top

    def peaks(self, quantity: str) -> tuple[float, float]:
        """Smallest and largest peak [m] of a period for "pipe_peak"; twice the largest for "relative_peak"."""
        largest = self.facts[quantity]
        largest = np.nan if largest is None else float(largest)
        smallest = self.facts["pipe_envelope"][0] if quantity == "pipe_peak" else None
        return (largest if smallest is None else float(smallest)), largest


def motion_views(results: dict[str, Any], data: dict[str, xr.Dataset]) -> list[MotionView]:
    """Views of all integrated motions, in the order of the summary; none if that step was not finished."""
    if "motions" not in data:
        return []
    return [_view(facts, data["motions"].isel(motion=i), data["spectra"].isel(motion=i))
            for i, facts in enumerate(results["motions"])]  # fmt: skip


def trajectory_to_show(views: list[MotionView]) -> MotionView | None:
    """The motion shown on the slow manifold: one that does not repeat, if any, nearest to the natural frequency."""
    with_sink = [view for view in views if view.slow is not None]
    return min(
        with_sink, key=lambda view: (view.kind not in ("modulated", "chaotic"), abs(view.detuning)), default=None
    )


def manifold_height(manifold: xr.Dataset, motion: MotionView | None, folds: dict[str, Any] | None) -> float:
    """Pipe amplitude [m] up to which the slow manifold is worth showing: beyond folds and motion it only rises."""
    if folds is None and motion is None:
        return float(manifold["pipe_amplitude"].max())
    heights = [0.0 if folds is None else float(folds["pipe_ceiling"])]
    heights += [float(np.max(motion.slow[1], initial=0.0))] if motion is not None and motion.slow is not None else []
    return 1.7 * max(heights)


def _view(facts: dict[str, Any], motion: xr.Dataset, spectrum: xr.Dataset) -> MotionView:
    kept = _LAST_PERIODS * int(motion.attrs["samples_per_period"]) + 1
    time, envelope_time = motion["time"].values, motion["envelope_time"].values
    signals = [name for name in LABELS if name in motion]
    count = int(np.sum(np.isfinite(time)))
    window = slice(max(0, count - kept), count)
    known = np.isfinite(envelope_time)
    lines = np.isfinite(spectrum["frequency_hz"].values)
    return MotionView(
        facts=facts,
        envelope={
            name: _envelope(
                *(motion[column].values[known] for column in ("envelope_time", f"{name}_low", f"{name}_high"))
            )
            for name in signals
        },
        last={name: (time[window], motion[name].values[window]) for name in signals},
        spectrum={
            name: (spectrum["frequency_hz"].values[lines], spectrum[_SPECTRAL_AMPLITUDES[name]].values[lines])
            for name in signals
        },
        slow=_slow(motion) if "z" in signals else None,
    )


def _envelope(time: Floats, low: Floats, high: Floats) -> tuple[Floats, Floats, Floats]:
    """The envelope; of a long run over several periods at a time."""
    group = -(-time.size // _MOST_ENVELOPE)
    if group <= 1:
        return time, low, high
    starts = np.arange(0, time.size, group)
    return time[starts], np.minimum.reduceat(low, starts), np.maximum.reduceat(high, starts)


def _slow(motion: xr.Dataset) -> tuple[Floats, Floats]:
    Z, X = motion["z_amplitude"].values, motion["x1_amplitude"].values
    known = np.flatnonzero(np.isfinite(Z))[-_SLOW_PERIODS * int(motion.attrs["slow_samples_per_period"]) :]
    return Z[known], X[known]
