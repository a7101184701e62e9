"""What a design is asked for: frozen, checked settings."""

from __future__ import annotations

from typing import Any

from pydantic import ValidationError

from frahm.case import Case, Design
from frahm.case.problems import parameter_error
from frahm.errors import ParameterError, nearest

_MASS_RATIO = 0.02  # of a case without absorber


class DesignSettings(Design):
    """Settings of `design_absorber`: the fields of the section `design` of a case, under the same names.

    Attributes
    ----------
    objective : {"peak", "rms", "expected", "damage"}
        What is made as small as can be. "peak" and "rms": the largest of the pipe [m] over all attractors, frequencies
        and scatter. "expected": mean pipe peak [m] over the wind climate and the basins of its attractors, while the
        wind is in the band counted. "damage": fatigue damage over the wind climate [-], the worst attractor everywhere.
    family : {"sink", "tuned", "mixed"}
        Cubic spring alone, linear spring alone, or both.
    mass_ratio : float or tuple of float, optional
        Mass of all absorbers over that of the pipe [-], or a range of it.
    count : int or tuple of int
        Number of absorbers designed together, or the least and the most, of which the best number is chosen. They hang
        at one place, or where the case has its absorbers.
    mass_shares : {"equal", "free"} or tuple of float
        How several absorbers share the mass [-].
    devices : {"any", "equal"}
        Whether several absorbers are one drawing.
    linear, kappa, quintic, xi2 : tuple of float, optional
        Ranges (lo, hi) per mass of the pipe [1/s^2], [1/(m^2 s^2)], [1/(m^4 s^2)], [1/s]; by default wide ones that
        scale with the pipe, and no quintic part.
    position : tuple of float, optional
        Range along an elastic pipe [m].
    wind : tuple of float, optional
        Winds (lo, hi) [m/s] in which the worst is looked for, lift and frequency of each; by default the window of
        detuning of the case, with the lift at its wind.
    scatter : Scatter or dict or float
        How far pipe, absorber and force may be off [-]; a number alone is that of the pipe's frequency.
    quantile : float, optional
        Of the objective over the scatter; by default the worst.
    scatter_samples : int
        Pipes drawn where more than the pipe's frequency scatters or a quantile is asked.
    force_margin : float
        Factor on the force up to which no detached response curve may exist.
    stroke, spring_length : float, optional
        Largest displacement between absorber and pipe, and room for a transverse spring [m].
    spring_stress : float, optional
        Shear stress allowed in coil springs that must fit into their length [Pa].
    samples, seed : int
        Of the initial states per frequency in the verification.
    errors, margins : tuple of float
        Frequencies of the pipe over the nominal one of the comparison, and force margins of the trade-off [-].

    Raises
    ------
    ParameterError
        For bad input.
    """

    def __init__(self, /, **data: Any) -> None:
        try:
            super().__init__(**data)
        except ValidationError as error:
            raise parameter_error(error, Design) from error

    def changed(self, **changes: Any) -> DesignSettings:
        """The same with some of them changed."""
        return DesignSettings(**(self.given() | changes))

    def for_rival(self) -> DesignSettings:
        """The same without the ranges of spring and damper, which belong to the family asked for."""
        return self.changed(linear=None, kappa=None, quintic=None, xi2=None)

    def given(self) -> dict[str, Any]:
        """Those that were given, by name."""
        return {name: getattr(self, name) for name in self.model_fields_set}


def settings_for(
    case: Case, mass_ratio: Any = None, settings: Design | None = None, changes: dict[str, Any] | None = None
) -> DesignSettings:
    """Settings of a design: those of the case, those of `settings` in their place, and single changes.

    Raises
    ------
    ParameterError
        For bad input; an unknown name is refused with the nearest.
    """
    changes = dict(changes or {})
    for name in changes:
        if name not in Design.model_fields:
            near = nearest(name, Design.model_fields)
            hint = f"Did you mean {near!r}?" if near else None
            raise ParameterError(name, changes[name], "one of " + ", ".join(Design.model_fields), hint=hint)
    base = settings if settings is not None else case.design
    values = {} if base is None else {name: getattr(base, name) for name in base.model_fields_set}
    values |= changes | ({} if mass_ratio is None else {"mass_ratio": mass_ratio})
    if values.get("mass_ratio") is None:
        most = DesignSettings(**values).counts[-1]
        mass = sum(absorber.mass for absorber in case.absorbers[:most])
        values["mass_ratio"] = mass / case.pipe.mass if case.absorbers else _MASS_RATIO
    return DesignSettings(**values)
