"""The parameters a visitor can change: one table that feeds sliders, number fields and error messages."""

from __future__ import annotations

import math
import re
from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass
from typing import Any

from frahm.case import Case, CubicLaw, Pipe, PolynomialLaw, TransverseSpringsLaw, Tube, field_table
from frahm.case.quantities import Label
from frahm.errors import ParameterError, check_number
from frahm.units import si_value
from frahm.web.scope import DETUNING, PLACE, Axis

STEPS = 1000  # positions of a slider


@dataclass(frozen=True)
class Span:
    """Range of a slider; what is typed may lie outside of it.

    Attributes
    ----------
    low, high : float
        Ends of the slider, in the unit of the field.
    logarithmic : bool
        Whether equal steps are equal factors.
    """

    low: float
    high: float
    logarithmic: bool

    def holding(self, value: float) -> Span:
        """Span that holds a value too."""
        if self.logarithmic and value <= 0:
            return self
        return Span(min(self.low, value), max(self.high, value), self.logarithmic)

    def position(self, value: float) -> int:
        """Nearest position of the slider."""
        low, high, at = self.low, self.high, value
        if self.logarithmic:
            low, high, at = math.log(low), math.log(high), math.log(max(value, self.low))
        return min(STEPS, max(0, round(STEPS * (at - low) / (high - low))))


@dataclass(frozen=True)
class Control:
    """One parameter.

    Attributes
    ----------
    name : str
        Identifier on the page, and the name in error messages.
    title, symbol, unit : str
        As in the table of fields of a case.
    value : callable
        Value in a case [unit].
    changed : callable
        Case with another value; raises `ParameterError`.
    span : callable
        Range of the slider for a case.
    """

    name: str
    title: str
    symbol: str
    unit: str
    value: Callable[[Case], float]
    changed: Callable[[Case, float | str], Case]
    span: Callable[[Case], Span]


def shown(value: float) -> str:
    """Number as a field shows it."""
    return f"{value:.6g}"


def read_number(text: str, unit: str, name: str) -> float:
    """Number of a field in its unit: a plain number, or text with a unit."""
    try:
        return float(text)
    except ValueError:
        return si_value(text, unit, name=name)


def with_law(case: Case, name: str, value: Any) -> Case:
    """Case whose first absorber has another value in a field of its force law."""
    first, *others = case.to_dict()["absorbers"]
    changed = first | {"law": first["law"] | {name: value}}
    return Case(**case.to_dict() | {"absorbers": [changed, *others]})


def with_sink(case: Case, name: str, value: float) -> Case:
    """Case whose first absorber has another kappa, xi2 or rho2."""
    change: dict[str, Any] = {name: value}
    return case.with_absorber(**change)


def _normalised(
    name: str, title: str, symbol: str, unit: str, span: Callable[[Case, float], Span], above_zero: bool
) -> Control:
    """Control of a value of the first absorber over the mass of the pipe."""

    def value(case: Case) -> float:
        return case.absorbers[0].normalised(case.pipe.mass)[name]

    def changed(case: Case, given: float | str) -> Case:
        bounds: dict[str, float] = {"above": 0} if above_zero else {"at_least": 0}
        number = check_number(name, read_number(str(given), unit, name), unit=unit or "-", **bounds)
        return with_sink(case, name, number)

    return Control(name, title, symbol, unit, value, changed, lambda case: span(case, value(case)).holding(value(case)))


def _law_control(kind: str, field: str) -> Control:
    """Control of a field of the force law of the first absorber."""
    facts = field_table(Case)[f"absorbers[].law({kind}).{field}"]
    name = f"law.{field}"

    def value(case: Case) -> float:
        return float(getattr(case.absorbers[0].law, field))

    def changed(case: Case, given: float | str) -> Case:
        return with_law(case, field, read_number(str(given), facts.unit, name))

    def span(case: Case) -> Span:
        if value(case) or not isinstance(case.absorbers[0].law, TransverseSpringsLaw):
            return _around(value(case))
        springs = case.absorbers[0].law  # without pretension: as much as draws them out by a tenth, either way
        return Span(-0.1 * springs.stiffness * springs.length, 0.1 * springs.stiffness * springs.length, False)

    return Control(name, facts.title, facts.symbol, facts.unit, value, changed, span)


