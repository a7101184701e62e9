"""The wind: whether it can excite the pipe at all, what its coefficients are known for, and how far they shake it."""

from __future__ import annotations

import math
import re
from collections.abc import Iterator

import numpy as np

from frahm.case import Pipe
from frahm.loads import (
    forced_amplitude,
    lock_in_band,
    reynolds_number,
    site_winds,
    vortex_shedding,
    wind_excitation,
)
from frahm.loads.similarity import LOCK_IN_RATIOS
from frahm.plausibility.implausible import Implausible, Inputs
from frahm.plausibility.pipes import WATER

STRONGEST_WIND, STRONGEST_CURRENT = 70.0, 5.0  # [m/s]
STROUHAL = (0.1, 0.5)
LARGEST_LIFT = 1.0
LARGEST_AMPLITUDE = 1.0  # over the diameter
REYNOLDS = (300.0, 3e5)
_CONVERTED = 1e-13  # what the way from hertz and back may round
_BAND = "0.83 to 1.25 of a natural frequency, as in DNV-RP-C205 (quoted from memory)"


def judged_wind(inputs: Inputs) -> Iterator[Implausible]:
    """What is implausible about the wind and what it does."""
    yield from _speed(inputs)
    yield from _plain_frequencies(inputs)
    yield from _mode_reached(inputs)
    yield from _site(inputs)
    yield from _coefficients(inputs)
    yield from _tables(inputs)
    yield from _amplitude(inputs)


def _speed(inputs: Inputs) -> Iterator[Implausible]:
    wind = inputs.case.wind
    if wind.air_density > WATER:
        if wind.speed > STRONGEST_CURRENT:
            yield inputs.implausible("wind.speed", f"Currents stay below {STRONGEST_CURRENT:g} m/s, a rule of thumb.")
    elif wind.speed > STRONGEST_WIND:
        reason = f"A hurricane of category 5 (Saffir and Simpson) begins at {STRONGEST_WIND:g} m/s."
        yield inputs.implausible("wind.speed", reason, ["km/h"] if wind.speed / 3.6 <= STRONGEST_WIND else [])


def _mode_reached(inputs: Inputs) -> Iterator[Implausible]:
    """The wind of the case should shed near a natural frequency."""
    case, shed = inputs.case, vortex_shedding(inputs.case)
    natural = np.sort(case.pipe.modal.frequencies)
    ratios = shed.frequency / natural
    if np.any(_locks_in(ratios)):
        return
    path = _frequency_field(inputs)
    if path in inputs.values and inputs.bare(path) and _locks_in(shed.frequency_hz / case.pipe.frequency):
        return  # that is said of the frequency
    nearest = natural[int(np.argmin(np.abs(np.log(ratios))))]
    reason = (
        f"It sheds at {shed.frequency_hz:.4g} Hz, {shed.frequency / nearest:.3g} times the nearest natural frequency of"
        f" {nearest / (2 * math.pi):.4g} Hz; lock-in is expected at {_BAND}."
    )
    speeds = wind_excitation(case).speeds_of(float(nearest))
    reason += f" Resonance is at {float(speeds[0]):.3g} m/s." if speeds.size else ""
    if not isinstance(case.pipe, Pipe) and ratios[-1] > LOCK_IN_RATIOS[1]:
        reason += f" It is above all {natural.size} modes: higher ones may be missing."
    yield inputs.implausible("wind.speed", reason)


def _frequency_field(inputs: Inputs) -> str:
    pipe = inputs.case.pipe
    return "pipe.frequency" if isinstance(pipe, Pipe) else f"pipe.modes[{pipe.governing_mode - 1}].frequency"


def _plain_frequencies(inputs: Inputs) -> Iterator[Implausible]:
    """A natural frequency without a unit is in rad/s, where most are thought of in hertz.

    What is round in hertz was converted from them: so are the cases that frahm itself writes.
    """
    case, shed = inputs.case, vortex_shedding(inputs.case)
    for path, field in inputs.values.items():
        if (
            not re.fullmatch(r"pipe\.(modes\[\d+\]\.)?frequency", path)
            or not inputs.bare(path)
            or _is_round(field.value)
        ):
            continue
        reason = f"A plain number is in rad/s, so this is {field.value / (2 * math.pi):.4g} Hz"
        if path == _frequency_field(inputs) and _locks_in(shed.frequency_hz / case.pipe.frequency):
            reason += f"; the wind of {shed.speed:g} m/s sheds at {shed.frequency_hz:.4g} Hz"
        yield inputs.implausible(path, f"{reason}. A unit says which: {field.value:.6g} rad/s.", ["Hz"])


def _is_round(frequency: float) -> bool:
    hertz = frequency / (2 * math.pi)
    return math.isclose(hertz, float(f"{hertz:.6g}"), rel_tol=_CONVERTED)


