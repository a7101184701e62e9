"""The parameters a visitor can change: one table that feeds sliders, number fields and error messages."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import Any

from frahm.case import Case, field_table
from frahm.errors import ParameterError, check_number
from frahm.units import si_value

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

    @property
    def key(self) -> str:
        """Name without dots, for identifiers in HTML."""
        return self.name.replace(".", "-")


def shown(value: float) -> str:
    """Number as a field shows it."""
    return f"{value:.6g}"


def read_number(text: str, unit: str, name: str) -> float:
    """Number of a field in its unit: a plain number, or text with a unit."""
    try:
        return float(text)
    except ValueError:
        return si_value(text, unit, name=name)


def with_sink(case: Case, name: str, value: float) -> Case:
    """Case whose sink has another kappa, xi2 or rho2."""
    change: dict[str, Any] = {name: value}
    return case.with_absorber(**change)


def _absorber_control(name: str, title: str, symbol: str, unit: str, span: Span, above_zero: bool) -> Control:
    def changed(case: Case, given: float | str) -> Case:
        bounds: dict[str, float] = {"above": 0} if above_zero else {"at_least": 0}
        number = check_number(name, read_number(str(given), unit, name), unit=unit or "-", **bounds)
        return with_sink(case, name, number)

    return Control(
        name, title, symbol, unit, lambda case: case.absorbers[0].normalised(case.pipe.mass)[name], changed,
        lambda case: span.holding(case.absorbers[0].normalised(case.pipe.mass)[name]),
    )  # fmt: skip


def _field_control(path: str, span: Callable[[float], Span]) -> Control:
    """Control of a field of the case; title, symbol, unit and bounds come from its metadata."""
    facts = field_table(Case)[path]
    section, field = path.split(".")

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

    return Control(path, facts.title, facts.symbol, facts.unit, value, changed, ends)


CONTROLS = (
    _absorber_control("kappa", "Cubic stiffness of the sink", "κ", "1/(m^2 s^2)", Span(1.0, 1e4, True), True),
    _absorber_control("xi2", "Damping of the sink", "ξ₂", "1/s", Span(5e-4, 0.2, True), False),
    _absorber_control("rho2", "Mass ratio of the sink", "ρ₂", "", Span(2e-3, 0.1, True), True),
    _field_control("wind.speed", lambda speed: Span(0.5 * speed, 2 * speed, False)),
    _field_control("pipe.frequency", lambda omega: Span(0.7 * omega, 1.3 * omega, False)),
    _field_control("pipe.damping_ratio", lambda zeta: Span(0.0, max(0.02, 2 * zeta), False)),
)
DETUNING = "detuning"


@dataclass(frozen=True)
class Reading:
    """What the fields of the page say.

    Attributes
    ----------
    case : Case
        The case with every value that could be read.
    detuning : float
        Where the motion is looked at [rad/s].
    problems : dict
        By control: the message beside its field; empty if all is well.
    """

    case: Case
    detuning: float
    problems: dict[str, str]


def reading(base: Case, texts: Mapping[str, Any]) -> Reading:
    """Apply the texts of the fields to a case; a field that still shows the value of the case leaves it untouched."""
    case, problems = base, {}
    for control in CONTROLS:
        text = str(texts.get(control.name, "")).strip()
        if text == shown(control.value(base)):
            continue
        try:
            case = control.changed(case, text)
        except ParameterError as error:
            problems[control.name] = str(error)
    detuning = math.nan
    try:
        number = read_number(str(texts.get(DETUNING, "")).strip(), "rad/s", DETUNING)
        lo, hi = case.analysis.detuning
        detuning = check_number(DETUNING, number, at_least=lo, at_most=hi, unit="rad/s")
    except ParameterError as error:
        problems[DETUNING] = str(error)
    return Reading(case, detuning, problems)


def detuning_span(case: Case) -> Span:
    """Range of the detuning: the window of the analysis."""
    return Span(*case.analysis.detuning, False)
