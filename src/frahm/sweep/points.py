"""One point of a study: its case, its system, its place on the frequency axis and its seed."""

from __future__ import annotations

import functools
from typing import Any

from frahm.case import Case
from frahm.loads import OperatingRange, frequency_range, operating_range, vortex_shedding
from frahm.slow_flow import slow_flow_of
from frahm.sweep.field_types import WIND, WINDOW, is_window
from frahm.sweep.study import Study
from frahm.systems import System, build_system, excitation_frequency, excitation_window, with_parameters

_PIPE = {"pipe_frequency": "frequency", "pipe_damping": "damping_ratio"}
_WIND = {"wind_speed": "speed", "lift_coefficient": "lift_coefficient"}
_ABSORBER = ("position", "rho2", "kappa", "xi2")


class StudyPoint:
    """One point of a study; what is needed of it is made on first use.

    Parameters
    ----------
    study : Study
    index : int
        Number of the point, the last axis running fastest.
    """

    def __init__(self, study: Study, index: int):
        self.study, self.index, self.values = study, index, study.values_at(index)

    @functools.cached_property
    def case(self) -> Case:
        """The case of the study with the values of this point."""
        case, values = self.study.case, self.values
        pipe = {field: values[axis] for axis, field in _PIPE.items() if axis in values}
        wind = {field: values[axis] for axis, field in _WIND.items() if axis in values}
        absorber: dict[str, Any] = {name: values[name] for name in _ABSORBER if name in values}
        if pipe:
            case = case.with_pipe(**pipe)
        if wind:
            case = case.with_wind(**wind)
        if absorber:
            case = case.with_absorber(**absorber, name=self.study.absorber or None)
        if "count" in values:
            case = case.with_equal_parts(int(values["count"]), name=self.study.absorber or None)
        return case

    @functools.cached_property
    def system(self) -> System:
        """Equations of motion, with the factor on the force."""
        system = build_system(self.case)
        factor = self.values.get("force")
        return system if factor is None else with_parameters(system, force=factor)

    @functools.cached_property
    def range(self) -> OperatingRange:
        """Range of operation of the case."""
        return operating_range(self.case)

    def asked_range(self, asked: Any) -> OperatingRange:
        """The range a quantity over a window is asked about: that of the case, or the window of detuning asked for."""
        if asked.detuning == WINDOW and "detuning" not in self.values:
            return self.range
        lo, hi = excitation_window(self.system, detuning=self.place(asked))
        return frequency_range(lo, hi, self.system.reference_frequency)

    @property
    def seed(self) -> int:
        """Seed of this point."""
        return self.study.seed_at(self.index)

    def place(self, asked: Any) -> float | tuple[float, float]:
        """Detuning, or window of it, a quantity is computed at [rad/s]."""
        if "detuning" in self.values:
            return self.values["detuning"]
        if asked.detuning == WINDOW:
            return self.range.detuning
        return float(vortex_shedding(self.case).detuning) if asked.detuning == WIND else asked.detuning

    def check(self) -> None:
        """Raise a ParameterError for what can be seen without computing."""
        for name, asked in self.study.asked.items():
            if name == "slow_flow":
                slow_flow_of(self.system, self.case.analysis.form)
            if name == "fatigue":
                continue
            place = self.place(asked)
            if is_window(place):
                excitation_window(self.system, detuning=place)
            else:
                excitation_frequency(self.system, detuning=place)  # type: ignore[arg-type]
