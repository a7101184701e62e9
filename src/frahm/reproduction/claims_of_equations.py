"""The printed equations as claims: each is reproduced, or a misprint with the derived form beside it."""

from __future__ import annotations

from frahm.reproduction.judging import ClaimVerdict, Finding, Judgement
from frahm.slow_flow.print_check import ExpressionJudgement, TermJudgement

_METHOD = "every term compared with the equation derived from the equations of motion, by computer algebra"
_TOLERANCE = "exact"


def equation_judgement(whole: ExpressionJudgement) -> Judgement:
    """Return the verdict on one printed equation."""
    wrong = [term for term in whole.terms if not term.verdict.good]
    place = f"Eq. {whole.equation}"
    return Judgement(
        id=equation_id(whole),
        figure=place,
        claim=f"{place}, {whole.expression}, as printed.",
        findings=(_count(whole), *(_wrong_term(number, term) for number, term in enumerate(wrong, start=1))),
        verdict=ClaimVerdict.MISPRINT if wrong else ClaimVerdict.REPRODUCED,
        method=_METHOD,
        explanation="; ".join(_sentence(term) for term in wrong) or "Every printed term agrees with the derivation.",
    )


def equation_id(whole: ExpressionJudgement) -> str:
    """Return a short name of an equation, such as "A1-p2" or "18-row-3"."""
    return f"{whole.equation}-{whole.expression.replace(chr(39), '').replace(' ', '-')}"


def _count(whole: ExpressionJudgement) -> Finding:
    printed = [term for term in whole.terms if term.printed]
    agreeing = sum(term.verdict.good for term in printed)
    needed = sum(1 for term in whole.terms if term.derived)
    return Finding("terms that agree", needed, agreeing, "-", agreeing == needed == len(printed), _TOLERANCE)


def _wrong_term(number: int, term: TermJudgement) -> Finding:
    return Finding(f"term {number}", term.printed or "not printed", term.derived or "none", "", False, _TOLERANCE)


def _sentence(term: TermJudgement) -> str:
    return f"{term.printed}: {term.statement}" if term.printed else term.statement
