"""The chosen design as hardware: springs, wires, damper, strokes, forces, sag, and what to mind."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace

from frahm.case import Case, PolynomialLaw
from frahm.design.absorber import DesignedAbsorber, left_out, with_design
from frahm.design.springs import ALLOWED_SHEAR, MOST_SPRING_STROKE, CoilSprings, coil_springs, why_not_wound
from frahm.errors import check_number

GRAVITY = 9.80665
STEEL_MODULUS = 2.06e11  # [Pa]
MOST_WIRE_STROKE = 0.07  # of half the span
WIRE_STRENGTH, THINNEST_WIRE = 1.0e9, 1e-4  # half of what drawn spring wire breaks at [Pa], and its diameter [m]
ENDURANCE_SHEAR = 2.41e8  # amplitude of the shear stress that unpeened spring steel outlives [Pa]
_YEAR = 365.25 * 86_400.0


@dataclass(frozen=True)
class HardwareItem:
    """One line of the sheet: what, its value in SI units, and where it comes from."""

    name: str
    value: float
    unit: str
    basis: str


@dataclass(frozen=True)
class Hardware:
    """Sheet of a design.

    Attributes
    ----------
    items : tuple of HardwareItem
    warnings : tuple of str
    """

    items: tuple[HardwareItem, ...]
    warnings: tuple[str, ...]

    def value(self, name: str) -> float:
        """Value of the line of that name [SI]."""
        return next(item.value for item in self.items if item.name == name)


def transverse_pair_ratio(stroke_over_length: float) -> float:
    """Exact over cubic force of two transverse springs at y/L: 2 (1 - 1/sqrt(1 + s^2))/s^2 [-].

    The exact force is 2 k_s y (1 - L/sqrt(L^2 + y^2)), its leading term k_s y^3/L^2.
    """
    s = check_number("stroke_over_length", stroke_over_length, above=0)
    return 2 * (1 - 1 / math.hypot(1.0, s)) / s**2


def as_built(
    case: Case, design: DesignedAbsorber, stroke: float, room: float | None = None, replaced: int | None = None
) -> Case:
    """The case with the exact force of the transverse springs of the sheet in place of the cubic laws of a design.

    2 k_s y (1 - L/sqrt(L^2 + y^2)) = k3 y^3 (1 - 3/4 s^2 + 5/8 s^4 - ...) with s = y/L, L a quarter of which is the
    stroke, or the room there is: three terms miss it by less than 2e-4 up to there, and stay a hardening spring beyond.
    """
    designed = with_design(case, design, replaced=replaced)
    host, new = designed.pipe.mass, list(designed.absorbers)
    for at, one in enumerate(design.absorbers):
        if one.kappa:
            law = _transverse_law(
                host * one.kappa, host * one.linear, host * one.xi2, room or stroke / MOST_SPRING_STROKE
            )
            new[at] = new[at].model_copy(update={"law": law})
    return Case(**({key: getattr(designed, key) for key in designed.model_fields_set} | {"absorbers": tuple(new)}))


def _transverse_law(k3: float, k1: float, damping: float, length: float) -> PolynomialLaw:
    """Three terms of the force of two transverse springs of a length [m]."""
    coefficients = [k1, 0.0]
    for factor in (1.0, -0.75 / length**2, 0.625 / length**4):
        coefficients += [k3 * factor, 0.0]
    return PolynomialLaw(coefficients=tuple(coefficients[:-1]), damping=damping)


def hardware(
    case: Case, design: DesignedAbsorber, stroke: float, frequency: float, room: float | None = None,
    stress: float | None = None, replaced: int | None = None,
) -> Hardware:  # fmt: skip
    """Sheet of a design on a case.

    Parameters
    ----------
    case : Case
    design : DesignedAbsorber
    stroke : float
        Largest displacement between absorber and pipe, force margin included [m].
    frequency : float
        Excitation frequency at the worst [rad/s].
    room, stress : float, optional
        Free length of a transverse spring [m] and shear stress in it [Pa]; by default four times the stroke, 400 MPa.
    replaced : int, optional
        Number of absorbers of the case in whose place the design comes; by default as many as it has.

    Returns
    -------
    Hardware
        Two transverse springs of length L on either side, L so that the stroke is a quarter of it, with the pretension
        T0 = k1 L/2 that the linear part needs: k3 = (k_s - T0/L)/L^2. Or two wires of length L (k3 = E A/L^3) with
        the same pretension. Coil springs by tau = 8 F C K/(pi d^2) with Wahl's factor K and k = G d/(8 C^3 n)
        (textbook formulas, secondary). Coil springs that nobody can wind, and wires that would break, are left out:
        a warning says why and what to take instead.
    """
    sheets = [_sheet(case, one, stroke, frequency, room, stress, design.count) for one in design.absorbers]
    if len(sheets) == 1:
        items, warnings = sheets[0]
    else:
        items = [
            replace(item, name=f"absorber {n}: {item.name}") for n, (own, _) in enumerate(sheets, 1) for item in own
        ]
        warnings = _by_absorber([own for _, own in sheets])
    old = left_out(case, design.count if replaced is None else replaced)
    return Hardware(tuple(items), tuple(dict.fromkeys((*old, *warnings))))


def _by_absorber(sheets: Sequence[Sequence[str]]) -> list[str]:
    """Warnings of several absorbers: those that hold for all as they are, the others with the absorber's number."""
    common = [warning for warning in sheets[0] if all(warning in own for own in sheets)]
    single = [f"Absorber {n}: {w}" for n, own in enumerate(sheets, 1) for w in own if w not in common]
    return [*single, *common]


