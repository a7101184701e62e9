"""The validation page: what the literature tests compared, from the results of their last run."""

from __future__ import annotations

import ast
import json
import re
import sys
from pathlib import Path

ROOT = Path(__file__).resolve().parents[1]
LITERATURE = ROOT / "tests" / "literature"
STORED = ROOT / "docs" / "validation.json"
MOST_ROWS = 6  # comparisons of one test that are shown
WORDS = {  # outcome: in a row, in the sum
    "passed": ("holds", "hold"),
    "failed": ("**fails**", "**fail**"),
    "misprint": ("*misprint*", "show a misprint of the source"),
    "not reproduced": ("*not reproduced*", "show a printed number that is not reproduced"),
    "skipped": ("not run", "were skipped"),
    "not run": ("not run", "were not run"),
}
_UNREAD = str.maketrans({"\\": r"\\", "<": "&lt;", "`": "'", **{sign: f"\\{sign}" for sign in "*[]_$|"}})

sys.path.insert(0, str(ROOT / "tests"))  # there it is known how results are kept
from validation_record import RECORD, state_of  # noqa: E402


def validation() -> str:
    """One section per file of literature tests: what was compared with what, and whether it holds."""
    record = _record()
    sections = [_Section(file, record) for file in sorted(LITERATURE.glob("test_*.py"))]
    outcomes = [outcome for section in sections for outcome in section.outcomes]
    said = [f"{outcomes.count(outcome)} {words[1]}" for outcome, words in WORDS.items() if outcome in outcomes]
    if "failed" not in outcomes:
        said.append("none fails otherwise")
    lines = [f"Of {len(outcomes)} tests {', '.join(said)}.", ""]
    for section in sections:
        lines += section.lines
    return "\n".join(lines)


def _record() -> dict[str, dict]:
    """Results of the last run of the literature tests, and the stored ones where a test was not run here."""
    found: dict[str, dict] = {}
    for path in (STORED, RECORD):
        if path.exists():
            found.update(json.loads(path.read_text(encoding="utf-8"))["tests"])
    return found


class _Section:
    """One file of tests, as Markdown in `lines`, and the `outcomes` of its tests."""

    def __init__(self, file: Path, record: dict[str, dict]) -> None:
        self.name = f"tests/literature/{file.name}"
        tree = ast.parse(file.read_text(encoding="utf-8"))
        tests = [node.name for node in tree.body if isinstance(node, ast.FunctionDef) and node.name[:5] == "test_"]
        self.outcomes: list[str] = []
        self.rows: list[str] = []
        self.states: set[str] = set()
        self.dates: set[str] = set()
        for test in tests:
            whole = f"{self.name}::{test}"
            entries = {key: entry for key, entry in record.items() if key.partition("[")[0] == whole}
            for key, entry in (entries or {whole: {"outcome": "not run", "held": []}}).items():
                self._add(key, entry)
        title, *rest = (ast.get_docstring(tree) or file.name).splitlines()
        self.lines = [f"## {title.rstrip('.')}", "", *rest, "", self._when(), "", "````{container} wide-table", ""]
        self.lines += ["| what | compared | computed | expected | |", "|---|---|---|---|---|", *self.rows, "````", ""]

    def _when(self) -> str:
        if not self.dates:
            return f"`{self.name}`, not run."
        late = (
            ""
            if self.states == {state_of(self.name)}
            else ", **before the last change of the package or of this file**"
        )
        return f"`{self.name}`, run {max(self.dates)}{late}."

    def _add(self, key: str, entry: dict) -> None:
        self.outcomes.append(entry["outcome"])
        if "state" in entry:
            self.states.add(entry["state"])
            self.dates.add(entry["date"])
        for row in _rows(key, entry):
            self.rows.append(f"| {' | '.join(row)} | {WORDS[entry['outcome']][0]} |")


def _rows(key: str, entry: dict) -> list[tuple[str, str, str, str]]:
    """One row per comparison with numbers, and one if there is none; what failed says why."""
    what = _what(key, entry)
    numbers = [held for held in entry["held"] if len(held) == 3]
    if not numbers or entry["outcome"] == "failed":
        return [(what, _shown(entry.get("reason") or entry.get("message", "")), "", "")]
    rows = [
        (
            "" if index else what,
            _shown(compared.partition(" == ")[0]),
            _shown(_short(computed)),
            _shown(_short(expected)),
        )
        for index, (compared, computed, expected) in enumerate(numbers[:MOST_ROWS])
    ]
    if len(numbers) > MOST_ROWS:
        rows.append(("", f"… and {len(numbers) - MOST_ROWS} more", "", ""))
    return rows


def _what(key: str, entry: dict) -> str:
    """Name of the test as words, with its parameters."""
    test, _, case = key.partition("::")[2].partition("[")
    words = test.removeprefix("test_").replace("_", " ")
    case = case.removesuffix("]") if entry.get("parameters") is None else entry["parameters"]
    return f"{words}: {_shown(case)}" if case else words


def _short(number: str) -> str:
    """A number with the digits that matter."""
    number = re.sub(r"np\.\w+\(([^()]*)\)", r"\1", number)
    return re.sub(r"-?\d+\.\d{7,}(?:e[-+]?\d+)?", lambda m: f"{float(m[0]):.6g}", number)


def _shown(text: str, longest: int = 90) -> str:
    """Text that Markdown must not read, cut where it is long."""
    text = re.sub(r"\s+", " ", text)
    return (text if len(text) <= longest else text[: longest - 2] + " …").translate(_UNREAD)
