"""The largest lasting motion at every frequency of a range of operation, as one curve to draw."""

from __future__ import annotations

from collections.abc import Sequence
from itertools import pairwise
from typing import TYPE_CHECKING

import numpy as np

from frahm.arrays import Floats, labelled
from frahm.attractors.worst import WorstCase
from frahm.tolerances import AS_LARGE

if TYPE_CHECKING:
    import xarray as xr

_PEAKS = {"pipe": "pipe displacement", "relative": "displacement of the first absorber relative to the pipe"}


def lasting_motions(parts: Sequence[WorstCase]) -> xr.Dataset:
    """Largest lasting motions over ranges of operation, such as those of the modes of a pipe.

    Parameters
    ----------
    parts : sequence of WorstCase
        One after the other.

    Returns
    -------
    Dataset
        Over "point", ascending in frequency within each part: `part` (its number), `frequency`, `detuning` [rad/s],
        `wind_speed` [m/s] where the lift follows the wind; `pipe_peak` and `relative_peak` [m], of the largest stable
        periodic response, or where none is stable of the largest attractor found there; `searched_pipe_peak` and
        `searched_relative_peak` [m], of the largest attractor at the frequencies that were searched, NaN elsewhere.
        Frequencies of which nothing lasting is known are left out.
    """
    import xarray as xr

    rows = [_of_part(part, number) for number, part in enumerate(parts)]
    table = {name: np.concatenate([row[name] for row in rows]) for name in rows[0]}
    over_wind = all(part.range.over_wind for part in parts)
    facts = {
        "part": ("number of the range of operation", "1"),
        "frequency": ("excitation frequency Omega", "rad/s"),
        "detuning": ("detuning sigma = Omega - omega", "rad/s"),
        **({"wind_speed": ("wind speed U", "m/s")} if over_wind else {}),
        **{f"{which}_peak": (f"largest lasting {text}", "m") for which, text in _PEAKS.items()},
        **{f"searched_{which}_peak": (f"{text} of the largest attractor found", "m") for which, text in _PEAKS.items()},
    }
    return xr.Dataset({name: labelled("point", table[name], *text) for name, text in facts.items()})


def _of_part(part: WorstCase, number: int) -> dict[str, Floats]:
    lo, hi = part.range.frequency
    curve, searched = part.curve, np.array([survey.frequency for survey in part.surveys])
    inside = (curve.frequency >= lo) & (curve.frequency <= hi)
    W = np.unique(np.concatenate([curve.frequency[inside], searched]))
    columns: dict[str, Floats] = {}
    for which in _PEAKS:
        found = _searched(part, f"{which}_peak", W)
        periodic = _largest_stable(part, getattr(curve, f"{which}_peak"), W)
        exact = np.isfinite(found) & ~((found > AS_LARGE * periodic) | (periodic > AS_LARGE * found))
        columns[f"{which}_peak"] = np.where(exact, found, np.where(np.isfinite(periodic), periodic, found))
        columns[f"searched_{which}_peak"] = found
    known = np.isfinite(columns["pipe_peak"])
    reference = part.frequency - part.detuning
    places = {
        "part": np.full(W.size, number), "frequency": W, "detuning": W - reference, "wind_speed": part.range.speed(W),
    }  # fmt: skip
    return {name: values[known] for name, values in (places | columns).items()}


def _searched(part: WorstCase, name: str, W: Floats) -> Floats:
    """Largest finite peak of all attractors at the frequencies searched, NaN at the others [m]."""
    peaks = np.full(W.size, np.nan)
    for survey in part.surveys:
        finite = [peak for peak in (getattr(a, name) for a in survey) if np.isfinite(peak)]
        if finite:
            peaks[np.searchsorted(W, survey.frequency)] = max(finite)
    return peaks


def _largest_stable(part: WorstCase, peak: Floats, W: Floats) -> Floats:
    """Largest peak of the stable periodic responses [m], linear between the points of the curve; NaN where none is."""
    curve, largest = part.curve, np.full(W.size, -np.inf)
    for run in _monotone_stable_runs(curve.frequency, curve.stable_or_limit, curve.branch, curve.piece):
        x, y = curve.frequency[run], peak[run]
        order = np.argsort(x)
        within = (x.min() <= W) & (x.max() >= W)
        largest[within] = np.maximum(largest[within], np.interp(W[within], x[order], y[order]))
    return np.where(np.isfinite(largest), largest, np.nan)


def _monotone_stable_runs(frequency: Floats, stable: np.ndarray, *numbers: np.ndarray) -> list[slice]:
    """Runs of stable points of one branch and piece along which the frequency turns nowhere."""
    step = np.sign(np.diff(frequency))
    joined = stable[:-1] & stable[1:] & np.all([np.diff(values) == 0 for values in numbers], axis=0)
    turns = np.flatnonzero(~joined[1:] | ~joined[:-1] | (step[1:] != step[:-1])) + 1
    edges = [0, *turns.tolist(), frequency.size - 1]
    return [slice(a, b + 1) for a, b in pairwise(edges) if b > a and joined[a]]
