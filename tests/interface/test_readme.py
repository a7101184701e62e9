import re
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[2]
PAGES = ("README.md", "CONTRIBUTING.md", "CHANGELOG.md")


def test_the_python_of_the_readme_works(capsys):
    (code,) = re.findall(r"```python\n(.*?)```", (ROOT / "README.md").read_text(encoding="utf-8"), re.DOTALL)
    exec(compile(code, "README.md", "exec"), {})
    said = capsys.readouterr().out
    assert said.count("saddle-node") == 4
    assert said.count("neimark-sacker") == 2
    assert "detached branches: [1]" in said
    assert 0.0169 < float(re.search(r"resonance: ([\d.]+) m", said)[1]) < 0.0172  # .0170 by another integrator


@pytest.mark.parametrize("page", PAGES)
def test_links_lead_somewhere(page):
    text = (ROOT / page).read_text(encoding="utf-8")
    for target in re.findall(r"\]\(([^)#]+)\)", text):
        assert (ROOT / target).exists(), target


def test_the_rooms_of_the_contributing_page_are_those_of_the_package():
    text = (ROOT / "CONTRIBUTING.md").read_text(encoding="utf-8")
    named = set(re.findall(r"^\| `(\w+)` \|", text, re.MULTILINE))
    assert named == {folder.parent.name for folder in (ROOT / "src" / "frahm").glob("*/__init__.py")}