def _sheet(
    case: Case, design: DesignedAbsorber, stroke: float, frequency: float, room: float | None, stress: float | None,
    count: int,
) -> tuple[list[HardwareItem], list[str]]:  # fmt: skip
    """Lines and warnings of one absorber of so many, all of which are made for the largest stroke."""
    whose = "of all attractors" if count == 1 else "of any of the absorbers and all attractors"
    host = case.pipe.mass
    mass, k1, k3, c = (host * value for value in (design.rho2, design.linear, design.kappa, design.xi2))
    items = [
        HardwareItem("moving mass", mass, "kg", "rho2 times the mass of the pipe"),
        HardwareItem("damper coefficient", c, "N s/m", "xi2 times the mass of the pipe"),
        HardwareItem("largest stroke", stroke, "m", f"largest relative peak {whose}, force margin included"),
        HardwareItem("largest damper force", c * frequency * stroke, "N", "c Omega z, harmonic at the largest stroke"),
        HardwareItem("heat in the damper", 0.5 * c * (frequency * stroke) ** 2, "W", "c (Omega z)^2/2"),
    ]
    friction = math.pi / 4 * c * frequency * stroke
    items.append(HardwareItem("friction as strong as the damper", friction, "N", "pi/4 c Omega z: keep far below it"))
    if k1:
        items.append(HardwareItem("linear stiffness", k1, "N/m", "linear times the mass of the pipe"))
    unfit: tuple[str, ...] = ()
    if k3:
        items.append(HardwareItem("cubic stiffness", k3, "N/m^3", "kappa times the mass of the pipe"))
        springs = coil_springs(k1, k3, stroke, room, stress)
        not_wound, breaks = why_not_wound(springs), _why_wires_break(k1, k3, stroke)
        items += _transverse_springs(k1, springs, stroke, room)
        items += [] if not_wound else _coils(springs, frequency, stress)
        items += [] if breaks else _wires(k1, k3, stroke)
        unfit = _unfit(not_wound, breaks, stroke)
    sag = _sag(mass * GRAVITY, k1, k3)
    items.append(HardwareItem("sag if gravity acts along the motion", sag, "m", "k1 s + k3 s^3 = m g"))
    return items, [*unfit, *_warnings(design, stroke, sag)]


def _transverse_springs(k1: float, springs: CoilSprings, stroke: float, room: float | None) -> list[HardwareItem]:
    """What the springs must do, however they are made."""
    length, pretension = float(springs.length), float(springs.pretension)
    origin = "stroke over 0.25: force within 4.5 % of cubic" if room is None else "the room given"
    items = [
        HardwareItem("spring length L in the middle, each side", length, "m", origin),
        HardwareItem("spring free length, each side", float(springs.free), "m", "L - T0/k_s"),
        HardwareItem("spring stiffness k_s, each side", float(springs.stiffness), "N/m", "k3 L^2 + k1/2"),
        HardwareItem("spring extension by the stroke", float(springs.extension), "m", "sqrt(L^2 + z^2) - L"),
        HardwareItem("spring force at the stroke", float(springs.force), "N", "k_s times extension, with pretension"),
        HardwareItem("exact over cubic force at the stroke", transverse_pair_ratio(stroke / length), "-", "exact law"),
    ]
    if k1:
        items.append(HardwareItem("pretension for the linear part", pretension, "N", "T0 = k1 L/2, at length L"))
    return items


