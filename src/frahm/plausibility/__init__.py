"""Room `plausibility`: what a practised engineer would ask about a case before trusting any number of it.

The room is called like its verb: ``frahm.plausibility(case)`` is `frahm.plausibility.plausibility`.
"""

import sys
import types

from frahm.plausibility.implausible import Implausible
from frahm.plausibility.judging import plausibility

__all__ = ["Implausible", "plausibility"]


class _Room(types.ModuleType):
    """A module that can be called: the public name and this folder are the same attribute of frahm."""

    __call__ = staticmethod(plausibility)


sys.modules[__name__].__class__ = _Room
