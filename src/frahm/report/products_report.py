"""The report of a design of products: one HTML file that needs no network."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from pathlib import Path
from typing import Any

from markupsafe import Markup

from frahm.analysis import plain
from frahm.files import write_text
from frahm.plotting.products import save_products_figure
from frahm.products import FAIL, NOT_VERIFIED, PASS, ProductStudy
from frahm.report.columns import Column, heads, of, rows_of
from frahm.report.environment import template
from frahm.report.numbers import number
from frahm.report.report import REPORT_FILE, figures_folder, image_address
from frahm.screening import share

Row = Mapping[str, Any]
_MARKS = {FAIL: "fail", NOT_VERIFIED: "unverified", PASS: "pass"}
_UNKNOWN = "-"


def write_products_report(study: ProductStudy, folder: str | Path) -> Path:
    """Draw the figure into `folder`/figures and write the report beside it; return the path of the report.

    Raises
    ------
    ParameterError
        If a file cannot be written.
    """
    figures, path = figures_folder(folder), Path(folder) / REPORT_FILE
    drawn = [] if study.best is None else save_products_figure(plain(study.best.row()), figures)
    images = {file.stem: image_address(file.read_text(encoding="utf-8")) for file in drawn if file.suffix == ".svg"}
    write_text(path, render_products_report(study, images))
    return path


def render_products_report(study: ProductStudy, images: dict[str, str]) -> str:
    """The report as HTML text; `images` are addresses of the figure by name."""
    results = plain(study.results())
    best = study.best
    word = PASS if best is None or best.passes else FAIL if study.fails else NOT_VERIFIED
    return template("products.html.jinja").render(
        study=study,
        results=results,
        word=word,
        mark=_MARKS[word],
        images=images,
        plots={},
        best=best,
        product_head=heads(_PRODUCTS),
        products=rows_of(_PRODUCTS, study.products),
        kind_head=heads(_KINDS),
        kinds=[] if best is None else rows_of(_KINDS, plain(best.row())["kinds"]),
        member_head=heads(_MEMBERS),
        members=[] if best is None else rows_of(_MEMBERS, plain(best.row())["members"]),
        unverified=study.unverified,
        others=[(one.title, text) for one in study.products if one is not best for text in one.unverified],
        not_served=study.not_served,
        provenance=[*results["provenance"]["versions"].items()],
    )


def _status(word: str) -> Markup:
    return Markup('<span class="status {}">{}</span>').format(_MARKS[word], word)


def _used(value: float | None) -> str:
    return _UNKNOWN if value is None else share(value)


def _word(product: Any) -> str:
    return PASS if product.passes else FAIL if product.fails else NOT_VERIFIED


def _some(value: float | None) -> str:
    return number(value, 4) if value else _UNKNOWN


def _in_parts(part: float) -> Callable[[float | None], str]:
    """Numbers in another unit, so much of the SI one."""
    return lambda value: _UNKNOWN if value is None else number(value / part, 3)


_PRODUCTS = (
    Column("Product", lambda product: product.title),
    Column("Worst utilisation", lambda product: plain(product.row())["worst_utilisation"], _used),
    Column("Binds", lambda product: plain(product.row())["binds"]),
    Column("By the closed form", lambda product: plain(product.row())["expected_worst"], _used),
    Column("Verdict", _word, _status),
)
_KINDS = (
    Column("Kind", of("kind")),
    Column("Mass [kg]", of("mass"), number),
    Column("Linear spring [N/m]", of("linear"), _some),
    Column("Cubic spring [N/m\N{SUPERSCRIPT THREE}]", of("kappa"), _some),
    Column("Damper [N s/m]", of("xi2"), number),
    Column("Own frequency [Hz]", of("frequency_hz"), _some),
    Column("Members", of("members"), ", ".join),
)
_MEMBERS = (
    Column("Member", of("member")),
    Column("f [Hz]", of("natural_frequency_hz"), _in_parts(1.0)),
    Column("Kind", of("kind")),
    Column("Mass ratio [%]", of("mass_ratio"), _in_parts(1e-2)),
    Column("Without", of("utilisation_without"), _used),
    Column("With", of("utilisation"), _used),
    Column("By the closed form", of("expected"), _used),
    Column("Peak [mm]", of("pipe_peak"), _in_parts(1e-3)),
    Column("Stroke [mm]", of("stroke"), _in_parts(1e-3)),
    Column("Stress range [MPa]", of("stress_range"), _in_parts(1e6)),
    Column("Damage", of("damage"), _in_parts(1.0)),
    Column("Verdict", of("verdict"), _status),
)
