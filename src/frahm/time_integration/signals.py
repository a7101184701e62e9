"""What is read off sampled signals: peaks, rms, spectra, envelopes."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from frahm.arrays import Floats, labelled
from frahm.errors import ParameterError

if TYPE_CHECKING:
    import xarray as xr


class Peaks(NamedTuple):
    """Largest displacement of the pipe and of the first element [m]."""

    pipe: float
    relative: float


def whole_periods(samples: int, per_period: int) -> int:
    """How many of the first samples make up whole periods; all of them if there is not even one."""
    periods = (samples - 1) // per_period
    return periods * per_period if periods else samples


def rms(values: Floats, per_period: int) -> float:
    """Root mean square over whole periods."""
    return float(np.sqrt(np.mean(values[: whole_periods(values.size, per_period)] ** 2)))


def sliding_amplitude(values: Floats, time: Floats, frequency: float, per_period: int, places: int) -> Floats:
    """First-harmonic amplitude over a period that slides along the samples, at some places a period."""
    carried = values * np.exp(-1j * frequency * time)
    total = np.concatenate([[0.0], np.cumsum(carried)])
    mean = (total[per_period:] - total[:-per_period]) / per_period
    return np.asarray(2 * np.abs(mean[:: per_period // places]), dtype=float)


def peak(x: Floats, v: Floats, spacing: float) -> float:
    """Largest |x|, between samples too: where v changes sign, the extremum of the cubic through both ends."""
    if x.size == 0:
        return float("nan")
    largest = float(np.max(np.abs(x)))
    turns = np.nonzero(v[:-1] * v[1:] < 0)[0]
    if turns.size == 0:
        return largest
    a, b, va, vb = x[turns], x[turns + 1], spacing * v[turns], spacing * v[turns + 1]
    # x = a + va s + p s^2 + q s^3 on [0, 1]; its slope changes sign once inside.
    p, q = 3 * (b - a) - 2 * va - vb, 2 * (a - b) + va + vb
    root = np.sqrt(np.maximum(p * p - 3 * q * va, 0.0))
    s = -va / (p + np.copysign(root, -va))
    s = np.clip(np.where(np.isfinite(s), s, 0.0), 0.0, 1.0)
    return max(largest, float(np.max(np.abs(a + s * (va + s * (p + s * q))))))


def spectrum(
    pipe: Floats, relative: Floats, spacing: float, per_period: int, window: str, attributes: dict[str, Any]
) -> xr.Dataset:
    """One-sided amplitudes over `frequency_hz`, corrected for the window."""
    import xarray as xr

    count = whole_periods(pipe.size, per_period)
    if count < 4 and np.all(np.isfinite(pipe)):
        raise ParameterError("samples", pipe.size, "a history of at least four samples")
    weights = np.ones(count) if window == "boxcar" else 0.5 - 0.5 * np.cos(2 * np.pi * np.arange(count) / count)
    sides = np.full(count // 2 + 1, 2.0)
    sides[0] = 1.0
    if count % 2 == 0:
        sides[-1] = 1.0

    def amplitudes(values: Floats) -> Floats:
        return np.asarray(sides * np.abs(np.fft.rfft(weights * values[:count])) / np.sum(weights))

    return xr.Dataset(
        {
            "pipe_amplitude": labelled("frequency_hz", amplitudes(pipe), "amplitude of the pipe", "m"),
            "relative_amplitude": labelled("frequency_hz", amplitudes(relative), "amplitude of the first element", "m"),
        },
        {"frequency_hz": labelled("frequency_hz", np.fft.rfftfreq(count, spacing), "frequency", "Hz")},
        {**attributes, "window": window},
    )


def envelope(time: Floats, pipe: Floats, relative: Floats, per_period: int, attributes: dict[str, Any]) -> xr.Dataset:
    """Complex first harmonic period by period, as amplitude and phase."""
    import xarray as xr

    periods = (pipe.size - 1) // per_period
    if per_period < 3 or periods < 1:
        raise ParameterError("samples_per_period", per_period, "at least 3, and a history of at least one period")
    count = periods * per_period
    turn = np.exp(-2j * np.pi * (np.arange(per_period) / per_period))
    # The first sample need not stand at phase 0: a history can be cut anywhere.
    step = (time[1] - time[0]) * per_period
    start = np.exp(-2j * np.pi * (time[0] / step - np.floor(time[0] / step)))

    def harmonic(values: Floats) -> Any:
        return 2.0 / per_period * start * (values[:count].reshape(periods, per_period) @ turn)

    x, z = harmonic(pipe), harmonic(relative)
    middle = time[:count:per_period] + 0.5 * step
    return xr.Dataset(
        {
            "pipe_amplitude": labelled("time", np.abs(x), "amplitude of the pipe", "m"),
            "pipe_phase": labelled("time", np.angle(x), "phase of the pipe against the force", "rad"),
            "relative_amplitude": labelled("time", np.abs(z), "amplitude of the first element", "m"),
            "relative_phase": labelled("time", np.angle(z), "phase of the first element against the force", "rad"),
        },
        {"time": labelled("time", middle, "time", "s")},
        attributes,
    )
