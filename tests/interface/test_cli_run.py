"""One real run of the built-in case, and what is in the files it leaves."""

import json
import math
import os
import pty
import re
import subprocess
import sys
from pathlib import Path

import h5py
import numpy as np
import pytest
import scipy.optimize
import xarray as xr
from typer.testing import CliRunner

import frahm
from frahm.cli import app

FRAHM = [sys.executable, "-m", "frahm"]
CASE = frahm.load_case("jacket-pipe")
QUICK = CASE.without_absorbers().with_name("quick").with_analysis(periods=1000)


def frahm_in(folder, *arguments):
    return subprocess.run([*FRAHM, *arguments], cwd=folder, capture_output=True, text=True, check=False)


@pytest.fixture(scope="session")
def finished(tmp_path_factory):
    folder = tmp_path_factory.mktemp("run")
    return folder / "out" / "jacket-pipe", frahm_in(folder, "run", "jacket-pipe")


@pytest.fixture(scope="session")
def summary(finished):
    def refuse(constant):
        raise AssertionError(f"{constant} is no strict JSON")

    return json.loads((finished[0] / "summary.json").read_text(encoding="utf-8"), parse_constant=refuse)


def one_harmonic_roots(sigma, kappa=90742.86 / 247, xi2=2.8899 / 247, rho2=0.02):
    """|Z|^2 of all one-harmonic responses, written down afresh: substitute X = x Z into both balances."""
    omega, xi1, force = 2 * math.pi * 0.78, 2 * 0.0015 * 2 * math.pi * 0.78, 0.5 * 0.4535 * 1.225 * 2.7**2 * 0.762 / 247
    W = omega + sigma
    host = omega**2 - W**2 + 1j * W * xi1
    x0, x1 = (1j * W * xi2) / (rho2 * W**2) - 1, 0.75 * kappa / (rho2 * W**2)
    a, b = host * x0 - 1j * W * xi2, host * x1 - 0.75 * kappa  # F = Z (a + b N), N = |Z|^2
    roots = np.roots([abs(b) ** 2, 2 * (a * np.conj(b)).real, abs(a) ** 2, -(force**2)])
    return np.sort(roots[np.abs(roots.imag) < 1e-9 * np.abs(roots)].real), (omega, xi1, xi2, kappa, rho2, W)


def growth_of_the_pair(N, parameters):
    """Real part of the complex pair of eigenvalues nearest the axis; Jacobian by differences of the right-hand side."""
    omega, xi1, xi2, kappa, rho2, W = parameters
    Z0 = math.sqrt(N)
    X0 = Z0 * ((1j * W * xi2 + 0.75 * kappa * N) / (rho2 * W**2) - 1)
    host = omega**2 - W**2 + 1j * W * xi1

    def velocity(y):
        X, Z = y[0] + 1j * y[1], y[2] + 1j * y[3]
        g = (1j * W * xi2 + 0.75 * kappa * abs(Z) ** 2) * Z
        dX = (-host * X + g) / (2j * W)
        dZ = (W**2 * (X + Z) - g / rho2) / (2j * W) - dX
        return np.array([dX.real, dX.imag, dZ.real, dZ.imag])

    y0, step = np.array([X0.real, X0.imag, Z0, 0.0]), 1e-7
    columns = [(velocity(y0 + step * e) - velocity(y0 - step * e)) / (2 * step) for e in np.eye(4)]
    eigenvalues = np.linalg.eigvals(np.array(columns).T)
    pairs = eigenvalues[np.abs(eigenvalues.imag) > 1e-6].real
    return pairs[np.argmin(np.abs(pairs))]


def test_the_run_is_clean_and_quiet_in_a_pipe(finished):
    folder, done = finished
    assert done.returncode == 0
    assert done.stderr == ""
    assert "report.html" in done.stdout
    assert len(done.stdout.splitlines()) <= 4
    names = {"case.yaml", "summary.json", "results.nc", "report.html", "figures"}
    assert {entry.name for entry in folder.iterdir()} == names
    figures = {entry.name for entry in (folder / "figures").iterdir()}
    for stem in ("response-pipe", "response-absorber", "slow-manifold", "motion-design-wind", "motion-resonance"):
        assert {f"{stem}.png", f"{stem}.svg"} <= figures
    assert "motion-resonance-last.csv" in figures
    drawn = [entry for entry in (folder / "figures").iterdir() if entry.suffix != ".csv"]
    assert all(entry.stat().st_size > 3000 for entry in drawn)


