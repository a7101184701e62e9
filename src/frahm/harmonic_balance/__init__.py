"""Room `harmonic_balance`: exact periodic responses, every branch, with Floquet multipliers and special points."""

from frahm.harmonic_balance.births import LOOKED_AHEAD, births_ahead
from frahm.harmonic_balance.branch import SolutionBranch, connected
from frahm.harmonic_balance.branches import find_branches
from frahm.harmonic_balance.linear import check_rest, is_linear, linear_growth, linear_response, resonant_grid
from frahm.harmonic_balance.responses import PeriodicResponse, periodic_responses_of, responses_on
from frahm.harmonic_balance.search import Search, search_over

__all__ = [
    "LOOKED_AHEAD",
    "PeriodicResponse",
    "Search",
    "SolutionBranch",
    "births_ahead",
    "check_rest",
    "connected",
    "find_branches",
    "is_linear",
    "linear_growth",
    "linear_response",
    "periodic_responses_of",
    "resonant_grid",
    "responses_on",
    "search_over",
]
