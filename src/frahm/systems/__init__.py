"""Room `systems`: equations of motion as arrays (host modes, local elements, excitation)."""

from frahm.systems.excitation import detuning_of, excitation_frequency, excitation_window
from frahm.systems.parameters import (
    PARAMETERS,
    Derivative,
    check_parameter,
    derivative_of,
    parameter_value,
    with_parameters,
)
from frahm.systems.pipe import as_system, build_system, stress_row, stress_rows
from frahm.systems.system import Element, System

__all__ = [
    "PARAMETERS",
    "Derivative",
    "Element",
    "System",
    "as_system",
    "build_system",
    "check_parameter",
    "derivative_of",
    "detuning_of",
    "excitation_frequency",
    "excitation_window",
    "parameter_value",
    "stress_row",
    "stress_rows",
    "with_parameters",
]