def _coefficient_control(power: int) -> Control:
    """Control of a coefficient of a polynomial spring."""
    name, unit = f"law.c{power}", "N/m" if power == 1 else f"N/m^{power}"
    kind = {1: "Linear", 2: "Quadratic", 3: "Cubic"}.get(power, f"Coefficient of the power {power}:")

    def value(case: Case) -> float:
        return float(case.absorbers[0].law.coefficients[power - 1])  # type: ignore[union-attr]

    def changed(case: Case, given: float | str) -> Case:
        coefficients = list(case.absorbers[0].law.coefficients)  # type: ignore[union-attr]
        coefficients[power - 1] = read_number(str(given), unit, name)
        return with_law(case, "coefficients", coefficients)

    return Control(
        name, f"{kind} stiffness", f"c{'₀₁₂₃₄₅₆₇₈₉'[power % 10] if power < 10 else power}", unit, value, changed,
        lambda case: _around(value(case)),
    )  # fmt: skip


def _around(value: float) -> Span:
    """A decade to both sides of a positive value; for a negative one as far again beyond zero."""
    if value > 0:
        return Span(value / 10, 10 * value, True)
    return Span(2 * value, -2 * value, False)


def _position_control() -> Control:
    """Control of the place of the first absorber on an elastic pipe."""
    facts = field_table(Case)["absorbers[].position"]

    def value(case: Case) -> float:
        where = case.absorbers[0].position
        return float(case.pipe.modal.largest or 0.0) if where is None else where

    def changed(case: Case, given: float | str) -> Case:
        return case.with_absorber(position=read_number(str(given), "m", "position"))

    return Control(
        "position", facts.title, facts.symbol, "m", value, changed, lambda case: Span(0.0, case.pipe.length, False)
    )


def _field_control(path: str, span: Callable[[float], Span]) -> Control:
    """Control of a field of the case; title, symbol, unit and bounds come from its metadata."""
    facts = field_table(Case)[path]
    section, field = path.split(".")
    section = section.removesuffix("(tube)")

    def value(case: Case) -> float:
        return float(getattr(getattr(case, section), field))

    def changed(case: Case, given: float | str) -> Case:
        try:
            number: float | str = float(given)
        except ValueError:
            number = given
        change = case.with_pipe if section == "pipe" else case.with_wind
        return change(**{field: number})

    def ends(case: Case) -> Span:
        return span(value(case)).holding(value(case))

    return Control(f"{section}.{field}", facts.title, facts.symbol, facts.unit, value, changed, ends)


def _damping_span(case: Case, value: float) -> Span:
    """Loss factors xi2/(rho2 omega) of the absorber from 0.005 to 2."""
    scale = case.absorbers[0].normalised(case.pipe.mass)["rho2"] * case.pipe.frequency
    return Span(5e-3 * scale, 2 * scale, True)


def _stiffness_span(case: Case, value: float) -> Span:
    return Span(value / 300, 30 * value, True)


def _mass_span(case: Case, value: float) -> Span:
    return Span(2e-3, 0.1, True)  # a ratio


_KAPPA = _normalised("kappa", "Cubic stiffness of the sink", "κ", "1/(m^2 s^2)", _stiffness_span, True)
_XI2, _RHO2 = (
    {word: _normalised(name, f"{title} of the {word}", symbol, unit, span, above_zero) for word in ("sink", "absorber")}
    for name, title, symbol, unit, span, above_zero in (
        ("xi2", "Damping", "ξ₂", "1/s", _damping_span, False),
        ("rho2", "Mass ratio", "ρ₂", "", _mass_span, True),
    )
)
_WIND = _field_control("wind.speed", lambda speed: Span(0.5 * speed, 2 * speed, False))
_FREQUENCY = _field_control("pipe.frequency", lambda omega: Span(0.7 * omega, 1.3 * omega, False))
_RATIO, _TUBE_RATIO = (
    _field_control(f"{pipe}.damping_ratio", lambda zeta: Span(0.0, 10 * zeta if zeta else 0.02, False))
    for pipe in ("pipe", "pipe(tube)")
)
_WALL = _field_control("pipe(tube).wall", lambda wall: Span(0.5 * wall, 1.5 * wall, False))


def controls_of(case: Case) -> tuple[Control, ...]:
    """The parameters of a case that can be changed on the page: of its first absorber, the wind and the pipe."""
    return (*_absorber_controls(case), _WIND, *_pipe_controls(case))


def _absorber_controls(case: Case) -> tuple[Control, ...]:
    if not case.absorbers:
        return ()
    law = case.absorbers[0].law
    place = (_position_control(),) if isinstance(case.pipe, Tube) else ()
    if isinstance(law, CubicLaw):
        return (_KAPPA, _XI2["sink"], _RHO2["sink"], *place)
    spring: list[Control]
    if isinstance(law, PolynomialLaw):
        spring = [_coefficient_control(power) for power, c in enumerate(law.coefficients, 1) if c]
    else:
        names = [name for name in type(law).model_fields if name not in ("kind", "damping")]
        spring = [_law_control(law.kind, name) for name in names]
    return (*spring, _XI2["absorber"], _RHO2["absorber"], *place)


