"""The report: one HTML file that needs no network, rendered from an analysis."""

from __future__ import annotations

import base64
import pkgutil
import re
import zlib
from pathlib import Path
from typing import Any

import numpy as np
from markupsafe import Markup

from frahm import readable
from frahm.analysis import FORCE_MARGIN, CaseAnalysis, margin_sentence
from frahm.errors import ParameterError
from frahm.files import write_text
from frahm.plotting.fatigue import fatigue_plot
from frahm.plotting.gallery import bare_beside, save_figures, stands_over_wind
from frahm.plotting.interactive import CONFIG, basin_map_plot, manifold_plot, motion_plot, response_plot
from frahm.plotting.over_wind import over_wind_plot
from frahm.plotting.plain import PlainFigure
from frahm.plotting.views import MotionView, motion_views, trajectory_to_show
from frahm.plotting.wind import gusts_plot
from frahm.report import (
    check_tables,
    decision,
    fatigue_tables,
    input_tables,
    motion_tables,
    response_tables,
    wind_tables,
)
from frahm.report.document import document_rows
from frahm.report.environment import template
from frahm.report.references import reference_rows

REPORT_FILE = "report.html"
_MOST_MOTIONS = 8
_DRAWN = ("decision", "decision-narrow")  # not interactive
_LONG_COORDINATE = re.compile(r"(\.\d)\d+")
_PATH = re.compile(r' d="[^"]*"')


def write_report(analysis: CaseAnalysis, folder: str | Path) -> Path:
    """Draw the figures into `folder`/figures and render the report beside them; return the path of the report.

    Raises
    ------
    ParameterError
        If a file cannot be written.
    """
    figures, path = figures_folder(folder), Path(folder) / REPORT_FILE
    drawn = save_figures(analysis.results, analysis.data, figures)
    images = {file.stem: file.read_text(encoding="utf-8") for file in drawn if file.suffix == ".svg"}
    write_text(path, render_report(analysis, images))
    return path


def figures_folder(folder: str | Path) -> Path:
    """The folder of the figures beside a report, made if it is not there.

    Raises
    ------
    ParameterError
        If it cannot be made.
    """
    figures = Path(folder) / "figures"
    try:
        figures.mkdir(exist_ok=True)
    except OSError as error:
        raise ParameterError("DIR", str(folder), "a folder that can be written", hint=f"{error.strerror}.") from None
    return figures


def render_report(analysis: CaseAnalysis, images: dict[str, str]) -> str:
    """Return the report as HTML text with everything it needs inside.

    Parameters
    ----------
    analysis : CaseAnalysis
        What is reported.
    images : dict of str
        Figures by name as SVG text: for paper, and for readers without JavaScript.
    """
    views = motion_views(analysis.results, analysis.data)
    plots = _plots(analysis, views)
    return template("report.html.jinja").render(
        analysis=analysis,
        **_head(analysis),
        cards=cards(analysis.results),
        results=analysis.results,
        margin=margin_of(analysis.results),
        force_margin=FORCE_MARGIN,
        check_tables=check_tables,
        fatigue_tables=fatigue_tables,
        input_tables=input_tables,
        motion_tables=motion_tables,
        response_tables=response_tables,
        wind_tables=wind_tables,
        views=views[:_MOST_MOTIONS],
        more_motions=max(0, len(views) - _MOST_MOTIONS),
        plots=plots,
        zoomed='"narrow":' in plots.get("response-pipe", ""),
        images={name: image_address(svg) for name, svg in images.items() if name in {*plots, *_DRAWN}},
        plotly_js=packed_plotly(),
        plotly_config=CONFIG,
    )


def _head(analysis: CaseAnalysis) -> dict[str, Any]:
    """What the page that decides is made of."""
    results = analysis.results
    found, sentence = results["acceptance"], results["acceptance"]["sentence"]
    compared = results.get("decision")
    return {
        "deciding": decision,
        "acceptance": found,
        "lead": analysis.verdict.removeprefix(sentence).strip(),
        "decision": compared,
        "errors": compared["frequency_errors"] if compared else {},
        "health": decision.numerical_checks([(c.name, c.status) for c in analysis.checks], analysis.unverified),
        "unverified": analysis.unverified,
        "interrupted": analysis.interrupted,
        "titles": document_rows(analysis.case),
        "references": reference_rows(
            analysis.case, results.get("wind"), [row["name"] for row in compared["rows"]] if compared else ()
        ),
    }