def _coils(springs: CoilSprings, frequency: float, stress: float | None) -> list[HardwareItem]:
    """The springs as coil springs."""
    top = ALLOWED_SHEAR if stress is None else stress
    index, wire, coils = float(springs.spring_index), float(springs.wire), float(springs.coils)
    swing = 0.5 * top * (1 - float(springs.pretension / springs.force))
    return [
        HardwareItem("coil spring index", index, "-", "mean over wire diameter C: 8, less for three active coils"),
        HardwareItem("coil spring wire diameter", wire, "m", f"shear stress {top / 1e6:g} MPa, C K (secondary)"),
        HardwareItem("coil spring active coils", coils, "-", "G d/(8 C^3 k_s) (secondary)"),
        HardwareItem(
            "coil spring solid over free length", float(springs.solid / springs.free), "-", "(n + 2) d, below 1 it fits"
        ),
        HardwareItem("spring extensions a year", 2 * frequency / (2 * math.pi) * _YEAR, "-", "two a cycle, all year"),
        HardwareItem("shear stress amplitude in the springs", swing, "Pa", "half of what the stroke adds"),
        HardwareItem(
            "spring fatigue: amplitude over endurance", swing / ENDURANCE_SHEAR, "-",
            "241 MPa, unpeened spring steel by Zimmerli (secondary): below 1 it outlives any number of cycles",
        ),
    ]  # fmt: skip


def _why_wires_break(k1: float, k3: float, stroke: float) -> str | None:
    """Why taut wires cannot take the place of the springs, as a sentence; None if they can."""
    length = stroke / MOST_WIRE_STROKE
    area = k3 * length**3 / STEEL_MODULUS
    stress = 0.5 * k1 * length / area + 0.5 * STEEL_MODULUS * MOST_WIRE_STROKE**2
    if (diameter := math.sqrt(4 * area / math.pi)) < THINNEST_WIRE:
        return f"it would be {1e3 * diameter:.2g} mm thick, and wire is {1e3 * THINNEST_WIRE:g} mm at least"
    if stress > WIRE_STRENGTH:
        return f"the linear part tightens it to {stress / 1e6:.3g} MPa, more than {WIRE_STRENGTH / 1e6:g} MPa"
    return None


def _unfit(not_wound: str | None, breaks: str | None, stroke: float) -> tuple[str, ...]:
    """What cannot be made, why, and what to take instead."""
    if not_wound and breaks:
        return (
            f"No coil spring can be wound for this: {not_wound}. Nor can a taut wire do it: {breaks}. It needs another"
            " device, such as a leaf spring bent around a shaped block or a cam, or another stroke or mass.",
        )
    if not_wound:
        return (
            f"No coil spring can be wound for this: {not_wound}. Take the two taut wires of the sheet instead,"
            f" k3 = E A/L^3 with L = {stroke / MOST_WIRE_STROKE:.3g} m each side, or another device.",
        )
    return (f"No taut wire can take the place of the coil springs: {breaks}.",) if breaks else ()


def _wires(k1: float, k3: float, stroke: float) -> list[HardwareItem]:
    length = stroke / MOST_WIRE_STROKE
    area = k3 * length**3 / STEEL_MODULUS
    range_ = 0.5 * STEEL_MODULUS * MOST_WIRE_STROKE**2
    items = [
        HardwareItem("wire length L, each side", length, "m", "stroke over 0.07, instead of springs"),
        HardwareItem("wire cross-section", area, "m^2", "k3 L^3/E, steel"),
        HardwareItem("wire diameter", math.sqrt(4 * area / math.pi), "m", "solid wire"),
        HardwareItem("wire stress range", range_, "Pa", "E z^2/(2 L^2), twice a cycle"),
    ]
    if k1:
        items.append(HardwareItem("wire pretension for the linear part", 0.5 * k1 * length, "N", "T0 = k1 L/2"))
    return items


def _sag(weight: float, k1: float, k3: float) -> float:
    """Positive root of k3 s^3 + k1 s = weight."""
    if not k3:
        return weight / k1
    if not k1:
        return float((weight / k3) ** (1 / 3))
    p, q = k1 / k3, weight / k3
    root = math.sqrt(q * q / 4 + p**3 / 27)
    s = (q / 2 + root) ** (1 / 3) - (root - q / 2) ** (1 / 3)
    for _ in range(3):  # the difference loses digits where the linear part dominates
        s -= (s * (s * s + p) - q) / (3 * s * s + p)
    return float(s)


def _warnings(design: DesignedAbsorber, stroke: float, sag: float) -> tuple[str, ...]:
    warnings = []
    if sag > 0.1 * stroke:
        warnings.append(
            f"Gravity along the motion would make the mass sag by {sag:.3g} m against a stroke of {stroke:.3g} m, which"
            " breaks the symmetry the design relies on: let it move horizontally, or carry it by a counter-spring."
        )
    warnings.append("On a vertical pipe the direction of the wind varies: the device must work in two directions.")
    if design.quintic:
        warnings.append(
            "Two transverse springs have no stiffness of the fifth power: it needs a cam, a shaped spring, or a stop."
        )
    if design.kappa:
        warnings.append("The springs stretch twice a cycle: their fatigue counts twice the cycles of the pipe.")
    return tuple(warnings)
