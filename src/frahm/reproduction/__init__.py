"""Room `reproduction`: the claims and figures of the paper the package began with, judged and redrawn."""

from frahm.reproduction.claims import judge_claims
from frahm.reproduction.computations import Computations
from frahm.reproduction.judging import ClaimVerdict, Judgement

__all__ = ["ClaimVerdict", "Computations", "Judgement", "judge_claims"]
