"""The report of a design study: one HTML file that needs no network."""

from __future__ import annotations

import dataclasses
import math
from collections.abc import Callable
from pathlib import Path
from typing import Any

from frahm import readable
from frahm.analysis import FORCE_MARGIN, defaulted_fields, provenance
from frahm.analysis.decision import together
from frahm.case import Case, Design, field_table, field_values
from frahm.design import FAR, DesignedAbsorber, DesignStudy, Objective, Rival, design_summary
from frahm.files import write_text
from frahm.loads import lock_in_band, resonant_shedding, vortex_shedding
from frahm.plotting.decision import DEVICES, Marks
from frahm.plotting.design_figures import save_design_figures
from frahm.report import decision
from frahm.report.columns import Column, heads, rows_of, yes_or_no
from frahm.report.document import document_rows
from frahm.report.environment import template
from frahm.report.input_tables import input_rows
from frahm.report.numbers import number
from frahm.report.references import reference_rows
from frahm.report.report import REPORT_FILE, figures_folder, image_address
from frahm.response import frequency_response

_PARAMETERS = {"ρ₂": "rho2", "linear [1/s²]": "linear", "κ [1/(m² s²)]": "kappa", "ξ₂ [1/s]": "xi2"}
_ROPES = {  # the real competitor, which this program does not compute
    "Device": "helical ropes", "Worst pipe peak [mm]": "not computed", "Stroke [mm]": "0",
    "Rests on": "experience: three 25 mm ropes, 120° apart, pitch 1 m, cured Statfjord A",
}  # fmt: skip


def write_design_report(study: DesignStudy, folder: str | Path) -> Path:
    """Draw the figures into `folder`/figures and write the report beside them; return the path of the report.

    Raises
    ------
    ParameterError
        If a file cannot be written.
    """
    figures, path = figures_folder(folder), Path(folder) / REPORT_FILE
    curve = frequency_response(study.best_case).to_dataset()
    lasting = together(study.lasting) if study.lasting else None
    drawn = save_design_figures(study.to_dataset(), figures, curve, lasting, _marks(study.case))
    images = {file.stem: image_address(file.read_text(encoding="utf-8")) for file in drawn if file.suffix == ".svg"}
    write_text(path, render_design_report(study, images))
    return path


def render_design_report(study: DesignStudy, images: dict[str, str]) -> str:
    """The report as HTML text; `images` are addresses of the figures by name."""
    objective = study.objective
    compared = _comparison(objective, FAR * study.settings.force_margin)
    return template("design.html.jinja").render(
        study=study,
        **_head(study),
        asked=asked_rows(study),
        comparison_head=heads(compared),
        comparison=[
            *rows_of(compared, study.comparison), tuple(_ROPES.get(head, "-") for head in heads(compared)),
        ],
        by_count_head=heads(_by_count(objective)),
        by_count=rows_of(_by_count(objective), study.by_count) if len(study.settings.counts) > 1 else [],
        error_head=["Device", *(f"{100 * (r - 1):+.3g} %" if r != 1 else "0 %" for r in study.errors)],
        error_rows=error_rows(study),
        trade_off_head=heads(_trade_off(objective)),
        trade_off=rows_of(_trade_off(objective), study.trade_off),
        hardware=hardware_rows(study),
        sensitivities=sensitivity_rows(study),
        least_stroke=least_stroke(study),
        plots={},
        inputs=input_rows(study.case, defaulted_fields(study.case), study.case.typed),
        checks=check_rows(study),
        provenance=provenance_rows(study),
        missed=missed_below(study),
        force_margin=FORCE_MARGIN,
        images=images,
    )  # fmt: skip


