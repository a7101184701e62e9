"""Short examples and the notebook print what the literature says; the others are kept with their output."""

import json
import re
import runpy
import sys
from pathlib import Path

import matplotlib as mpl
import pytest

import frahm

ROOT = Path(__file__).resolve().parents[2]
EXAMPLES = ROOT / "examples"
SPECIAL = re.compile(r"(saddle-node|neimark-sacker) +(?:sigma|at) +(-?[\d.]+)")


def output_of(name, capsys, monkeypatch, *arguments):
    monkeypatch.setattr(sys, "argv", [name, *map(str, arguments)])
    runpy.run_path(str(EXAMPLES / f"{name}.py"), run_name="__main__")
    return capsys.readouterr().out


def test_the_paper(capsys, monkeypatch, tmp_path):
    said = output_of("seed_paper", capsys, monkeypatch, tmp_path)
    parts = dict(re.findall(r"kappa ([\d.]+)\n(.*?)(?=kappa|\Z)", said, re.DOTALL))
    # collocation (AUTO-07p)
    assert [float(sigma) for _, sigma in SPECIAL.findall(parts["97.97"])] == [0.01149, 0.02778, 0.03479, 0.04013]
    assert [float(sigma) for _, sigma in SPECIAL.findall(parts["367.38"])][:2] == [-0.16923, -0.09507]
    assert parts["367.38"].count("detached branch") == 2
    assert SPECIAL.findall(parts["24.425"]) == []
    assert "it beats" not in parts["24.425"]
    rest = {key: float(re.search(r"from rest at sigma 0: pipe peak ([\d.]+)", part)[1]) for key, part in parts.items()}
    assert rest["97.97"] == pytest.approx(0.0315, abs=2e-4)
    assert rest["367.38"] == pytest.approx(0.0170, abs=1e-4)
    assert (tmp_path / "seed_paper.png").stat().st_size > 10_000


def test_the_optimum_that_is_not_safe(capsys, monkeypatch):
    said = output_of("unsafe_optimum", capsys, monkeypatch)
    rms, where = re.search(r"largest rms ([\d.]+) at ([\d.]+), where it is unstable", said).groups()
    assert float(rms) == pytest.approx(0.663, abs=2e-3)  # as the optimisation reports it
    assert 0.951 < float(where) < 0.973
    peaks = {key: float(peak) for key, peak in re.findall(r"at ([\d.]+): pipe peak ([\d.]+)", said)}
    assert peaks["0.97"] == pytest.approx(31.4, abs=0.05)
    assert peaks["0.9729"] == pytest.approx(52.0, abs=1.0)


def test_a_sweep_on_a_cluster(capsys, monkeypatch, tmp_path):
    said = output_of("sweep_on_a_cluster", capsys, monkeypatch, tmp_path, 5)
    assert "25 points, every branch followed and every special point located at 25" in said
    peak, kappa, xi2 = map(float, re.search(r"others: ([\d.]+) m at kappa ([\d.]+), xi2 ([\d.]+)", said).groups())
    curve = frahm.frequency_response(
        frahm.load_case("jacket-pipe").with_absorber(kappa=kappa, xi2=xi2), detuning=(-0.3, 0.3)
    )
    assert curve.pipe_peak.max() == pytest.approx(peak, abs=1e-4)
    assert (curve.detached, bool(curve.stable.all())) == ((False,), True)
    worst = re.search(r"largest of all lasting motions there: ([\d.]+) m, periodic, verified", said)
    assert float(worst[1]) == pytest.approx(peak, abs=1e-4)
    assert (tmp_path / "sweep_on_a_cluster.png").stat().st_size > 10_000


@pytest.mark.parametrize("name", ["elastic_fatigue", "design_a_sink"])
def test_a_long_example_shows_the_output_of_this_script(name):
    """Not run here; what its first words say must be what the stored output says."""
    script = (EXAMPLES / f"{name}.py").read_text(encoding="utf-8")
    stored = (ROOT / "docs" / "examples" / f"{name}.txt").read_text(encoding="utf-8")
    first_words = re.findall(r'print\(f?"(\w[^{"]*)', script)
    assert len(first_words) > 4
    assert [words for words in first_words if words.strip() not in stored and words.strip() != "unverified:"] == []


def test_every_example_is_run_somewhere():
    makefile = (ROOT / "Makefile").read_text(encoding="utf-8")
    tests = "".join(file.read_text(encoding="utf-8") for file in (ROOT / "tests").rglob("test_*.py"))
    for script in EXAMPLES.glob("*.py"):
        assert script.stem in makefile or f'("{script.stem}"' in tests, script.name


def test_the_notebook(capsys, monkeypatch):
    notebook = json.loads((ROOT / "docs" / "quickstart_notebook.ipynb").read_text(encoding="utf-8"))
    cells = [cell for cell in notebook["cells"] if cell["cell_type"] == "code"]
    assert not any(cell["outputs"] for cell in cells)
    mpl.use("Agg")
    space = {}
    for cell in cells:
        exec(compile("".join(cell["source"]), "quickstart_notebook.ipynb", "exec"), space)
    said = capsys.readouterr().out
    assert len(SPECIAL.findall(said)) == 6
    assert float(re.search(r"displacement: ([\d.]+) m", said)[1]) == pytest.approx(0.0170, abs=2e-4)
