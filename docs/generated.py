"""Pages that are made from the code itself each time the documentation is built, as Markdown in docs/_generated."""

from __future__ import annotations

import os
import re
import subprocess
import sys
from collections.abc import Iterator
from pathlib import Path

from validation_page import validation

ROOT = Path(__file__).resolve().parents[1]
OUT = ROOT / "docs" / "_generated"
SHORT_EXAMPLES = ("seed_paper", "unsafe_optimum", "sweep_on_a_cluster")
GREEK = {
    "kappa": "κ", "omega": "ω", "Omega": "Ω", "sigma": "σ", "rho": "ρ", "xi": "ξ", "zeta": "ζ", "gamma": "γ",
    "alpha": "α", "beta": "β", "theta": "θ", "nu": "ν",
}  # fmt: skip
_SUBSCRIPTS, _POWERS = str.maketrans("0123456789", "₀₁₂₃₄₅₆₇₈₉"), str.maketrans("0123456789", "⁰¹²³⁴⁵⁶⁷⁸⁹")


def write_pages() -> None:
    """Write every generated page; a file that would not change is left alone."""
    OUT.mkdir(exist_ok=True)
    pages = {"nomenclature": nomenclature, "results": results, "misprints": misprints, "validation": validation,
             "sweep_variables": sweep_variables, "member_columns": member_columns}  # fmt: skip
    for name, page in {**pages, "api": api}.items():
        _keep(OUT / f"{name}.md", page())
    for name in SHORT_EXAMPLES:
        _keep(OUT / f"{name}.txt", _output_of(ROOT / "examples" / f"{name}.py"))


def _keep(path: Path, text: str) -> None:
    if not path.exists() or path.read_text(encoding="utf-8") != text:
        path.write_text(text, encoding="utf-8")


def _output_of(script: Path) -> str:
    """What an example prints, run now."""
    environment = {**os.environ, "PYTHONIOENCODING": "utf-8"}
    done = subprocess.run(
        [sys.executable, str(script), str(OUT)], capture_output=True, text=True, encoding="utf-8", check=False,
        env=environment, cwd=ROOT,
    )  # fmt: skip
    if done.returncode != 0:
        raise RuntimeError(f"{script.name} failed:\n{done.stderr}")
    return done.stdout


def _table(head: tuple[str, ...], rows: Iterator[tuple[str, ...]] | list[tuple[str, ...]]) -> list[str]:
    cells = [head, tuple("---" for _ in head), *rows]
    return ["| " + " | ".join(cell.replace("|", "\\|") for cell in row) + " |" for row in cells] + [""]


def _code(text: str) -> str:
    return f"`{text}`" if text else ""


# --- nomenclature ---------------------------------------------------------------------------------------------------


def _symbol(text: str) -> str:
    """A symbol such as m_1 or rho_2, with its index below."""
    base, _, index = text.partition("_")
    base = GREEK.get(base, f"*{base}*" if base else "")
    return f"{base}<sub>{index}</sub>" if index else base


def _default(facts) -> str:
    from pydantic import BaseModel

    if facts.required:
        return "*required*"
    if facts.default is None or facts.default in ((), ""):
        return "left out"
    if isinstance(facts.default, BaseModel) or str(facts.default).startswith("Pydantic"):
        return "see below"
    value = facts.default
    shown = (
        f"{value:.6g}"
        if isinstance(value, float)
        else ", ".join(map(str, value))
        if isinstance(value, tuple)
        else value
    )
    return _code(str(shown))


def nomenclature() -> str:
    """Every field of a case file, section by section."""
    from frahm.case import Case, field_table

    sections: dict[str, list] = {}
    for path, facts in field_table(Case).items():
        section, _, _ = path.rpartition(".")
        sections.setdefault(section, []).append(facts)
    lines: list[str] = []
    for section, found in sections.items():
        lines += [f"## `{section}`" if section else "## The case", "", "````{container} fields-table", ""]
        lines += _table(
            ("field", "symbol", "unit", "what it is", "allowed", "default"),
            [
                (_code(f.path.rpartition(".")[2]), _symbol(f.symbol), _code(f.unit), f"**{f.title}.** {f.description}",
                 f.allowed, _default(f))
                for f in found
            ],
        )  # fmt: skip
        lines += ["````", ""]
    return "\n".join(lines)


def results() -> str:
    """Every variable of the datasets, with its unit, from short computations."""
    import frahm

    case = frahm.load_case("jacket-pipe")
    history = frahm.integrate(case, detuning=0.0, periods=20, samples_per_period=16)
    found = {
        "Response curve, `frahm.frequency_response(...).to_dataset()`": frahm.frequency_response(
            case, detuning=(-0.1, 0.1), method="slow-flow"
        ).to_dataset(),
        "Time history, `frahm.integrate(...).to_dataset()`": history.to_dataset(),
        "Spectrum, `.spectrum()`": history.spectrum(),
        "Slow flow over parameters, `frahm.slow_flow_map(...)`": frahm.slow_flow_map(
            case, detuning=[0.0], kappa=[100.0], xi2=[0.01]
        ),
    }
    lines = []
    for title, data in found.items():
        lines += [f"### {title}", ""]
        lines += _table(
            ("variable", "unit", "what it is", "over"),
            [
                (_code(str(name)), _code(data[name].attrs.get("units", "")), data[name].attrs.get("long_name", ""),
                 _code(", ".join(map(str, data[name].dims))))
                for name in data.variables
            ],
        )  # fmt: skip
    return "\n".join(lines)