def _head(study: DesignStudy) -> dict[str, Any]:
    """What the page that decides is made of."""
    checks = [(check["name"], check["status"]) for check in design_summary(study)["checks"]]
    return {
        "deciding": decision,
        "acceptance": study.acceptance,
        "lead": study.verdict,
        "decision": study.decision,
        "errors": study.frequency_errors(),
        "health": decision.numerical_checks(checks, study.unverified),
        "unverified": study.unverified,
        "interrupted": study.interrupted,
        "titles": document_rows(study.case),
        "references": reference_rows(
            study.case,
            {"lock_in_band": dataclasses.asdict(lock_in_band(study.case))},
            [rival.name for rival in study.comparison],
        ),
    }


def _marks(case: Case) -> Marks:
    shedding, band, omega = vortex_shedding(case), lock_in_band(case), case.pipe.frequency
    lo, hi = (omega * (ratio - 1) for ratio in band.ratios)
    return Marks(case.wind.speed, float(shedding.detuning), (band.low, band.high), (lo, hi), band.standing)


def check_rows(study: DesignStudy) -> list[tuple[str, str, str]]:
    """Check, outcome, detail."""
    marks = {"pass": "✓ pass", "unverified": "? unverified"}
    return [(check["name"], marks[check["status"]], check["detail"]) for check in design_summary(study)["checks"]]


def provenance_rows(study: DesignStudy) -> list[tuple[str, str]]:
    """Versions, seed and tolerances."""
    known = provenance(study.case)
    rows = [("frahm", study.version), *known["versions"].items()]
    rows += [("Seed of the sampled initial states", str(study.settings.seed))]
    tolerances = ("harmonic_balance_residual", "integration_tolerance")
    return rows + [(name.replace("_", " "), number(known["settings"][name])) for name in tolerances]


def missed_below(study: DesignStudy) -> str:
    """Basin that the sample misses at a frequency with a chance of 5 % [%]."""
    return f"{100 * (1 - 0.05 ** (1 / study.settings.samples)):.2g}"


def least_stroke(study: DesignStudy) -> str:
    """Motion of the mass below which no absorber balances the force, at the pipe's frequency."""
    design = study.best.design
    ratio = sum(one.rho2 for one in design.absorbers) if design else math.nan
    case = study.case
    lift = resonant_shedding(case).lift * float(case.pipe.modal.lift_lengths[0]) / case.pipe.length
    return readable.length(lift / (ratio * case.pipe.mass * case.pipe.frequency**2))


def asked_rows(study: DesignStudy) -> list[tuple[str, ...]]:
    """What was asked for: name, value, unit, and whether it was left at its default."""
    facts, settings = field_table(Design), study.settings
    rows: list[tuple[str, ...]] = []
    for field in field_values(settings):
        if field.path in ("errors", "margins"):
            continue
        about = facts[field.path]
        values = field.value if isinstance(field.value, tuple) else (field.value,)
        between = ", " if field.path == "mass_shares" else " ... "
        text = between.join(number(value, 5) if isinstance(value, float) else str(value) for value in values)
        if field.path.startswith("scatter.") and not field.value:
            continue
        rows.append((about.title, text, about.unit or "-", "" if field.given else "default"))
    return rows


def _comparison(objective: Objective, searched: float) -> list[Column]:
    """Columns of the devices compared; force margins were searched up to a factor."""
    aimed = Column(_titled(objective), lambda rival: _value(rival.value, objective))
    return [
        Column("Device", _device),
        *(Column(head, _of_design(name)) for head, name in _PARAMETERS.items()),
        *(() if _is_peak(objective) else (aimed,)),
        Column("Worst pipe peak [mm]", lambda rival: rival.worst_pipe_peak, readable.in_mm),
        Column("Motion", lambda rival: rival.kind, readable.motion),
        Column("Stroke [mm]", _stroke),
        Column("Force margin", lambda rival: _margin(rival.force_margin, searched)),
        Column("Rests on", _basis),
        Column("Verified", lambda rival: rival.verified, yes_or_no),
    ]


