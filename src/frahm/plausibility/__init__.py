"""Room `plausibility`: what a practised engineer would ask about a case before trusting any number of it.

The room is called like its verb: ``frahm.plausibility(case)`` is `frahm.plausibility.plausibility`.
"""

from frahm.lazy import make_callable
from frahm.plausibility.implausible import Implausible
from frahm.plausibility.judging import plausibility

__all__ = ["Implausible", "plausibility"]

make_callable(__name__, plausibility)
