"""Regions of initial states: named ranges of x1, v1, z and w, and the states they stand for."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np
import scipy.linalg
from scipy.stats import qmc

from frahm.arrays import Floats
from frahm.errors import ParameterError, check_number, nearest
from frahm.harmonic_balance import PeriodicResponse
from frahm.systems import System

NAMES = ("x1", "v1", "z", "w")
UNITS = {"x1": "m", "v1": "m/s", "z": "m", "w": "m/s"}
_HOST_DOMINATES = 1e3  # above this many static deflections the host's own resonance says nothing about its motions
_INDEPENDENT = 1e-9
_LARGEST = 1e30  # beyond any structure, and far from where numbers end

Region = dict[str, tuple[float, float]]


def lift(system: System) -> tuple[Floats, bool]:
    """Displacements (n, 2) of all coordinates per x1 (output) and z (first element), and whether z is free.

    All other elements are at rest relative to what they hang on; what this leaves open is as soft as it can be: a
    pipe of several modes is bent as by a force where the output is, not in modes a hundred times stiffer.
    """
    rows = [system.output]
    free = False
    for index, element in enumerate(system.elements):
        if _independent(rows, element.direction):
            rows.append(element.direction)
            free = free or index == 0
    inverse = _softest(system, np.array(rows))
    columns = inverse[:, :2] if free else np.column_stack([inverse[:, 0], np.zeros(system.size)])
    return columns, free


def states_of(system: System, values: Mapping[str, Any]) -> Floats:
    """States (N, 2n) of named values (N,) of x1, v1, z, w; those not named are 0."""
    columns, _ = lift(system)
    count = max((np.size(value) for value in values.values()), default=1)
    x1, v1, z, w = (np.broadcast_to(np.asarray(values.get(name, 0.0), dtype=float), (count,)) for name in NAMES)
    states = np.empty((count, 2 * system.size))
    states[:, 0::2] = np.column_stack([x1, z]) @ columns.T
    states[:, 1::2] = np.column_stack([v1, w]) @ columns.T
    return states


def check_names(system: System, argument: str, names: Sequence[Any]) -> None:
    """Refuse names that are no initial values of the system."""
    _, free = lift(system)
    known = NAMES if free else NAMES[:2]
    for name in names:
        if name not in known:
            near = nearest(str(name), known)
            hint = f"Did you mean {near!r}?" if near else None
            raise ParameterError(argument, name, "one of " + ", ".join(known), hint=hint)


def checked_region(system: System, region: Any, argument: str = "region") -> Region:
    """Region with checked names and bounds lo <= hi."""
    allowed = "a region such as {'x1': (-0.08, 0.08), 'v1': (-0.4, 0.4)} over " + ", ".join(NAMES)
    if not isinstance(region, Mapping) or not region:
        raise ParameterError(argument, region, allowed)
    check_names(system, argument, list(region))
    checked = {}
    for name, bounds in region.items():
        try:
            lo, hi = bounds
        except (TypeError, ValueError):
            raise ParameterError(f"{argument}[{name!r}]", bounds, f"two numbers (lo, hi) [{UNITS[name]}]") from None
        lo = check_number(f"{argument}[{name!r}][0]", lo, at_least=-_LARGEST, at_most=_LARGEST, unit=UNITS[name])
        hi = check_number(f"{argument}[{name!r}][1]", hi, at_least=-_LARGEST, at_most=_LARGEST, unit=UNITS[name])
        if not lo <= hi:
            raise ParameterError(f"{argument}[{name!r}]", (lo, hi), f"two numbers lo <= hi [{UNITS[name]}]")
        checked[name] = (lo, hi)
    return checked


def default_region(system: System, frequency: float, responses: Sequence[PeriodicResponse]) -> Region:
    """Region scaled by the largest of the periodic responses, see `region_for`."""
    pipe = max([response.pipe_peak for response in responses], default=0.0)
    stroke = max([response.relative_peak for response in responses], default=0.0)
    return region_for(system, frequency, pipe, stroke)


def region_for(system: System, frequency: float, pipe: float, stroke: float) -> Region:
    """What the structure may do before it is left to itself, all four names.

    x1 reaches as far as the larger of `pipe` and the host at resonance without its elements, plus what a gust adds that
    holds the amplitude of the force for half a period; z as far as `stroke` [m].
    """
    gust = np.pi * float(np.max(np.abs(np.linalg.solve(system.mass, system.forcing)))) / frequency**2
    pipe = max(pipe, _host_resonance(system)) + gust or 1.0
    region = {"x1": (-pipe, pipe), "v1": (-pipe * frequency, pipe * frequency)}
    if lift(system)[1]:
        stroke = max(stroke, gust) or pipe
        region |= {"z": (-stroke, stroke), "w": (-stroke * frequency, stroke * frequency)}
    return region


def sample_region(system: System, region: Region, samples: int, seed: int) -> Floats:
    """Scrambled Sobol points (samples, 2n), uniform over the region."""
    sobol = qmc.Sobol(len(region), scramble=True, seed=seed)
    unit = sobol.random(1 << max(samples - 1, 0).bit_length())[:samples]
    lo, hi = (np.array([bounds[side] for bounds in region.values()]) for side in (0, 1))
    return states_of(system, dict(zip(region, (lo + (hi - lo) * unit).T, strict=True)))


def _softest(system: System, rows: Floats) -> Floats:
    """Displacements (n, rows) of every coordinate per value of each row, of least strain energy.

    Kinetic energy at the reference frequency is added, so that what no spring holds stays small too.
    """
    if rows.shape[0] == rows.shape[1]:
        return np.asarray(np.linalg.inv(rows))
    positive = system.natural_frequencies[system.natural_frequencies > 0]
    square = float(positive[0]) ** 2 if positive.size else 1.0
    stiffness = 0.5 * (system.stiffness + system.stiffness.T) + square * system.mass
    try:
        spread = scipy.linalg.solve(stiffness, rows.T, assume_a="pos")
    except np.linalg.LinAlgError:  # a negative stiffness has no softest shape
        spread = rows.T
    return np.asarray(spread @ np.linalg.inv(rows @ spread))


def _independent(rows: list[Floats], row: Floats) -> bool:
    stacked = np.array([*rows, row])
    stacked = stacked / np.linalg.norm(stacked, axis=1, keepdims=True)
    return bool(np.linalg.svd(stacked, compute_uv=False)[-1] > _INDEPENDENT) and len(stacked) <= row.size


def _host_resonance(system: System) -> float:
    """Largest steady |output| of the structure without its elements at one of its natural frequencies [m]."""
    largest = 0.0
    for omega in system.natural_frequencies[system.natural_frequencies > 0]:
        dynamic = system.stiffness - omega**2 * system.mass + 1j * omega * system.damping
        try:
            amplitude = float(abs(system.output @ np.linalg.solve(dynamic, system.forcing.astype(complex))))
        except np.linalg.LinAlgError:
            continue
        push = float(np.max(np.abs(np.linalg.solve(system.mass, system.forcing)))) / omega**2
        if amplitude < _HOST_DOMINATES * push:
            largest = max(largest, amplitude)
    return largest
