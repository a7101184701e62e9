"""All claims of the paper and their verdicts."""

from __future__ import annotations

from collections.abc import Iterator

from frahm.published.yang2022 import CLAIMS
from frahm.reproduction.claims_of_curves import CURVE_CLAIMS
from frahm.reproduction.claims_of_equations import equation_judgement
from frahm.reproduction.claims_of_motions import MOTION_CLAIMS
from frahm.reproduction.computations import Computations
from frahm.reproduction.judging import Judgement, judge
from frahm.slow_flow.print_check import ExpressionJudgement

_EVIDENCE = {**CURVE_CLAIMS, **MOTION_CLAIMS}


def judge_claims(computed: Computations) -> Iterator[Judgement]:
    """Give the verdict on each row of the claims table, one after the other."""
    for claim in CLAIMS:
        yield judge(claim, _EVIDENCE[claim.id](claim, computed))


def judge_printed_equations(wholes: tuple[ExpressionJudgement, ...]) -> list[Judgement]:
    """Return the verdict on each printed equation."""
    return [equation_judgement(whole) for whole in wholes]
