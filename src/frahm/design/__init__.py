"""Room `design`: the best absorber, verified over all attractors and compared with its rivals."""

from frahm.design.absorber import DesignedAbsorber, parameters_text, with_design
from frahm.design.designing import check_design, design_absorber, verified_designs
from frahm.design.effort import step_weights
from frahm.design.finalists import FAR
from frahm.design.objective import Objective
from frahm.design.pareto import pareto_front
from frahm.design.problem import Problem
from frahm.design.screening import Screening
from frahm.design.settings import DesignSettings
from frahm.design.space import DesignSpace, design_space
from frahm.design.store import design_summary, save_design
from frahm.design.study import SIMPLEST_FIRST, DesignStudy, Rival

__all__ = [
    "FAR",
    "SIMPLEST_FIRST",
    "DesignSettings",
    "DesignSpace",
    "DesignStudy",
    "DesignedAbsorber",
    "Objective",
    "Problem",
    "Rival",
    "Screening",
    "check_design",
    "design_absorber",
    "design_space",
    "design_summary",
    "parameters_text",
    "pareto_front",
    "save_design",
    "step_weights",
    "verified_designs",
    "with_design",
]
