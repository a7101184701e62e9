"""Step `cross_check`: the exact equations started on stable responses of the slow flow: whether they stay."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np

from frahm.analysis.section import FAIL, PASS, UNVERIFIED, Check, Section, Work
from frahm.arrays import Floats, labelled
from frahm.response import frequency_response
from frahm.slow_flow import SlowFlow
from frahm.slow_flow.kernels import coefficients
from frahm.systems import System
from frahm.time_integration import BatchResult, integrate_batch

if TYPE_CHECKING:
    import xarray as xr

POINTS = 15
PIPE_BOUND, RELATIVE_BOUND = 0.05, 0.10
_WINDOW = 50
_STEADY = 0.01


@dataclass(frozen=True)
class Start:
    """A stable response of the slow flow: frequency [rad/s], complex amplitudes X and Z [m], growth rate [1/s]."""

    frequency: float
    X: complex
    Z: complex
    growth_rate: float


def cross_check(work: Work) -> Section:
    """Peaks of the slow flow against the exact equations started on it, over the whole window of the case."""
    if isinstance(work.slow_flow, str) or "response" not in work.done.data:
        return Section()
    starts = _starts(work, work.slow_flow)
    if not starts:
        return Section(unverified=("The slow flow has no stable response in the window: nothing could be compared.",))
    states = np.array([_state(work.system, work.slow_flow, start) for start in starts])
    batch = integrate_batch(
        work.system, frequency=np.array([start.frequency for start in starts]), initial_states=states,
        periods=max(_WINDOW, work.case.analysis.periods), window=_WINDOW,
    )  # fmt: skip
    table = _table(starts, batch, work.slow_flow.omega)
    check = _judged(table)
    found = {
        "points": len(starts),
        "pipe_bound": PIPE_BOUND,
        "relative_bound": RELATIVE_BOUND,
        "largest_pipe_error": float(np.max(np.abs(table["pipe_error"].values))),
        "largest_relative_error": float(np.max(np.abs(table["relative_error"].values))),
    }
    return Section(results={"cross_check": found}, data={"cross_check": table}, checks=(check,))


def equilibrium(slow: SlowFlow, frequency: float, relative_amplitude: float) -> tuple[complex, complex]:
    """Complex amplitudes X, Z [m] of the response with |Z| given; x1 = Re X e^{i Omega t}, z = Re Z e^{i Omega t}."""
    _, a, _, _, e, g1, g2 = coefficients(slow.code, frequency, *slow.host)
    n = 0.75 * slow.kappa * relative_amplitude**2
    ratio = (g2 + n) / e - 1
    Z = slow.force / (a * ratio - (g1 + n))
    return complex(ratio * Z), complex(Z)


def _starts(work: Work, slow: SlowFlow) -> list[Start]:
    """Every stable response at frequencies spread over the window, and a few along each detached branch."""
    window = work.case.analysis.detuning
    coarse = frequency_response(work.system, detuning=window, method="slow-flow", form=slow.form, points=POINTS)
    special = [point.frequency for point in coarse.special_points]
    wanted = coarse.stable & ~np.isin(coarse.frequency, special)
    rows = np.stack([coarse.frequency, coarse.relative_amplitude, coarse.growth_rate], axis=1)[wanted]
    rows = np.concatenate([rows, _on_detached_branches(work.done.data["response"])])
    return [Start(float(W), *equilibrium(slow, W, Z), float(growth)) for W, Z, growth in rows]


def _on_detached_branches(curve: xr.Dataset) -> Floats:
    """Frequency, |Z| and growth rate at a quarter, half and three quarters of the stable part of detached branches."""
    names = ("frequency", "relative_amplitude", "growth_rate")
    rows = np.stack([curve[name].values for name in names], axis=1)
    picked = [np.empty((0, 3))]
    for number in np.flatnonzero(curve["detached"].values):
        stable = np.flatnonzero((curve["branch"].values == number) & curve["stable"].values.astype(bool))
        picked += [rows[stable[[stable.size // 4, stable.size // 2, 3 * stable.size // 4]]]] if stable.size else []
    return np.concatenate(picked)


def _state(system: System, slow: SlowFlow, start: Start) -> Floats:
    """State (x1, v1, x2, v2) at t = 0."""
    X1, X2 = start.X, start.X + start.Z
    return np.array([X1.real, (1j * start.frequency * X1).real, X2.real, (1j * start.frequency * X2).real])


def _table(starts: list[Start], batch: BatchResult, omega: float) -> xr.Dataset:
    import xarray as xr

    def column(values: Any, long_name: str, unit: str) -> tuple[Any, ...]:
        return labelled("comparison", np.asarray(values), long_name, unit)

    frequency = np.array([start.frequency for start in starts])
    pipe, relative = np.array([abs(s.X) for s in starts]), np.array([abs(s.Z) for s in starts])
    return xr.Dataset(
        {
            "frequency": column(frequency, "excitation frequency Omega", "rad/s"),
            "detuning": column(frequency - omega, "detuning sigma = Omega - omega", "rad/s"),
            "growth_rate": column([s.growth_rate for s in starts], "growth rate by the slow flow", "1/s"),
            "slow_pipe_peak": column(pipe, "pipe peak by the slow flow", "m"),
            "slow_relative_peak": column(relative, "relative peak by the slow flow", "m"),
            "pipe_peak": column(batch.pipe_peak, "pipe peak by integration", "m"),
            "relative_peak": column(batch.relative_peak, "relative peak by integration", "m"),
            "pipe_error": column(_error(pipe, batch.pipe_peak), "relative error of the slow pipe peak", "1"),
            "relative_error": column(_error(relative, batch.relative_peak), "relative error of the slow stroke", "1"),
            "steady": column(
                batch.pipe_least_peak >= (1 - _STEADY) * batch.pipe_peak, "integrated motion repeats every period", "1"
            ),
        }
    )


def _error(approximate: Floats, exact: Floats) -> Floats:
    """Relative error; 0 where both are 0."""
    same = approximate == exact
    return np.where(same, 0.0, approximate / np.where(same, 1.0, exact) - 1)


def _judged(table: xr.Dataset) -> Check:
    name = "Slow flow and exact equations agree on stable responses"
    pipe, relative = np.abs(table["pipe_error"].values), np.abs(table["relative_error"].values)
    sigma, steady = table["detuning"].values, table["steady"].values
    known = np.isfinite(pipe) & np.isfinite(relative)
    apart = known & ~((pipe <= PIPE_BOUND) & (relative <= RELATIVE_BOUND) & steady)
    bounds = f"{PIPE_BOUND:.0%} for the pipe, {RELATIVE_BOUND:.0%} for the stroke"
    if np.any(apart):
        where = "; ".join(
            f"at {sigma[i]:.4g} rad/s the pipe peak is off by {pipe[i]:.1%}, the stroke by {relative[i]:.1%}"
            + ("" if steady[i] else ", and the motion leaves the response")
            for i in np.flatnonzero(apart)
        )
        return Check(name, FAIL, f"Bounds {bounds}. Beyond them: {where}.")
    if not np.all(known):
        return Check(name, UNVERIFIED, f"{int(np.sum(~known))} of {sigma.size} integrations did not finish.")
    worst = f"largest difference {pipe.max():.2%} for the pipe, {relative.max():.2%} for the stroke"
    return Check(name, PASS, f"{sigma.size} responses over the window, {worst}; bounds {bounds}.")
