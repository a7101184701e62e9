"""The response curve: every branch of periodic motion over a frequency window, whatever method found it."""

from __future__ import annotations

import functools
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any

import numpy as np

from frahm import __version__, readable
from frahm.arrays import Floats, labelled

if TYPE_CHECKING:
    import xarray as xr

MARGINAL = 1e-7  # growth over frequency below which a special point is met: 1e-9 there, 1e-5 at its neighbours
SPECIAL_KINDS = ("saddle-node", "hopf", "neimark-sacker", "period-doubling", "branch-point")


@dataclass(frozen=True)
class SpecialPoint:
    """A point where stability or the number of responses changes.

    Attributes
    ----------
    kind : str
        "saddle-node", "hopf", "neimark-sacker", "period-doubling" or "branch-point".
    frequency, detuning : float
        Omega and sigma [rad/s].
    pipe_peak, relative_peak : float
        max |x1| and max |z| over a period [m].
    branch : int
        Number of the branch it lies on.
    interval : tuple of float
        Interval of Omega [rad/s] that holds the point.
    status : str
        "located" or "unverified".
    wind_speed : float, optional
        U [m/s] where the response is over the wind.
    """

    kind: str
    frequency: float
    detuning: float
    pipe_peak: float
    relative_peak: float
    branch: int
    interval: tuple[float, float]
    status: str
    wind_speed: float | None = None


@dataclass(frozen=True)
class Branch:
    """One connected branch of the response, in order along it; arrays of shape (points,).

    Attributes
    ----------
    number : int
        0 holds the smallest response at the lower edge of the window.
    detached : bool
        Whether the branch is not connected to the one that comes from low frequency.
    asymmetric : bool
        Whether the motion lacks the symmetry x(t + T/2) = -x(t) of the equations; its mirror image is another response.
    """

    __repr__ = readable.summary

    number: int
    detached: bool
    asymmetric: bool
    frequency: Floats
    detuning: Floats
    pipe_amplitude: Floats
    relative_amplitude: Floats
    pipe_peak: Floats
    relative_peak: Floats
    stable: np.ndarray
    growth_rate: Floats
    piece: np.ndarray
    wind_speed: Floats | None = None


