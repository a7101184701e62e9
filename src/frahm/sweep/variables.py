"""What a sweep stores: names, units and codes of all variables."""

from __future__ import annotations

import enum
from dataclasses import dataclass
from typing import Any

import numpy as np

from frahm.attractors.attractor import KINDS
from frahm.sweep.field_types import is_window
from frahm.sweep.study import Study

ROOTS = 3
NOT_COMPUTED = -1
_KIND_CODES = ", ".join(f"{code} {kind}" for code, kind in enumerate(KINDS))
_VERIFIED_CODES = "0 unverified, 1 verified"


class Status(enum.IntEnum):
    """What became of a point."""

    PENDING = 0
    VERIFIED = 1
    UNVERIFIED = 2
    FAILED = 3


STATUS_CODES = ", ".join(f"{status.value} {status.name.lower()}" for status in Status)


@dataclass(frozen=True)
class Variable:
    """A variable over the axes of a study.

    Attributes
    ----------
    name, long_name, units : str
    codes : str
        What the whole numbers mean; empty for a real number or a count.
    dtype : str
        "f8" for a real number, "i4" or "i1" for a whole one.
    roots : bool
        Whether it has the further axis `root` of length 3.
    headline : bool
        Whether it is what one compares points by: the smaller the better.
    """

    name: str
    long_name: str
    units: str = "1"
    codes: str = ""
    dtype: str = "f8"
    roots: bool = False
    headline: bool = False

    @property
    def blank(self) -> float | int:
        """Value where nothing is known."""
        return float("nan") if self.dtype == "f8" else NOT_COMPUTED

    def array(self, points: int) -> np.ndarray:
        """Array of blanks for a number of points."""
        return np.full((points, ROOTS) if self.roots else (points,), self.blank, dtype=self.dtype)

    @property
    def attributes(self) -> dict[str, Any]:
        """Attributes in the store."""
        missing: dict[str, Any] = (
            {} if self.dtype == "f8" else {"missing": f"{NOT_COMPUTED} where nothing was computed"}
        )
        return {"long_name": self.long_name, "units": self.units} | ({"codes": self.codes} if self.codes else missing)


def variables_of(study: Study) -> tuple[Variable, ...]:
    """All variables of a study but those of its points' state."""
    return tuple(variable for name in study.asked for variable in variables_of_quantity(study, name))


def variables_of_quantity(study: Study, name: str) -> tuple[Variable, ...]:
    """Variables of one quantity."""
    over_window = at_window(study, study.asked[name])
    table = {
        "slow_flow": _slow_flow_window if over_window else _slow_flow_point,
        "response": _response_window if over_window else _response_point,
        "attractors": _attractors_window if over_window else _attractors_point,
        "fatigue": _fatigue,
    }
    return table[name](name)


def at_window(study: Study, asked: Any) -> bool:
    """Whether a quantity is computed over a window of detuning, not at one."""
    return "detuning" not in study.axes_given and is_window(getattr(asked, "detuning", None))


def _count(name: str, long_name: str, **more: Any) -> Variable:
    return Variable(name, long_name, dtype="i4", **more)


def _curve(name: str, noun: str) -> tuple[Variable, ...]:
    return (
        Variable(f"{name}_stable_pipe_peak", f"largest pipe peak of a stable {noun}", "m", headline=True),
        Variable(f"{name}_stable_peak_detuning", f"where the largest stable {noun} is", "rad/s"),
        Variable(f"{name}_pipe_peak", f"largest pipe peak of any {noun}, stable or not", "m"),
        Variable(f"{name}_peak_detuning", f"where the largest {noun} is", "rad/s"),
        Variable(f"{name}_stable_relative_peak", f"largest stroke of a stable {noun}", "m"),
        _count(f"{name}_branches", "number of branches"),
        _count(f"{name}_detached_branches", "number of detached branches"),
        Variable(f"{name}_detached_pipe_peak", "largest pipe peak on a detached branch", "m"),
        _count(f"{name}_unstable_ranges", f"ranges of detuning with an unstable {noun}"),
        _count(f"{name}_ranges_without_stable", f"ranges of detuning without a stable {noun}"),
        _count(f"{name}_saddle_nodes", "number of saddle-node points"),
    )


