"""Examples and the notebook print what the literature and other methods say, and what the documentation shows."""

import json
import math
import re
import runpy
import sys
from pathlib import Path

import matplotlib as mpl
import numpy as np
import pytest

import frahm
from frahm.products.search import ProductSearch
from frahm.products.served import served_member

ROOT = Path(__file__).resolve().parents[2]
EXAMPLES = ROOT / "examples"
NUMBER = re.compile(r"(?<![\w.])[-+]?\d+(?:\.\d+)?(?:e[-+]?\d+)?(?![\w.]*\w)")
SPECIAL = re.compile(r"(saddle-node|neimark-sacker) +(?:sigma|at) +(-?[\d.]+)")


def output_of(name, capsys, monkeypatch, *arguments):
    monkeypatch.setattr(sys, "argv", [name, *map(str, arguments)])
    runpy.run_path(str(EXAMPLES / f"{name}.py"), run_name="__main__")
    return capsys.readouterr().out


def kept(name):
    """Output the documentation shows."""
    return (ROOT / "docs" / "examples" / f"{name}.txt").read_text(encoding="utf-8")


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


def same_words(said, page):
    """Whether two outputs say the same, numbers to 3 %; what is unverified must at least be said on the page."""
    doubts = [line.strip() for line in said.splitlines() if line.strip().startswith("unverified")]
    assert [line for line in doubts if NUMBER.sub("#", line) not in NUMBER.sub("#", page)] == []
    left, right = ([line for line in text.splitlines() if "unverified:" not in line] for text in (said, page))
    assert [NUMBER.sub("#", line) for line in left] == [NUMBER.sub("#", line) for line in right]
    values = [[float(value) for line in lines[1:] for value in NUMBER.findall(line)] for lines in (left, right)]
    assert values[0] == pytest.approx(values[1], rel=0.03)
    return True


def bare_damage(load, low, high):
    """Damage of a linear oscillator over the wind, by the trapezoidal rule: the first mode, curve D, Weibull(7, 2)."""
    speed = np.linspace(low, high, 200_001)
    omega, excitation = 2 * np.pi * 0.78, 2 * np.pi * 0.225 * speed / 0.762
    force = load * 0.5 * 0.4535 * 1.225 * speed**2 * 0.762
    tip = force / 247 / np.abs(omega**2 - excitation**2 + 2j * 0.0015 * omega * excitation)
    stress = 2 * 283.5 * tip  # MPa; 283.5 MPa per metre at the tip of the cantilever
    cycles = np.where(stress > 52.63, 10**12.164 / stress**3, 10**15.606 / stress**5)
    density = 2 / 7 * (speed / 7) * np.exp(-((speed / 7) ** 2))
    return np.trapezoid(density * excitation / (2 * np.pi) * 20 * 365.25 * 86400 / cycles, speed)


def test_the_elastic_pipe_and_its_fatigue(capsys, monkeypatch, tmp_path):
    said = output_of("elastic_fatigue", capsys, monkeypatch, tmp_path)
    assert same_words(said, kept("elastic_fatigue"))
    assert (tmp_path / "elastic_fatigue.png").stat().st_size > 10_000
    ratios = [float(value) / 0.78 for value in re.findall(r"([\d.]+) Hz", said)]
    assert ratios == pytest.approx([1, 6.2669, 17.5475], rel=2e-3)  # of a cantilever, in any book
    assert float(re.search(r"first mode: (\d+) kg", said)[1]) == pytest.approx(247 * 31.2 / 4, rel=3e-3)
    assert float(re.search(r"tip: ([\d.]+) MPa/m", said)[1]) == pytest.approx(283.5, abs=0.5)
    parts = dict(re.findall(r"^lift (\S+), (.*?)(?=^lift|\Z)", said, re.DOTALL | re.MULTILINE))
    for lift, load in (("mode-shape", 1.0), ("uniform", 1.566)):  # 1.566: a cantilever under a uniform load
        low, high = map(float, re.search(r"winds ([\d.]+) to ([\d.]+)", parts[lift]).groups())
        found = float(re.search(r"without the sink +(\S+)", parts[lift])[1])
        assert found == pytest.approx(bare_damage(load, low, high), rel=0.02)
    stress, wind = map(float, re.search(r"stress range with it +(\S+) MPa at (\S+) m/s", parts["uniform"]).groups())
    case = frahm.load_case("jacket-pipe-elastic").with_pipe(lift="uniform").with_wind(speed=wind)
    detuning = 2 * math.pi * 0.225 * wind / 0.762 - case.pipe.modal.frequencies[0]
    exact = max(one.pipe_peak for one in frahm.periodic_responses(case, detuning=detuning) if one.stable)
    assert stress == pytest.approx(2 * 283.5 * exact, rel=0.01)  # by harmonic balance; the example integrates
    assert "at 2.652 m/s (quasi-periodic)" in parts["mode-shape"]


