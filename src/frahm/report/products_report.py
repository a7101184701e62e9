"""The report of a design of products: one HTML file that needs no network."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import Any

from markupsafe import Markup

from frahm.analysis import plain
from frahm.files import write_text
from frahm.plotting.products import save_products_figure
from frahm.products import FAIL, NOT_VERIFIED, PASS, ProductStudy
from frahm.report.environment import template
from frahm.report.numbers import number
from frahm.report.report import REPORT_FILE, figures_folder, image_address
from frahm.screening import share

Row = Mapping[str, Any]
_MARKS = {FAIL: "fail", NOT_VERIFIED: "unverified", PASS: "pass"}
_UNKNOWN = "-"
PRODUCT_HEAD = ["Product", "Worst utilisation", "Binds", "By the closed form", "Verdict"]
KIND_HEAD = [
    "Kind", "Mass [kg]", "Linear spring [N/m]", "Cubic spring [N/m\N{SUPERSCRIPT THREE}]", "Damper [N s/m]",
    "Own frequency [Hz]", "Members",
]  # fmt: skip
MEMBER_HEAD = [
    "Member", "f [Hz]", "Kind", "Mass ratio [%]", "Without", "With", "By the closed form", "Peak [mm]", "Stroke [mm]",
    "Stress range [MPa]", "Damage", "Verdict",
]  # fmt: skip


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
        product_head=PRODUCT_HEAD,
        products=[_product_row(one) for one in study.products],
        kind_head=KIND_HEAD,
        kinds=[] if best is None else [_kind_row(kind) for kind in plain(best.row())["kinds"]],
        member_head=MEMBER_HEAD,
        members=[] if best is None else [_member_row(row) for row in plain(best.row())["members"]],
        unverified=study.unverified,
        others=[(one.title, text) for one in study.products if one is not best for text in one.unverified],
        not_served=study.not_served,
        provenance=[*results["provenance"]["versions"].items()],
    )


def _status(word: str) -> Markup:
    return Markup('<span class="status {}">{}</span>').format(_MARKS[word], word)


def _used(value: float | None) -> str:
    return _UNKNOWN if value is None else share(value)


def _product_row(product: Any) -> tuple[Any, ...]:
    row = plain(product.row())
    word = PASS if product.passes else FAIL if product.fails else NOT_VERIFIED
    return product.title, _used(row["worst_utilisation"]), row["binds"], _used(row["expected_worst"]), _status(word)


def _kind_row(row: Row) -> tuple[str, ...]:
    def some(value: float | None) -> str:
        return number(value, 4) if value else _UNKNOWN

    return (
        str(row["kind"]), number(row["mass"], 4), some(row["linear"]), some(row["kappa"]), number(row["xi2"], 4),
        some(row["frequency_hz"]), ", ".join(row["members"]),
    )  # fmt: skip


def _member_row(row: Row) -> tuple[Any, ...]:
    def times(value: float | None, factor: float) -> str:
        return _UNKNOWN if value is None else number(factor * value, 3)

    return (
        row["member"], number(row["natural_frequency_hz"], 3), str(row["kind"]), times(row["mass_ratio"], 100),
        _used(row["utilisation_without"]), _used(row["utilisation"]), _used(row["expected"]),
        times(row["pipe_peak"], 1e3), times(row["stroke"], 1e3), times(row["stress_range"], 1e-6),
        times(row["damage"], 1.0), _status(row["verdict"]),
    )  # fmt: skip
