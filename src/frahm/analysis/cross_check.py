"""Step `cross_check`: harmonic balance against integration started on it, and the slow flow against both."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Any

import numpy as np

from frahm.analysis.section import FAIL, PASS, UNVERIFIED, Check, Section, Work
from frahm.arrays import Floats, labelled
from frahm.errors import ParameterError
from frahm.harmonic_balance import PeriodicResponse
from frahm.harmonic_balance.bifurcations import NEUTRAL
from frahm.response import periodic_responses, slow_flow_map
from frahm.slow_flow import SlowFlow
from frahm.slow_flow.kernels import NO_ROOT
from frahm.systems import System
from frahm.time_integration import BatchResult, integrate_batch

if TYPE_CHECKING:
    import xarray as xr

POINTS = 9
EXACT_BOUND = 1e-6
PIPE_BOUND, RELATIVE_BOUND = 0.05, 0.10
QUANTITIES = ("pipe", "relative")
_COUNTS = 1e-3  # of the largest peak of a motion: what is smaller is compared with this share
_LISTED = 4  # in a sentence
_PERIODS, _WINDOW = 100, 20
_TOLERANCE = 1e-11
_FEW, _MOST = 2, 6  # branches beside the main one


def cross_check(work: Work) -> Section:
    """Peaks by three methods on stable periodic responses over the window, detached branches included."""
    curve = work.done.data.get("response")
    if curve is None:
        return Section()
    responses = [response for sigma in _detunings(curve) for response in _stable_responses(work, sigma)]
    if not responses:
        return Section(unverified=("No stable periodic response was found to start integrations on.",))
    batch = integrate_batch(
        work.system, frequency=np.array([response.frequency for response in responses]),
        force_scale=np.array([work.range.lift_factor(response.frequency) for response in responses]),
        initial_states=np.array([response.state for response in responses]),
        periods=_PERIODS, window=_WINDOW, tolerance=_TOLERANCE,
    )  # fmt: skip
    theory = None
    if isinstance(work.theory, SlowFlow) and np.any(work.system.forcing):
        theory = _theory(work, work.theory, responses)
    table = _table(work.system, responses, batch, theory)
    if work.range.over_wind:
        speeds = work.range.speed(table["frequency"].values)
        table["wind_speed"] = labelled("comparison", speeds, "wind speed U", "m/s")
    places = [work.range.place(response.frequency) for response in responses]
    measured = (_measured(table, places),) if theory is not None else ()
    return Section(
        results={"cross_check": _found(table)},
        data={"cross_check": table},
        checks=(_judged(table, places), *measured),
    )


def _detunings(curve: xr.Dataset) -> Floats:
    """Detunings spread over the window, and within the stable part of every branch that is detached or asymmetric."""
    sigma, branch, stable = curve["detuning"].values, curve["branch"].values, curve["stable"].values.astype(bool)
    others = np.flatnonzero(curve["detached"].values.astype(bool) | curve["asymmetric"].values.astype(bool))
    shares = (0.25, 0.5, 0.75) if others.size <= _FEW else (0.5,)
    picked = [np.linspace(sigma.min(), sigma.max(), POINTS)]
    for number in others[:_MOST]:
        on = sigma[(branch == number) & stable]
        picked += [on.min() + np.array(shares) * np.ptp(on)] if on.size else []
    return np.unique(np.concatenate(picked))


def _stable_responses(work: Work, detuning: float) -> list[PeriodicResponse]:
    """Responses no disturbance leaves within the periods integrated; none at an undamped resonance."""
    try:
        W = work.system.reference_frequency + detuning
        found = periodic_responses(work.driven(W), frequency=W)
    except ParameterError:
        return []
    return [response for response in found if abs(response.multipliers[0]) <= 1 + NEUTRAL]


def _theory(work: Work, slow: SlowFlow, responses: list[PeriodicResponse]) -> dict[str, Floats]:
    """Amplitudes [m] of the root of the slow flow nearest to each response, both amplitudes on logarithmic scales."""
    frequency = np.array([response.frequency for response in responses])
    found = slow_flow_map(work.system, detuning=frequency - slow.omega, form=slow.form)
    names = {"pipe": "pipe_amplitude", "relative": "relative_amplitude"}
    exact = {name: np.array([getattr(response, name) for response in responses])[:, None] for name in names.values()}
    with np.errstate(divide="ignore", invalid="ignore"):
        distance = np.hypot(*(np.log(found[name].values / exact[name]) for name in names.values()))
    distance[(found["stability"].values == NO_ROOT) | ~np.isfinite(distance)] = math.inf
    rows, nearest = np.arange(len(responses)), np.argmin(distance, axis=1)
    return {which: found[name].values[rows, nearest] for which, name in names.items()}


def _table(
    system: System, responses: list[PeriodicResponse], batch: BatchResult, theory: dict[str, Floats] | None
) -> xr.Dataset:
    import xarray as xr

    def column(values: Any, long_name: str, unit: str) -> tuple[Any, ...]:
        return labelled("comparison", np.asarray(values), long_name, unit)

    frequency = np.array([response.frequency for response in responses])
    growth = [math.log(abs(response.multipliers[0])) / response.period for response in responses]
    variables = {
        "frequency": column(frequency, "excitation frequency Omega", "rad/s"),
        "detuning": column(frequency - system.reference_frequency, "detuning sigma = Omega - omega", "rad/s"),
        "growth_rate": column(growth, "growth rate of a disturbance", "1/s"),
        "harmonics": column([max(response.harmonics) for response in responses], "highest harmonic", "1"),
    }
    names = QUANTITIES if system.elements else QUANTITIES[:1]
    size = np.max([[getattr(response, f"{which}_peak") for response in responses] for which in names], axis=0)
    for which in names:
        exact = np.array([getattr(response, f"{which}_peak") for response in responses])
        integrated = getattr(batch, f"{which}_peak")
        error = f"{which} peak, harmonic balance over integration, minus 1"
        variables[f"{which}_peak"] = column(exact, f"{which} peak by harmonic balance", "m")
        variables[f"integrated_{which}_peak"] = column(integrated, f"{which} peak by integration", "m")
        variables[f"{which}_error"] = column(_error(exact, integrated, size), error, "1")
        if theory is not None:
            error = f"{which} peak, slow flow over harmonic balance, minus 1"
            variables[f"slow_{which}_peak"] = column(theory[which], f"{which} peak by the slow flow", "m")
            variables[f"slow_{which}_error"] = column(_error(theory[which], exact, size), error, "1")
    return xr.Dataset(variables)


def _error(approximate: Floats, exact: Floats, size: Floats) -> Floats:
    """Relative error; of the smallest that counts, where less than that is left, as of a sink at a node of the mode.

    Parameters
    ----------
    approximate, exact : ndarray
    size : ndarray
        Largest peak of the motion, of pipe or stroke [m].
    """
    least = _COUNTS * size
    small = np.maximum(np.abs(approximate), np.abs(exact)) <= least
    apart = np.where(small, approximate - exact, 0.0) / np.where(least > 0, least, 1.0)
    with np.errstate(divide="ignore", invalid="ignore"):
        return np.where(small, apart, approximate / exact - 1)


def _errors(table: xr.Dataset, prefix: str = "") -> Floats:
    """Sizes of the errors of pipe and, if there is one, stroke, shape (quantities, responses)."""
    names = [f"{prefix}{which}_error" for which in QUANTITIES]
    return np.abs(np.array([table[name].values for name in names if name in table]))


def _found(table: xr.Dataset) -> dict[str, Any]:
    found = {"points": int(table.sizes["comparison"]), "bound": EXACT_BOUND, **_largest(table)}
    if "slow_pipe_error" not in table:
        return found
    slow = {"pipe_bound": PIPE_BOUND, "relative_bound": RELATIVE_BOUND, **_largest(table, "slow_")}
    within = slow["largest_pipe_error"] <= PIPE_BOUND and slow["largest_relative_error"] <= RELATIVE_BOUND
    return found | {"slow_flow": slow | {"within_bounds": within}}


def _largest(table: xr.Dataset, prefix: str = "") -> dict[str, float]:
    errors = _errors(table, prefix).max(axis=1)
    return {f"largest_{which}_error": float(error) for which, error in zip(QUANTITIES, errors, strict=False)}


def _judged(table: xr.Dataset, places: list[str]) -> Check:
    """Harmonic balance and integration solve the same equations: they must agree."""
    name = "Harmonic balance and integration agree on stable responses"
    worst = _errors(table).max(axis=0)
    known = np.isfinite(worst)
    apart = known & (worst > EXACT_BOUND)
    if np.any(apart):
        where = "; ".join(f"{worst[i]:.1e} at {places[i]}" for i in np.flatnonzero(apart))
        return Check(name, FAIL, f"Peaks differ by more than {EXACT_BOUND:g}: {where}.")
    if not np.all(known):
        return Check(name, UNVERIFIED, f"{int(np.sum(~known))} of {len(places)} integrations did not finish.")
    detail = f"{len(places)} responses, {_PERIODS} periods each, largest difference of a peak {worst.max():.1e}"
    return Check(name, PASS, f"{detail}; bound {EXACT_BOUND:g}.")


def _measured(table: xr.Dataset, places: list[str]) -> Check:
    """How far the slow flow is off: theory beside the exact curve, its error is stated and nothing rests on it."""
    name = "The error of the slow flow against harmonic balance is known"
    pipe, stroke = _errors(table, "slow_")
    worst = f"largest error {pipe.max():.2%} for the pipe, {stroke.max():.2%} for the stroke"
    bounds = f"{PIPE_BOUND:.0%} for the pipe, {RELATIVE_BOUND:.0%} for the stroke"
    beyond = np.flatnonzero(~((pipe <= PIPE_BOUND) & (stroke <= RELATIVE_BOUND)))
    if not beyond.size:
        return Check(name, PASS, f"{len(places)} responses, {worst}; within its bounds of {bounds}.")
    worst_first = beyond[np.argsort(-np.maximum(pipe, stroke)[beyond])]
    where = "; ".join(f"at {places[i]} pipe {pipe[i]:.1%}, stroke {stroke[i]:.1%}" for i in worst_first[:_LISTED])
    where += f"; and {beyond.size - _LISTED} more" if beyond.size > _LISTED else ""
    limit = f"Beyond its bounds of {bounds} the slow flow is at its limit, and the exact curve stands in its place"
    return Check(name, PASS, f"{len(places)} responses, {worst}. {limit}: {where}.")
