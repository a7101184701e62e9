"""From a row of a table to the case of one member, an elastic tube, and what of it was assumed."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Any

import numpy as np

from frahm.case import Case, load_case
from frahm.errors import ParameterError
from frahm.loads import excited_bands, lock_in_band, site_winds, wind_excitation
from frahm.screening.columns import BY_NAME, COLUMNS
from frahm.screening.ends import supports_of
from frahm.screening.reading import MemberRow
from frahm.structure.modes import MOST_MODES
from frahm.units import si_value

_FEWEST_MODES, _MOST_MODES = 3, 24
_CURVES = "en1991"  # Strouhal number and lift of one standard, made for one another
_JOINT_CURVE, _JOINT_THICKNESS = "T", 0.016  # [m]; reference thickness of tubular joints, secondary
# What holds without being said; columns of which nothing follows where they are left out are not among them.
_ASSUMED = (
    "youngs modulus", "density", "contained mass", "added mass", "lift", "wind speed", "lowest wind", "highest wind",
    "air density", "viscosity", "strouhal", "lift coefficient", "weibull scale", "s-n curve",
)  # fmt: skip
_ASSUMED_BESIDE = {
    "direction factor": "weibull scale", "stress concentration": "s-n curve", "design fatigue factor": "s-n curve",
    "static stress": "yield strength",
}  # fmt: skip


@dataclass(frozen=True)
class MemberCase:
    """A member as a case.

    Attributes
    ----------
    case : Case
        An elastic tube without absorbers in the winds of the site.
    ends : str
        As the table has them.
    assumed : dict of str to str
        What the table does not say, and what was taken.
    """

    case: Case
    ends: str
    assumed: dict[str, str]


def member_case(row: MemberRow) -> MemberCase:
    """The case of a member.

    Parameters
    ----------
    row : MemberRow
        One that could be read.

    Raises
    ------
    ParameterError
        If a value is out of bounds, or the ends are unknown.
    """
    values = dict(row.values)
    try:
        case = load_case(_data(values))
    except ParameterError as error:
        raise _in_words_of_the_table(error) from None
    if case.pipe.damping_ratio == 0:
        raise ParameterError("damping ratio", 0.0, "above 0", hint="Without damping nothing bounds the resonance.")
    case = _with_modes(case, "modes" in values)
    if "wind speed" not in values:
        case = case.with_wind(speed=_design_wind(case))
    assumed = {name: BY_NAME[name].default for name in _ASSUMED if name not in values}
    assumed |= {name: BY_NAME[name].default for name, beside in _ASSUMED_BESIDE.items()
                if name not in values and beside in values}  # fmt: skip
    if "s-n curve" in values:
        assumed["detail"] = _about_detail(case)
    if "highest wind" in values:
        assumed.pop("weibull scale", None) if "s-n curve" not in values else None
    else:
        assumed.pop("lowest wind", None)
    return MemberCase(case, _ends_in_words(values), assumed)


def _ends_in_words(values: dict[str, Any]) -> str:
    ends = values["ends"]
    return f"fixity {ends:g}" if isinstance(ends, float) else ends


def _data(values: dict[str, Any]) -> dict[str, Any]:
    """The case as plain data, from the cells of a row."""
    sections: dict[str, Any] = {"name": values["name"], "title": str(values.get("title", ""))}
    for column in COLUMNS:
        section, _, name = column.path.partition(".")
        if not name or column.name not in values or column.name in _MADE:
            continue
        sections.setdefault(section, {})[name] = values[column.name]
    wind = {"strouhal": _CURVES, "lift_coefficient": _CURVES} | sections.get("wind", {})
    pipe = {"kind": "tube", **sections["pipe"], "supports": _supports(values)}
    sections |= {"pipe": pipe, "wind": {"speed": 1.0, **_range(values), **wind}}
    if "weibull scale" in values:
        sections["climate"] = sections["climate"] | _weibull(values)
    else:
        sections.pop("climate", None)
        sections.pop("fatigue", None)
    if "s-n curve" not in values:
        sections.pop("fatigue", None)
    if "fatigue" in sections:
        sections["fatigue"]["thickness"] = pipe["wall"]
        if values["s-n curve"] == _JOINT_CURVE:
            sections["fatigue"]["reference_thickness"] = _JOINT_THICKNESS
    return sections


_MADE = ("ends", "rotational stiffness", "lowest wind", "highest wind", "weibull scale", "weibull shape")


def _weibull(values: dict[str, Any]) -> dict[str, Any]:
    missing = [name for name in ("weibull shape", "design life") if name not in values]
    if missing:
        raise ParameterError(missing[0], "nothing", "a value beside a weibull scale")
    climate = {"weibull": {"scale": values["weibull scale"], "shape": values["weibull shape"]}}
    return climate | {"duration": values["design life"]}


def _range(values: dict[str, Any]) -> dict[str, Any]:
    if "highest wind" not in values:
        if "lowest wind" in values:
            raise ParameterError("highest wind", "nothing", "a value beside a lowest wind")
        return {}
    return {"range": [values.get("lowest wind", 0.0), values["highest wind"]]}


def _supports(values: dict[str, Any]) -> list[dict[str, Any]]:
    def si(name: str, otherwise: float = 0.0) -> float:
        value = values.get(name, otherwise)
        return si_value(value, BY_NAME[name].unit, name=name) if isinstance(value, str) else value

    outer, length = si("diameter"), si("length")
    inner = outer - 2 * si("wall thickness")
    stiffness = si("youngs modulus", _modulus()) * math.pi / 64 * (outer**4 - inner**4)
    return supports_of(values["ends"], length, stiffness, si("rotational stiffness"))


def _modulus() -> float:
    """Young's modulus of a tube that names none [Pa]."""
    from frahm.case import Tube

    return float(Tube.model_fields["youngs_modulus"].default)