def sweep_variables() -> str:
    """Every variable a sweep can store, quantity by quantity."""
    import frahm
    from frahm.sweep.variables import variables_of_quantity

    case = frahm.load_case("jacket-pipe-elastic")
    lines = []
    for title, name, place in (
        ("`slow_flow` over a window", "slow_flow", "window"), ("`slow_flow` at a detuning", "slow_flow", 0.0),
        ("`response` over a window", "response", "window"), ("`response` at a detuning", "response", 0.0),
        ("`attractors` over a window", "attractors", "window"), ("`attractors` at a detuning", "attractors", 0.0),
        ("`fatigue`", "fatigue", None),
    ):  # fmt: skip
        settings = {} if place is None else {"detuning": place}
        start = "jacket-pipe" if name == "slow_flow" else case
        study = frahm.load_study({"case": start, "axes": {"pipe_damping": [0.01]}, "quantities": {name: settings}})
        lines += [f"**{title}**", ""]
        lines += _table(
            ("variable", "unit", "what it is"),
            [(_code(v.name), _code(v.units), v.long_name + (f" ({v.codes})" if v.codes else ""))
             for v in variables_of_quantity(study, name)],
        )  # fmt: skip
    return "\n".join(lines)


# --- members --------------------------------------------------------------------------------------------------------


def member_columns() -> str:
    """The columns of a table of members, with their other names and defaults."""
    from frahm.screening import COLUMNS

    rows = [
        (_code(c.head), ", ".join(map(_code, c.aliases)), c.description, f"*{c.default}*" if c.required else c.default)
        for c in COLUMNS
    ]
    return "\n".join(_table(("column", "also", "what it is", "default"), rows))


# --- misprints ------------------------------------------------------------------------------------------------------


def _formula(text: str) -> str:
    """A formula in plain letters with Greek letters, subscripts and powers."""
    text = re.sub(r"e\^\{([^}]*)\}", lambda m: f"e<sup>{m[1]}</sup>", text)
    text = re.sub(r"\b(kappa|omega|Omega|sigma|rho|xi|gamma|alpha|beta)(\d?)(?![a-z])",
                  lambda m: GREEK[m[1]] + m[2].translate(_SUBSCRIPTS), text)  # fmt: skip
    text = re.sub(r"\b([kmpqxztABDJ])(\d+)", lambda m: m[1] + m[2].translate(_SUBSCRIPTS), text)
    text = re.sub(r"k_nes", "k<sub>nes</sub>", text)
    text = re.sub(r"\^(\d)", lambda m: m[1].translate(_POWERS), text)
    return re.sub(r"(?<![\w])-(?=[\sκ(])", "−", text)


def misprints() -> str:
    """The misprints of the paper, as the tests know them."""
    from frahm.published.yang2022 import MISPRINTS

    rows = [tuple(_formula(cell) for cell in (m.where, m.printed, m.corrected, m.reason)) for m in MISPRINTS]
    return "\n".join(_table(("where", "as printed", "must be", "how one knows"), rows))


# --- reference ------------------------------------------------------------------------------------------------------

_ROOMS = {
    "frahm.case": "The case", "frahm.systems": "Systems", "frahm.absorbers": "Force laws", "frahm.structure": "Beams",
    "frahm.loads": "Wind", "frahm.plausibility": "Plausibility",
    "frahm.response": "Responses", "frahm.harmonic_balance": "Periodic responses",
    "frahm.time_integration": "Integration", "frahm.attractors": "Attractors", "frahm.assessment": "Fatigue",
    "frahm.design": "Design", "frahm.screening": "Members",
    "frahm.products": "Products",
    "frahm.sweep": "Parameter studies", "frahm.errors": "Errors",
}  # fmt: skip


def api() -> str:
    """All public names, room by room."""
    import inspect

    import frahm

    rooms: dict[str, list[str]] = {}
    for name, room in frahm._PUBLIC.items():
        rooms.setdefault(room, []).append(name)
    order = [*(room for room in _ROOMS if room in rooms), *(room for room in rooms if room not in _ROOMS)]
    lines = []
    for room in order:
        lines += [f"## {_ROOMS.get(room, room)}", ""]
        for name in rooms[room]:
            thing = getattr(frahm, name)
            path = f"frahm.{name}"
            if inspect.ismodule(thing):  # a room that is called like its verb
                thing, path = getattr(thing, name), f"{room}.{name}"
            kind = "autofunction" if inspect.isroutine(thing) else "autoclass" if inspect.isclass(thing) else "autodata"
            options = ["   :members:"] if kind == "autoclass" else []
            lines += ["```{eval-rst}", f".. {kind}:: {path}", *options, "```", ""]
    return "\n".join(lines)
