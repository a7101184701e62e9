"""Rows on the wind: similarity numbers, onset criteria, estimates and gusts, as text ready to be read."""

from __future__ import annotations

import math

from frahm import readable
from frahm.analysis import CaseAnalysis
from frahm.report.columns import Column, heads, of, rows_of
from frahm.report.numbers import number


def similarity_rows(analysis: CaseAnalysis) -> list[tuple[str, str]]:
    """Name and value of every similarity number."""
    found = analysis.results["wind"]
    band = found["lock_in_band"]
    return [
        ("Reduced velocity U / (f D)", number(found["reduced_velocity"], 3)),
        ("Reynolds number", number(found["reynolds_number"], 3)),
        ("Strouhal number", number(found["strouhal"], 3)),
        ("Mass ratio m / (ρ D²)", number(found["mass_ratio"], 3)),
        ("Mass damping K_s, the Scruton number", number(found["scruton_number"], 3)),
        ("Skop-Griffin number S_G", number(found["skop_griffin_number"], 3)),
        (f"Lock-in band [m/s], {band['standing']}", f"{number(band['low'], 3)} … {number(band['high'], 3)}"),
        ("Time constant of the build-up 1/(ζω) [s]", number(found["build_up_time"], 3)),
    ]


def criterion_rows(analysis: CaseAnalysis) -> list[tuple[str, ...]]:
    """Every onset criterion."""
    return rows_of(_CRITERIA, analysis.results["wind"]["criteria"])


def estimate_rows(analysis: CaseAnalysis) -> list[tuple[str, ...]]:
    """Every amplitude estimate."""
    return rows_of(_ESTIMATES, analysis.results["wind"]["estimates"])


def estimate_sentence(analysis: CaseAnalysis) -> str:
    """The interval of the estimates beside the computed amplitude."""
    found = analysis.results["wind"]
    low, high, computed = (readable.in_mm(value) for value in (*found["interval"], found["computed"]))
    used = f"this analysis uses the harmonic lift of the case, which gives {computed} mm over its range"
    if sum(row["ratio"] is not None and not math.isnan(row["ratio"]) for row in found["estimates"]) == 1:
        return f"No published estimate can be given; {used}."
    return f"The estimates span {low} … {high} mm; {used}."


def load_cycle_rows(analysis: CaseAnalysis) -> list[tuple[str, ...]]:
    """The number of load cycles at resonance."""
    return rows_of(_LOAD_CYCLES, [analysis.results["wind"]["load_cycles"]])


def unsteady_rows(analysis: CaseAnalysis) -> list[tuple[str, ...]]:
    """Quantity, value with absorbers and value without; one value if there are none."""
    found = analysis.results["unsteady_wind"]
    gusts = found["reduction_by_gusts"]
    rows: list[tuple[str, ...]] = [
        ("Largest pipe displacement [mm]", readable.in_mm(found["pipe_peak"]), readable.in_mm(found["bare_pipe_peak"])),
        ("Pipe rms [mm]", readable.in_mm(found["pipe_rms"]), readable.in_mm(found["bare_pipe_rms"])),
        ("Pipe rms in steady wind of the same mean [mm]", readable.in_mm(found["steady_pipe_rms"]),
         readable.in_mm(found["bare_steady_pipe_rms"])),
        ("Reduction by the gusts", _percent(gusts["with_absorbers"]), _percent(gusts["without_absorbers"])),
        ("Reduction by the absorbers", _percent(found["reduction_by_absorbers"]), "-"),
        ("Amplitude in steady resonant wind [mm]", "-", readable.in_mm(found["resonant_amplitude"])),
        ("Build-up in steady resonant wind, time constant [s]", "-", number(found["build_up_time"])),
    ]  # fmt: skip
    if analysis.results["has_absorber"]:
        return rows
    return [(row[0], row[2]) for row in rows if row[2] != "-"]


def _percent(value: float | None) -> str:
    return "-" if value is None or not math.isfinite(value) else f"{value:.0%}"


_EXPECTED = {True: "yes", False: "no", None: "not decided"}
_CRITERIA = [
    Column("Criterion", of("name")),
    Column("Vibration is expected for", of("condition")),
    Column("Expected here", of("expects_vibration"), _EXPECTED.__getitem__),
    Column("Evidence", of("detail")),
    Column("Standing", of("standing")),
]
CRITERION_HEAD = heads(_CRITERIA)
_ESTIMATES = [
    Column("Estimate", of("name")),
    Column("A/D", of("ratio"), lambda ratio: number(ratio, 3)),
    Column("A [mm]", of("amplitude"), readable.in_mm),
    Column("From", of("detail")),
    Column("Standing", of("standing")),
]
ESTIMATE_HEAD = heads(_ESTIMATES)
_LOAD_CYCLES = [
    Column("Number", lambda _: "EN 1991-1-4, load cycles at resonance"),
    Column("N", of("number"), lambda count: number(count, 3)),
    Column("From", of("detail")),
    Column("Standing", of("standing")),
]
LOAD_CYCLE_HEAD = heads(_LOAD_CYCLES)
