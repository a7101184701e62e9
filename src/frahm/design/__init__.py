"""Room `design`: the best absorber, verified over all attractors and compared with its rivals."""

from frahm.design.absorber import DesignedAbsorber, with_design
from frahm.design.designing import design_absorber, verified_designs
from frahm.design.pareto import pareto_front
from frahm.design.settings import DesignSettings
from frahm.design.store import save_design
from frahm.design.study import DesignStudy, Rival

__all__ = [
    "DesignSettings",
    "DesignStudy",
    "DesignedAbsorber",
    "Rival",
    "design_absorber",
    "pareto_front",
    "save_design",
    "verified_designs",
    "with_design",
]