def _device(rival: Rival) -> str:
    design, name = rival.design, DEVICES[rival.name]
    if design is not None:
        name += f", {design.count} absorbers" if design.count > 1 else ""
        fifth = any(one.quintic for one in design.absorbers)
        name += f", fifth power {_each(design, 'quintic')} 1/(m⁴ s²)" if fifth else ""
        name += f", at {number(design.position)} m" if design.position is not None else ""
    return name


def _of_design(name: str) -> Callable[[Rival], str]:
    return lambda rival: "-" if rival.design is None else _each(rival.design, name)


def _trade_off(objective: Objective) -> list[Column]:
    """Columns of the designs for several force margins."""
    return [
        Column("Force", lambda point: f"{point.force_margin:g}"),
        Column("linear [1/s²]", lambda point: _each(point.design, "linear")),
        Column("κ [1/(m² s²)]", lambda point: _each(point.design, "kappa", 5)),
        Column("ξ₂ [1/s]", lambda point: _each(point.design, "xi2")),
        Column(_titled(objective), lambda point: _value(point.value, objective)),
        Column("Verified", lambda point: point.verified, yes_or_no),
    ]


def _by_count(objective: Objective) -> list[Column]:
    """Columns of the best designs of every family and number of absorbers."""
    return [
        Column("Device", lambda rival: DEVICES[rival.name]),
        Column("Absorbers", lambda rival: str(rival.count)),
        *(Column(head, _of_design(name)) for head, name in _PARAMETERS.items()),
        Column(_titled(objective), lambda rival: _value(rival.value, objective)),
        Column("Verified", lambda rival: rival.verified, yes_or_no),
    ]


def _each(design: DesignedAbsorber, name: str, digits: int = 4) -> str:
    """A parameter of every absorber."""
    return " · ".join(number(getattr(one, name), digits) for one in design.absorbers)


def _value(value: float, objective: Objective) -> str:
    return readable.in_mm(value) if objective.unit == "m" else number(value)


def _is_peak(objective: Objective) -> bool:
    return objective.name == "peak" and objective.quantile is None


def _titled(objective: Objective) -> str:
    title = objective.title[0].upper() + objective.title[1:]
    return f"{title} [{'mm' if objective.unit == 'm' else '-'}]"


def error_rows(study: DesignStudy) -> list[tuple[str, ...]]:
    """Worst pipe peaks of every device; a question mark where unverified."""
    return [
        (
            DEVICES[name],
            *(readable.in_mm(p) + ("" if s else " ?") for p, s in zip(peaks, study.error_verified[name], strict=True)),
        )
        for name, peaks in study.error_table.items()
    ]


def hardware_rows(study: DesignStudy) -> list[tuple[str, ...]]:
    """Name, value, unit, origin of every line of the hardware sheet, in the units of a workshop."""
    items = study.hardware.items if study.hardware else ()
    return [(item.name, *_as_made(item.value, item.unit), item.basis) for item in items]


def _as_made(value: float, unit: str) -> tuple[str, str]:
    columns = {"m": (readable.in_mm, "mm"), "Pa": (readable.in_mpa, "MPa")}
    if unit not in columns:
        return number(value), unit
    shown, made = columns[unit]
    return shown(value), made


def sensitivity_rows(study: DesignStudy) -> list[tuple[str, ...]]:
    """Parameter, slope of the peak, slope of the force margin."""
    return [(s.parameter, f"{s.pipe_peak:+.3g}", _slope(s.force_margin)) for s in study.sensitivities]


def _slope(value: float) -> str:
    return "-" if math.isnan(value) else f"{value:+.3g}"


def _stroke(rival: Rival) -> str:
    return "-" if rival.name == "none" else readable.in_mm(rival.worst.relative_peak)


def _margin(value: float, searched: float) -> str:
    """The force margin of a device; the search for it ends at a factor on the force."""
    if math.isinf(value):
        return "no such curve"
    return f"at least {searched:.4g}" if value >= searched else f"{value:.4g}"


def _basis(rival: Rival) -> str:
    return f"{rival.tier}, {rival.samples} states a frequency" if rival.samples else rival.tier
