"""What the literature tests compared, kept for the validation page of the documentation: out/validation.json."""

from __future__ import annotations

import functools
import hashlib
import json
import time
from pathlib import Path

ROOT = Path(__file__).resolve().parents[1]
RECORD = ROOT / "out" / "validation.json"
LITERATURE = "tests/literature/"
LONGEST = 300  # characters of the message of a failure
_reports: dict[str, dict] = {}


@functools.cache
def state_of(test_file):
    """Hash of the package and of one test file: what a result belongs to."""
    digest = hashlib.sha256()
    for path in (*sorted((ROOT / "src" / "frahm").rglob("*.py")), ROOT / test_file):
        digest.update(path.read_bytes())
    return digest.hexdigest()[:16]


def pytest_runtest_logreport(report):
    if not report.nodeid.startswith(LITERATURE):
        return
    # A set-up or teardown says something only if it fails, or skips the test.
    if report.when != "call" and report.passed:
        return
    held = [value for name, value in report.user_properties if name == "held"]
    entry = {"outcome": report.outcome, "parameters": dict(report.user_properties).get("parameters"), "held": held}
    if hasattr(report, "wasxfail"):
        reason = report.wasxfail.removeprefix("reason: ")
        known = "misprint" if reason.startswith("misprint") else "not reproduced"
        entry["outcome"], entry["reason"] = known, reason.removeprefix("misprint: ")
    crash = getattr(report.longrepr, "reprcrash", None)
    if crash is not None:
        entry["message"] = crash.message[:LONGEST]
    _reports[report.nodeid] = entry


def pytest_sessionfinish(session):
    if hasattr(session.config, "workerinput") or not _reports:
        return
    kept = json.loads(RECORD.read_text(encoding="utf-8"))["tests"] if RECORD.exists() else {}
    now = time.strftime("%Y-%m-%d", time.gmtime())
    for nodeid, entry in _reports.items():
        kept[nodeid] = {"state": state_of(nodeid.split("::")[0]), "date": now, **entry}
    RECORD.parent.mkdir(exist_ok=True)
    part = RECORD.with_suffix(".part")
    part.write_text(json.dumps({"tests": dict(sorted(kept.items()))}, indent=1, ensure_ascii=False), encoding="utf-8")
    part.replace(RECORD)
