"""The printed equations of doi 10.3390/app12147272 judged term by term against the derivation.

Every verdict follows from a comparison: the derived expression times the printed denominator is expanded, and its
terms are matched with the printed ones. SymPy is loaded when a judgement is asked for.
"""

from __future__ import annotations

import enum
import itertools
from collections.abc import Sequence
from dataclasses import dataclass
from fractions import Fraction
from typing import Any

import numpy as np
from scipy.optimize import linear_sum_assignment

from frahm.published.yang2022_equations import JACOBIAN_ORDER, PRINTED, PrintedExpression, PrintedTerm

# A left-over printed term is read as a misprint of a derived one if at most this many exponents differ in all
# (one subscript: 2; the subscript of a square: 4); another coefficient counts as much as one subscript.
_PAIRING_LIMIT = 4.0
_COEFFICIENT_COST = 2.0


class Verdict(enum.Enum):
    """What the comparison says of one term; the value is the phrase a reader sees."""

    AGREES = "agrees"
    SIGN_LOST = "sign lost in the text, magnitude agrees"
    SIGN_DOUBTFUL = "misprint or lost in extraction: the sign should be"
    SIGN_WRONG = "misprint: the sign should be"
    WRONG = "misprint: should be"
    FOREIGN = "misprint: does not belong here"
    MISSING = "missing in print"

    @property
    def good(self) -> bool:
        """Whether nothing speaks against the print."""
        return self in (Verdict.AGREES, Verdict.SIGN_LOST)


@dataclass(frozen=True)
class TermJudgement:
    """Verdict on one term of one printed equation.

    Parameters
    ----------
    equation, expression : str
        Number of the equation and which part of it.
    printed : str
        The term as printed with the sign found in the text ("?" for none); empty if the print lacks it.
    derived : str
        The term as derived, signs counted as in the printed expression; empty if there is none.
    verdict : Verdict
    statement : str
        The verdict as a phrase, with the correct term where the print is wrong.
    """

    equation: str
    expression: str
    printed: str
    derived: str
    verdict: Verdict
    statement: str


@dataclass(frozen=True)
class ExpressionJudgement:
    """All terms of one printed equation.

    Parameters
    ----------
    equation, expression : str
        Number of the equation and which part of it.
    overall_sign : str
        The sign the whole expression needs, and whether the text shows it.
    terms : tuple of TermJudgement
    """

    equation: str
    expression: str
    overall_sign: str
    terms: tuple[TermJudgement, ...]

    @property
    def good(self) -> bool:
        """Whether nothing speaks against the print of any term."""
        return all(term.verdict.good for term in self.terms)


@dataclass(frozen=True)
class _Monomial:
    """Signed term of a derived expression."""

    coefficient: Fraction
    powers: tuple[tuple[str, int], ...]

    def times(self, sign: int) -> _Monomial:
        """Monomial with its sign turned by `sign` (+1 or -1)."""
        return _Monomial(sign * self.coefficient, self.powers)

    @property
    def text(self) -> str:
        """Sign, magnitude where it is not 1, and symbols in the notation of the printed terms."""
        sign, magnitude = "+" if self.coefficient > 0 else "-", abs(self.coefficient)
        factors = [name if power == 1 else f"{name}^{power}" for name, power in self.powers]
        return " ".join([sign, *([str(magnitude)] if magnitude != 1 else []), *factors])


def judge_equations(expressions: Sequence[PrintedExpression] = PRINTED) -> tuple[ExpressionJudgement, ...]:
    """Judge Eqs. 12 to 16, 18, 20, A1 and A2 of the paper, each term against the derivation.

    Parameters
    ----------
    expressions : sequence of PrintedExpression
        The printed equations, or variants of them with the same number and name.

    Returns
    -------
    tuple of ExpressionJudgement
        In the order given.
    """
    derived = _derived_expressions()
    return tuple(_judged(printed, derived[printed.number, printed.name]) for printed in expressions)


def judgement_rows(judgements: Sequence[ExpressionJudgement]) -> list[dict[str, str]]:
    """Return the judgements as flat rows for a table: one per term."""
    return [
        {
            "equation": term.equation,
            "expression": term.expression,
            "overall_sign": whole.overall_sign,
            "printed": term.printed,
            "derived": term.derived,
            "verdict": term.statement,
        }
        for whole in judgements
        for term in whole.terms
    ]


def _derived_expressions() -> dict[tuple[str, str], Any]:
    from sympy import Symbol

    from frahm.slow_flow.derivation import STATE, derive, multiple_scales
    from frahm.slow_flow.polar_form import equilibrium_relations, polar_equations

    scales, flow = multiple_scales(), derive("paper")
    names = [symbol.name for symbol in STATE]
    order = [names.index(name) for name in JACOBIAN_ORDER]
    return {
        ("12", "slow invariant manifold"): scales.slow_manifold,
        ("13", "D1 A"): scales.host_rate,
        ("14", "x12"): scales.correction * Symbol("exp(3i*omega*t0)"),
        ("15", "second order of the sink"): scales.second_order,
        ("16", "second solvability condition"): scales.sink,
        **{("18", f"row {number}"): row for number, row in enumerate(polar_equations(), start=1)},
        **{("20", name): relation for name, relation in equilibrium_relations().items()},
        **{("A1", f"{name}'"): rate for name, rate in zip(names, flow.cartesian, strict=True)},
        **{
            ("A2", f"J{row + 1}{column + 1}"): flow.jacobian[order[row], order[column]]
            for row, column in itertools.product(range(4), repeat=2)
        },
    }


