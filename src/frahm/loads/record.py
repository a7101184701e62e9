"""Wind that changes: records from files, and synthetic turbulence."""

from __future__ import annotations

import math
import os
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import ArrayLike
from pydantic_core import PydanticCustomError

from frahm import readable
from frahm.arrays import Floats, finite_array, frozen, labelled
from frahm.case.table_files import table_rows
from frahm.case.wind import RECORD_COLUMNS, SPECTRA
from frahm.errors import ParameterError, check_choice, check_count, check_number

if TYPE_CHECKING:
    import xarray as xr

_MOST = 4_000_000  # frequencies of a synthetic record


@dataclass(frozen=True, eq=False, init=False)
class WindRecord:
    """Wind speed over time, linear between its samples.

    Parameters
    ----------
    time : array_like, shape (r,)
        Ascending, regular or not [s].
    speed : array_like, shape (r,)
        Speed across the pipe, at least 0 [m/s].
    source : str
        Where it comes from.
    notes : tuple of str
        What a reader must know about it.

    Raises
    ------
    ParameterError
        If there are fewer than two samples, the time does not ascend, or a speed is negative.
    """

    __repr__ = readable.summary

    time: Floats
    speed: Floats
    source: str
    notes: tuple[str, ...]

    def __init__(self, time: ArrayLike, speed: ArrayLike, source: str = "given", notes: tuple[str, ...] = ()):
        t, U = finite_array("record.time", time, (-1,)), finite_array("record.speed", speed, (-1,))
        if t.size < 2 or t.size != U.size:
            raise ParameterError("record", f"{t.size} times, {U.size} speeds", "as many speeds as times, two at least")
        late = np.flatnonzero(np.diff(t) <= 0)
        if late.size:
            raise ParameterError("record.time", float(t[late[0] + 1]), "times that ascend [s]",
                                 hint=f"Sample {late[0] + 1} comes after {t[late[0]]:g} s.")  # fmt: skip
        if np.any(U < 0):
            raise ParameterError("record.speed", float(U.min()), "speeds >= 0 [m/s]")
        for name, value in (("time", t), ("speed", U), ("source", source), ("notes", notes)):
            object.__setattr__(self, name, value)

    @property
    def duration(self) -> float:
        """Length of the record [s]."""
        return float(self.time[-1] - self.time[0])

    @property
    def mean_speed(self) -> float:
        """Time average of the speed [m/s], exact for the straight lines between the samples."""
        return float(np.trapezoid(self.speed, self.time) / self.duration)

    @property
    def intensity(self) -> float:
        """Standard deviation over mean of the speed [-]."""
        low, high = self.speed[:-1] - self.mean_speed, self.speed[1:] - self.mean_speed
        variance = float(np.sum(np.diff(self.time) * (low**2 + low * high + high**2) / 3) / self.duration)
        return math.sqrt(variance) / self.mean_speed if self.mean_speed else 0.0

    def to_dataset(self) -> xr.Dataset:
        """Speed over time, labelled."""
        import xarray as xr

        return xr.Dataset(
            {"speed": labelled("time", self.speed, "wind speed", "m/s")},
            {"time": labelled("time", self.time, "time", "s")},
            {"source": self.source},
        )


def read_record(path: str | os.PathLike[str]) -> WindRecord:
    """Wind record of a CSV file with the columns time and speed; units in brackets in the head, SI without.

    Raises
    ------
    ParameterError
        If there is no such file, it cannot be read, or it is no wind record.
    """
    name = os.fspath(path)
    try:
        rows = table_rows(str(Path(name).resolve()), RECORD_COLUMNS)
    except PydanticCustomError as error:
        context = error.context or {}
        raise ParameterError("record", name, str(context["allowed"]), hint=context.get("hint")) from None
    return WindRecord([row["time"] for row in rows], [row["speed"] for row in rows], Path(name).name)


def as_record(record: Any) -> WindRecord:
    """Wind record of what a user gives: a record, a file, or a pair (time, speed)."""
    if isinstance(record, WindRecord):
        return record
    if isinstance(record, str | os.PathLike):
        return read_record(record)
    try:
        time, speed = record
    except (TypeError, ValueError):
        raise ParameterError("record", record, "a WindRecord, a CSV file, or a pair (time, speed)") from None
    return WindRecord(time, speed)


