"""The pipe of a case as a `System`."""

from __future__ import annotations

from frahm.case import Case
from frahm.systems.system import System


def build_system(case: Case) -> System:
    """Equations of motion of a case."""
    raise NotImplementedError


def as_system(case_or_system: Case | System) -> System:
    """Return the `System` of a case, or the system itself."""
    return case_or_system if isinstance(case_or_system, System) else build_system(case_or_system)
