"""Room `systems`: equations of motion as arrays (host modes, local elements, excitation)."""

from frahm.systems.excitation import detuning_of, excitation_frequency, excitation_window
from frahm.systems.pipe import as_system, build_system
from frahm.systems.system import Element, Law, System

__all__ = [
    "Element",
    "Law",
    "System",
    "as_system",
    "build_system",
    "detuning_of",
    "excitation_frequency",
    "excitation_window",
]
