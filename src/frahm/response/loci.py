"""Curves of special points of the exact equations in two parameters, and events of detached curves."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from frahm import __version__
from frahm.arrays import labelled
from frahm.case import Case
from frahm.errors import ParameterError, check_choice, check_count, check_number, nearest
from frahm.harmonic_balance import is_linear
from frahm.harmonic_balance.detached import DetachedCurveEvent, detached_events
from frahm.harmonic_balance.found import Found
from frahm.harmonic_balance.loci import Locus, loci_at_frequency, loci_with_frequency
from frahm.harmonic_balance.quasi_static import searched_window
from frahm.systems import (
    PARAMETERS,
    System,
    as_system,
    check_parameter,
    excitation_frequency,
    excitation_window,
)

if TYPE_CHECKING:
    import xarray as xr

LOCUS_KINDS = ("saddle-node", "neimark-sacker")
MARKS = ("none", "cusp", "1:1 resonance", "1:2 resonance")
_FREQUENCIES = ("detuning", "frequency")
_BOUNDS = {"force": (0.2, 3.0)}


def bifurcation_curve(
    case_or_system: Case | System | str,
    *,
    kind: str = "saddle-node",
    plane: tuple[str, str] = ("detuning", "kappa"),
    bounds: tuple[tuple[float, float], tuple[float, float]],
    detuning: float | None = None,
    frequency: float | None = None,
    slices: int = 5,
) -> xr.Dataset:
    """Curves of saddle-node or Neimark-Sacker points of the exact equations in a plane of two parameters.

    Parameters
    ----------
    case_or_system : Case, System or str
        Any system with a nonlinear element.
    kind : str
        "saddle-node" or "neimark-sacker".
    plane : tuple of str
        Two of "detuning" or "frequency" [rad/s], "kappa" [1/(m^2 s^2)], "xi2" [1/s], "rho2" [-], "force" (a factor)
        and "pipe_frequency" [rad/s]; the absorber's are the first element's, per host mass.
    bounds : tuple of tuple of float
        (lo, hi) for both axes.
    detuning, frequency : float, optional
        Excitation where it is no axis; detuning 0 by default.
    slices : int
        Values of the second parameter at which the complete response curve is searched for points to start from. A
        curve that crosses none of these slices is not found.

    Returns
    -------
    xarray.Dataset
        Over "point": both axes, `frequency`, `pipe_peak` and `relative_peak` [m], `kind`, `curve` and
        `codimension2` (codes in its attributes).

    Raises
    ------
    ParameterError
        For bad input, or a system this cannot be asked of.
    """
    system = _nonlinear(case_or_system)
    check_choice("kind", kind, LOCUS_KINDS)
    axes = _checked_plane(system, plane)
    limits = _checked_bounds(axes, bounds)
    count = check_count("slices", slices, at_most=200)
    along = [axis for axis in axes if axis in _FREQUENCIES]
    doubts: list[str] = []
    if along:
        parameter = axes[0] if axes[1] in _FREQUENCIES else axes[1]
        lo, hi, unsearched = searched_window(system, *excitation_window(system, **{along[0]: limits[along[0]]}))
        window = (lo, hi)
        doubts += unsearched
        found, _ = loci_with_frequency(system, kind, parameter, window, limits[parameter], count, doubts=doubts)
    else:
        if detuning is None and frequency is None:
            detuning = 0.0
        W = excitation_frequency(system, detuning=detuning, frequency=frequency)
        found = loci_at_frequency(system, kind, axes, (limits[axes[0]], limits[axes[1]]), W, count, doubts)
    data = _dataset(system, kind, axes, limits, found, count)
    return data.assign_attrs(unverified=" ".join(doubts)) if doubts else data


def detached_curve_events(
    case_or_system: Case | System | str,
    parameter: str = "force",
    bounds: tuple[float, float] | None = None,
    *,
    detuning: tuple[float, float] | None = None,
    frequency: tuple[float, float] | None = None,
    slices: int = 9,
) -> Found[DetachedCurveEvent]:
    """Births and merges of detached response curves as a parameter changes.

    Both are points at which the parameter is extreme along a curve of saddle-nodes: the response curve there is a
    point (birth) or crosses itself (merge). They are located on the exact equations.

    Parameters
    ----------
    case_or_system : Case, System or str
        Any system with a nonlinear element.
    parameter : str
        "force" (a factor on the forcing, 1 = as given), "kappa", "xi2", "rho2" or "pipe_frequency".
    bounds : tuple of float
        (lo, hi) of the parameter; (0.2, 3) for the force by default.
    detuning, frequency : tuple of float, optional
        Window of the excitation [rad/s]; by default 0.7 to 1.4 times the reference frequency.
    slices : int
        Values of the parameter at which the complete response curve is searched. A detached curve that is born and
        gone again between two slices is not found.

    Returns
    -------
    list of DetachedCurveEvent
        Ascending in the parameter. The attribute `searched` says in which window, over which values: an event outside
        is not in the list.

    Raises
    ------
    ParameterError
        For bad input, or a system this cannot be asked of.
    """
    system = _nonlinear(case_or_system)
    check_parameter(system, parameter)
    if bounds is None and parameter not in _BOUNDS:
        raise ParameterError("bounds", None, f"two numbers (lo, hi) for {parameter!r} [{PARAMETERS[parameter]}]")
    limits = _pair(parameter, bounds or _BOUNDS[parameter])
    if detuning is None and frequency is None:
        frequency = (0.7 * system.reference_frequency, 1.4 * system.reference_frequency)
    window = excitation_window(system, detuning=detuning, frequency=frequency)
    lo, hi, unsearched = searched_window(system, *window)
    count = check_count("slices", slices, at_least=2, at_most=200)
    found = detached_events(system, parameter, (lo, hi), limits, count)
    found.unverified = (*unsearched, *found.unverified)
    return found


def _nonlinear(case_or_system: Case | System | str) -> System:
    system = as_system(case_or_system)
    if is_linear(system) or not np.any(system.forcing):
        raise ParameterError("case", system.name, "a system with a nonlinear element and a force")
    return system


def _checked_plane(system: System, plane: tuple[str, str]) -> tuple[str, str]:
    names = (*_FREQUENCIES, *PARAMETERS)
    allowed = "two different names out of " + ", ".join(names)
    if len(set(plane)) != 2 or set(plane) == set(_FREQUENCIES):
        raise ParameterError("plane", plane, allowed)
    for axis in plane:
        if axis not in names:
            near = nearest(str(axis), names)
            raise ParameterError("plane", axis, allowed, hint=f"Did you mean {near!r}?" if near else None)
        if axis not in _FREQUENCIES:
            check_parameter(system, axis)
    return plane[0], plane[1]


def _checked_bounds(
    axes: tuple[str, str], bounds: tuple[tuple[float, float], tuple[float, float]]
) -> dict[str, tuple[float, float]]:
    try:
        first, second = bounds
    except (TypeError, ValueError):
        raise ParameterError("bounds", bounds, "((lo, hi), (lo, hi)), one pair for each axis") from None
    return {axis: _pair(axis, pair) for axis, pair in zip(axes, (first, second), strict=True)}


def _pair(name: str, pair: tuple[float, float]) -> tuple[float, float]:
    try:
        lo, hi = pair
    except (TypeError, ValueError):
        raise ParameterError(f"bounds of {name}", pair, "two numbers (lo, hi)") from None
    if name in _FREQUENCIES:
        return check_number(f"bounds of {name}", lo), check_number(f"bounds of {name}", hi, above=lo)
    unit = PARAMETERS[name]
    lo = check_number(f"bounds of {name}", lo, at_least=0.0, unit=unit)
    return lo, check_number(f"bounds of {name}", hi, above=lo, unit=unit)


def _dataset(
    system: System,
    kind: str,
    axes: tuple[str, str],
    limits: dict[str, tuple[float, float]],
    found: list[Locus],
    slices: int,
) -> xr.Dataset:
    import xarray as xr

    sizes = [len(locus.frequency) for locus in found]
    columns: dict[str, list[np.ndarray]] = {axis: [] for axis in axes}
    for locus in found:
        parameters = iter(locus.values.T) if not set(axes) & set(_FREQUENCIES) else None
        for axis in axes:
            if axis == "frequency":
                columns[axis].append(locus.frequency)
            elif axis == "detuning":
                columns[axis].append(locus.frequency - _reference(system, axes, locus))
            else:
                columns[axis].append(next(parameters) if parameters is not None else locus.values[:, 1])
    codes = [np.zeros(size, int) for size in sizes]
    for code, locus in zip(codes, found, strict=True):
        for index, name in locus.marks:
            code[index] = MARKS.index(name)

    def joined(parts: list[np.ndarray], dtype: type = float) -> np.ndarray:
        return np.concatenate(parts).astype(dtype) if parts else np.empty(0, dtype)

    units = {"detuning": "rad/s", "frequency": "rad/s", **PARAMETERS}
    variables = {axis: labelled("point", joined(columns[axis]), axis.replace("_", " "), units[axis]) for axis in axes}
    variables["frequency"] = labelled(
        "point", joined([locus.frequency for locus in found]), "excitation frequency", "rad/s"
    )
    variables["pipe_peak"] = labelled("point", joined([locus.pipe_peak for locus in found]), "pipe peak", "m")
    variables["relative_peak"] = labelled(
        "point", joined([locus.relative_peak for locus in found]), "relative peak", "m"
    )
    number = np.repeat(np.arange(len(found)), sizes).astype(int)
    variables["curve"] = labelled("point", number, "number of the connected curve", "1")
    kinds = np.full(number.size, LOCUS_KINDS.index(kind))
    variables["kind"] = labelled("point", kinds, "kind of special point", "1", codes=", ".join(LOCUS_KINDS))
    variables["codimension2"] = labelled("point", joined(codes, int), "codimension two", "1", codes=", ".join(MARKS))
    attributes = {
        "title": f"{kind} points in ({axes[0]}, {axes[1]})",
        "system": system.name,
        "kind_names": ", ".join(LOCUS_KINDS),
        "bounds": ", ".join(f"{axis} {lo:g} ... {hi:g}" for axis, (lo, hi) in limits.items()),
        "slices": slices,
        "endings": "; ".join(" ".join(outcome.name for outcome in locus.outcomes) for locus in found),
        "frahm_version": __version__,
    }
    return xr.Dataset(variables, attrs=attributes)


def _reference(system: System, axes: tuple[str, str], locus: Locus) -> np.ndarray | float:
    """Frequency from which the detuning counts: the pipe's own where that is the other axis."""
    return locus.values[:, 1] if "pipe_frequency" in axes else system.reference_frequency
