"""The list of references of a report: every formula or limit used, with its standing."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from typing import Any

from frahm.assessment import CONVENTION
from frahm.case import Case
from frahm.published.dnv_rp_c203 import SOURCE

Reference = tuple[str, str, str]
_EQUAL_PEAKS = "Asami and Nishihara, J. Vib. Acoust. 125 (2003) 398-405, doi 10.1115/1.1569514"
_SPLIT = "Den Hartog, Mechanical Vibrations, section 3.2"
_SINK = "Yang et al., Appl. Sci. 12 (2022) 7272, doi 10.3390/app12147272"
_OWN = "given in the case"


def reference_rows(case: Case, wind: Mapping[str, Any] | None, devices: Iterable[str]) -> list[Reference]:
    """Used for what, source and standing of everything a report rests on.

    Parameters
    ----------
    case : Case
    wind : mapping or None
        Criteria, estimates and lock-in band of an analysis, or the band alone, as plain data with their sources.
    devices : iterable of str
        Names of the devices compared.
    """
    rows: list[Reference] = []
    if wind is not None:
        for kind, name in (("Onset", "criteria"), ("Amplitude", "estimates")):
            rows += [(f"{kind}: {row['name']}", row["source"], row["standing"]) for row in wind.get(name, [])]
        band = wind["lock_in_band"]
        rows.append(("Lock-in band", band["source"], band["standing"]))
    if case.analysis.detuning is None and case.analysis.wind is None:
        rows.append(("Range of operation: resonances split by an absorber", _SPLIT, "secondary"))
    if "tuned mass damper" in devices:
        rows.append(("Tuned mass damper of equal peaks", _EQUAL_PEAKS, "secondary, checked numerically"))
    if case.absorbers or "sink" in devices:
        rows.append(("Equations of a pipe with a cubic sink", _SINK, "verified"))
    if case.fatigue is not None:
        rows.append((f"S-N curve {case.fatigue.curve}", SOURCE, "read at second hand"))
        rows.append(("Counting of stress cycles", CONVENTION, "verified on its example"))
    if case.limits is not None:
        rows += [
            (f"Limit: {name.replace('_', ' ')}", _OWN, _OWN)
            for name in sorted(case.limits.model_fields_set)
            if getattr(case.limits, name) is not None
        ]
    return rows
