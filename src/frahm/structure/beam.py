"""A uniform beam on supports as numbers: what it is, and that it stays where it is put."""

from __future__ import annotations

import math
from dataclasses import dataclass
from itertools import pairwise

from frahm.errors import ParameterError, check_number

_CLOSEST = 1e-6  # of the length: two sections nearer than this can only be a mistake


@dataclass(frozen=True)
class Support:
    """A support across the beam.

    Parameters
    ----------
    at : float
        Position along the beam [m].
    translation : float
        Stiffness against displacement [N/m]; infinite if it is held.
    rotation : float
        Stiffness against rotation [N m/rad]; infinite if it is held.
    """

    at: float
    translation: float = 0.0
    rotation: float = 0.0

    def __post_init__(self) -> None:
        check_number("at", self.at, at_least=0, unit="m")
        for name in ("translation", "rotation"):
            value = getattr(self, name)
            if value != math.inf:
                check_number(name, value, at_least=0)
        if self.translation == 0 and self.rotation == 0:
            raise ParameterError("translation, rotation", (0, 0), "a support that holds one of the two")


@dataclass(frozen=True)
class PointMass:
    """A mass at one section.

    Parameters
    ----------
    at : float
        Position along the beam [m].
    mass : float
        [kg]
    """

    at: float
    mass: float

    def __post_init__(self) -> None:
        check_number("at", self.at, at_least=0, unit="m")
        check_number("mass", self.mass, above=0, unit="kg")


@dataclass(frozen=True)
class Beam:
    """A uniform Euler-Bernoulli beam on any number of supports; an end without a support is free.

    Parameters
    ----------
    length : float
        [m]
    bending_stiffness : float
        E I [N m^2].
    mass_per_length : float
        [kg/m], contents and added mass included.
    supports : tuple of Support
        Wherever the beam is held, in any order.
    point_masses : tuple of PointMass
    stress_per_curvature : float
        Bending stress of the outermost fibre per curvature, E D/2 [Pa m]; 0 if it is not asked for.

    Raises
    ------
    ParameterError
        If a value is out of bounds, a section lies off the beam, two supports share a place, or the supports leave a
        mechanism, which is named.
    """

    length: float
    bending_stiffness: float
    mass_per_length: float
    supports: tuple[Support, ...]
    point_masses: tuple[PointMass, ...] = ()
    stress_per_curvature: float = 0.0

    def __post_init__(self) -> None:
        check_number("length", self.length, above=0, unit="m")
        check_number("bending_stiffness", self.bending_stiffness, above=0, unit="N m^2")
        check_number("mass_per_length", self.mass_per_length, above=0, unit="kg/m")
        check_number("stress_per_curvature", self.stress_per_curvature, at_least=0, unit="Pa m")
        for name in ("supports", "point_masses"):
            for index, item in enumerate(getattr(self, name)):
                if item.at > self.length:
                    raise ParameterError(
                        f"{name}[{index}].at", item.at, f"a section of the beam, 0 to {self.length:g} m"
                    )
        places = [support.at for support in self.supports]
        for index, place in enumerate(places):
            if place in places[:index]:
                raise ParameterError(f"supports[{index}].at", place, "one support at a section")
        near = next((pair for pair in pairwise(self.nodes) if pair[1] - pair[0] < _CLOSEST * self.length), None)
        if near:
            allowed = "ends, supports and masses at the same section or clearly apart"
            raise ParameterError("supports, point_masses", near, allowed)
        free = mechanism(self.supports)
        if free:
            raise ParameterError("supports", places, "supports that hold the pipe", hint=free)

    @property
    def nodes(self) -> tuple[float, ...]:
        """Ends, supports and masses [m], ascending."""
        held, loaded = [support.at for support in self.supports], [point.at for point in self.point_masses]
        return tuple(sorted({0.0, float(self.length), *map(float, held + loaded)}))


def mechanism(supports: tuple[Support, ...]) -> str:
    """The rigid motion that supports leave free, as a sentence; empty if they leave none."""
    across = [support.at for support in supports if support.translation > 0]
    turning = any(support.rotation > 0 for support in supports)
    if len(set(across)) >= 2 or (across and turning):
        return ""
    if across:
        return f"The pipe can turn freely about its only support, at {across[0]:g} m: it is a mechanism."
    if turning:
        return "Nothing holds the pipe against sideways motion: it is a mechanism."
    return "Nothing holds the pipe: it can move sideways and turn freely."
