"""Room `assessment`: stress histories, cycles and fatigue damage over the attractors and the wind climate."""

from frahm.assessment.acceptance import Utilisation, accepted, headline, nothing_to_judge, utilisations
from frahm.assessment.all_modes import damage_of_modes, doubts_of_modes, total_damage
from frahm.assessment.closed_forms import constant_range_damage, weibull_damage
from frahm.assessment.damage import FatigueDamage
from frahm.assessment.device_row import device_row
from frahm.assessment.fatigue import fatigue_damage
from frahm.assessment.rainflow_cycles import CONVENTION, Cycles, rainflow_cycles, turning_points
from frahm.assessment.spring_fatigue import transverse_spring_cycles
from frahm.assessment.verdict import doubts_of_the_rest
from frahm.assessment.worst_stress import stress_places, with_stress

__all__ = [
    "CONVENTION",
    "Cycles",
    "FatigueDamage",
    "Utilisation",
    "accepted",
    "constant_range_damage",
    "damage_of_modes",
    "device_row",
    "doubts_of_modes",
    "doubts_of_the_rest",
    "fatigue_damage",
    "headline",
    "nothing_to_judge",
    "rainflow_cycles",
    "stress_places",
    "total_damage",
    "transverse_spring_cycles",
    "turning_points",
    "utilisations",
    "weibull_damage",
    "with_stress",
]
