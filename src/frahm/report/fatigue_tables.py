"""Rows of the tables on fatigue in a report, as text ready to be read."""

from __future__ import annotations

import math
from typing import Any

from frahm import readable
from frahm.analysis import CaseAnalysis
from frahm.report.columns import Column, heads, of, rows_of
from frahm.report.numbers import number
from frahm.units import MPA

_CASE, _COMPUTED = "given in the case", "computed"


def method_sentence(analysis: CaseAnalysis) -> str:
    """What was counted and how."""
    found = _found(analysis)
    low, high = found["wind_speeds"]
    return (
        f"Palmgren-Miner damage over {number(found['duration_years'])} years by the vortices of winds from"
        f" {number(low)} to {number(high)} m/s, in {found['bins']} bins. At every wind each lasting motion was followed"
        f" and its stress cycles counted by the rainflow method ({analysis.data['fatigue'].attrs['rainflow']}); curve"
        f" {found['curve']} of DNV-RP-C203 in air. Without absorbers the response is known in closed form."
    )


def damage_rows(analysis: CaseAnalysis) -> list[tuple[str, str, str]]:
    """Name, value with, value without absorbers."""
    found = _found(analysis)
    factor = number(found["design_fatigue_factor"])
    return [
        ("Damage, worst motion at every wind", _damage(found["damage_with"]), _damage(found["damage_without"])),
        ("Damage, motions weighted by their basins", _damage(found["damage_with_weighted"]), ""),
        (f"Times the design fatigue factor {factor}", _damage(found["utilisation_with"]),
         _damage(found["utilisation_without"])),
        ("Life until that is 1 [years]", _life(found["life_years"]), _life(found["life_years_without"])),
        ("Damage if locked in over the whole band (secondary)", _damage(found["locked_in_with"]),
         _damage(found["locked_in_without"])),
        ("Damage by winds outside the bins, not counted above", "", _damage(found["outside_without"])),
    ]  # fmt: skip


def detail_rows(analysis: CaseAnalysis) -> list[tuple[str, str, str, str]]:
    """Quantity, value, unit, standing."""
    found, stay = _found(analysis), _found(analysis)["persistence"]
    attributes = analysis.data["fatigue"].attrs
    low, high = found["lock_in"]
    rows = [
        ("S-N curve", str(found["curve"]), "", f"table read at second hand: {attributes['sn_curve_source']}"),
        ("Stress factor: concentration times thickness", number(float(attributes["stress_factor"])), "",
         "exponent as the curve, reference thickness secondary"),
        ("Largest hot-spot stress range with absorbers", _stress(found["stress_range_with"]), "MPa", _COMPUTED),
        ("Largest hot-spot stress range without", _stress(found["stress_range_without"]), "MPa", _COMPUTED),
        ("Lock-in band", f"{number(low)} … {number(high)}", "m/s", "secondary"),
        ("Share of the time in the lock-in band", number(stay["probability"], 3), "", "computed from the climate"),
        ("Mean stay of the wind in it", number(stay["mean_stay"], 3), "s", "secondary: a simple model"),
        ("Time the response needs to build up", number(stay["build_up"], 3), "s", _COMPUTED),
        ("Share of that time in stays that go on as long", number(stay["share_built_up"], 2), "", "secondary"),
    ]  # fmt: skip
    if found["section"] is not None:
        rows.insert(1, ("Section of the pipe", number(float(found["section"])), "m", _COMPUTED))
    return rows


def bin_rows(analysis: CaseAnalysis) -> list[tuple[str, ...]]:
    """Every wind bin."""
    data = analysis.data["fatigue"]
    kinds = data["kind"].attrs["kinds"].split(", ")
    columns: dict[str, Any] = {str(name): data[name].values for name in data}
    records = [{name: values[i].item() for name, values in columns.items()} for i in range(len(columns["kind"]))]
    return rows_of(_BINS, [record | {"kind": kinds[record["kind"]]} for record in records])


def _found(analysis: CaseAnalysis) -> dict[str, Any]:
    return dict(analysis.results["fatigue"])


def _damage(value: float | None) -> str:
    return "unbounded" if value is None or value == float("inf") else number(float(value), 3)


def _life(value: float | None) -> str:
    return "endless" if value is None or value == float("inf") else number(float(value), 3)


def _stress(value: float | None) -> str:
    return "unbounded" if value is None or value == float("inf") else number(float(value) / MPA, 3)


_BINS = [
    Column("Wind [m/s]", lambda row: f"{row['speed_lower']:.4g} … {row['speed_upper']:.4g}"),
    Column("Frequency [Hz]", lambda row: row["frequency"] / (2 * math.pi), number),
    Column("Share of the time", of("probability"), lambda share: number(share, 3)),
    Column("Stress range with [MPa]", of("stress_range_with"), _stress),
    Column("without [MPa]", of("stress_range_without"), _stress),
    Column("Motion", of("kind"), readable.motion),
    Column("Attractors", of("attractors")),
    Column("Damage with", of("damage_with"), _damage),
    Column("weighted", of("damage_with_weighted"), _damage),
    Column("without", of("damage_without"), _damage),
]
BIN_HEAD = heads(_BINS)
