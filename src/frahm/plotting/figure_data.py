"""What the figures of an analysis show, as datasets by figure name."""

from __future__ import annotations

from collections.abc import Iterator
from typing import TYPE_CHECKING, Any

import numpy as np

from frahm.arrays import labelled
from frahm.plotting.views import LABELS, MotionView, motion_views, trajectory_to_show

if TYPE_CHECKING:
    import xarray as xr

_WHOLE = {
    "decision": "decision",
    "response": "response-harmonic-balance",
    "slow_flow": "response-slow-flow",
    "without_absorber": "response-without-absorber",
    "modulated": "response-modulated",
    "response_over_wind": "response-over-wind",
    "without_absorber_over_wind": "response-over-wind-without-absorber",
    "slow_manifold": "slow-manifold",
    "unsteady_wind": "unsteady-wind",
    "basin_map": "basin-map",
    "fatigue": "fatigue",
}


def figure_data(results: dict[str, Any], data: dict[str, xr.Dataset]) -> Iterator[tuple[str, xr.Dataset]]:
    """File name and dataset of everything that is drawn: a curve each for the responses, three tables a motion."""
    for name, file in _WHOLE.items():
        if name in data:
            yield file, data[name]
    views = motion_views(results, data)
    for view in views:
        for part, dataset in _motion_data(view).items():
            yield f"motion-{view.key}-{part}", dataset
    shown = trajectory_to_show(views)
    if "slow_manifold" in data and shown is not None and shown.slow is not None:
        yield "slow-manifold-motion", _trajectory(shown)


def _motion_data(view: MotionView) -> dict[str, xr.Dataset]:
    """Envelope of the whole run, last periods, and spectrum of the tail."""
    import xarray as xr

    first = view.signals[0]
    envelope = {"time": labelled("stretch", view.envelope[first][0], "time", "s")}
    last = {"time": labelled("sample", view.last[first][0], "time", "s")}
    spectrum = {"frequency_hz": labelled("line", view.spectrum[first][0], "frequency", "Hz")}
    for name in view.signals:
        text = LABELS[name]
        _, low, high = view.envelope[name]
        envelope[f"{name}_low"] = labelled("stretch", low, f"smallest displacement, {text}", "m")
        envelope[f"{name}_high"] = labelled("stretch", high, f"largest displacement, {text}", "m")
        last[name] = labelled("sample", view.last[name][1], f"displacement, {text}", "m")
        spectrum[f"{name}_amplitude"] = labelled("line", view.spectrum[name][1], f"amplitude, {text}", "m")
    facts = {"detuning": view.detuning, "kind": view.kind}
    parts = {"envelope": envelope, "last": last, "spectrum": spectrum}
    return {part: xr.Dataset(variables, attrs=facts) for part, variables in parts.items()}


def _trajectory(view: MotionView) -> xr.Dataset:
    import xarray as xr

    Z, X = (np.zeros(0), np.zeros(0)) if view.slow is None else view.slow
    variables = {
        "relative_amplitude": labelled("sample", Z, "amplitude of the absorber relative to the pipe |Z|", "m"),
        "pipe_amplitude": labelled("sample", X, "amplitude of the pipe |X|", "m"),
    }
    return xr.Dataset(variables, attrs={"detuning": view.detuning})