def test_summary_has_the_shape_of_the_contract(summary):
    assert set(summary) == {"schema", "frahm", "case", "results", "checks", "unverified"}
    assert summary["frahm"] == frahm.__version__
    assert summary["unverified"] == []
    assert frahm.load_case(summary["case"]).digest == CASE.digest
    for check in summary["checks"]:
        assert set(check) == {"name", "status", "detail"}
        assert check["status"] == "pass"
    for method in ("harmonic-balance", "slow-flow"):
        assert {"pipe_peak_max", "special_points"} <= set(summary["results"]["response"][method])
    exact = summary["results"]["response"]["harmonic-balance"]
    assert {"inventory", "detached_curve_margin", "branches"} <= set(exact)


def test_the_exact_response_is_near_the_slow_flow_and_holds_against_integration(summary):
    exact, slow = (summary["results"]["response"][method] for method in ("harmonic-balance", "slow-flow"))
    kinds = {"saddle-node": "saddle-node", "neimark-sacker": "hopf"}
    for one, other in zip(exact["special_points"], slow["special_points"], strict=True):
        assert kinds[one["kind"]] == other["kind"]
        assert one["detuning"] == pytest.approx(other["detuning"], abs=2e-3)
        assert one["pipe_peak"] == pytest.approx(other["pipe_peak"], rel=0.02)
    assert summary["results"]["cross_check"]["largest_pipe_error"] < 1e-8
    assert summary["results"]["cross_check"]["largest_relative_error"] < 1e-8


def test_the_margin_is_in_summary_terminal_and_report(finished, summary):
    margin = summary["results"]["response"]["harmonic-balance"]["detached_curve_margin"]
    ahead = margin["next_event"]
    assert margin["force_margin"] == ahead["force"]
    assert ahead["kind"] == "birth"
    (event,) = frahm.detached_curve_events(CASE, "force", (1.05, 1.15), detuning=(-0.2, 0.0), slices=2)
    assert ahead["force"] == pytest.approx(event.value, rel=1e-6)
    text = f"The force margin is {ahead['force']:.4g}: beyond that factor on the force a detached response curve"
    assert text in finished[1].stdout
    assert text in (finished[0] / "report.html").read_text(encoding="utf-8")


def test_the_bare_pipe_is_as_in_the_paper(summary):
    assert summary["results"]["without_absorber"]["pipe_peak_max"] == pytest.approx(0.08670, abs=1e-5)
    resonance = next(motion for motion in summary["results"]["motions"] if motion["key"] == "resonance")
    assert resonance["pipe_peak_without_absorber"] == pytest.approx(0.08670, abs=1e-5)


def test_saddle_nodes_by_counting_roots(summary):
    found = [
        p["detuning"]
        for p in summary["results"]["response"]["slow-flow"]["special_points"]
        if p["kind"] == "saddle-node"
    ]
    grid = np.arange(-0.4, 0.4, 0.0005)
    counts = [one_harmonic_roots(sigma)[0].size for sigma in grid]
    changes = [grid[i : i + 2] for i in range(grid.size - 1) if counts[i] != counts[i + 1]]
    assert len(found) == len(changes) == 2
    for value, (lo, hi) in zip(found, changes, strict=True):
        few = one_harmonic_roots(lo)[0].size
        for _ in range(30):
            middle = 0.5 * (lo + hi)
            lo, hi = (middle, hi) if one_harmonic_roots(middle)[0].size == few else (lo, middle)
        assert value == pytest.approx(lo, abs=1e-7)


def test_hopf_points_by_eigenvalues_of_differences(summary):
    points = [p for p in summary["results"]["response"]["slow-flow"]["special_points"] if p["kind"] == "hopf"]
    assert len(points) == 2
    for point in points:

        def growth(sigma, near=point["relative_peak"] ** 2):
            roots, parameters = one_harmonic_roots(sigma)
            return growth_of_the_pair(roots[np.argmin(np.abs(roots - near))], parameters)

        root = scipy.optimize.brentq(growth, point["detuning"] - 0.002, point["detuning"] + 0.002, xtol=1e-9)
        assert point["detuning"] == pytest.approx(root, abs=1e-6)
    assert points[0]["detuning"] == pytest.approx(-0.0115, abs=5e-4)


def test_motions_against_values_of_independent_integrations(summary):
    motions = {motion["key"]: motion for motion in summary["results"]["motions"]}
    assert motions["design-wind"]["detuning"] == pytest.approx(2 * math.pi * (0.225 * 2.7 / 0.762 - 0.78))
    assert motions["design-wind"]["kind"] == "periodic"
    assert motions["resonance"]["kind"] == "modulated"
    assert max(m["pipe_peak"] for m in motions.values()) == pytest.approx(0.0171, abs=1.5e-4)
    largest = summary["results"]["largest_motion"]
    assert largest["kind"] in ("modulated", "chaotic")  # a modulated motion may beat without ever repeating
    assert largest["ratio_to_no_absorber"] == pytest.approx(0.0171 / 0.0867, abs=0.003)
    ceiling = summary["results"]["slow_manifold"]["folds"]["pipe_ceiling"]
    assert 1.0 < largest["pipe_peak"] / ceiling < 1.1


