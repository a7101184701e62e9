"""A report on paper: PDF of the HTML file, by weasyprint."""

from __future__ import annotations

import base64
import html
import io
import re
from pathlib import Path
from typing import Any

from frahm.errors import ParameterError
from frahm.files import write_bytes

_SCRIPT = re.compile(r"<script\b.*?</script>", re.DOTALL)
_PLOT = re.compile(r'<div class="plot"[^>]*></div>')
_FORMULA = re.compile(r'<math\b[^>]*\balttext="([^"]*)"[^>]*>.*?</math>', re.DOTALL)
_EXTRA = "an installation with the extra pdf"
_INSTALL = "Install it with: pip install 'frahm[pdf]'. Or print report.html from a browser."
_LIBRARIES = (
    "weasyprint is installed, but the library Pango that it draws text with is not: on Debian apt install"
    " libpango-1.0-0 libpangoft2-1.0-0, on Windows pacman -S mingw-w64-x86_64-pango in MSYS2, on macOS brew install"
    " pango. Or print report.html from a browser."
)


def write_pdf(report: str | Path) -> Path:
    """Write a report as PDF beside its HTML file; return the path of the PDF.

    Raises
    ------
    ParameterError
        If weasyprint or what it needs is missing, the report cannot be read or the PDF not be written.
    """
    report = Path(report)
    printer = _printer()
    try:
        text = report.read_text(encoding="utf-8")
    except OSError as error:
        allowed = "a folder with report.html in it"
        raise ParameterError("DIR", str(report.parent), allowed, hint=f"{error.strerror}.") from None
    path = report.with_suffix(".pdf")
    write_bytes(path, printer(string=paper_text(text)).write_pdf())
    return path


def paper_text(text: str) -> str:
    """The report without scripts and interactive figures, and with its formulas as images: what paper can show."""
    still = _PLOT.sub("", _SCRIPT.sub("", text)).replace("rad/s", "rad/\N{WORD JOINER}s")
    return _FORMULA.sub(lambda formula: _formula_image(html.unescape(formula[1])), still)


def _printer() -> Any:
    try:
        import weasyprint
    except ImportError:
        raise ParameterError("--pdf", "weasyprint is not installed", _EXTRA, hint=_INSTALL) from None
    except OSError:
        raise ParameterError("--pdf", "Pango is not installed", _EXTRA, hint=_LIBRARIES) from None
    return weasyprint.HTML


def _formula_image(tex: str) -> str:
    """A formula as image element: no printer to PDF knows MathML."""
    import matplotlib as mpl
    from matplotlib.figure import Figure

    figure, drawn = Figure(figsize=(0.1, 0.1)), io.StringIO()
    figure.text(0, 0, f"${tex}$", fontsize=11)
    with mpl.rc_context({"mathtext.fontset": "stix", "svg.fonttype": "path", "svg.hashsalt": "frahm"}):
        figure.savefig(drawn, format="svg", bbox_inches="tight", pad_inches=0.02, metadata={"Date": None})
    address = base64.b64encode(drawn.getvalue().encode()).decode()
    return f'<img class="formula" src="data:image/svg+xml;base64,{address}" alt="{html.escape(tex)}">'
