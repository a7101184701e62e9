"""The path of a newcomer, as the quickstart tells it: every command is read from the page and typed into a shell."""

import json
import os
import re
import subprocess
import sys
from pathlib import Path

import pytest
from browsing import Server, Visitor, wait_until
from playwright.sync_api import expect

import frahm

ROOT = Path(__file__).resolve().parents[3]
PAGE = (ROOT / "docs" / "quickstart.md").read_text(encoding="utf-8")
PLACEHOLDER = "<address of the repository>"


def steps():
    """Commands of every numbered section of the page."""
    sections = re.split(r"^## (?=\d)", PAGE.partition("(without-make)=")[0], flags=re.MULTILINE)[1:]
    blocks = [re.findall(r"```sh\n(.*?)```", section, re.DOTALL) for section in sections]
    return [[line for block in found for line in block.splitlines()] for found in blocks]


def stated(pattern):
    """A number the page promises."""
    (found,) = re.findall(pattern, PAGE.replace("\n", " "))
    return float(found)


class Newcomer:
    """A shell in an empty home folder; `cd` lasts."""

    def __init__(self, home):
        self.home = self.place = home
        self.environment = {**os.environ, "HOME": str(home), "XDG_CACHE_HOME": str(Path.home() / ".cache")}

    def types(self, line, ends=(0,)):
        """Run one line of the page; it must end as the page says. Return what it said, and what it complained of."""
        if line.startswith("cd "):
            self.place = self.place / line.removeprefix("cd ")
            return "", ""
        line = line.replace(PLACEHOLDER, f"'{ROOT}'")
        done = subprocess.run(
            ["bash", "-c", line], cwd=self.place, env=self.environment, capture_output=True, text=True, check=False
        )
        assert done.returncode in ends, f"{line}\n{done.stdout}{done.stderr}"
        assert done.returncode == 0 or "unverified" in done.stderr
        return done.stdout, done.stderr

    def finds_set_up(self):
        """The environment the tests run in, in place of the one that make would download."""
        binaries = self.place / ".venv" / "bin"
        binaries.mkdir(parents=True)
        for name in ("python", "frahm"):
            (binaries / name).symlink_to(Path(sys.executable).with_name(name))
        (binaries.parent / ".set-up").touch()

    def serves(self, line):
        """Start the page on a free port, as several tests may run at a time."""
        process = subprocess.Popen(
            ["bash", "-c", f"exec {line} --port 0"], cwd=self.place, env=self.environment, stdout=subprocess.PIPE,
            stderr=subprocess.PIPE, text=True,
        )  # fmt: skip
        said = process.stdout.readline()
        found = re.search(r"http://127\.0\.0\.1:(\d+)/", said)
        assert found, said + process.stderr.read()
        return Server(process, found[0], int(found[1]))


def opened_from_disk(browser, report):
    """Text of the verdict and number of figures of a report, in a browser that has no network and asks for none."""
    context = browser.new_context(offline=True)
    page, asked, faults = context.new_page(), [], []
    page.on("request", lambda request: asked.append(request.url))
    page.on("pageerror", lambda error: faults.append(str(error)))
    page.goto(report.as_uri())
    page.wait_for_function("[...document.querySelectorAll('.plot')].every((plot) => plot.querySelector('.main-svg'))")
    said = [page.locator(where).inner_text() for where in ("#verdict p:last-child", "p.lead")]
    verdict, figures = " ".join(said), page.locator(".plot, figure").count()
    assert [url for url in asked if not url.startswith(("file:", "data:", "blob:"))] == []
    assert faults == []
    context.close()
    return verdict, figures


def saved_after_a_drag(browser, address, downloads):
    """Drag the damping of the sink in a browser, save the case with the button of the page; return the new damping."""
    context = browser.new_context(bypass_csp=True, viewport={"width": 1280, "height": 900})
    visitor = Visitor(context.new_page(), address).open()
    slider, field = visitor.slider("xi2"), visitor.field("xi2")
    before = field.input_value()
    box = slider.bounding_box()
    start = box["x"] + box["width"] * int(slider.input_value()) / int(slider.get_attribute("max"))
    height = box["y"] + box["height"] / 2
    visitor.page.mouse.move(start, height)
    visitor.page.mouse.down()
    visitor.page.mouse.move(start + 25, height, steps=5)
    visitor.page.mouse.up()
    expect(field).not_to_have_value(before)
    visitor.rest()
    with visitor.page.expect_download() as saved:
        visitor.page.get_by_role("button", name="Save case").click()
    saved.value.save_as(downloads / saved.value.suggested_filename)
    after = float(field.input_value())
    assert visitor.faults == []
    context.close()
    assert after > 1.05 * float(before)
    return after


