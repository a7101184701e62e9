"""The verdicts as tables: JSON and CSV for programs, Markdown for people."""

from __future__ import annotations

import csv
import io
import json
from collections import Counter
from collections.abc import Sequence
from typing import Any

from frahm.published import yang2022
from frahm.reproduction.judging import Beside, ClaimVerdict, Computed, Finding, Judgement
from frahm.slow_flow.print_check import ExpressionJudgement, judgement_rows


def claims_json(judgements: Sequence[Judgement]) -> str:
    """List of objects: `id`, `claim`, `printed`, `computed`, `verdict` and what led to the verdict.

    `printed` and `computed` have the same keys: the names of the numbers and statements of the claim.
    """
    return json.dumps([_record(judgement) for judgement in judgements], indent=2, ensure_ascii=False) + "\n"


def claims_csv(judgements: Sequence[Judgement]) -> str:
    """One row per claim, values as text with their units."""
    rows = [
        {
            "id": str(judgement.id),
            "where": judgement.figure,
            "claim": judgement.claim,
            "printed": printed_text(judgement),
            "computed": computed_text(judgement),
            "verdict": judgement.verdict.value,
            "tolerance": "; ".join(f"{finding.name}: {finding.tolerance}" for finding in judgement.findings),
            "method": judgement.method,
            "explanation": judgement.explanation,
        }
        for judgement in judgements
    ]
    return _csv(rows)


def equations_csv(wholes: Sequence[ExpressionJudgement]) -> str:
    """One row per term of every printed equation."""
    return _csv(judgement_rows(wholes))


def claims_markdown(judgements: Sequence[Judgement]) -> str:
    """The verdicts as a document: counts, a table, and what was found claim by claim."""
    claims, equations = split(judgements)
    lines = [
        f"# Claims of doi {yang2022.DOI}",
        "",
        f"{', '.join(yang2022.AUTHORS)}: {yang2022.TITLE}. {yang2022.JOURNAL}.",
        "",
        f"Claims: {counts_text(claims)}. Equations: {counts_text(equations)}.",
        "",
        *_markdown_table(claims),
        "",
        "## What was found",
        "",
        *(line for judgement in claims for line in _markdown_section(judgement)),
        "## Equations",
        "",
        *_equation_table(equations),
    ]
    return "\n".join(lines) + "\n"


def split(judgements: Sequence[Judgement]) -> tuple[list[Judgement], list[Judgement]]:
    """Claims of the text and figures, and those of the equations."""
    claims = [judgement for judgement in judgements if isinstance(judgement.id, int)]
    return claims, [judgement for judgement in judgements if not isinstance(judgement.id, int)]


def counts_text(judgements: Sequence[Judgement]) -> str:
    """How many of each verdict, in words."""
    count = Counter(judgement.verdict for judgement in judgements)
    return ", ".join(f"{count[verdict]} {verdict.value}" for verdict in ClaimVerdict if count[verdict])


def printed_text(judgement: Judgement) -> str:
    """What is printed, with units."""
    return "; ".join(f"{f.name} {value_text(f.printed, f.unit)}" for f in judgement.findings)


def computed_text(judgement: Judgement) -> str:
    """What was computed, with units."""
    return "; ".join(f"{f.name} {value_text(f.computed, f.unit)}" for f in judgement.findings)


def value_text(value: Computed, unit: str) -> str:
    """A number with four digits and its unit; a statement as yes or no."""
    if isinstance(value, bool):
        return "yes" if value else "no"
    if isinstance(value, str):
        return value
    return f"{value:.4g}" + ("" if unit in ("", "-") else f" {unit}")


def _record(judgement: Judgement) -> dict[str, Any]:
    return {
        "id": str(judgement.id),
        "where": judgement.figure,
        "claim": judgement.claim,
        "printed": {finding.name: finding.printed for finding in judgement.findings},
        "computed": {finding.name: finding.computed for finding in judgement.findings},
        "verdict": judgement.verdict.value,
        "units": {finding.name: finding.unit for finding in judgement.findings if finding.unit},
        "agrees": {finding.name: finding.agrees for finding in judgement.findings},
        "tolerance": {finding.name: finding.tolerance for finding in judgement.findings},
        "method": judgement.method,
        "explanation": judgement.explanation,
        "beside": [_beside_record(beside) for beside in judgement.beside],
    }


def _beside_record(beside: Beside) -> dict[str, Any]:
    return {"name": beside.name, "value": beside.value, "unit": beside.unit}


def _csv(rows: Sequence[dict[str, Any]]) -> str:
    text = io.StringIO()
    writer = csv.DictWriter(text, fieldnames=list(rows[0]), lineterminator="\n")
    writer.writeheader()
    writer.writerows(rows)
    return text.getvalue()


def _markdown_table(judgements: Sequence[Judgement]) -> list[str]:
    rows = [
        f"| {j.id} | {j.figure} | {_cell(j.claim)} | {_values(j.findings, 'printed')}"
        f" | {_values(j.findings, 'computed')} | {j.verdict.value} |"
        for j in judgements
    ]
    return ["| # | where | claim | printed | computed | verdict |", "|---|---|---|---|---|---|", *rows]


def _values(findings: Sequence[Finding], which: str) -> str:
    return "<br>".join(_cell(f"{f.name}: {value_text(getattr(f, which), f.unit)}") for f in findings)


def _markdown_section(judgement: Judgement) -> list[str]:
    beside = [f"- {b.name}: {value_text(b.value, b.unit)}" for b in judgement.beside]
    heading = f"### {judgement.id}. {judgement.claim} ({judgement.verdict.value})"
    return [
        heading,
        "",
        judgement.explanation,
        "",
        f"Method: {judgement.method}.",
        "",
        *beside,
        *([""] if beside else []),
    ]


def _equation_table(judgements: Sequence[Judgement]) -> list[str]:
    rows = [f"| {j.id} | {_cell(j.explanation)} | {j.verdict.value} |" for j in judgements]
    return ["| equation | finding | verdict |", "|---|---|---|", *rows]


def _cell(text: str) -> str:
    return text.replace("|", "\\|")
