"""Rows on how far the numbers can be trusted: methods compared, checks, versions, as text ready to be read."""

from __future__ import annotations

from collections.abc import Callable

from frahm.analysis import CaseAnalysis
from frahm.report.numbers import number
from frahm.report.places import over_wind, place_head

_MARKS = {"pass": "✓ pass", "fail": "✗ fail", "unverified": "? unverified"}
_SETTINGS = {
    "slow_flow_form": "Form of the slow flow",
    "harmonic_balance_residual": "Harmonic balance: residual below",
    "integration_tolerance": "Integration: local error below this share of the motion",
    "integration_periods": "Integration: excitation periods",
    "samples_per_period": "Integration: samples in a period",
    "periodic_below": "Periodic: Poincaré section within this share of its size",
}


def comparison_head(analysis: CaseAnalysis) -> list[str]:
    """Column heads of `comparison_rows`."""
    return [place_head(analysis), *(head for head, _, _ in _comparisons(analysis))]


def comparison_rows(analysis: CaseAnalysis) -> list[tuple[str, ...]]:
    """Peaks by three methods and their differences, response by response, in order of the detuning."""
    if "cross_check" not in analysis.data:
        return []
    table = analysis.data["cross_check"].sortby("detuning")
    columns = [[form(float(value)) for value in table[name].values] for _, name, form in _comparisons(analysis)]
    places = table["wind_speed" if over_wind(analysis) else "detuning"].values
    return list(zip([number(float(place)) for place in places], *columns, strict=True))


def _comparisons(analysis: CaseAnalysis) -> list[tuple[str, str, Callable[[float], str]]]:
    """Head, variable and form of every column that is there."""
    columns: list[tuple[str, str, Callable[[float], str]]] = []
    for name, text in (("pipe", "Pipe"), ("relative", "Stroke")):
        columns += [
            (f"{text}, harmonic balance [mm]", f"{name}_peak", lambda value: number(1e3 * value, 6)),
            ("Off integration by", f"{name}_error", lambda value: f"{value:+.1e}"),
            (f"{text}, slow flow [mm]", f"slow_{name}_peak", lambda value: number(1e3 * value)),
            ("Off by", f"slow_{name}_error", lambda value: f"{value:+.2%}"),
        ]
    return [column for column in columns if column[1] in analysis.data["cross_check"]]


def check_rows(analysis: CaseAnalysis) -> list[tuple[str, str, str, str]]:
    """Name, status, its sign in words, detail of every check."""
    return [(check.name, check.status, _MARKS[check.status], check.detail) for check in analysis.checks]


def provenance_rows(analysis: CaseAnalysis) -> list[tuple[str, str]]:
    """Versions, seed and tolerances: name and value."""
    found, settings = analysis.results["provenance"], analysis.case.analysis
    rows = [("frahm", analysis.version), *found["versions"].items()]
    rows += [("Seed of the sampled initial states", str(settings.seed)), ("Initial states", str(settings.samples))]
    return rows + [
        (_SETTINGS.get(name, name.replace("_", " ")), number(value)) for name, value in found["settings"].items()
    ]