def _pipe_controls(case: Case) -> tuple[Control, ...]:
    if isinstance(case.pipe, Pipe):
        return _FREQUENCY, _RATIO
    if isinstance(case.pipe, Tube):
        return (_WALL,) if case.pipe.damping_ratios else (_WALL, _TUBE_RATIO)
    return ()  # the modes of a table belong together


_SAME = 1e-12  # relative difference of two numbers that are the same but for rounding
_LONGEST = Label().longest  # a title
_CHANGED = re.compile(r"\s*\(changed: ([^()]*)\)$")


@dataclass(frozen=True)
class Reading:
    """What the fields of the page say.

    Attributes
    ----------
    case : Case
        The case with every value that could be read; its title names those that differ from what was opened.
    at : float
        Where on the axis of the response the motion is looked at: detuning [rad/s], or wind speed [m/s].
    problems : dict
        By control: the message beside its field; empty if all is well.
    """

    case: Case
    at: float
    problems: dict[str, str]

    @property
    def axis(self) -> Axis:
        """What the response is drawn over."""
        return Axis(self.case)


def changed_title(title: str, names: Iterable[str]) -> str:
    """Title that says which values are not those it was given for; names it holds already are not said twice."""
    found = _CHANGED.search(title)
    before = found[1].split(", ") if found else []
    listed = _at_most(", ".join(dict.fromkeys([*before, *names])), _LONGEST // 2)
    changes = f" (changed: {listed})"
    return (_at_most(_CHANGED.sub("", title), _LONGEST - len(changes)) + changes).strip()


def _at_most(text: str, length: int) -> str:
    return text if len(text) <= length else text[: length - 1] + "…"


def reading(base: Case, texts: Mapping[str, Any]) -> Reading:
    """Apply the texts of the fields to a case; a field that still shows the value of the case leaves it untouched."""
    case, changed, problems = base, [], {}
    for control in controls_of(base):
        text, value = str(texts.get(control.name, "")).strip(), control.value(base)
        if text == shown(value):
            continue
        try:
            other = control.changed(case, text)
        except ParameterError as error:
            problems[control.name] = str(error)
            continue
        if not math.isclose(control.value(other), value, rel_tol=_SAME):
            case = other
            changed.append(control.name)
    if changed:
        case = case.with_name(base.name, changed_title(base.title, changed))
    axis, at = Axis(case), math.nan
    try:
        number = read_number(str(texts.get(axis.name, "")).strip(), axis.unit, axis.name)
        lo, hi = axis.ends
        at = check_number(axis.name, number, at_least=lo, at_most=hi, unit=axis.unit)
    except ParameterError as error:
        problems[axis.name] = str(error)
    return Reading(case, at, problems)


def field_texts(case: Case, at: float) -> dict[str, str]:
    """Texts of all fields."""
    return {control.name: shown(control.value(case)) for control in controls_of(case)} | {Axis(case).name: shown(at)}


def spans(case: Case) -> dict[str, Span]:
    """Ranges of all sliders."""
    axis = Axis(case)
    return {control.name: control.span(case) for control in controls_of(case)} | {axis.name: Span(*axis.shown, False)}


_HINTS = {
    "wind.speed": "of the case: the dotted line",
    "pipe.frequency": "or text with a unit, such as 0.78 Hz",
    DETUNING: "where the motion is looked at",
    PLACE: "where the motion is looked at, with the lift of this wind",
}
_GREEK = {"omega": "ω", "zeta": "ζ"}


def shown_symbol(control: Control) -> str:
    """Symbol of a control as the page writes it."""
    return _GREEK.get(control.symbol, control.symbol)


def field_facts(case: Case, at: float) -> list[dict[str, Any]]:
    """What the script of the page must know to build the fields and sliders, and to turn positions into numbers."""
    texts, ranges, axis = field_texts(case, at), spans(case), Axis(case)
    head = {control.name: (control.title, shown_symbol(control), control.unit) for control in controls_of(case)}
    head[axis.name] = ("Wind looked at", "U", axis.unit) if axis.over_wind else ("Detuning", "σ", axis.unit)
    return [
        {
            "name": name, "key": html_key(name), "title": title, "symbol": symbol,
            "unit": unit.replace("^2", "²").replace("^3", "³") or "-", "hint": _HINTS.get(name, ""),
            "text": texts[name], "low": ranges[name].low, "high": ranges[name].high,
            "logarithmic": ranges[name].logarithmic, "steps": STEPS,
        }
        for name, (title, symbol, unit) in head.items()
    ]  # fmt: skip


def html_key(name: str) -> str:
    """Name of a control without dots, for identifiers in HTML."""
    return name.replace(".", "-")
