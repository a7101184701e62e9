"""How fast the page follows a slider, in the system's chromium: run on an idle machine of two cores.

    python benchmarks/page_in_a_browser.py

Prints the time from the command to a page that answers, the time from a step of the slider to the redrawn response,
and the redraws a second while the slider is dragged. A redraw counts when the frame that shows it has been handed to
the screen, and only if its numbers are others than those of the last one. Processor time is printed beside, for
machines that are not idle.
"""

import os
import re
import shutil
import statistics
import subprocess
import sys
import time

from playwright.sync_api import sync_playwright

DRAWN = """() => ((document.querySelector('#response .js-plotly-plot') || {})._fullData || [])
  .some((t) => t.visible === true && t.name.startsWith('slow flow') && t.x.length)"""
WATCH = """() => { window.waits = []; window.redrawn = 0; window.since = 0;
  const figure = document.querySelector('#response .js-plotly-plot');
  const numbers = () => figure._fullData.filter((t) => t.visible === true && t.name.startsWith('slow flow'))
    .map((t) => Array.from(t.y).slice(0, 200).join()).join(';');
  let last = numbers();
  figure.on('plotly_afterplot', () => {
    const now = numbers();
    if (now === last) return;
    last = now;
    const since = window.since;
    window.since = 0;
    requestAnimationFrame(() => { const shown = new MessageChannel(); shown.port1.onmessage = () => {
      window.redrawn += 1;
      if (since) window.waits.push(performance.now() - since); };
      shown.port2.postMessage(0); }); });
  document.addEventListener('input', () => { if (!window.since) window.since = performance.now(); }, true); }"""


def processor_seconds():
    """Processor time of all processes that this one has started, directly or not."""
    facts = {}
    for entry in filter(str.isdigit, os.listdir("/proc")):
        try:
            with open(f"/proc/{entry}/stat", encoding="utf-8") as stat:
                fields = stat.read().rsplit(")", 1)[1].split()
        except OSError:
            continue
        facts[int(entry)] = int(fields[1]), (int(fields[11]) + int(fields[12])) / os.sysconf("SC_CLK_TCK")
    total, young = 0.0, {os.getpid()}
    while young := {entry for entry, (parent, _) in facts.items() if parent in young}:
        total += sum(facts[entry][1] for entry in young)
    return total


def measure(page, server):
    """Print the three times."""
    page.wait_for_selector("#slow-status:has-text('largest')")
    page.wait_for_function(DRAWN)
    print(f"command to a page that answers: {time.monotonic() - server.began:.2f} s")
    page.wait_for_selector("#exact-status:has-text('Exact response:')", timeout=240_000)
    page.wait_for_timeout(1000)
    page.evaluate(WATCH)
    page.focus("#slider-kappa")
    for _ in range(20):
        page.keyboard.press("ArrowRight")
        page.wait_for_timeout(300)
    waits = page.evaluate("window.waits")
    print(f"step of a slider to the redrawn response: median {statistics.median(waits):.0f} ms of {len(waits)}")
    box = page.locator("#slider-kappa").bounding_box()
    x, y = box["x"] + 0.4 * box["width"], box["y"] + box["height"] / 2
    page.mouse.move(x, y)
    page.mouse.down()
    page.evaluate("window.redrawn = 0")
    began, used, step = time.monotonic(), processor_seconds(), 0
    while time.monotonic() < began + 5:
        step += 1
        page.mouse.move(x + step % 80, y)
        page.wait_for_timeout(10)
    seconds, redrawn = time.monotonic() - began, page.evaluate("window.redrawn")
    used = processor_seconds() - used
    page.mouse.up()
    print(f"redraws a second while dragging: {redrawn / seconds:.1f}")
    print(f"processor time for a redraw, map and manifold included: {1000 * used / redrawn:.0f} ms")
    answers = page.evaluate(
        "performance.getEntriesByType('resource').filter((e) => /update-component|drawn.response/.test(e.name))"
        ".map((e) => [e.responseStart - e.requestStart, e.responseEnd - e.responseStart]).slice(-40)"
    )
    print(
        "answer of the server, wait and transfer [ms]:",
        *(round(statistics.median(a)) for a in zip(*answers, strict=True)),
    )


def main():
    """Start the page, drive it, end it."""
    chromium = next(filter(None, map(shutil.which, ("chromium", "chromium-browser", "google-chrome"))))
    with sync_playwright() as playwright:
        browser = playwright.chromium.launch(executable_path=chromium, args=["--no-sandbox"])
        page = browser.new_page(viewport={"width": 1280, "height": 900}, bypass_csp=True)
        began = time.monotonic()
        command = [sys.executable, "-m", "frahm", "app", "--port", "8765"]
        server = subprocess.Popen(command, stdout=subprocess.PIPE, text=True)
        server.began = began
        try:
            page.goto(re.search(r"http\S+", server.stdout.readline())[0])
            measure(page, server)
        finally:
            server.terminate()
            browser.close()


if __name__ == "__main__":
    main()
