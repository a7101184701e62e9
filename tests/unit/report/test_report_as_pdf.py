"""The report on paper: what is left out, what takes its place, and what is said if the printer is missing."""

import sys

import pytest
from typer.testing import CliRunner

from frahm.cli import app
from frahm.report.pdf import paper_text

PAGE = (
    '<html><head><style>p { color: #000 }</style></head><body><p>at 0.1 rad/s</p>'
    '<div class="plot" id="plot-a" data-figure="data-a"></div>\n<script type="application/json" id="data-a">{}</script>'
    '<math display="block" alttext="F_L = \\dfrac{St\\,U}{D}"><mrow><mi>F</mi></mrow></math>'
    "<script>const a = 1;</script></body></html>"
)  # fmt: skip


@pytest.fixture
def folder(tmp_path):
    (tmp_path / "summary.json").write_text('{"schema": "frahm-design-1"}')
    (tmp_path / "report.html").write_text(PAGE)
    return tmp_path


def test_paper_has_no_scripts_and_formulas_as_images():
    text = paper_text(PAGE)
    assert "<script" not in text
    assert 'class="plot"' not in text
    assert "<math" not in text
    assert text.count('<img class="formula" src="data:image/svg+xml;base64,') == 1
    assert 'alt="F_L = \\dfrac{St\\,U}{D}"' in text
    assert "<p>at 0.1 rad/" in text


def test_a_design_is_printed_as_it_was_written(folder):
    pytest.importorskip("weasyprint")
    done = CliRunner().invoke(app, ["report", str(folder), "--pdf"])
    assert done.exit_code == 0
    assert (folder / "report.html").read_text() == PAGE
    assert (folder / "report.pdf").read_bytes().startswith(b"%PDF-")


def test_without_the_extra_it_is_said_what_to_install(folder, monkeypatch):
    monkeypatch.setitem(sys.modules, "weasyprint", None)
    refused = CliRunner().invoke(app, ["report", str(folder), "--pdf"])
    assert refused.exit_code == 2
    assert "pip install 'frahm[pdf]'" in refused.stderr
    assert "Traceback" not in refused.stderr
    assert not (folder / "report.pdf").exists()


def test_a_library_that_is_missing_below_is_named(folder, monkeypatch):
    class Broken:
        def find_spec(self, name, *_):
            if name == "weasyprint":
                raise OSError("cannot load library 'libpango-1.0-0'")

    monkeypatch.delitem(sys.modules, "weasyprint", raising=False)
    monkeypatch.setattr(sys, "meta_path", [Broken(), *sys.meta_path])
    refused = CliRunner().invoke(app, ["report", str(folder), "--pdf"])
    assert refused.exit_code == 2
    assert "Pango" in refused.stderr


def test_a_folder_without_a_report_is_refused(folder):
    pytest.importorskip("weasyprint")
    (folder / "report.html").unlink()
    refused = CliRunner().invoke(app, ["report", str(folder), "--pdf"])
    assert refused.exit_code == 2
    assert "report.html" in refused.stderr
