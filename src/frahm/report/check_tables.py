"""Rows on how far the numbers can be trusted: methods compared, checks, versions, as text ready to be read."""

from __future__ import annotations

from frahm.analysis import CaseAnalysis
from frahm.plotting.lines import MM
from frahm.report.columns import Column, heads, of, rows_of
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
    """Head of `comparison_rows`."""
    return heads(_comparisons(analysis))


def comparison_rows(analysis: CaseAnalysis) -> list[tuple[str, ...]]:
    """Peaks by three methods and their differences, response by response, in order of the detuning."""
    if "cross_check" not in analysis.data:
        return []
    table = analysis.data["cross_check"].sortby("detuning")
    records = [{str(name): float(table[name].values[i]) for name in table} for i in range(len(table["detuning"]))]
    return rows_of(_comparisons(analysis), records)


def _comparisons(analysis: CaseAnalysis) -> list[Column]:
    """The columns that are there."""
    place = "wind_speed" if over_wind(analysis) else "detuning"
    columns = {place: Column(place_head(analysis), of(place), number)}
    for name, text in (("pipe", "Pipe"), ("relative", "Stroke")):
        exact, slow, error, slow_error = f"{name}_peak", f"slow_{name}_peak", f"{name}_error", f"slow_{name}_error"
        columns |= {
            exact: Column(f"{text}, harmonic balance [mm]", of(exact), lambda value: number(MM * value, 6)),
            error: Column("Off integration by", of(error), lambda value: f"{value:+.1e}"),
            slow: Column(f"{text}, slow flow [mm]", of(slow), lambda value: number(MM * value)),
            slow_error: Column("Off by", of(slow_error), lambda value: f"{value:+.2%}"),
        }
    return [column for name, column in columns.items() if name in analysis.data["cross_check"]]


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
