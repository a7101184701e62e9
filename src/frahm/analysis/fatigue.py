"""Step `fatigue`: damage over the wind climate, with and without absorbers, where a case asks for it."""

from __future__ import annotations

import dataclasses

import numpy as np

from frahm.analysis.section import FAIL, PASS, UNVERIFIED, Check, Section, Work
from frahm.assessment import (
    FatigueDamage,
    damage_of_modes,
    doubts_of_modes,
    rainflow_cycles,
    total_damage,
    turning_points,
)
from frahm.assessment.detail import Detail, detail_of
from frahm.assessment.linear_damage import linear_pipe
from frahm.errors import ParameterError
from frahm.harmonic_balance import linear_response
from frahm.systems import build_system
from frahm.time_integration import integrate

_PERIODS, _PER_PERIOD = 40, 32
_COUNTED = "Counted cycles of a constant amplitude give the closed-form damage"
_AGREES = 1e-3  # damage grows with up to the fifth power of a stress integrated to 1e-7


def fatigue(work: Work) -> Section:
    """Fatigue damage, if the case has the sections `climate` and `fatigue`."""
    if work.case.fatigue is None:
        return Section()
    try:
        parts = damage_of_modes(work.case)
    except ParameterError as refused:
        return Section(unverified=(f"The fatigue damage could not be counted: {refused}",))
    found = parts[0]
    modes = [_mode(part) for part in parts[1:]]
    return Section(
        results={"fatigue": _summary(found) | total_damage(parts) | {"other_modes": modes}},
        data={"fatigue": found.to_dataset()},
        checks=_closed_form(found),
        unverified=doubts_of_modes(parts),
        notes=found.notes,
    )


def _mode(part: FatigueDamage) -> dict[str, object]:
    """Damage of another mode over the winds that excite it."""
    return {
        "mode": part.case.pipe.governing_mode,
        "wind_speeds": [float(part.lower[0]), float(part.upper[-1])],
        "damage_with": part.damage_with,
        "damage_without": part.damage_without,
    }


def _summary(found: FatigueDamage) -> dict[str, object]:
    factor = found.design_fatigue_factor
    return {
        "damage_with": found.damage_with,
        "damage_without": found.damage_without,
        "damage_with_weighted": found.damage_with_weighted,
        "design_fatigue_factor": factor,
        "utilisation_with": factor * found.damage_with,
        "utilisation_without": factor * found.damage_without,
        "life_years": found.life_years,
        "life_years_without": found.life_years_without,
        "duration_years": found.duration_years,
        "locked_in_with": found.locked_in_with,
        "locked_in_without": found.locked_in_without,
        "outside_without": found.outside_without,
        "lock_in": list(found.lock_in),
        "curve": found.settings["curve"],
        "section": found.section,
        "stress_range_with": float(np.max(found.range_with, initial=0.0)),
        "stress_range_without": found.stress_range_without,
        "wind_speeds": [float(found.lower[0]), float(found.upper[-1])],
        "bins": int(found.speeds.size),
        "persistence": dataclasses.asdict(found.persistence),
        "verified": found.verified,
    }


def _closed_form(found: FatigueDamage) -> tuple[Check, ...]:
    """The bare pipe integrated at its worst wind and rainflow counted, against n/N(S) of its closed-form amplitude."""
    case = found.case.without_absorbers()
    pipe = linear_pipe(case)
    if pipe is None or not pipe.decays:
        return ()
    speed = float(found.speeds[np.argmax(found.range_without)])
    at = detail_of(case)
    if found.section is not None:
        at = Detail(at.curve, at.factor, case.pipe.modal.stress(found.section), found.section)
    system = build_system(case.with_wind(speed=speed))
    W = float(pipe.excitation.frequency(speed))
    (X,) = linear_response(system, np.array([W]))
    state = np.column_stack([X.real, (1j * W * X).real]).ravel()
    history = integrate(
        system, frequency=W, periods=_PERIODS, initial_state=state, samples_per_period=_PER_PERIOD, tolerance=1e-9
    )
    if not history.outcome.ok:
        return (Check(_COUNTED, UNVERIFIED, f"Without absorbers at {speed:.4g} m/s: {history.outcome.value}"),)
    points = turning_points(history.x @ at.row, history.v @ at.row, float(history.time[1]))[1:-1]
    whole = points[: points.size - (points.size + 1) % 2]  # from an extreme to one of the same side: whole cycles
    counted = rainflow_cycles(whole).damage(at.curve, at.factor)
    cycles = (whole.size - 1) / 2
    closed = float(pipe.rate(np.array([speed]), at)[0]) * cycles * 2 * np.pi / W
    right = cycles in (_PERIODS - 1, _PERIODS)
    error = abs(counted / closed - 1) if closed > 0 else abs(counted)
    detail = (
        f"Without absorbers at {speed:.4g} m/s: {cycles:g} cycles, integrated and rainflow counted, differ in"
        f" damage by {error:.1e} from the closed form."
    )
    return (Check(_COUNTED, PASS if right and error <= _AGREES else FAIL, detail),)
