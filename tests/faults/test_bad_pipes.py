"""Impossible tubes, mechanisms, absorbers off the pipe, and tables of modes that do not fit together."""

import re

import pytest

import frahm

WIND = "wind: {speed: 2.7, lift_coefficient: 0.45}\n"
TUBE = ("pipe: {kind: tube, diameter: 0.762, wall: 0.0134, length: 31.2, damping_ratio: 0.0015, "
        "supports: [{at: 0, kind: clamped}]}\n")  # fmt: skip
SINK = "absorbers: [{mass: 38, position: 31.2, law: {kind: cubic, stiffness: 7e5, damping: 22}}]\n"
HEAD = "mass,frequency [Hz],damping_ratio,lift_length,displacement at 0,displacement at 31.2\n"


@pytest.fixture
def folder(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    return tmp_path


def message(folder, text):
    (folder / "bad.yaml").write_text(text)
    with pytest.raises(frahm.ParameterError) as caught:
        frahm.load_case("bad.yaml")
    return str(caught.value)


@pytest.mark.parametrize(
    ("old", "new", "says"),
    [
        ("wall: 0.0134", "wall: 0.4", r"bad.yaml:1: pipe.wall: given 0.4; allowed: at most the radius, 0.381 m"),
        ("wall: 0.0134, ", "", r"bad.yaml:1: pipe.wall: given nothing; .*required"),
        ("wall: 0.0134", "thickness: 1", r"pipe.thickness: given 1; allowed: no such field here, only kind, diameter"),
        ("kind: tube", "kind: tubes", r"pipe.kind: given 'tubes'; allowed: one of mode, tube, modes. Did you mean"),
        ("{at: 0, kind: clamped}", "", r"pipe.supports: given \[\]; .*Nothing holds the pipe"),
        ("kind: clamped", "kind: pinned", r"pipe.supports: given \[0.0\]; .*turn freely about its only support"),
        ("kind: clamped", "kind: spring", r"pipe.supports\[0\]: .*a spring with a translation or rotation"),
        ("kind: clamped", "kind: spring, rotation: 1e5", r"Nothing holds the pipe against sideways motion"),
        ("kind: clamped", "kind: clamped, rotation: 1", r"supports\[0\].rotation: given 1.0; allowed: nothing, for a"),
        ("kind: clamped", "kind: clampd", r"supports\[0\].kind: given 'clampd'; .*Did you mean 'clamped'"),
        ("at: 0", "at: 40", r"pipe.supports\[0\].at: given 40.0; allowed: a section of the beam, 0 to 31.2 m"),
        ("at: 0", "at: 10 kg", r"pipe.supports\[0\].at: given '10 kg'; .*does not measure \[m\]"),
        ("at: 0, kind: clamped", "at: 5, kind: free", r"supports\[0\].at: given 5.0; allowed: free only at an end"),
        ("damping_ratio: 0.0015", "damping_ratios: [0.1]", r"pipe.damping_ratios: given \[0.1\]; allowed: 3 numbers"),
        (
            ", wall",
            ", governing_mode: 4, wall",
            r"pipe.governing_mode: given 4; allowed: a mode that takes part, 1 to 3",
        ),
        (", wall", ", mode_count: 100, wall", r"pipe.mode_count: given 100; .*<= 60"),
        (", wall", ", lift: shape, wall", r"pipe.lift: given 'shape'; allowed: one of uniform, mode-shape"),
        (
            "position: 31.2",
            "position: 32",
            r"absorbers\[0\].position: given 32.0; allowed: a section of the pipe, 0 to",
        ),
        ("position: 31.2", "position: 0", r"absorbers\[0\].position: given 0.0; allowed: a section that moves"),
        ("position: 31.2", "position: -1", r"absorbers\[0\].position: given -1; .*>= 0"),
    ],
)
def test_bad_tube(folder, old, new, says):
    text = TUBE + WIND + SINK
    assert old in text
    found = message(folder, text.replace(old, new, 1))
    assert re.search(says, found), found


def test_a_rigid_pipe_has_no_positions(folder):
    text = "pipe: {mass: 247, frequency: 4.9, damping_ratio: 0.0015, diameter: 0.762}\n" + WIND + SINK
    assert "absorbers[0].position: given 31.2; allowed: nothing" in message(folder, text)


@pytest.mark.parametrize(
    ("table", "says"),
    [
        (
            HEAD + "1930,0.78,0.0015,12.2,0,0.5\n",
            r"largest displacement is 1 or -1.*Divide the shape by 0.5 .* by 0.25",
        ),
        (HEAD + "1930,0.78,0.0015,12.2,0,2\n", r"Divide the shape by 2 and the mass by 4"),
        (HEAD + "1930,0.78,0.0015,12.2,0\n", r"6 cells in every row"),
        (HEAD + "1930,0.78,0.0015,12.2,0,one\n", r"a number in every cell"),
        (HEAD, r"at least one row of numbers"),
        (HEAD.replace("mass", "maas") + "1930,0.78,0.0015,12.2,0,1\n", r"Did you mean 'mass'"),
        (HEAD.replace(" [Hz]", "") + "1930,0.78,0.0015,12.2,0,1\n", r"say the unit of frequency"),
        (HEAD.replace("31.2", "40") + "1930,0.78,0.0015,12.2,0,1\n", r"pipe.sections\[1\]: given 40.0"),
        (HEAD + "1930,4,0.0015,6,0,1\n1930,0.78,0.0015,12.2,0,1\n", r"modes\[1\].frequency: .*frequencies that ascend"),
        (HEAD + "-3,0.78,0.0015,12.2,0,1\n", r"pipe.modes\[0\].mass: given -3.0; .*> 0"),
        ("mass,frequency [Hz],damping_ratio,lift_length\n1,1,0,1\n", r"'displacement at ...' for every section"),
        (HEAD[:-1] + ",stress at 3\n1930,0.78,0.0015,12.2,0,1,2\n", r"'stress at ...' for the same ones or none"),
    ],
)
def test_bad_table_of_modes(folder, table, says):
    (folder / "modes.csv").write_text(table)
    found = message(folder, "pipe: {kind: modes, diameter: 1, length: 31.2, modes: modes.csv}\n" + WIND)
    assert re.search(says, found), found


def test_what_a_table_does_not_hold_is_refused(folder):
    (folder / "modes.csv").write_text(HEAD + "1930,0.78,0.0015,12.2,0,1\n")
    text = "pipe: {kind: modes, diameter: 1, length: 31.2, modes: modes.csv}\n" + WIND
    assert "a section of the table of modes: 0, 31.2 m" in message(folder, text + SINK.replace("31.2", "3"))
    (folder / "good.yaml").write_text(text + SINK)
    case = frahm.load_case("good.yaml")
    assert frahm.load_case(case.to_yaml("again.yaml") and "again.yaml") == case
    assert frahm.build_system(case).elements[0].direction.tolist() == [-1, 1]
    with pytest.raises(frahm.ParameterError, match="with their stress at every section"):
        frahm.stress_row(case)
    assert "There is no such file" in message(folder, text.replace("modes.csv", "none.csv"))