def margin_of(results: dict[str, Any]) -> str:
    """The sentence on births and merges of detached curves; empty if they were not searched."""
    exact = results.get("response", {}).get("harmonic-balance", {})
    return margin_sentence(exact.get("detached_curve_margin"))


def _plots(analysis: CaseAnalysis, views: list[MotionView]) -> dict[str, Markup]:
    """Interactive figures as JSON, by the same names as the figures on paper."""
    data, results = analysis.data, analysis.results
    figures: dict[str, PlainFigure] = {}
    for name, quantity in (("response-pipe", "pipe_peak"), ("response-absorber", "relative_peak")):
        if "response" in data and quantity in data["response"]:
            beside = bare_beside(results, data), data.get("slow_flow"), data.get("modulated")
            figures[name] = response_plot(data["response"], quantity, views, *beside)
    for view in views[:_MOST_MOTIONS]:
        figures[f"motion-{view.key}"] = motion_plot(view)
    if "response_over_wind" in data and not stands_over_wind(data):
        both = data["response_over_wind"], data["without_absorber_over_wind"]
        figures["response-over-wind"] = over_wind_plot(*both)
    if "unsteady_wind" in data:
        figures["unsteady-wind"] = gusts_plot(data["unsteady_wind"])
    if "slow_manifold" in data:
        folds = results["slow_manifold"]["folds"]
        figures["slow-manifold"] = manifold_plot(data["slow_manifold"], trajectory_to_show(views), folds)
    if "basin_map" in data:
        figures["basin-map"] = basin_map_plot(data["basin_map"])
    if "fatigue" in data:
        figures["fatigue"] = fatigue_plot(data["fatigue"])
    return {name: Markup(_inside_script(figure)) for name, figure in figures.items()}


def _inside_script(figure: PlainFigure) -> str:
    """JSON of a figure that cannot end the script element it stands in."""
    return figure.to_json().replace("<", "\\u003c")


def image_address(svg: str) -> str:
    """The drawing as data address, coordinates to a tenth of a point: no reader sees more, and it is half as long."""
    short = _PATH.sub(lambda path: _LONG_COORDINATE.sub(r"\1", path[0]), svg)
    return "data:image/svg+xml;base64," + base64.b64encode(short.encode()).decode()


def packed_plotly() -> str:
    """plotly.js, deflated and in base64: what the browser inflates is two and a half times as long."""
    script = pkgutil.get_data("plotly", "package_data/plotly.min.js")
    if script is None:
        raise RuntimeError("plotly is installed without its package_data/plotly.min.js")
    return base64.b64encode(zlib.compress(script, 4)).decode()


def cards(results: dict[str, Any]) -> list[tuple[str, str, str]]:
    """The few numbers a reader looks for first: name, value, remark."""
    shown = []
    largest = results.get("largest_motion")
    if largest:
        shown.append(("Largest pipe motion found", readable.length(largest["pipe_peak"]),
                      f"{largest['kind']}, {_place(largest)}"))  # fmt: skip
        if results["has_absorber"] and largest["ratio_to_no_absorber"] is not None:
            bare = results["without_absorber"]["pipe_peak_max"]
            shown.append(("Share of the motion without absorber", f"{largest['ratio_to_no_absorber']:.1%}",
                          f"of {readable.length(bare)} at resonance"))  # fmt: skip
        if results["has_absorber"] and largest["stroke"] is not None:
            shown.append(("Largest stroke of the absorber", readable.length(largest["stroke"]), "relative to the pipe"))
    if results.get("motions") and results["motions"][0]["pipe_peak"] is not None:
        motion = results["motions"][0]
        shown.append(("From rest at the design wind", readable.length(motion["pipe_peak"]),
                      f"{motion['kind']}, without lock-in, {_place(motion)}"))  # fmt: skip
    return shown


def _place(found: dict[str, Any]) -> str:
    speed = found.get("wind_speed")
    if speed is not None and np.isfinite(speed):
        return f"at {readable.speed(speed)}"
    return f"at σ = {found['detuning']:.3g} rad/s"
