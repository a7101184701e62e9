"""`basin_map`: which attractor every initial state of a plane leads to."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from frahm.arrays import Floats, labelled
from frahm.attractors.attractor import AttractorSet
from frahm.attractors.finding import begin_settling, describe, settling_periods
from frahm.attractors.regions import UNITS, Region, check_names, checked_region, default_region, states_of
from frahm.attractors.seeds import seed_states
from frahm.attractors.settling import UNLABELLED
from frahm.attractors.stroboscope import stroboscope
from frahm.errors import Outcome, ParameterError, check_count
from frahm.harmonic_balance import periodic_responses_of
from frahm.systems import System, as_system, detuning_of, excitation_frequency

if TYPE_CHECKING:
    import xarray as xr

    from frahm.case import Case

_LONG_NAMES = {
    "x1": "initial displacement of the pipe", "v1": "initial velocity of the pipe",
    "z": "initial displacement of the first element", "w": "initial velocity of the first element",
}  # fmt: skip
_MOST_STATES = 4_000_000


def basin_map(
    case_or_system: Case | System | str,
    *,
    detuning: float | None = None,
    frequency: float | None = None,
    plane: tuple[str, str] = ("x1", "v1"),
    extent: tuple[tuple[float, float], tuple[float, float]] | None = None,
    resolution: int | tuple[int, int] = 100,
    periods: int | None = None,
    workers: int | None = None,
) -> xr.Dataset:
    """Attractor that every initial state of a plane leads to, the other initial values being 0.

    Parameters
    ----------
    case_or_system : Case, System or str
        What is excited.
    detuning, frequency : float
        sigma or Omega [rad/s]; give one of the two.
    plane : tuple of str
        Two of x1, v1, z, w as in `find_attractors`.
    extent : tuple of two (lo, hi), optional
        Ranges of the two [m or m/s]; by default those of the region `find_attractors` samples.
    resolution : int or tuple of int
        States along each axis, ends included.
    periods : int
        Periods after which a motion that has not settled is given up.
    workers : int, optional
        Threads; one per core by default.

    Returns
    -------
    xarray.Dataset
        `label` over the two axes: the index along `attractor`, the largest pipe peak first; -1 not settled within the
        periods, -2 escaped, -3 too stiff to integrate, -4 interrupted before. Along `attractor` the variables of
        `AttractorSet.to_dataset`, with the share of the map as `basin_fraction`.

    Raises
    ------
    ParameterError
        For bad input.
    """
    system = as_system(case_or_system)
    W = excitation_frequency(system, detuning=detuning, frequency=frequency)
    names, shape = _checked_plane(system, plane), _checked_resolution(resolution)
    given = None if extent is None else _checked_extent(system, names, extent)
    periods = settling_periods(system, W) if periods is None else check_count("periods", periods, at_most=1_000_000)
    strobe = stroboscope(system, W, None if workers is None else check_count("workers", workers, at_most=1024))
    responses = periodic_responses_of(system, W, None)
    region = given or {name: default_region(system, W, responses)[name] for name in names}
    axes = [np.linspace(*region[name], count) for name, count in zip(names, shape, strict=True)]
    grid = [values.ravel() for values in np.meshgrid(*axes, indexing="ij")]
    states = states_of(system, dict(zip(names, grid, strict=True)))
    settling = begin_settling(strobe, responses, periods)
    seeds = settling.settle(seed_states(strobe, responses))
    settled = settling.settle(states, resume=not seeds.interrupted)
    done = np.array([outcome is not Outcome.INTERRUPTED for outcome in settled.outcomes], dtype=bool)
    found = [
        (group, attractor) for group, attractor in describe(settling, settled, done, int(seeds.labels[0])) if group
    ]
    labels = np.array([_CODES.get(outcome, UNLABELLED) for outcome in settled.outcomes])
    for index, (group, _) in enumerate(found):
        labels[np.isin(settled.labels, group)] = index
    attractors = AttractorSet(
        tuple(attractor for _, attractor in found), W, float(detuning_of(system, W)), region, len(states), 0, periods,
        Outcome.DONE if np.all(done) else Outcome.INTERRUPTED, responses.unverified,
    )  # fmt: skip
    return _dataset(attractors, names, axes, labels.reshape(shape))


_CODES = {
    Outcome.DIVERGED: -2, Outcome.STEP_LIMIT: -3, Outcome.STEP_TOO_SMALL: -3, Outcome.INTERRUPTED: -4,
}  # fmt: skip


def _dataset(attractors: AttractorSet, names: tuple[str, str], axes: list[Floats], labels: np.ndarray) -> xr.Dataset:
    data = attractors.to_dataset().drop_vars("basin_interval")
    for name in ("statement", "seed", "samples"):
        del data.attrs[name]
    meaning = "index along attractor; -1 not settled, -2 escaped, -3 too stiff to integrate, -4 interrupted"
    data["label"] = labelled(names, labels.astype(np.int32), "attractor reached", "1", meaning=meaning)
    for name, values in zip(names, axes, strict=True):
        data = data.assign_coords({name: labelled(name, values, _LONG_NAMES[name], UNITS[name])})
    return data


def _checked_plane(system: System, plane: Any) -> tuple[str, str]:
    if isinstance(plane, str) or not hasattr(plane, "__len__") or len(plane) != 2 or plane[0] == plane[1]:
        raise ParameterError("plane", plane, "two different names such as ('x1', 'v1')")
    check_names(system, "plane", list(plane))
    return plane[0], plane[1]


def _checked_extent(system: System, names: tuple[str, str], extent: Any) -> Region:
    try:
        first, second = extent
    except (TypeError, ValueError):
        raise ParameterError("extent", extent, "two ranges ((lo, hi), (lo, hi))") from None
    return checked_region(system, {names[0]: first, names[1]: second}, "extent")


def _checked_resolution(resolution: Any) -> tuple[int, int]:
    pair = resolution if isinstance(resolution, tuple | list) else (resolution, resolution)
    if len(pair) != 2:
        raise ParameterError("resolution", resolution, "a whole number or two of them")
    shape = check_count("resolution", pair[0], at_least=2), check_count("resolution", pair[1], at_least=2)
    if shape[0] * shape[1] > _MOST_STATES:
        raise ParameterError("resolution", resolution, f"at most {_MOST_STATES} states in all")
    return shape
