"""A real browser on the real page: the system's chromium, and `frahm app` in a process of its own."""

import os
import shutil

import pytest
from browsing import PATIENCE, Visitor, start
from playwright.sync_api import expect

expect.set_options(timeout=PATIENCE)


def chromium():
    return next(filter(None, map(shutil.which, ("chromium", "chromium-browser", "google-chrome"))), None)


@pytest.fixture(scope="session")
def browser_type_launch_args(browser_type_launch_args):
    path = chromium()
    if path is None:
        if os.environ.get("CI"):
            pytest.fail("there is no chromium: .ci/run installs it")
        pytest.skip("no chromium found: install it to test the page in a browser")
    return browser_type_launch_args | {"executable_path": path, "args": ["--no-sandbox"], "headless": True}


@pytest.fixture(scope="session")
def browser_context_args(browser_context_args):
    # The page forbids itself to run code from text; the test driver needs that to look inside.
    return browser_context_args | {"bypass_csp": True, "viewport": {"width": 1280, "height": 900}}


@pytest.fixture(scope="module")
def server():
    running = start()
    yield running
    running.end()


@pytest.fixture
def visit(context, server):
    """Open a page; nothing on it may go wrong unheard."""
    visitors = []

    def one(address=server.address):
        visitors.append(Visitor(context.new_page(), address))
        return visitors[-1].open()

    yield one
    for visitor in visitors:
        assert visitor.faults == []
