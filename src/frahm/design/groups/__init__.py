"""Several absorbers at one place, screened together: every one-harmonic response in closed form."""

from frahm.design.groups.births import group_births
from frahm.design.groups.responses import group_amplitudes, group_responses

__all__ = ["group_amplitudes", "group_births", "group_responses"]
