"""The report of a screening from disk in a browser that has no network: on a wide and a narrow screen, and on paper."""

import pytest
from axe_playwright_python.sync_playwright import Axe

import frahm
from frahm.report import write_members_report
from frahm.screening import read_members

HIDDEN = "[...document.querySelectorAll('.scroll')].filter((box) => box.scrollWidth > box.clientWidth + 1).length"
PAPER = 688  # pixels between the margins of A4


@pytest.fixture(scope="module")
def folder(tmp_path_factory):
    """The built-in members, and one whose row cannot be read."""
    rows = [dict(row.values) for row in read_members("members-example").rows]
    tmp = tmp_path_factory.mktemp("members")
    write_members_report(frahm.screen_members([*rows, {**rows[0], "name": "<i>odd</i>", "ends": "glued"}]), tmp)
    return tmp


@pytest.fixture
def page(browser, folder):
    context = browser.new_context(viewport={"width": 1280, "height": 900}, offline=True)
    page, faults = context.new_page(), []
    page.on("console", lambda message: faults.append(message.text) if message.type == "error" else None)
    page.on("request", lambda asked: None if asked.url.startswith(("file:", "data:")) else faults.append(asked.url))
    page.goto((folder / "report.html").as_uri())
    yield page
    assert faults == []
    context.close()


@pytest.mark.parametrize("width", [390, 1280, 1920])
def test_nothing_is_wider_than_the_screen(page, width):
    page.set_viewport_size({"width": width, "height": 900})
    assert page.evaluate("document.documentElement.scrollWidth") <= width
    assert page.evaluate(HIDDEN) == 0
    drawn = page.locator("figure img")
    assert drawn.count() == 2
    for image in drawn.all():
        assert image.is_visible()
        assert image.evaluate("(one) => one.currentSrc === one.src") == (width != 390)


def test_it_fits_the_paper(page):
    page.emulate_media(media="print")
    page.set_viewport_size({"width": PAPER, "height": 900})
    assert page.evaluate("document.documentElement.scrollWidth") <= PAPER


def test_it_can_be_heard_and_says_what_was_not_judged(page):
    assert Axe().run(page, options={"runOnly": ["wcag2a", "wcag2aa"]}).response["violations"] == []
    assert "<i>odd</i>" in page.locator("#left-out").inner_text()
    assert page.locator("#verdicts tbody tr").count() == 30
    assert page.locator("#verdict .word").inner_text() == "FAIL"
    assert page.locator("#assumed tbody tr").count() > 10
