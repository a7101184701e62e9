"""From a printed claim and what was computed for it to a verdict; every verdict follows from the numbers."""

from __future__ import annotations

import enum
import itertools
from collections.abc import Mapping
from dataclasses import dataclass, field

from frahm.published.yang2022 import Claim, PrintedValue

Computed = float | bool | str


class ClaimVerdict(enum.Enum):
    """What became of a claim."""

    REPRODUCED = "reproduced"
    MISPRINT = "misprint"
    NOT_REPRODUCED = "not-reproduced"


@dataclass(frozen=True)
class Beside:
    """A further value, shown beside the one a claim is judged by.

    Parameters
    ----------
    name : str
        Which quantity it is, and by which method.
    value : float
    unit : str
    """

    name: str
    value: float
    unit: str


@dataclass(frozen=True)
class Evidence:
    """What was computed for one claim.

    Parameters
    ----------
    method : str
        How, in one sentence.
    values : mapping of str to float
        By name of the printed value, in its unit.
    statements : mapping of str to bool
        Whether each printed statement holds.
    beside : tuple of Beside
        Further values that inform the reader and are not judged.
    remark : str
        What the numbers mean, where that needs a sentence.
    unverified : tuple of str
        What could not be computed to the end.
    """

    method: str
    values: Mapping[str, float] = field(default_factory=dict)
    statements: Mapping[str, bool] = field(default_factory=dict)
    beside: tuple[Beside, ...] = ()
    remark: str = ""
    unverified: tuple[str, ...] = ()


@dataclass(frozen=True)
class Finding:
    """One printed number or statement with what was computed.

    Parameters
    ----------
    name : str
    printed, computed : float, bool or str
        A statement is printed as True, a term of an equation as text.
    unit : str
        Empty for a statement or a term.
    agrees : bool
        Whether the computed value is within the tolerance.
    tolerance : str
        How near is near enough, and why.
    """

    name: str
    printed: Computed
    computed: Computed
    unit: str
    agrees: bool
    tolerance: str


@dataclass(frozen=True)
class Judgement:
    """The verdict on one claim.

    Parameters
    ----------
    id : int or str
        Row of the claims table, or the name of an equation.
    figure : str
        Figure, section or equation of the paper.
    claim : str
        What the paper says.
    findings : tuple of Finding
        Every printed number and statement of it.
    verdict : ClaimVerdict
    method, explanation : str
        How it was computed, and what was found.
    beside : tuple of Beside
        Further values.
    unverified : tuple of str
        What could not be computed to the end.
    """

    id: int | str
    figure: str
    claim: str
    findings: tuple[Finding, ...]
    verdict: ClaimVerdict
    method: str
    explanation: str
    beside: tuple[Beside, ...] = ()
    unverified: tuple[str, ...] = ()


def judge(claim: Claim, evidence: Evidence) -> Judgement:
    """Return the verdict on a claim.

    It is reproduced if every printed number is within its tolerance and every statement holds. Otherwise two numbers
    of the same unit are tried in exchanged order: if everything agrees then, the print has exchanged them.
    """
    findings = _findings(claim, claim.printed, evidence)
    verdict = ClaimVerdict.REPRODUCED if _agree(findings) else ClaimVerdict.NOT_REPRODUCED
    sentences = [_outcome(findings)]
    if verdict is ClaimVerdict.NOT_REPRODUCED:
        for first, second in _exchangeable(claim):
            if _agree(_findings(claim, _exchanged(claim.printed, first, second), evidence)):
                verdict = ClaimVerdict.MISPRINT
                sentences.append(_exchange_sentence(first, second))
    return Judgement(
        id=claim.id,
        figure=_place(claim.figure),
        claim=claim.statement,
        findings=findings,
        verdict=verdict,
        method=evidence.method,
        explanation=" ".join(sentence for sentence in (*sentences, evidence.remark) if sentence),
        beside=evidence.beside,
        unverified=evidence.unverified,
    )


def _findings(claim: Claim, printed: tuple[PrintedValue, ...], evidence: Evidence) -> tuple[Finding, ...]:
    numbers = [_number_finding(value, float(evidence.values[value.name])) for value in printed]
    return (*numbers, *(_statement_finding(name, evidence.statements[name]) for name in claim.statements))


def _number_finding(printed: PrintedValue, computed: float) -> Finding:
    tolerance = printed.tolerance
    agrees = tolerance.allows(printed.value, computed)
    return Finding(printed.name, printed.value, computed, printed.unit, agrees, tolerance_text(printed))


def tolerance_text(printed: PrintedValue) -> str:
    """Return how far a computed value may be from a printed one, and why."""
    tolerance, unit = printed.tolerance, "" if printed.unit == "-" else f" {printed.unit}"
    if tolerance.upper_bound:
        return tolerance.reason
    parts = [f"{tolerance.absolute:g}{unit}"] if tolerance.absolute else []
    parts += [f"{100 * tolerance.relative:g} %"] if tolerance.relative else []
    return f"{' or '.join(parts)}: {tolerance.reason}"


def _statement_finding(name: str, holds: bool) -> Finding:
    return Finding(name, True, bool(holds), "", bool(holds), "holds or not")


def _agree(findings: tuple[Finding, ...]) -> bool:
    return all(finding.agrees for finding in findings)


def _exchangeable(claim: Claim) -> list[tuple[PrintedValue, PrintedValue]]:
    """Pairs of printed amplitudes that may have been exchanged; the ends of a range are not among them."""
    lengths = [value for value in claim.printed if value.unit == "m" and not value.tolerance.upper_bound]
    return list(itertools.combinations(lengths, 2))


def _exchanged(
    printed: tuple[PrintedValue, ...], first: PrintedValue, second: PrintedValue
) -> tuple[PrintedValue, ...]:
    swapped = {
        first: PrintedValue(first.name, second.value, first.unit, first.tolerance),
        second: PrintedValue(second.name, first.value, second.unit, second.tolerance),
    }
    return tuple(swapped.get(value, value) for value in printed)


def _exchange_sentence(first: PrintedValue, second: PrintedValue) -> str:
    return (
        f"The claim holds with the two amplitudes exchanged: {first.name} {second.value:g} {first.unit},"
        f" {second.name} {first.value:g} {second.unit}."
    )


def _outcome(findings: tuple[Finding, ...]) -> str:
    """Say what disagrees, or how near everything is."""
    if not _agree(findings):
        return " ".join(_disagreement(finding) for finding in findings if not finding.agrees)
    numbers = [finding for finding in findings if finding.unit]
    if not numbers:
        return "Holds." if len(findings) == 1 else "All statements hold."
    return "Within tolerance: " + ", ".join(_comparison(finding) for finding in numbers) + "."


def _comparison(finding: Finding) -> str:
    unit = "" if finding.unit == "-" else f" {finding.unit}"
    return f"{finding.name} {finding.computed:.4g} for {finding.printed:.4g}{unit}"


def _disagreement(finding: Finding) -> str:
    if not finding.unit:
        return f"Does not hold: {finding.name}."
    return f"Out of tolerance: {_comparison(finding)}."


def _place(figure: str) -> str:
    if not figure[:1].isdigit():
        return figure
    return ("Figs. " if "," in figure else "Fig. ") + figure