def _in_words_of_the_table(error: ParameterError) -> ParameterError:
    """A refusal of the case with the name of the column in place of the field."""
    names = {column.path: column.name for column in COLUMNS if column.path} | {"wind.range": "highest wind"}
    return ParameterError(names.get(error.name, error.name), error.value, error.allowed, hint=error.hint)


def _with_modes(case: Case, given: bool) -> Case:
    """The case with every mode that winds of the site excite, at least three; three where nothing bounds them."""
    highest = site_winds(case)[0][1]
    if given or math.isinf(highest):
        return case
    count = _FEWEST_MODES
    while count < _MOST_MODES and _lowest_wind(case, case.pipe.modal.count) <= highest:
        count = min(2 * count, _MOST_MODES)
        case = case.with_pipe(mode_count=count)
    needed = 1 + sum(_lowest_wind(case, mode) <= highest for mode in range(1, case.pipe.modal.count + 1))
    return case.with_pipe(mode_count=min(max(needed, _FEWEST_MODES), count))


def lacks_modes(case: Case) -> bool:
    """Whether winds of the site excite a mode above those that take part; where nothing bounds them that is open."""
    highest, count = site_winds(case)[0][1], case.pipe.modal.count
    if math.isinf(highest) or _lowest_wind(case, count) > highest:
        return False
    return count >= MOST_MODES or _lowest_wind(case.with_pipe(mode_count=count + 1), count + 1) <= highest


def _lowest_wind(case: Case, mode: int) -> float:
    """Lowest wind that excites a mode [m/s]; infinite if none of those the tables are given for does."""
    law, band = wind_excitation(case), excited_bands(case)[mode - 1]
    speeds = law.speeds_of(band[0])
    if speeds.size:
        return float(np.min(speeds))
    low, high = law.speed_range
    inside = [U for U in (low, high) if 0 < U < math.inf and band[0] <= float(law.frequency(U)) <= band[1]]
    return min(inside, default=math.inf)


def _design_wind(case: Case) -> float:
    """The wind of the site nearest to the resonance of the first mode [m/s], as far as the tables of the case reach."""
    law, (site, _) = wind_excitation(case), site_winds(case)
    low, high = max(site[0], law.speed_range[0]), min(site[1], law.speed_range[1])
    resonance = lock_in_band(case).resonance
    if math.isnan(resonance):
        resonance = high if math.isfinite(high) else low
    speed = min(max(resonance, low), high)
    if not speed > 0:
        raise ParameterError("highest wind", site[1], "winds that the Strouhal number and the lift are given for")
    return speed


def _about_detail(case: Case) -> str:
    fatigue = case.fatigue
    if fatigue is None:
        return "not counted, because there is no climate"
    reference = f"{1e3 * fatigue.reference_thickness:g} mm"
    return f"where the stress is largest; its thickness is that of the wall, against {reference} (secondary)"