@dataclass(frozen=True, eq=False)
class ResponseCurve:
    """All periodic responses over a window of the excitation frequency; arrays of shape (points,), branch by branch.

    Attributes
    ----------
    frequency, detuning : ndarray
        Omega and sigma [rad/s].
    pipe_amplitude, relative_amplitude : ndarray
        First-harmonic amplitudes of x1 and z [m].
    pipe_peak, relative_peak : ndarray
        max |x1| and max |z| over a period [m].
    branch, piece : ndarray of int
        Branch, and the piece of it where a branch leaves the window and comes back.
    stable : ndarray of bool
        Whether the response is locally stable.
    growth_rate : ndarray
        Largest growth rate of a disturbance [1/s].
    detached, asymmetric : tuple of bool
        For every branch, see `Branch`; of a mirrored pair of asymmetric branches one is listed.
    special_points : tuple of SpecialPoint
        Ascending in frequency.
    unverified : tuple of str
        Sentences on what was not verified; empty if nothing.
    settings : dict
        Method, form, window and number of points that made the curve.
    system : str
        Name of the system.
    wind_speed : ndarray, optional
        U [m/s] at every point where the response is over the wind.
    """

    __repr__ = readable.summary

    frequency: Floats
    detuning: Floats
    pipe_amplitude: Floats
    relative_amplitude: Floats
    pipe_peak: Floats
    relative_peak: Floats
    branch: np.ndarray
    piece: np.ndarray
    stable: np.ndarray
    growth_rate: Floats
    detached: tuple[bool, ...]
    asymmetric: tuple[bool, ...]
    special_points: tuple[SpecialPoint, ...]
    unverified: tuple[str, ...]
    settings: dict[str, Any] = field(default_factory=dict)
    system: str = "system"
    wind_speed: Floats | None = None

    @functools.cached_property
    def branches(self) -> tuple[Branch, ...]:
        """The branches, number 0 first."""
        return tuple(self._branch(number) for number in range(len(self.detached)))

    def _branch(self, number: int) -> Branch:
        on = self.branch == number
        names = ("frequency", "detuning", "pipe_amplitude", "relative_amplitude", "pipe_peak", "relative_peak")
        columns = {name: getattr(self, name)[on] for name in (*names, "stable", "growth_rate", "piece")}
        if self.wind_speed is not None:
            columns["wind_speed"] = self.wind_speed[on]
        return Branch(number=number, detached=self.detached[number], asymmetric=self.asymmetric[number], **columns)

    @property
    def stable_or_limit(self) -> np.ndarray:
        """Where a response is stable, or the limit of stable ones: at a special point rounding decides which."""
        return np.asarray(self.growth_rate <= MARGINAL * self.frequency)

    def largest(self, *, stable_only: bool = False) -> tuple[float, float]:
        """Largest pipe peak [m] on the curve and its frequency [rad/s]; NaN if no point qualifies.

        With `stable_only` of stable responses and of the ends of their ranges.
        """
        peak = np.where(self.stable_or_limit, self.pipe_peak, -np.inf) if stable_only else self.pipe_peak
        if peak.size == 0 or not np.isfinite(np.max(peak)):
            return float("nan"), float("nan")
        index = int(np.argmax(peak))
        return float(peak[index]), float(self.frequency[index])

    def to_dataset(self) -> xr.Dataset:
        """The curve as `xarray.Dataset` over "point", special points over "special_point", all with units."""
        import xarray as xr

        points = {
            "frequency": ("excitation frequency Omega", "rad/s"),
            "detuning": ("detuning sigma = Omega - omega", "rad/s"),
            "pipe_amplitude": ("first-harmonic amplitude of the pipe", "m"),
            "relative_amplitude": ("first-harmonic amplitude of the sink relative to the pipe", "m"),
            "pipe_peak": ("largest pipe displacement over a period", "m"),
            "relative_peak": ("largest relative displacement over a period", "m"),
            "branch": ("number of the branch", "1"),
            "piece": ("piece of the branch inside the window", "1"),
            "stable": ("locally stable", "1"),
            "growth_rate": ("largest growth rate of a disturbance", "1/s"),
        }
        if self.wind_speed is not None:
            points["wind_speed"] = ("wind speed U", "m/s")
        variables = {name: labelled("point", getattr(self, name), *text) for name, text in points.items()}
        special = {
            "special_kind": ([SPECIAL_KINDS.index(p.kind) for p in self.special_points], "kind of special point", "1"),
            "special_frequency": ([p.frequency for p in self.special_points], "frequency of special point", "rad/s"),
            "special_detuning": ([p.detuning for p in self.special_points], "detuning of special point", "rad/s"),
            "special_pipe_peak": ([p.pipe_peak for p in self.special_points], "pipe peak at special point", "m"),
            "special_relative_peak": (
                [p.relative_peak for p in self.special_points], "relative peak at special point", "m",
            ),
            "special_branch": ([p.branch for p in self.special_points], "branch of special point", "1"),
            "special_located": ([p.status == "located" for p in self.special_points], "special point verified", "1"),
        }  # fmt: skip
        if self.wind_speed is not None:
            speeds = [p.wind_speed for p in self.special_points]
            special["special_wind_speed"] = (speeds, "wind speed of special point", "m/s")
        integer = {"special_kind", "special_branch"}
        for name, (data, long_name, units) in special.items():
            dtype = int if name in integer else (bool if name == "special_located" else float)
            variables[name] = labelled("special_point", np.array(data, dtype=dtype), long_name, units)
        for name, values in (("detached", self.detached), ("asymmetric", self.asymmetric)):
            variables[name] = labelled("branch_number", np.array(values, dtype=bool), f"branch is {name}", "1")
        attributes = {
            "title": "frequency response",
            "system": self.system,
            "frahm_version": __version__,
            "special_kind_names": ", ".join(SPECIAL_KINDS),
            "unverified": "; ".join(self.unverified),
            **{key: str(value) for key, value in self.settings.items()},
        }
        return xr.Dataset(variables, attrs=attributes)