def test_arrays_open_with_xarray_and_with_h5py(finished, summary):
    path = finished[0] / "results.nc"
    with xr.open_dataset(path) as opened:
        assert len(opened.variables) > 40
        for name, variable in opened.variables.items():
            assert {"units", "long_name"} <= set(variable.attrs), name
            assert variable.dtype.kind in "fiub", name
        peak = float(opened["response.pipe_peak"].max())
        assert peak == summary["results"]["response"]["harmonic-balance"]["pipe_peak_max"]
        slow = summary["results"]["response"]["slow-flow"]["pipe_peak_max"]
        assert float(opened["slow_flow.pipe_peak"].max()) == slow
        design = opened.isel({"motions.motion": 0})
        last = np.abs(design["motions.x1"].values[-2000:]).max()
        assert last == pytest.approx(summary["results"]["motions"][0]["pipe_peak"], rel=6e-3)
        np.testing.assert_allclose(design["motions.z"], design["motions.x2"] - design["motions.x1"], atol=1e-15)
    with h5py.File(path) as raw:
        assert raw["response.pipe_peak"][:].max() == peak
        assert raw["response.pipe_peak"].attrs["units"] == "m"


def test_the_spectrum_has_its_line_at_the_shedding_frequency(finished):
    with xr.open_dataset(finished[0] / "results.nc") as opened:
        design = opened.isel({"spectra.motion": 0, "motions.motion": 0})
        amplitude, frequency = design["spectra.pipe_amplitude"].values, design["spectra.frequency_hz"].values
    highest = int(np.nanargmax(amplitude))
    assert frequency[highest] == pytest.approx(0.225 * 2.7 / 0.762, rel=1e-3)
    assert amplitude[highest] == pytest.approx(0.00579, rel=5e-3)


def test_the_report_stands_alone(finished, summary):
    text = (finished[0] / "report.html").read_text(encoding="utf-8")
    assert len(text.encode()) < 8e6
    assert text.count("Plotly.newPlot(") >= 1
    own = re.sub(r"<script>.*?</script>", "", text, flags=re.DOTALL)  # without the library itself
    addresses = re.findall(r"\b(?:src|href|action|poster)\s*=\s*[\"']([^\"']*)", own)
    assert addresses
    assert [address for address in addresses if not address.startswith(("data:", "#"))] == []
    assert "@import" not in own
    assert not re.search(r"url\((?!['\"]?data:)", own)
    assert "default-src 'none'" in own
    assert '"showSendToCloud": false' in text
    assert '"displaylogo": false' in text
    judged = summary["results"]["acceptance"]["sentence"]  # the banner
    assert summary["results"]["verdict"].startswith(judged)
    lead = summary["results"]["verdict"].removeprefix(judged).strip()
    assert own.index(lead) < own.index("<h2>")
    for point in ("H1", "NS1", "SN1", "SN2", CASE.digest, "✓ pass", "@media print"):
        assert point in own


def test_defaulted_values_are_flagged_in_the_report(tmp_path):
    file = tmp_path / "short.yaml"
    file.write_text("name: short\npipe: {mass: 247, frequency: 0.78 Hz, damping_ratio: 0.0015, diameter: 0.762}\n"
                    "wind: {speed: 2.7, lift_coefficient: 0.4535}\nanalysis: {periods: 1000}\n")  # fmt: skip
    assert CliRunner().invoke(app, ["run", str(file), "--out", str(tmp_path / "o")]).exit_code == 0
    rows = re.findall(r"<tr>(.*?)</tr>", (tmp_path / "o" / "report.html").read_text(encoding="utf-8"))
    marked = {re.search(r"<code>(.*?)</code>", row)[1] for row in rows if "(default)" in row}
    assert {"pipe.length", "wind.air_density", "wind.strouhal", "analysis.seed"} <= marked
    assert not {"pipe.mass", "analysis.periods"} & marked


def test_show_prints_what_the_summary_says(finished, summary):
    result = CliRunner().invoke(app, ["show", str(finished[0])])
    assert result.exit_code == 0
    for text in (summary["results"]["verdict"], "SN2", "modulated", "✓ pass"):
        assert text in result.stdout


def test_the_report_is_rebuilt_from_what_is_stored(finished, tmp_path):
    folder = tmp_path / "copy"
    folder.mkdir()
    for name in ("summary.json", "results.nc"):
        (folder / name).write_bytes((finished[0] / name).read_bytes())
    assert CliRunner().invoke(app, ["report", str(folder)]).exit_code == 0
    assert (folder / "report.html").read_text() == (finished[0] / "report.html").read_text()


