"""The input of every analysis: one frozen `Case`."""

from __future__ import annotations

import hashlib
import json
from collections.abc import Mapping
from pathlib import Path
from types import MappingProxyType
from typing import Annotated, Any

import numpy as np
from pydantic import Field, ValidationError, field_validator, model_validator

from frahm.case.absorber import Absorber, CubicLaw, LinearLaw, PolynomialLaw, free_name
from frahm.case.analysis import Analysis
from frahm.case.climate import Climate
from frahm.case.design import MOST_ABSORBERS, Design
from frahm.case.document import Document
from frahm.case.fatigue import Fatigue
from frahm.case.limits import Limits
from frahm.case.pipe import AnyPipe
from frahm.case.problems import parameter_error
from frahm.case.quantities import Label, refusal
from frahm.case.section import CaseSection
from frahm.case.typed import typed_texts, unchanged_texts
from frahm.case.wind import Wind
from frahm.errors import ParameterError, check_count, check_number, nearest

_MOVES = 1e-6  # of the largest displacement of a mode


class Case(CaseSection):
    """A pipe in the wind, its absorbers, and what is to be computed. SI units, frequencies in rad/s.

    Raises
    ------
    ParameterError
        Naming the field, what was given and what is allowed.
    """

    name: Annotated[str, Label(shortest=1, longest=60)] = Field(
        default="case", title="Name of the case", description="Short name for files and figures."
    )
    title: Annotated[str, Label()] = Field(
        default="", title="Title of the case", description="One line that says what the case is."
    )
    document: Document | None = Field(
        default=None, title="Document", description="Project, number, revision and names for the title block."
    )
    pipe: AnyPipe = Field(
        title="Pipe", description="The pipe: one mode of vibration, an elastic tube, or a table of modes."
    )
    wind: Wind = Field(title="Wind", description="The wind that sheds vortices from the pipe.")
    absorbers: tuple[Absorber, ...] = Field(
        default=(), title="Absorbers", description="Masses on the pipe; none is allowed."
    )
    climate: Climate | None = Field(
        default=None, title="Wind climate", description="How often which wind blows, and for how long."
    )
    fatigue: Fatigue | None = Field(
        default=None, title="Fatigue", description="The detail whose fatigue damage is counted."
    )
    limits: Limits | None = Field(
        default=None, title="Limits", description="What the member must keep to pass; nothing else is held against it."
    )
    design: Design | None = Field(
        default=None, title="Design", description="What the best absorber is asked for, by frahm design."
    )
    analysis: Analysis = Field(default=Analysis(), title="Analysis", description="What is computed for the case.")

    def __init__(self, /, **data: Any) -> None:
        try:
            super().__init__(**data)
        except ValidationError as error:
            raise parameter_error(error, type(self)) from error
        # Beside the fields, as the cached properties are: what was typed is no part of what the case is.
        self.__dict__["_typed"] = typed_texts(data, self)

    @field_validator("absorbers", "analysis", mode="before")
    @classmethod
    def _empty_section(cls, value: Any, info: Any) -> Any:
        empty: dict[str, Any] = {"absorbers": (), "analysis": {}}
        return empty[info.field_name] if value is None else value

    @model_validator(mode="after")
    def _consistent(self) -> Case:
        window, omega = self.analysis.detuning, self.pipe.frequency
        if window is not None and window[0] <= -omega:
            allowed = f"more than -{omega:g} rad/s, where the excitation frequency is zero"
            raise refusal(allowed, path="analysis.detuning[0]", value=window[0])
        speed = self.wind.speed
        for field, (low, high) in self.wind.speed_ranges(self.pipe.diameter).items():
            if not low * (1 - 1e-12) <= speed <= high * (1 + 1e-12):
                allowed = f"{low:g} ... {high:g} m/s, the Reynolds numbers that wind.{field} is given for"
                raise refusal(allowed, path="wind.speed", value=speed)
        names = [absorber.name for absorber in self.absorbers]
        for index, name in enumerate(names):
            if name in names[:index]:
                raise refusal("a name no other absorber has", path=f"absorbers[{index}].name", value=name)
        if self.fatigue is not None:
            self._fatigue_complete(self.fatigue)
        self._check_positions()
        return self

    def _fatigue_complete(self, fatigue: Fatigue) -> None:
        if self.climate is None:
            hint = "Say how often which wind blows: climate: {duration: 20 year, weibull: {scale: ..., shape: ...}}."
            raise refusal("a case with the section climate", hint=hint, path="fatigue", value="a case without climate")
        stress, where = fatigue.stress_per_displacement, fatigue.position
        path = "fatigue.stress_per_displacement"
        if self.pipe.kind == "mode":
            if stress is None:
                allowed = "a number [Pa/m], or text with a unit such as MPa/m, because the pipe is given as one mode"
                raise refusal(allowed, path=path, value=None)
            if where is not None:
                allowed = "nothing, because a pipe given as one mode has no sections"
                raise refusal(allowed, path="fatigue.position", value=where)
            return
        if stress is not None:
            raise refusal("nothing, because the stress follows from the modes of the pipe", path=path, value=stress)
        try:
            self.pipe.modal.stress(where)
        except ParameterError as error:
            raise refusal(error.allowed, hint=error.hint, path="fatigue.position", value=where) from None

    def _check_positions(self) -> None:
        for index, absorber in enumerate(self.absorbers):
            where, path = absorber.position, f"absorbers[{index}].position"
            if where is None:
                continue
            if self.pipe.kind == "mode":
                raise refusal("nothing, because a pipe given as one mode moves alike all along", path=path, value=where)
            if where > self.pipe.length:
                raise refusal(f"a section of the pipe, 0 to {self.pipe.length:g} m", path=path, value=where)
            try:
                motion = self.pipe.modal.displacement(where)
            except ParameterError as error:
                raise refusal(error.allowed, path=path, value=where) from None
            if not np.max(np.abs(motion)) > _MOVES:
                raise refusal("a section that moves in one of the modes", path=path, value=where)

    @property
    def typed(self) -> Mapping[str, str]:
        """Text of every field that was typed with a unit of its own, by its path: ``{"pipe.diameter": "24 inch"}``.

        Fields given as plain numbers, which are in SI units as they stand, and fields changed since are left out. It
        is carried along by ``with_...`` and by pickling, and is no part of equality, `digest` or `to_dict`.
        """
        return MappingProxyType(self.__dict__.get("_typed", {}))

    def with_typed(self, texts: Mapping[str, str]) -> Case:
        """The same case that shows these texts, such as those of `typed` kept beside `to_dict`."""
        new = self.model_copy()
        new.__dict__["_typed"] = dict(texts)
        return new

    def with_document(self, /, **changes: Any) -> Case:
        """Case with other entries of the title block, such as ``revision="B"``; what is not named stays."""
        return self._with_section("document", changes)

    def with_pipe(self, /, **changes: Any) -> Case:
        """Case with other values of the pipe, such as ``frequency="0.8 Hz"``; what is not named stays."""
        if changes.get("kind", self.pipe.kind) != self.pipe.kind:  # another kind of pipe: nothing of the old one fits
            return self._with({"pipe": changes})
        return self._with_section("pipe", changes)

    def with_wind(self, /, **changes: Any) -> Case:
        """Case with other values of the wind, such as ``speed=2.7`` [m/s]; what is not named stays."""
        return self._with_section("wind", changes)

    def with_climate(self, /, **changes: Any) -> Case:
        """Case with other values of the wind climate, such as ``duration="25 year"``; what is not named stays."""
        return self._with_section("climate", changes)

    def with_fatigue(self, /, **changes: Any) -> Case:
        """Case with other values of the fatigue detail, such as ``curve="E"``; what is not named stays."""
        return self._with_section("fatigue", changes)

    def with_design(self, /, **changes: Any) -> Case:
        """Case with other settings of the design, such as ``objective="rms"``; what is not named stays."""
        return self._with_section("design", changes)

    def with_analysis(self, /, **changes: Any) -> Case:
        """Case with other settings of the analysis, such as ``seed=2``; what is not named stays."""
        return self._with_section("analysis", changes)

    def with_name(self, name: str, title: str | None = None) -> Case:
        """Case under another name, and another title if one is given."""
        return self._with({"name": name} | ({} if title is None else {"title": title}))

    def without_absorbers(self) -> Case:
        """Case with the bare pipe."""
        return self._with({"absorbers": ()})

    def with_absorber(
        self,
        *,
        kappa: float | None = None,
        xi2: float | None = None,
        rho2: float | None = None,
        position: float | str | None = None,
        name: str | None = None,
        index: int | None = None,
    ) -> Case:
        """Case with another absorber, given by values normalised by the mass of the pipe; what is not named stays.

        The mass of an elastic pipe is the modal mass of its governing mode, with a largest displacement of 1.

        Parameters
        ----------
        kappa : float, optional
            Cubic stiffness over mass of the pipe [1/(m^2 s^2)]; makes the law cubic if it was not.
        xi2 : float, optional
            Damping over mass of the pipe [1/s].
        rho2 : float, optional
            Mass of the absorber over mass of the pipe [-].
        position : float or str, optional
            Where on an elastic pipe it hangs [m].
        name, index : str, int, optional
            Which absorber: by name or by position; by default the first. If the case has none, a cubic sink is
            added, and all three values are needed.

        Returns
        -------
        Case
            A new case; this one is left as it is.

        Raises
        ------
        ParameterError
            If a value is out of bounds, there is no such absorber, or a value is missing for a new one.
        """
        given = {"kappa": kappa, "xi2": xi2, "rho2": rho2}
        unit = {"kappa": "1/(m^2 s^2)", "xi2": "1/s", "rho2": "-"}
        host = self.pipe.mass
        si = {key: host * check_number(key, value, at_least=0, unit=unit[key])
              for key, value in given.items() if value is not None}  # fmt: skip
        if rho2 is not None:
            check_number("rho2", rho2, above=0)
        if not self.absorbers:
            for key in given:
                if key not in si:
                    raise ParameterError(key, None, f"a number [{unit[key]}], because the case has no absorber yet")
            which, old = 0, None
        else:
            which = self._position(name, index)
            old = self.absorbers[which]
        new = _changed(old, si.get("kappa"), si.get("xi2"), si.get("rho2"), name)
        new |= {} if position is None else {"position": position}
        return self._with({"absorbers": (*self.absorbers[:which], new, *self.absorbers[which + 1 :])})

    def with_equal_parts(self, count: int, *, name: str | None = None) -> Case:
        """Case with an absorber split into equal ones beside each other, of the same mass, spring and damper together.

        Moving alike, they do what the one did; they may also part.

        Parameters
        ----------
        count : int
            Number of parts.
        name : str, optional
            Which absorber; by default the first.

        Raises
        ------
        ParameterError
            If there is no such absorber, or it is not a spring with a damper alone.
        """
        parts = check_count("count", count, at_least=1, at_most=MOST_ABSORBERS)
        if not self.absorbers:
            raise ParameterError("absorbers", "none", "an absorber that can be split")
        which = self._position(name, None)
        old = self.absorbers[which]
        if parts == 1:
            return self
        taken = [absorber.name for absorber in self.absorbers]
        new = [_share(old, parts)]
        for _ in range(1, parts):
            taken.append(free_name(old.name, taken))
            new.append(new[0].model_copy(update={"name": taken[-1]}))
        return self._with({"absorbers": (*self.absorbers[:which], *new, *self.absorbers[which + 1 :])})

    def to_dict(self) -> dict[str, Any]:
        """Plain dictionary with every field in SI units; `load_case` gives an equal case back."""
        return self.model_dump(mode="json")

    def to_yaml(self, path: str | Path | None = None) -> str:
        """YAML text with every field in SI units, also written to `path` if one is given.

        The file appears complete or not at all; `load_case` gives an equal case back.
        """
        from frahm.case.yaml_text import yaml_text
        from frahm.files import write_text

        text = yaml_text(self.to_dict())
        if path is not None:
            write_text(path, text)
        return text

    @property
    def digest(self) -> str:
        """SHA-256 of the content: equal cases have equal digests, on every machine."""
        canonical = json.dumps(self.to_dict(), sort_keys=True, separators=(",", ":"), allow_nan=False)
        return hashlib.sha256(canonical.encode()).hexdigest()

    def _with(self, changes: dict[str, Any]) -> Case:
        new = type(self)(**{name: getattr(self, name) for name in self.model_fields_set} | changes)
        new.__dict__["_typed"] = {**unchanged_texts(self.typed, self, new), **new.typed}
        return new

    def _with_section(self, section: str, changes: dict[str, Any]) -> Case:
        old = getattr(self, section)
        kept = {} if old is None else {name: getattr(old, name) for name in old.model_fields_set}
        return self._with({section: kept | changes})

    def _position(self, name: str | None, index: int | None) -> int:
        names = [absorber.name for absorber in self.absorbers]
        if name is not None and index is not None:
            raise ParameterError("name, index", (name, index), "at most one of the two")
        if name is not None:
            if name not in names:
                near = nearest(str(name), names)
                hint = f"Did you mean {near!r}?" if near else None
                raise ParameterError("name", name, "one of " + ", ".join(names), hint=hint)
            return names.index(name)
        return check_count("index", 0 if index is None else index, at_least=0, at_most=len(names) - 1)


