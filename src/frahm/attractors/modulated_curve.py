"""What `modulated_branches` returns: limit cycles of the slow flow over the frequency, as one frozen result."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any

import numpy as np

from frahm import __version__, readable
from frahm.arrays import Floats, labelled
from frahm.attractors.cycle_branches import CRITICAL, End

if TYPE_CHECKING:
    import xarray as xr

Range = tuple[float, float]


@dataclass(frozen=True)
class ModulatedPoint:
    """A point on a branch of modulated responses where their number or stability changes.

    Attributes
    ----------
    kind : str
        "fold of cycles", "period-doubling" or "torus".
    frequency, detuning : float
        Omega and sigma [rad/s].
    period : float
        Period of the modulation [s].
    pipe_max : float
        Largest amplitude of the pipe over the modulation [m].
    branch : int
        Number of the branch it lies on.
    """

    kind: str
    frequency: float
    detuning: float
    period: float
    pipe_max: float
    branch: int


@dataclass(frozen=True)
class ExactCheck:
    """A stable modulated response of the slow flow held against the exact equations, started on it.

    Attributes
    ----------
    frequency, detuning : float
        Omega and sigma [rad/s].
    pipe_max, pipe_min : float
        Largest and smallest amplitude of the pipe by the slow flow [m].
    exact_pipe_max, exact_pipe_min : float
        Largest and smallest peak of a period by the exact equations, after 600 periods over 400 [m].
    modulated : bool
        Whether the exact motion is still modulated (its peaks differ by more than 3 %).
    """

    frequency: float
    detuning: float
    pipe_max: float
    pipe_min: float
    exact_pipe_max: float
    exact_pipe_min: float
    modulated: bool


@dataclass(frozen=True, eq=False)
class ModulatedCurve:
    """Branches of modulated responses over a window of the excitation frequency; arrays (points,), branch by branch.

    Amplitudes are those of the first harmonic, |X| and |Z|, which vary slowly.

    Attributes
    ----------
    frequency, detuning : ndarray
        Omega and sigma [rad/s].
    period : ndarray
        Period of the modulation [s].
    pipe_max, pipe_min, relative_max, relative_min : ndarray
        Largest and smallest amplitude over a modulation, of the pipe and of the first element [m].
    multiplier : ndarray
        Largest modulus of the Floquet multipliers besides the trivial one.
    stable : ndarray of bool
        Whether the modulated response is locally stable.
    branch : ndarray of int
        Number of the branch.
    special_points : tuple of ModulatedPoint
        Folds of cycles, and the period doublings and tori at which stability changes.
    ends : tuple of (End, End)
        For every branch, how it ends on either side.
    ranges : tuple of (float, float)
        Ranges of the detuning [rad/s] in which a modulated response is stable.
    coexistence : tuple of (float, float)
        Ranges of the detuning [rad/s] in which a stable modulated response coexists with a stable periodic one.
    checks : tuple of ExactCheck
        Samples held against the exact equations.
    unverified : tuple of str
        Sentences on what was not verified; empty if nothing.
    settings : dict
        Form, window and number of looks that made the curve.
    system : str
        Name of the system.
    """

    __repr__ = readable.summary

    frequency: Floats
    detuning: Floats
    period: Floats
    pipe_max: Floats
    pipe_min: Floats
    relative_max: Floats
    relative_min: Floats
    multiplier: Floats
    stable: np.ndarray
    branch: np.ndarray
    special_points: tuple[ModulatedPoint, ...]
    ends: tuple[tuple[End, End], ...]
    ranges: tuple[Range, ...]
    coexistence: tuple[Range, ...]
    checks: tuple[ExactCheck, ...]
    unverified: tuple[str, ...]
    settings: dict[str, Any] = field(default_factory=dict)
    system: str = "system"

    def to_dataset(self) -> xr.Dataset:
        """The curve as `xarray.Dataset` over "point", special points, ranges and checks beside it, all with units."""
        import xarray as xr

        points = {
            "frequency": ("excitation frequency Omega", "rad/s"),
            "detuning": ("detuning sigma = Omega - omega", "rad/s"),
            "period": ("period of the modulation", "s"),
            "pipe_max": ("largest amplitude of the pipe over a modulation", "m"),
            "pipe_min": ("smallest amplitude of the pipe over a modulation", "m"),
            "relative_max": ("largest relative amplitude over a modulation", "m"),
            "relative_min": ("smallest relative amplitude over a modulation", "m"),
            "multiplier": ("largest modulus of the Floquet multipliers", "1"),
            "stable": ("locally stable", "1"),
            "branch": ("number of the branch", "1"),
        }
        variables = {name: labelled("point", getattr(self, name), *text) for name, text in points.items()}
        special = self.special_points
        for name, (long_name, units) in {
            "frequency": ("frequency of special point", "rad/s"),
            "detuning": ("detuning of special point", "rad/s"),
            "period": ("period of the modulation at special point", "s"),
            "pipe_max": ("largest pipe amplitude at special point", "m"),
        }.items():
            values = np.array([getattr(point, name) for point in special], dtype=float)
            variables[f"special_{name}"] = labelled("special_point", values, long_name, units)
        kinds = np.array([CRITICAL.index(point.kind) for point in special], dtype=int)
        variables["special_kind"] = labelled("special_point", kinds, "kind of special point", "1")
        owners = np.array([point.branch for point in special], dtype=int)
        variables["special_branch"] = labelled("special_point", owners, "branch of special point", "1")
        for name, found, text in (
            ("stable_range", self.ranges, "detuning over which a modulated response is stable"),
            ("coexistence", self.coexistence, "detuning over which it coexists with a stable periodic response"),
        ):
            values = np.array(found, dtype=float).reshape(-1, 2)
            variables[name] = labelled((f"{name}_number", "edge"), values, text, "rad/s")
        for name, text, units in (
            ("detuning", "detuning of a check against the exact equations", "rad/s"),
            ("pipe_max", "largest pipe amplitude by the slow flow", "m"),
            ("exact_pipe_max", "largest pipe peak of a period by the exact equations", "m"),
        ):
            values = np.array([getattr(check, name) for check in self.checks], dtype=float)
            variables[f"check_{name}"] = labelled("check", values, text, units)
        attributes = {
            "title": "modulated responses of the slow flow",
            "system": self.system,
            "frahm_version": __version__,
            "special_kind_names": ", ".join(CRITICAL),
            "ends": " | ".join(f"{number}: {a.sentence} {b.sentence}" for number, (a, b) in enumerate(self.ends)),
            "unverified": "; ".join(self.unverified),
            **{key: str(value) for key, value in self.settings.items()},
        }
        return xr.Dataset(variables, attrs=attributes)
