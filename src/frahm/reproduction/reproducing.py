"""The whole reproduction as a directory of files: claims, equations, figures."""

from __future__ import annotations

import json
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from frahm import __version__
from frahm.errors import ParameterError
from frahm.files import write_text
from frahm.published import yang2022
from frahm.reproduction.claims import judge_claims, judge_printed_equations
from frahm.reproduction.computations import Computations
from frahm.reproduction.figures import figures
from frahm.reproduction.judging import Judgement
from frahm.reproduction.tables import claims_csv, claims_json, claims_markdown, counts_text, equations_csv, split
from frahm.slow_flow.print_check import ExpressionJudgement, judge_equations

SCHEMA = "frahm-reproduction-1"
_SUMMARY = "summary.json"
Progress = Callable[[str], None]


@dataclass(frozen=True)
class Reproduction:
    """What `reproduce` found and wrote.

    Attributes
    ----------
    directory : Path
        Where the files are.
    judgements : tuple of Judgement
        Claims first, equations after them.
    unverified : tuple of str
        What could not be computed to the end; empty if nothing.
    """

    directory: Path
    judgements: tuple[Judgement, ...]
    unverified: tuple[str, ...]


def step_count() -> int:
    """How many times `reproduce` reports progress."""
    return len(yang2022.CLAIMS) + 1 + len(figures())


def reproduce(directory: str | Path, *, force: bool = False, progress: Progress = lambda _: None) -> Reproduction:
    """Judge every claim and equation of the paper, redraw its figures, and write it all to a directory.

    Parameters
    ----------
    directory : str or Path
        Made if it does not exist. Files of an earlier reproduction are replaced.
    force : bool
        Write into a directory that holds something else.
    progress : callable
        Called with a few words before each step.

    Returns
    -------
    Reproduction

    Raises
    ------
    ParameterError
        If the directory holds something else, or cannot be written.
    """
    out = _prepared(Path(directory), force)
    computed = Computations()
    judgements = _judged_claims(computed, progress)
    progress("printed equations")
    wholes = judge_equations()
    judgements += judge_printed_equations(wholes)
    _write_tables(out, judgements, wholes)
    _draw(out / "figures", computed, progress)
    unverified = tuple(dict.fromkeys(computed.unverified))
    write_text(out / _SUMMARY, _summary(judgements, unverified))
    return Reproduction(out, tuple(judgements), unverified)


def _prepared(out: Path, force: bool) -> Path:
    """Directory that is empty, of an earlier reproduction, or allowed by force."""
    if out.exists() and not out.is_dir():
        raise ParameterError("--out", str(out), "a directory", hint="It is a file.")
    if out.is_dir() and any(out.iterdir()) and not _is_reproduction(out) and not force:
        hint = "It holds something else; --force writes into it."
        raise ParameterError(
            "--out", str(out), "a new or empty directory, or that of an earlier reproduction", hint=hint
        )
    try:
        (out / "figures").mkdir(parents=True, exist_ok=True)
        write_text(out / _SUMMARY, _text({"schema": SCHEMA, "frahm": __version__, "complete": False}))
    except OSError as error:
        raise ParameterError("--out", str(out), "a directory that can be written", hint=f"{error.strerror}.") from None
    return out


def _is_reproduction(out: Path) -> bool:
    try:
        return json.loads((out / _SUMMARY).read_text(encoding="utf-8")).get("schema") == SCHEMA
    except (OSError, ValueError, AttributeError):
        return False


def _judged_claims(computed: Computations, progress: Progress) -> list[Judgement]:
    judgements: list[Judgement] = []
    waiting = judge_claims(computed)
    for claim in yang2022.CLAIMS:
        progress(f"claim {claim.id}")
        judgements.append(next(waiting))
    return judgements


def _write_tables(out: Path, judgements: list[Judgement], wholes: tuple[ExpressionJudgement, ...]) -> None:
    write_text(out / "claims.json", claims_json(judgements))
    write_text(out / "claims.csv", claims_csv(judgements))
    write_text(out / "claims.md", claims_markdown(judgements))
    write_text(out / "equations.csv", equations_csv(wholes))


def _draw(out: Path, computed: Computations, progress: Progress) -> None:
    from frahm.plotting.style import figure_style, save_figure

    for name, draw in figures().items():
        progress(f"figure {name.removeprefix('fig').lstrip('0')}")
        with figure_style():
            save_figure(draw(computed), out / name)


def _summary(judgements: list[Judgement], unverified: tuple[str, ...]) -> str:
    claims, equations = split(judgements)
    return _text(
        {
            "schema": SCHEMA,
            "frahm": __version__,
            "complete": True,
            "paper": {"doi": yang2022.DOI, "title": yang2022.TITLE, "journal": yang2022.JOURNAL},
            "results": {"claims": counts_text(claims), "equations": counts_text(equations)},
            "checks": [{"name": str(j.id), "status": j.verdict.value, "detail": j.explanation} for j in judgements],
            "unverified": list(unverified),
        }
    )


def _text(content: dict[str, Any]) -> str:
    return json.dumps(content, indent=2, ensure_ascii=False) + "\n"
