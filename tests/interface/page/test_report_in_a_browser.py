"""The report from disk in a browser that has no network: on a wide and a narrow screen, on paper, and heard aloud."""

import csv
import json
import math
from pathlib import Path

import numpy as np
import pytest
from axe_playwright_python.sync_playwright import Axe

import frahm
from frahm.analysis import analyse, load_analysis, save_analysis
from frahm.analysis import analysis as steps
from frahm.analysis.linear import without_absorber
from frahm.analysis.manifold import manifold
from frahm.analysis.motions import motions
from frahm.analysis.response import exact_response, slow_flow_response
from frahm.analysis.wind import wind
from frahm.report import write_report

HIDDEN = """[...document.querySelectorAll('.scroll')].filter(
    (box) => box.scrollWidth > box.clientWidth + 1 || box.scrollHeight > box.clientHeight + 1
).map((box) => box.innerText)"""
QUICK = (without_absorber, exact_response, slow_flow_response, wind, manifold, motions)


def reported(case, chosen, folder):
    """Write the report of some steps of an analysis, read back from disk."""
    kept = steps.STEPS
    steps.STEPS = tuple(step for step in kept if step.run in chosen)
    try:
        analysis = analyse(case)
    finally:
        steps.STEPS = kept
    save_analysis(analysis, folder)
    write_report(load_analysis(folder), folder)
    return folder


@pytest.fixture(scope="module")
def folder(tmp_path_factory):
    """Results of the built-in pipe, of the steps that take no time."""
    return reported(frahm.load_case("jacket-pipe").with_analysis(periods=300), QUICK, tmp_path_factory.mktemp("report"))


@pytest.fixture
def shown(browser, folder):
    """The report on a screen of the width asked for, without network; what it asked for and what went wrong."""
    contexts = []

    def show(width, folder=folder):
        context = browser.new_context(viewport={"width": width, "height": 900}, offline=True)
        contexts.append(context)
        page, asked, faults = context.new_page(), [], []
        page.on("request", lambda request: asked.append(request.url))
        page.on("console", lambda message: faults.append(message.text) if message.type == "error" else None)
        page.on("pageerror", lambda error: faults.append(str(error)))
        page.goto((folder / "report.html").as_uri())
        page.wait_for_function(
            "[...document.querySelectorAll('.plot')].every((plot) => plot.querySelector('.main-svg'))"
        )
        assert [url for url in asked if not url.startswith(("file:", "data:", "blob:"))] == []
        assert faults == []
        return page

    yield show
    for context in contexts:
        context.close()


@pytest.mark.parametrize("width", [1280, 390])
def test_nothing_is_wider_than_the_screen(shown, width):
    page = shown(width)
    assert page.locator(".plot").count() >= 5
    assert page.evaluate("document.documentElement.scrollWidth") <= width
    assert page.evaluate(HIDDEN) == []
    clipped = page.evaluate(
        "[...document.querySelectorAll('math mi')].filter((letter) => {"
        "  const box = letter.closest('.scroll').getBoundingClientRect(), own = letter.getBoundingClientRect();"
        "  return own.bottom > box.bottom || own.top < box.top;}).length"
    )
    assert clipped == 0


@pytest.fixture(scope="module")
def judged(tmp_path_factory):
    """Everything that `frahm run` says of a bare pipe in the wind."""
    case = frahm.load_case(Path(__file__).parents[2] / "cases" / "chimney.yaml")
    return reported(case, [step.run for step in steps.STEPS], tmp_path_factory.mktemp("judged"))


@pytest.mark.parametrize("width", [390, 1280, 1920])
def test_the_page_that_decides_fits_the_screen(shown, judged, width):
    page = shown(width, judged)
    assert page.evaluate("document.documentElement.scrollWidth") <= width
    cut = "[...document.querySelectorAll('figure')].filter((f) => f.scrollWidth > f.clientWidth + 1).length"
    assert page.evaluate(cut) == 0
    image = page.locator("figure.head img")
    shape = image.evaluate("(one) => ({shown: one.clientWidth, drawn: one.naturalWidth, source: one.currentSrc})")
    narrow = (judged / "figures" / "decision-narrow.svg").exists()
    assert narrow
    assert (shape["source"] == page.locator("figure.head source").get_attribute("srcset")) == (width == 390)
    assert shape["shown"] >= 0.95 * min(shape["drawn"], width)  # nothing is shrunk until it cannot be read
    if width == 1920:  # what was found stands beside its figure
        lead, figure = page.locator("p.lead").bounding_box(), page.locator("figure.head").bounding_box()
        assert lead["x"] + lead["width"] <= figure["x"]
        assert figure["x"] + figure["width"] - lead["x"] > 0.75 * width