def test_a_design(capsys, monkeypatch, tmp_path):
    said = output_of("design_a_sink", capsys, monkeypatch, tmp_path)
    assert same_words(said, kept("design_a_sink"))
    assert (tmp_path / "design_a_sink.png").stat().st_size > 10_000
    rows = re.findall(r"^  (\w[\w ]*?) +([\d.]+) m, (\w+); detached response from: (.*)$", said, re.MULTILINE)
    peaks = {name: float(peak) for name, peak, *_ in rows}
    assert {state for _, _, state, _ in rows} == {"verified"}
    bare = 0.5 * 0.4535 * 1.225 * 2.7**2 * 0.762 / 247 / (2 * 0.0015 * (2 * math.pi * 0.78) ** 2)
    assert peaks["none"] == pytest.approx(bare, abs=1e-5)
    fixed_points = 2 * 0.0015 * bare * math.sqrt(1 + 2 / 0.02)  # Den Hartog, of a pipe without damping
    assert 0.9 * fixed_points < peaks["tuned mass damper"] < fixed_points
    kappa, xi2 = map(float, re.search(r"kappa ([\d.]+) .*?xi2 ([\d.]+)", said).groups())
    case = frahm.load_case("jacket-pipe").with_absorber(kappa=kappa, xi2=xi2, rho2=0.02)
    curve = frahm.frequency_response(case, detuning=(-0.4, 0.4)).to_dataset()
    assert peaks["sink"] == pytest.approx(float(curve["pipe_peak"].where(curve["stable"]).max()), rel=2e-3)
    events = frahm.detached_curve_events(case, parameter="force", bounds=(1.0, 1.2))
    births = [event.value for event in events if event.kind == "birth"]
    assert min(births) == pytest.approx(float(re.search(r"up to ([\d.]+) times", said)[1]), rel=3e-3)
    assert float(re.search(r"another sample of initial states: ([\d.]+)", said)[1]) == pytest.approx(
        peaks["sink"], rel=5e-3
    )


def test_a_sink_for_the_first_mode_takes_more_off_the_second_than_a_tuned_damper():
    space = runpy.run_path(str(EXAMPLES / "where_a_sink_wins.py"))
    peaks = space["second_mode"]()
    assert peaks["sink"] < 0.6 * peaks["tuned"]
    case = frahm.load_case("jacket-pipe-elastic").with_pipe(lift="uniform")
    # the bare pipe by hand: the resonance of the second mode, whose force and mass are those of the modes alone
    modal, speed = case.pipe.modal, case.pipe.modal.frequencies[1] * 0.762 / (2 * np.pi * 0.225)
    lift = 0.5 * 0.4535 * 1.225 * speed**2 * 0.762
    second = lift * modal.lift_lengths[1] / modal.masses[1] / (2 * 0.0015 * modal.frequencies[1] ** 2)
    assert peaks["none"] == pytest.approx(abs(second * modal.displacement(31.2)[1]), rel=0.02)
    sink = frahm.design.with_design(case, space["SINK"])
    curve = frahm.frequency_response(sink, wind=space["SECOND_MODE"])
    at = int(np.argmax(curve.pipe_peak))
    system = frahm.build_system(sink.with_wind(speed=float(curve.wind_speed[at])))
    motion = frahm.integrate(system, frequency=float(curve.frequency[at]), periods=3000, samples_per_period=32)
    last = motion.x[-32 * 50 :] @ system.output
    assert np.max(np.abs(last)) == pytest.approx(peaks["sink"], rel=5e-3)


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


def test_the_spread_from_which_a_sink_serves_many_pipes_better_is_as_the_documentation_says():
    """By the closed form: what the table of docs/products.md says, and what was kept for it by all attractors."""
    space = runpy.run_path(str(EXAMPLES / "products_study.py"))
    table = {row["spread"]: row for row in json.loads((ROOT / "docs/examples/products-study.json").read_text())}
    wins = {}
    for spread in (0.2, 0.5):
        screen = frahm.screen_members(space["family_of_pipes"](spread))
        members = [served_member(one, 0.02, 1.05) for one in screen]
        worst = {family: ProductSearch(members, family).best(1).worst for family in ("tuned", "sink")}
        wins[spread] = worst["sink"] < worst["tuned"]
        for family, value in worst.items():
            assert table[spread][family]["worst"] == pytest.approx(value, rel=0.03)
    assert wins == {0.2: False, 0.5: True}
    page = (ROOT / "docs" / "products.md").read_text(encoding="utf-8")
    rows = re.findall(r"^\| (\d+) % \| ([\d.]+)[^|]*\| ([\d.]+)[^|]*\| ([\d.]+)", page, re.MULTILINE)
    assert [int(row[0]) for row in rows] == [round(100 * spread) for spread in table]
    for row, one in zip(rows, table.values(), strict=True):
        for text, family in zip(row[1:], ("tuned", "mixed", "sink"), strict=True):
            assert float(text) == pytest.approx(one[family]["worst"], rel=6e-3)