def _share(old: Absorber, parts: int) -> Absorber:
    """One of so many equal parts of an absorber."""
    law = old.law
    if not isinstance(law, CubicLaw | LinearLaw | PolynomialLaw) or old.stops is not None or old.friction is not None:
        allowed = "a cubic, linear or polynomial spring with a damper, without stops and friction"
        raise ParameterError(f"absorbers({old.name})", law.kind, allowed)
    if isinstance(law, PolynomialLaw):
        spring: dict[str, Any] = {"coefficients": tuple(value / parts for value in law.coefficients)}
    else:
        spring = {"stiffness": law.stiffness / parts}
    new = law.model_copy(update=spring | {"damping": law.damping / parts})
    return old.model_copy(update={"mass": old.mass / parts, "law": new})


def _changed(
    old: Absorber | None, stiffness: float | None, damping: float | None, mass: float | None, name: str | None
) -> dict[str, Any]:
    """Fields of an absorber, with the values given in SI units in place of the old ones."""
    if old is None:
        law = {"kind": "cubic", "stiffness": stiffness, "damping": damping}
        return {"mass": mass, "law": law} | ({} if name is None else {"name": name})
    kept = {key: getattr(old, key) for key in old.model_fields_set}
    law = old.law.model_dump()
    if stiffness is not None:
        law = {"kind": "cubic", "stiffness": stiffness, "damping": old.law.damping}
    if damping is not None:
        law["damping"] = damping
    return kept | {"law": law} | ({} if mass is None else {"mass": mass})