def test_nothing_a_newcomer_needs_is_missing_in_the_repository():
    """What git does not know is not in a clone."""
    listed = subprocess.run(
        ["git", "ls-files", "src", "docs/quickstart.md", "Makefile", "constraints.txt"], cwd=ROOT,
        capture_output=True, text=True, check=True,
    )  # fmt: skip
    known = set(listed.stdout.split())
    assert {"docs/quickstart.md", "Makefile", "constraints.txt"} <= known
    there = {path.relative_to(ROOT).as_posix() for path in (ROOT / "src" / "frahm").rglob("*") if path.is_file()}
    assert {name for name in there - known if "__pycache__" not in name} == set()


def test_the_path_of_a_newcomer(tmp_path, browser):
    see, play, analyse, best, own, python = steps()
    newcomer = Newcomer(tmp_path)
    downloads = tmp_path / "Downloads"
    downloads.mkdir()

    clone, enter, make = see
    newcomer.types(clone)
    newcomer.types(enter)
    newcomer.finds_set_up()
    assert "report.html" in newcomer.types(make)[0]
    first = newcomer.place / "out" / "jacket-pipe"
    summary = json.loads((first / "summary.json").read_text(encoding="utf-8"))
    verdict, figures = opened_from_disk(browser, first / "report.html")
    assert f"{stated(r'largest motion found is ([0-9.]+) mm')} mm" in verdict
    assert figures > 5
    results = summary["results"]
    assert 1e3 * results["largest_motion"]["pipe_peak"] == pytest.approx(stated(r"found is ([0-9.]+) mm"), abs=0.05)
    # in closed form: resonance of the bare pipe
    bare = 0.5 * 0.4535 * 1.225 * 2.7**2 * 0.762 / 247 / (2 * 0.0015 * (2 * 3.141592653589793 * 0.78) ** 2)
    assert 1e3 * bare == pytest.approx(stated(r"a fifth of the ([0-9.]+) mm without"), abs=0.05)
    assert results["without_absorber"]["pipe_peak_max"] == pytest.approx(bare, rel=1e-4)

    (serve,) = play
    server = newcomer.serves(serve)
    try:
        xi2 = saved_after_a_drag(browser, server.address, downloads)
    finally:
        server.end()
    assert wait_until(lambda: server.process.poll() is not None)

    for line in analyse:
        said, _ = newcomer.types(line)
    mine = json.loads((newcomer.place / "out" / "my-sink" / "summary.json").read_text(encoding="utf-8"))
    assert mine["case"]["absorbers"][0]["law"]["damping"] == pytest.approx(247 * xi2, rel=1e-12)
    assert mine["results"]["verdict"] in said
    lead = mine["results"]["verdict"].removeprefix(mine["results"]["acceptance"]["sentence"]).strip()
    assert lead in opened_from_disk(browser, newcomer.place / "out/my-sink/report.html")[0]
    rows = re.findall(r"^\| `([\w./]+)` \|", PAGE, re.MULTILINE)
    assert {path.name for path in (newcomer.place / "out" / "my-sink").iterdir()} == {row.strip("/") for row in rows}

    design, show = best
    _, doubts = newcomer.types(design, ends=(0, 3))
    said, _ = newcomer.types(show)
    folder = newcomer.place / "out" / "my-design"
    summary = json.loads((folder / "summary.json").read_text(encoding="utf-8"))
    assert re.findall(r"^frahm: (.*)", doubts, re.MULTILINE) == summary["unverified"]
    found = summary["results"]["design"]
    assert found["best"]["verified"]
    peaks = {row["name"]: row["worst_pipe_peak"] for row in found["comparison"]}
    assert peaks["none"] == pytest.approx(bare, rel=1e-3)
    assert 1e3 * peaks["sink"] == pytest.approx(stated(r"best sink lets the pipe move ([0-9.]+) mm"), rel=0.02)
    assert 1e3 * peaks["tuned mass damper"] == pytest.approx(stated(r"of the same mass ([0-9.]+) mm as long"), rel=0.03)
    assert found["verdict"] in said
    assert found["verdict"] in opened_from_disk(browser, folder / "report.html")[0]
    assert frahm.load_case(folder / "best.yaml").absorbers[0].normalised(247)["kappa"] == pytest.approx(
        found["best"]["kappa"], rel=1e-9
    )

    for line in own:
        newcomer.types(line)
    assert python == []