def test_the_stored_case_runs_again(finished):
    assert frahm.load_case(finished[0] / "case.yaml").digest == CASE.digest


def test_a_folder_of_the_same_case_is_written_again_and_another_only_by_force(tmp_path):
    case, other, out = tmp_path / "a.yaml", tmp_path / "b.yaml", tmp_path / "o"
    QUICK.to_yaml(case)
    QUICK.with_wind(speed=2.8).to_yaml(other)
    arguments = ["--out", str(out)]
    assert CliRunner().invoke(app, ["run", str(case), *arguments]).exit_code == 0
    assert CliRunner().invoke(app, ["run", str(case), *arguments]).exit_code == 0
    before = (out / "summary.json").read_bytes()
    refused = CliRunner().invoke(app, ["run", str(other), *arguments])
    assert refused.exit_code == 2
    assert "--force" in refused.stderr
    assert "another case" in refused.stderr
    assert (out / "summary.json").read_bytes() == before
    assert CliRunner().invoke(app, ["run", str(other), *arguments, "--force"]).exit_code == 0
    assert json.loads((out / "summary.json").read_text())["case"]["wind"]["speed"] == 2.8


def test_what_is_unverified_is_named_and_ends_in_3(tmp_path):
    case = tmp_path / "short.yaml"
    QUICK.with_analysis(detuning=(0.05, 0.4)).to_yaml(case)
    result = CliRunner().invoke(app, ["run", str(case), "--out", str(tmp_path / "o")])
    assert result.exit_code == 3
    assert "sits at the lower end of the range" in result.stderr
    assert json.loads((tmp_path / "o" / "summary.json").read_text())["unverified"]


@pytest.mark.parametrize("name", ["chimney", "table"])
def test_a_case_without_limits_is_not_judged_and_nothing_failed(tmp_path, name):
    case = Path(__file__).parents[1] / "cases" / f"{name}.yaml"
    result = CliRunner().invoke(app, ["run", str(case), "--out", str(tmp_path / "o")])
    assert result.exit_code == 0, result.stderr
    assert result.stdout.startswith("NOT JUDGED: the case gives no limit")
    found = json.loads((tmp_path / "o" / "summary.json").read_text())["results"]["acceptance"]
    assert (found["verdict"], found["utilisation"]) == ("not verified", {})
    assert "gives no limit" in found["sentence"]
    html = (tmp_path / "o" / "report.html").read_text()
    assert '<p class="word">NOT JUDGED</p>' in html
    assert 'class="banner pass"' not in html


@pytest.mark.parametrize(("displacement", "code"), [("20 mm", 4), ("2 m", 0)])
def test_a_figure_of_a_transient_does_not_keep_the_answer_from_being_verified(tmp_path, displacement, code):
    case = tmp_path / "short.yaml"
    asked = QUICK.with_analysis(periods=100).to_dict() | {"limits": {"displacement": displacement}}
    frahm.load_case(asked).to_yaml(case)
    result = CliRunner().invoke(app, ["run", str(case), "--out", str(tmp_path / "o")])
    assert result.exit_code == code
    assert "has not settled" not in result.stderr
    summary = json.loads((tmp_path / "o" / "summary.json").read_text())
    assert summary["unverified"] == []
    assert summary["results"]["acceptance"]["verdict"] == ("pass" if code == 0 else "fail")
    for row in summary["results"]["motions"]:  # the system is linear: what the transient tends to is known
        assert row["kind"] == "periodic"
        assert row["pipe_peak"] == pytest.approx(row["pipe_peak_without_absorber"], rel=1e-9)
    assert any("has not settled within 100 periods" in note for note in summary["results"]["notes"])


def test_progress_is_shown_on_a_terminal(tmp_path):
    QUICK.to_yaml(tmp_path / "a.yaml")
    leader, follower = pty.openpty()
    process = subprocess.Popen([*FRAHM, "run", "a.yaml"], cwd=tmp_path, stdout=subprocess.PIPE, stderr=follower)
    os.close(follower)
    shown = b""
    while True:
        try:
            piece = os.read(leader, 4096)
        except OSError:
            break
        if not piece:
            break
        shown += piece
    process.communicate()
    os.close(leader)
    assert process.returncode == 0
    assert b"motions of the exact equations" in shown
    assert (tmp_path / "out" / "quick" / "report.html").exists()


def test_warmup_says_how_long_it_took():
    result = CliRunner().invoke(app, ["warmup"])
    assert result.exit_code == 0
    assert re.search(r"\d+\.\d s", result.stdout)