def _slow_flow_window(name: str) -> tuple[Variable, ...]:
    return (*_curve(name, "equilibrium"), _count(f"{name}_hopfs", "number of Hopf points"), _verified(name))


def _response_window(name: str) -> tuple[Variable, ...]:
    tori = _count(f"{name}_neimark_sackers", "number of Neimark-Sacker points")
    return (*_curve(name, "response"), tori, _verified(name))


def _verified(name: str) -> Variable:
    return Variable(f"{name}_verified", "whether nothing speaks against it", codes=_VERIFIED_CODES, dtype="i1")


def _slow_flow_point(name: str) -> tuple[Variable, ...]:
    codes = "-1 no root, 0 stable, 1 odd, 2 even number of unstable eigenvalues"
    return (
        Variable(f"{name}_stable_pipe_peak", "largest pipe amplitude of a stable equilibrium", "m", headline=True),
        Variable(f"{name}_pipe_peak", "largest pipe amplitude of any equilibrium, stable or not", "m"),
        _count(f"{name}_equilibria", "number of equilibria"),
        _count(f"{name}_stable_equilibria", "number of stable equilibria"),
        Variable(f"{name}_pipe_amplitude", "pipe amplitude of every equilibrium", "m", roots=True),
        Variable(f"{name}_relative_amplitude", "relative amplitude of every equilibrium", "m", roots=True),
        Variable(f"{name}_stability", "stability class of every equilibrium", codes=codes, dtype="i1", roots=True),
    )


def _response_point(name: str) -> tuple[Variable, ...]:
    return (
        Variable(f"{name}_stable_pipe_peak", "largest pipe peak of a stable response", "m", headline=True),
        Variable(f"{name}_pipe_peak", "largest pipe peak of any response, stable or not", "m"),
        Variable(f"{name}_stable_relative_peak", "largest stroke of a stable response", "m"),
        _count(f"{name}_responses", "number of periodic responses"),
        _count(f"{name}_stable_responses", "number of stable periodic responses"),
        _verified(name),
    )


def _attractors(name: str) -> tuple[Variable, ...]:
    return (
        Variable(f"{name}_pipe_peak", "largest pipe peak of a lasting motion that counts", "m", headline=True),
        Variable(f"{name}_relative_peak", "largest stroke of a lasting motion that counts", "m"),
        Variable(f"{name}_kind", "kind of the motion with the largest pipe peak", codes=_KIND_CODES, dtype="i1"),
        Variable(f"{name}_basin_fraction", "share of the sampled initial states that end on it"),
        Variable(f"{name}_not_excluded", "largest pipe peak whose basin could be as large as counts, 95 %", "m"),
    )


def _attractors_window(name: str) -> tuple[Variable, ...]:
    return (
        *_attractors(name),
        Variable(f"{name}_peak_detuning", "where the largest pipe peak is", "rad/s"),
        _count(f"{name}_frequencies", "number of frequencies looked at"),
        _verified(name),
    )


def _attractors_point(name: str) -> tuple[Variable, ...]:
    return (
        *_attractors(name),
        _count(f"{name}_motions", "number of lasting motions found"),
        Variable(f"{name}_unsettled", "share of the sampled initial states that end on none"),
        _verified(name),
    )


def _fatigue(name: str) -> tuple[Variable, ...]:
    return (
        Variable(f"{name}_damage_with", "damage with absorbers, the worst motion at every wind", headline=True),
        Variable(f"{name}_damage_weighted", "damage with absorbers, motions weighted by their basins"),
        Variable(f"{name}_damage_without", "damage without absorbers"),
        _verified(name),
    )