def _monomials(expression: Any, denominator: str) -> list[_Monomial]:
    """Terms of expression * denominator, expanded."""
    import sympy as sp

    symbols = {symbol.name: symbol for symbol in expression.free_symbols}
    product = sp.cancel(expression * sp.sympify(denominator, locals=symbols))
    found = []
    for term in sp.Add.make_args(sp.expand(product.subs(sp.I, sp.Symbol("i")))):
        coefficient, rest = term.as_coeff_Mul()
        powers = sorted((str(base), int(power)) for base, power in rest.as_powers_dict().items() if base != 1)
        found.append(_Monomial(Fraction(int(coefficient.p), int(coefficient.q)), tuple(powers)))
    return found


def _judged(printed: PrintedExpression, expression: Any) -> ExpressionJudgement:
    """Match every printed term with a derived one, then judge signs, then pair what is left over."""
    derived = _monomials(expression, printed.denominator)
    sides = [(term, 1) for term in printed.terms] + [(term, -1) for term in printed.right]
    partners: list[_Monomial | None] = [_taken(derived, term) for term, _ in sides]
    overall = _overall_sign(printed, sides, partners)
    left_over = [index for index, partner in enumerate(partners) if partner is None]
    pairs = _paired([sides[index][0] for index in left_over], derived)
    rows = []
    for index, ((term, side), partner) in enumerate(zip(sides, partners, strict=True)):
        nearest = partner or pairs.get(left_over.index(index))
        signed = None if nearest is None else nearest.times(overall * side)
        verdict = _verdict(term, signed, exact=partner is not None)
        rows.append(_row(printed, f"{term.sign} {term.text}", signed, verdict))
    missing = [monomial for monomial in derived if monomial not in pairs.values()]
    rows += [_row(printed, "", monomial.times(overall), Verdict.MISSING) for monomial in missing]
    shown = {"+": "as printed", "-": "as printed", "?": "not visible in the text"}[printed.sign]
    return ExpressionJudgement(printed.number, printed.name, f"{'+' if overall > 0 else '-'} ({shown})", tuple(rows))


def _taken(derived: list[_Monomial], term: PrintedTerm) -> _Monomial | None:
    """Remove from `derived` and return the monomial equal to `term` but for the sign."""
    for index, monomial in enumerate(derived):
        if (monomial.powers, abs(monomial.coefficient)) == (term.powers, term.magnitude):
            return derived.pop(index)
    return None


def _overall_sign(
    printed: PrintedExpression, sides: list[tuple[PrintedTerm, int]], partners: list[_Monomial | None]
) -> int:
    """Sign of the whole expression: as printed, or where the text has none the one most terms agree with."""
    if printed.sign != "?":
        return 1 if printed.sign == "+" else -1

    def agreeing(overall: int) -> int:
        return sum(
            _verdict(term, partner.times(overall * side), exact=True).good
            for (term, side), partner in zip(sides, partners, strict=True)
            if partner is not None
        )

    return max((1, -1), key=agreeing)


def _verdict(term: PrintedTerm, derived: _Monomial | None, *, exact: bool) -> Verdict:
    if derived is None:
        return Verdict.FOREIGN
    if not exact:
        return Verdict.WRONG
    positive = derived.coefficient > 0
    if term.sign == "?":
        if not positive:
            return Verdict.SIGN_LOST
        return Verdict.AGREES if term.leading else Verdict.SIGN_DOUBTFUL
    return Verdict.AGREES if positive == (term.sign == "+") else Verdict.SIGN_WRONG


def _paired(terms: list[PrintedTerm], derived: list[_Monomial]) -> dict[int, _Monomial]:
    """Nearest derived monomial of each left-over printed term, by the number of exponents that differ."""
    if not terms or not derived:
        return {}
    cost = np.array([[_distance(term, monomial) for monomial in derived] for term in terms])
    single = cost.shape == (1, 1)
    rows, columns = linear_sum_assignment(cost)
    return {
        int(row): derived[column]
        for row, column in zip(rows, columns, strict=True)
        if single or cost[row, column] <= _PAIRING_LIMIT
    }


def _distance(term: PrintedTerm, monomial: _Monomial) -> float:
    one, other = dict(term.powers), dict(monomial.powers)
    exponents = sum(abs(one.get(symbol, 0) - other.get(symbol, 0)) for symbol in one.keys() | other.keys())
    return exponents + _COEFFICIENT_COST * (term.magnitude != abs(monomial.coefficient))


def _row(printed: PrintedExpression, text: str, derived: _Monomial | None, verdict: Verdict) -> TermJudgement:
    correct = "" if derived is None else derived.text
    statement = {
        Verdict.WRONG: f"{verdict.value} {correct}",
        Verdict.MISSING: f"{verdict.value}: {correct}",
        Verdict.SIGN_WRONG: f"{verdict.value} {correct[:1]}",
        Verdict.SIGN_DOUBTFUL: f"{verdict.value} {correct[:1]}",
    }.get(verdict, verdict.value)
    return TermJudgement(printed.number, printed.name, text, correct, verdict, statement)