def test_an_elastic_pipe_is_shown_as_one(shown, tmp_path):
    elastic = reported(frahm.load_case("jacket-pipe-elastic"), (without_absorber, wind), tmp_path)
    for width in (1280, 390):
        page = shown(width, elastic)
        assert "moves in 3 modes" in page.locator("#inputs").inner_text()
        assert page.evaluate("document.documentElement.scrollWidth") <= width
        assert page.evaluate(HIDDEN) == []


def test_the_file_is_small(folder):
    assert (folder / "report.html").stat().st_size < 5_000_000


def test_a_browser_that_cannot_inflate_shows_the_drawings(browser, folder):
    context = browser.new_context(offline=True)
    context.add_init_script("delete globalThis.DecompressionStream")
    page = context.new_page()
    page.goto((folder / "report.html").as_uri())
    page.wait_for_selector("body.no-script")
    assert not page.locator(".plot").first.is_visible()
    assert page.locator("img.paper").first.is_visible()
    context.close()


def test_no_button_sends_data_away(shown):
    page = shown(1280)
    page.locator(".plot").first.hover()
    buttons = page.locator(".plot .modebar-btn").evaluate_all("all => all.map((b) => b.dataset.title || '')")
    assert any("Zoom" in button for button in buttons)
    assert not any("edit" in b.lower() or "cloud" in b.lower() or "plotly" in b.lower() for b in buttons)


def test_a_narrow_screen_shows_what_is_special_first(shown, folder):
    special = json.loads((folder / "summary.json").read_text())["results"]["response"]["harmonic-balance"]
    detunings = [point["detuning"] for point in special["special_points"]]
    reach = "document.querySelector('#plot-response-pipe').layout.xaxis.range"
    low, high = shown(390).evaluate(reach)
    assert -0.4 <= low < min(detunings)
    assert max(detunings) < high <= 0.4
    assert high - low < 0.5
    wide = shown(1280).evaluate(reach)
    assert wide[0] <= -0.4
    assert wide[1] >= 0.4


def test_on_paper_the_figures_are_drawings_and_nothing_is_folded_away(shown):
    page = shown(1280)
    page.emulate_media(media="print")
    page.evaluate("dispatchEvent(new Event('beforeprint'))")
    assert page.locator("details:not([open])").count() == 0
    assert not page.locator(".plot").first.is_visible()
    drawings = page.locator("img.paper")
    assert drawings.count() == page.locator(".plot").count()
    assert drawings.evaluate_all("all => all.every((image) => image.complete && image.naturalWidth > 100)")


def test_no_serious_accessibility_fault(shown):
    page = shown(390)
    found = Axe().run(page).response["violations"]
    assert [(fault["id"], fault["nodes"][0]["html"][:200]) for fault in found
            if fault["impact"] in ("serious", "critical")] == []  # fmt: skip


def rows(path):
    lines = [line for line in Path(path).read_text(encoding="utf-8").splitlines() if not line.startswith("#")]
    names, units, *values = csv.reader(lines)
    return dict(zip(names, units, strict=True)), [dict(zip(names, row, strict=True)) for row in values]


def test_every_figure_has_its_numbers_beside_it(folder):
    figures = folder / "figures"
    for drawing in figures.glob("*.svg"):
        assert drawing.with_suffix(".png").exists()
        group = "response" if drawing.stem.startswith("response") else drawing.stem
        assert list(figures.glob(f"{group}*.csv"))
    units, bare = rows(figures / "response-without-absorber.csv")
    assert units == {"frequency": "rad/s", "detuning": "rad/s", "pipe_peak": "m"}
    force = 0.5 * 0.4535 * 1.225 * 2.7**2 * 0.762
    omega = 2 * math.pi * 0.78
    for row in bare[::200]:  # the forced oscillator in closed form
        W = float(row["frequency"])
        expected = force / 247 / abs(omega**2 - W**2 + 2j * 0.0015 * omega * W)
        assert float(row["pipe_peak"]) == pytest.approx(expected, rel=1e-9)
    units, spectrum = rows(figures / "motion-design-wind-spectrum.csv")
    assert units["frequency_hz"] == "Hz"
    highest = max(spectrum, key=lambda row: float(row["x1_amplitude"]))
    assert float(highest["frequency_hz"]) == pytest.approx(0.225 * 2.7 / 0.762, rel=2e-2)
    assert np.isfinite([float(row["z_amplitude"]) for row in spectrum]).all()