def _site(inputs: Inputs) -> Iterator[Implausible]:
    """The winds of the site, and those asked about, should reach a mode, and no mode that is not modelled."""
    case, law = inputs.case, wind_excitation(inputs.case)
    natural = np.sort(case.pipe.modal.frequencies)
    first, last = law.speeds_of(LOCK_IN_RATIOS[0] * natural[0]), law.speeds_of(LOCK_IN_RATIOS[1] * natural[-1])
    windows = {"wind.range": case.wind.range, "analysis.wind": case.analysis.wind, "design.wind": None}
    windows["design.wind"] = None if case.design is None else case.design.wind
    for path, window in windows.items():
        if window is None:
            continue
        shed = law.frequency(np.clip(window, *law.speed_range))
        reaches = f"these winds shed at {shed[0] / (2 * math.pi):.3g} to {shed[1] / (2 * math.pi):.3g} Hz"
        if not np.any((natural * LOCK_IN_RATIOS[1] >= shed[0]) & (natural * LOCK_IN_RATIOS[0] <= shed[1])):
            named = ", ".join(f"{omega / (2 * math.pi):.3g}" for omega in natural)
            yield inputs.implausible(path, f"No mode is excited: {reaches}, and the modes are at {named} Hz ({_BAND}).")
        elif not isinstance(case.pipe, Pipe) and last.size and window[1] > float(last[-1]):
            reason = f"Higher modes may be missing: {reaches}, above all {natural.size} modes ({_BAND})."
            yield inputs.implausible(path, reason)
    if case.wind.range is not None and not case.wind.range[0] <= case.wind.speed <= case.wind.range[1]:
        reason = f"The site has winds of {case.wind.range[0]:g} to {case.wind.range[1]:g} m/s (wind.range)."
        yield inputs.implausible("wind.speed", reason)
    site = site_winds(case)[0]
    if case.wind.range is None and case.climate is not None and first.size and site[1] < float(first[0]):
        field = "climate.table" if case.climate.weibull is None else "climate.weibull.scale"
        path = next(path for path in inputs.values if path.startswith(field))
        reason = (
            f"Its strongest wind is {site[1]:.3g} m/s, and the lowest mode is excited from {float(first[0]):.3g} m/s on"
            f" ({_BAND}): there is nothing to count."
        )
        yield inputs.implausible(path, reason)


def _locks_in(ratio: np.ndarray | float) -> np.ndarray:
    return (np.asarray(ratio) >= LOCK_IN_RATIOS[0]) & (np.asarray(ratio) <= LOCK_IN_RATIOS[1])


def _coefficients(inputs: Inputs) -> Iterator[Implausible]:
    case, shed = inputs.case, vortex_shedding(inputs.case)
    if not STROUHAL[0] <= shed.strouhal <= STROUHAL[1]:
        reason = (
            f"At the wind of the case it is {shed.strouhal:.4g}; circular cylinders have 0.18 to 0.2, in the critical"
            f" range up to {STROUHAL[1]:g}."
        )
        yield inputs.implausible("wind.strouhal", reason)
    if shed.lift_coefficient > LARGEST_LIFT or shed.lift_coefficient == 0:
        reason = (
            f"At the wind of the case its amplitude is {shed.lift_coefficient:.4g}; EN 1991-1-4 has 0.7 at most,"
            " and 0.2 at least."
        )
        yield inputs.implausible("wind.lift_coefficient", reason)
    numbers = [
        f"wind.{name}" for name in ("lift_coefficient", "strouhal") if isinstance(getattr(case.wind, name), float)
    ]
    speed = _resonance(inputs)
    Re = reynolds_number(speed, case.pipe.diameter, case.wind.viscosity)
    if numbers and not REYNOLDS[0] <= Re <= REYNOLDS[1]:
        reason = (
            f"One number for every wind, and Re = {Re:.3g} at {speed:.3g} m/s: beyond {REYNOLDS[1]:g} the lift falls"
            " to a third (EN 1991-1-4) and the Strouhal number scatters."
            if Re > REYNOLDS[1]
            else f"Re = {Re:.3g} at {speed:.3g} m/s: St = 0.2 holds from {REYNOLDS[0]:g} on (Facchinetti et al.)."
        )
        yield inputs.implausible(numbers[0], reason)


def _resonance(inputs: Inputs) -> float:
    """Wind in resonance with the governing mode [m/s]; that of the case where the tables do not reach it."""
    speed = lock_in_band(inputs.case).resonance
    return inputs.case.wind.speed if math.isnan(speed) else speed


def _tables(inputs: Inputs) -> Iterator[Implausible]:
    """A table over the Reynolds number that ends inside the band of lock-in of the governing mode."""
    case = inputs.case
    law = wind_excitation(case)
    ends = [law.speeds_of(ratio * case.pipe.frequency) for ratio in LOCK_IN_RATIOS]
    for side, (speeds, word) in enumerate(zip(ends, ("begins", "ends"), strict=True)):
        if speeds.size:
            continue
        edge = law.speed_range[side]
        for field, bounds in case.wind.speed_ranges(case.pipe.diameter).items():
            if bounds[side] == edge:
                Re = reynolds_number(edge, case.pipe.diameter, case.wind.viscosity)
                reason = (
                    f"It {word} at Re = {Re:.3g}, {edge:.3g} m/s, inside the band of lock-in of the pipe ({_BAND});"
                    " what is beyond is not known, and is not extrapolated."
                )
                yield inputs.implausible(f"wind.{field}", reason)


def _amplitude(inputs: Inputs) -> Iterator[Implausible]:
    """The bare pipe in resonance by the closed form A = F_L/(2 m zeta omega^2), with the lift of the resonant wind."""
    case, pipe = inputs.case, inputs.case.pipe
    shed = vortex_shedding(case, _resonance(inputs))
    lift = shed.lift / pipe.length * abs(float(pipe.modal.lift_lengths[0]))
    ratio = forced_amplitude(lift, pipe.mass, pipe.damping_ratio, pipe.frequency) / pipe.diameter
    if LARGEST_AMPLITUDE < ratio < math.inf:
        reason = (
            f"In resonance at {shed.speed:.3g} m/s this lift alone moves the bare pipe by {ratio:.3g} diameters; a lift"
            " that does not feel the motion means nothing beyond about one: the formula of Griffin and Skop"
            " ends at 1.29 times the shape factor (quoted from memory)."
        )
        yield inputs.implausible("wind.lift_coefficient", reason)
