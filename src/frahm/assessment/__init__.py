"""Room `assessment`: stress histories, cycles and fatigue damage over the attractors and the wind climate."""

from frahm.assessment.closed_forms import constant_range_damage, weibull_damage
from frahm.assessment.damage import FatigueDamage
from frahm.assessment.fatigue import fatigue_damage
from frahm.assessment.rainflow_cycles import CONVENTION, Cycles, rainflow_cycles, turning_points
from frahm.assessment.spring_fatigue import transverse_spring_cycles

__all__ = [
    "CONVENTION",
    "Cycles",
    "FatigueDamage",
    "constant_range_damage",
    "fatigue_damage",
    "rainflow_cycles",
    "transverse_spring_cycles",
    "turning_points",
    "weibull_damage",
]