def spectral_density(frequency: ArrayLike, mean_speed: float, length_scale: float, spectrum: str = "kaimal") -> Floats:
    """One-sided spectrum of the along-wind turbulence over its variance [1/Hz].

    Parameters
    ----------
    frequency : array_like
        n > 0 [Hz].
    mean_speed : float
        U [m/s].
    length_scale : float
        L [m].
    spectrum : {"kaimal", "en1991", "von-karman"}
        With f = n L / U and S n / sigma^2 = 4 f / (1 + 6 f)^(5/3) (Kaimal, as in IEC 61400-1),
        6.8 f / (1 + 10.2 f)^(5/3) (EN 1991-1-4, annex B) or 4 f / (1 + 70.8 f^2)^(5/6) (von Karman): all quoted from
        memory, secondary; that they integrate to 1, the last one to 0.9999, is tested.
    """
    n = np.asarray(frequency, dtype=float)
    scale = length_scale / mean_speed
    f = n * scale
    kind = check_choice("spectrum", spectrum, SPECTRA)
    if kind == "kaimal":
        return 4 * scale / (1 + 6 * f) ** (5 / 3)
    if kind == "en1991":
        return 6.8 * scale / (1 + 10.2 * f) ** (5 / 3)
    return 4 * scale / (1 + 70.8 * f**2) ** (5 / 6)


def turbulent_record(
    mean_speed: float,
    intensity: float,
    length_scale: float,
    duration: float,
    *,
    highest_frequency: float,
    spectrum: str = "kaimal",
    seed: int = 1,
) -> WindRecord:
    """Synthetic turbulence: cosines with the amplitudes of a spectrum and random phases.

    Parameters
    ----------
    mean_speed : float
        [m/s].
    intensity : float
        Standard deviation over mean [-].
    length_scale : float
        [m].
    duration : float
        [s].
    highest_frequency : float
        Of the fluctuations kept [Hz]; faster gusts are left out and their share of the variance is told.
    spectrum : str
        See `spectral_density`.
    seed : int
        The same seed gives the same record.

    Raises
    ------
    ParameterError
        For bad input.
    """
    U = check_number("mean_speed", mean_speed, above=0, unit="m/s")
    I = check_number("intensity", intensity, at_least=0, at_most=1)  # noqa: E741 (turbulence intensity)
    L = check_number("length_scale", length_scale, above=0, unit="m")
    T = check_number("duration", duration, above=0, unit="s")
    top = check_number("highest_frequency", highest_frequency, above=0, unit="Hz")
    count = max(1, math.floor(top * T))
    if count > _MOST:
        raise ParameterError("duration", duration, f"at most {_MOST / top:g} s at {top:g} Hz")
    # Each cosine carries the variance of its band, so that slow gusts between zero and the first one are not lost.
    edges = (np.arange(count + 1) + 0.5) / T
    shares = np.diff(_cumulative(np.concatenate([[0.0], edges[1:]]), U, L, spectrum))
    phases = 2 * np.pi * np.random.default_rng(check_count("seed", seed, at_least=0)).random(count)
    spectrum_of_speed = np.zeros(2 * count + 1, dtype=complex)
    spectrum_of_speed[1 : count + 1] = I * U * np.sqrt(2 * shares) * np.exp(1j * phases)
    size = 8 * count  # eight samples for the fastest gust: straight lines between them keep its shape
    padded = np.zeros(size, dtype=complex)
    padded[: count + 1] = spectrum_of_speed[: count + 1]
    speed = U + np.real(np.fft.ifft(padded) * size)
    speed = np.append(speed, speed[0])
    negative = float(np.mean(speed < 0))
    notes = [f"Gusts faster than {top:.3g} Hz, {1 - float(shares.sum()):.1%} of the variance, are left out."]
    if negative:
        notes.append(f"The wind reverses in {negative:.2%} of the samples; there it is taken as calm.")
    return WindRecord(
        np.linspace(0.0, T, size + 1), np.maximum(speed, 0.0),
        f"synthetic turbulence, {spectrum}, intensity {I:g}, length scale {L:g} m, seed {seed}", tuple(notes),
    )  # fmt: skip


def _cumulative(frequency: Floats, U: float, L: float, spectrum: str) -> Floats:
    """Share of the variance below frequencies [Hz], in closed form or by quadrature."""
    scale = L / U
    kind = check_choice("spectrum", spectrum, SPECTRA)
    if kind == "von-karman":
        from scipy.special import hyp2f1

        f = frequency * scale
        return np.asarray(4 * f * hyp2f1(0.5, 5 / 6, 1.5, -70.8 * f**2))
    slope = 6.0 if kind == "kaimal" else 10.2
    return 1 - (1 + slope * frequency * scale) ** (-2 / 3)


def constant_record(speed: float, duration: float) -> WindRecord:
    """A wind that does not change."""
    return WindRecord(frozen([0.0, duration]), frozen([speed, speed]), "steady wind")
