"""What a step of the analysis hands over, and what the steps after it can read."""

from __future__ import annotations

import functools
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any

from frahm.attractors import driven_at
from frahm.case import Case
from frahm.errors import ParameterError
from frahm.loads import OperatingRange, operating_range
from frahm.slow_flow import SlowFlow, slow_flow_of
from frahm.systems import System, build_system

if TYPE_CHECKING:
    import xarray as xr

PASS, FAIL, UNVERIFIED = "pass", "fail", "unverified"


@dataclass(frozen=True)
class Check:
    """One statement that was put to the test.

    Attributes
    ----------
    name : str
        What was tested.
    status : str
        "pass", "fail" or "unverified".
    detail : str
        The numbers behind the status, as a sentence.
    """

    name: str
    status: str
    detail: str


@dataclass(frozen=True)
class Section:
    """What one step of the analysis found.

    Attributes
    ----------
    results : dict
        Numbers for the summary, by name; names of different steps are merged.
    data : dict of Dataset
        Arrays by name.
    checks : tuple of Check
        What was tested.
    unverified : tuple of str
        Sentences on what the step was asked for and could not vouch for.
    notes : tuple of str
        Sentences on what a reader must know: limits of the method, what was skipped and why.
    """

    results: dict[str, Any] = field(default_factory=dict)
    data: dict[str, xr.Dataset] = field(default_factory=dict)
    checks: tuple[Check, ...] = ()
    unverified: tuple[str, ...] = ()
    notes: tuple[str, ...] = ()


@dataclass(frozen=True)
class Work:
    """The case under analysis, and what the steps before found.

    Attributes
    ----------
    case : Case
        The case.
    done : Section
        Everything the finished steps found, merged.
    """

    case: Case
    done: Section = field(default_factory=Section)

    @functools.cached_property
    def system(self) -> System:
        """Equations of motion of the case."""
        return build_system(self.case)

    @functools.cached_property
    def range(self) -> OperatingRange:
        """Range of operation of the case."""
        return operating_range(self.case)

    def driven(self, frequency: float) -> System:
        """The system as the wind drives it at Omega = `frequency` [rad/s]."""
        return driven_at(self.system, self.range)(frequency)

    @functools.cached_property
    def theory(self) -> SlowFlow | str:
        """Slow flow of the case over its range, or the sentence that says why it does not apply."""
        if self.range.over_wind and not isinstance(self.slow_flow, str):
            return "It knows one lift for all frequencies, and here the lift follows the wind."
        return self.slow_flow

    @functools.cached_property
    def slow_flow(self) -> SlowFlow | str:
        """Slow flow of the case, or the sentence that says why it does not apply."""
        if not self.case.absorbers:
            return "The pipe carries no absorber, so that there is no slow flow to follow."
        try:
            slow = slow_flow_of(self.system, self.case.analysis.form)
        except ParameterError as error:
            return f"The slow flow takes {error.allowed}."
        return slow if slow.kappa > 0 else "The spring of the sink has no stiffness, so that the motion is linear."

    def with_section(self, section: Section) -> Work:
        """The work with one more step finished."""
        return Work(self.case, merged(self.done, section))


def merged(first: Section, second: Section) -> Section:
    """Both sections in one; mappings inside `results` are joined, never replaced, and no doubt is told twice."""
    results = dict(first.results)
    for name, value in second.results.items():
        old = results.get(name)
        results[name] = {**old, **value} if isinstance(old, dict) and isinstance(value, dict) else value
    return Section(
        results=results,
        data={**first.data, **second.data},
        checks=first.checks + second.checks,
        unverified=tuple(dict.fromkeys(first.unverified + second.unverified)),
        notes=first.notes + second.notes,
    )
