"""Helpers of the browser tests: the server, what a visitor does, and faults of accessibility."""

import dataclasses
import os
import re
import signal
import subprocess
import sys
import time

from axe_playwright_python.sync_playwright import Axe

PATIENCE = 1000 * int(os.environ.get("FRAHM_TEST_PATIENCE", "240"))  # ms; first, code may have to be compiled


@dataclasses.dataclass
class Server:
    process: subprocess.Popen
    address: str
    port: int

    def children(self):
        """Processes that work for its visitors."""
        listed = subprocess.run(
            ["ps", "-o", "pid=", "--ppid", str(self.process.pid)], capture_output=True, text=True, check=False
        )
        return {int(pid) for pid in listed.stdout.split()}

    def end(self):
        self.process.send_signal(signal.SIGINT)
        try:
            self.process.wait(20)
        finally:
            self.process.kill()


def start(*arguments):
    process = subprocess.Popen(
        [sys.executable, "-m", "frahm", "app", *arguments, "--port", "0"],
        stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True,
    )  # fmt: skip
    line = process.stdout.readline()
    found = re.search(r"http://127\.0\.0\.1:(\d+)/", line)
    assert found, line + process.stderr.read()
    return Server(process, found[0], int(found[1]))


class Visitor:
    """What the tests do on the page."""

    def __init__(self, page, address):
        self.page, self.address, self.faults, self.requests = page, address, [], []
        page.set_default_timeout(PATIENCE)
        page.on("pageerror", lambda error: self.faults.append(str(error)))
        page.on("console", lambda said: said.type == "error" and self.faults.append(said.text))
        page.on("request", lambda request: self.requests.append(request.url))

    def open(self):
        self.page.goto(self.address)
        self.page.wait_for_function("window.frahmDrawn >= 1")
        return self

    def rest(self):
        """Wait until everything drawn is of the values in the fields."""
        self.page.wait_for_selector("#exact-status:has-text('Exact response:')")
        return self

    def field(self, name):
        return self.page.locator(f"#field-{name}")

    def slider(self, name):
        return self.page.locator(f"#slider-{name}")

    def text(self, name):
        return self.page.locator(f"#{name}").inner_text()

    def lines(self, figure="response"):
        """x and y of every trace as the browser draws them, None for gaps; empty ones are left out."""
        script = """(figure) => document.querySelector('#' + figure + ' .js-plotly-plot')._fullData
            .map((t) => ({row: t.yaxis === 'y2' ? 1 : 0, name: t.name, opacity: t.opacity, dash: t.line && t.line.dash,
              visible: t.visible,
              x: Array.from(t.x || [], (v) => Number.isFinite(v) ? v : null),
              y: Array.from(t.y || [], (v) => Number.isFinite(v) ? v : null)}))
            .filter((t) => t.visible === true && t.x.length)"""
        there = "(figure) => !!(document.querySelector('#' + figure + ' .js-plotly-plot') || {})._fullData"
        self.page.wait_for_function(there, arg=figure)
        return self.page.evaluate(script, figure)

    def drawn(self, number):
        """Wait until values as new as these are drawn."""
        self.page.wait_for_function("(n) => window.frahmDrawn >= n", arg=number)

    def count(self):
        return self.page.evaluate("window.frahmDrawn || 0")


def wait_until(condition, seconds=60.0):
    """Whether a condition comes true in time."""
    end = time.monotonic() + seconds
    while time.monotonic() < end:
        if condition():
            return True
        time.sleep(0.1)
    return False


def axe_faults(page):
    """Serious and critical accessibility faults."""
    found = Axe().run(page).response
    return [
        (fault["id"], [node["html"][:160] for node in fault["nodes"]][:3])
        for fault in found["violations"]
        if fault["impact"] in ("serious", "critical")
    ]
