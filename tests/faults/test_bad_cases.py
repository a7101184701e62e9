import os
import re

import pytest
from typer.testing import CliRunner

import frahm
from frahm.cli import app

PIPE = "pipe: {mass: 1, frequency: 1, damping_ratio: 0.01, diameter: 1}\n"
WIND = "wind: {speed: 1, lift_coefficient: 1}\n"
GOOD = PIPE + WIND
LAUGHS = "a0: &a0 [x, x, x, x, x, x, x, x, x, x]\n" + "".join(
    f"a{i}: &a{i} [" + ", ".join([f"*a{i - 1}"] * 10) + "]\n" for i in range(1, 12)
)


@pytest.fixture
def folder(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    return tmp_path


def refused(source):
    """Message of the refusal, which the command line repeats as its only output, with exit code 2."""
    before = sorted(os.listdir("."))
    with pytest.raises(frahm.ParameterError) as caught:
        frahm.load_case(source)
    message = str(caught.value)
    result = CliRunner().invoke(app, ["check", str(source)])
    assert result.exit_code == 2
    assert result.stdout == ""
    assert result.stderr == f"frahm: {message}\n"
    assert sorted(os.listdir(".")) == before
    return message


def refused_text(folder, text, name="bad.yaml"):
    (folder / name).write_bytes(text if isinstance(text, bytes) else text.encode())
    return refused(name)


@pytest.mark.parametrize(
    ("old", "new", "says"),
    [
        ("mass: 1", "mass: -1", r"bad.yaml:1: pipe.mass: given -1; allowed: a finite number \[kg\] > 0"),
        ("mass: 1", "mass: 0", r"pipe.mass: given 0; .*> 0"),
        ("mass: 1", "mass: .nan", r"pipe.mass: given nan; allowed: a finite number"),
        ("mass: 1", "mass: .inf", r"pipe.mass: given inf; allowed: a finite number"),
        ("mass: 1", "mass: 1e999", r"pipe.mass: given inf; allowed: a finite number"),
        ("mass: 1", "mass: 1e200", r"pipe.mass: given 1e\+200; .*can only be a mistake"),
        ("mass: 1", "mass: 1e-200", r"pipe.mass: given 1e-200; .*can only be a mistake"),
        ("mass: 1", "mass: true", r"pipe.mass: given True; allowed: a finite number"),
        ("mass: 1", "mass: heavy", r"pipe.mass: given 'heavy'; allowed: a finite number"),
        ("mass: 1", "mass: 2 m", r"pipe.mass: given '2 m'; .*'m' does not measure \[kg\]"),
        ("mass: 1", "mass: 2 kgg", r"Unknown unit 'kgg'. Did you mean 'kg'"),
        ("mass: 1", "mass: [1]", r"pipe.mass: given \[1\]"),
        ("mass: 1", "mass: {a: 1}", r"pipe.mass: given \{'a': 1\}"),
        ("mass: 1", "mass: ", r"pipe.mass: given None"),
        ("mass: 1", "mass: 2022-07-01", r"pipe.mass: given '2022-07-01'"),
        ("frequency: 1", "frequency: 0", r"pipe.frequency: given 0; .*\[rad/s\] > 0.*Hz"),
        ("frequency: 1", "frequency: '0.78'", r"pipe.frequency: given '0.78'; .*add the unit"),
        ("damping_ratio: 0.01", "damping_ratio: -0.01", r"pipe.damping_ratio: given -0.01; .*>= 0 and < 1"),
        ("damping_ratio: 0.01", "dampingratio: 0.01", r"pipe.dampingratio: given 0.01; .*Did you mean 'damping_ratio'"),
        ("damping_ratio: 0.01, ", "", r"bad.yaml:1: pipe.damping_ratio: given nothing; .*required"),
        ("speed: 1", "speed: 0", r"bad.yaml:2: wind.speed: given 0; .*\[m/s\] > 0"),
        ("wind:", "wnd:", r"bad.yaml:2: wnd: given .*Did you mean 'wind'"),
        ("wind:", "wind: 3 #", r"bad.yaml:2: wind: given 3; allowed: a mapping with speed"),
    ],
)
def test_bad_field(folder, old, new, says):
    assert old in GOOD
    message = refused_text(folder, GOOD.replace(old, new))
    assert re.search(says, message)
    assert "\n" not in message


@pytest.mark.parametrize(
    ("text", "says"),
    [
        ("absorbers: 3", r"bad.yaml:3: absorbers: given 3; allowed: a list of mappings with name, mass, law"),
        ("absorbers: [3]", r"absorbers\[0\]: given 3; allowed: a mapping with name, mass, law"),
        (
            "absorbers: [{mass: 1, law: {kind: qubic}}]",
            r"absorbers\[0\].law.kind: given 'qubic'; .*mean 'cubic'",
        ),
        ("absorbers: [{mass: 1, law: {stiffness: 1}}]", r"absorbers\[0\].law.kind: given nothing"),
        ("absorbers: [{mass: 1, law: {kind: 3}}]", r"absorbers\[0\].law.kind: given 3"),
        ("absorbers: [{mass: 1, law: soft}]", r"absorbers\[0\].law: given 'soft'; allowed: a mapping with kind"),
        (
            "absorbers:\n- mass: 1\n  law:\n    kind: cubic\n    stiffness: -2\n    damping: 0",
            r"bad.yaml:7: absorbers\[0\].law.stiffness: given -2; .*\[N/m\^3\] > 0",
        ),
        (
            "absorbers:\n- mass: 1\n  law:\n    kind: cubic\n    stifness: 2\n    damping: 0",
            r"bad.yaml:7: absorbers\[0\].law.stifness: given 2; .*Did you mean 'stiffness'",
        ),
        (
            "absorbers: [{mass: 1, law: {kind: polynomial, coefficients: [], damping: 0}}]",
            r"law.coefficients: given \[\]; allowed: a list of 1 to 15",
        ),
        (
            "absorbers:\n- {mass: 1, law: {kind: linear, stiffness: 1, damping: 0}}\n"
            "- {mass: 1, law: {kind: linear, stiffness: 1, damping: 0}}",
            r"bad.yaml:5: absorbers\[1\].name: given 'sink'; allowed: a name no other",
        ),
        ("analysis: {detuning: [0.1, -0.1]}", r"analysis.detuning: given \[0.1, -0.1\]; .*lo < hi"),
        ("analysis: {detuning: [-2, 0.1]}", r"bad.yaml:3: analysis.detuning\[0\]: given -2.0; allowed: more than -1"),
        ("analysis: {detuning: 0.1}", r"analysis.detuning: given 0.1"),
        ("analysis: {harmonics: many}", r"analysis.harmonics: given 'many'; .*whole number.*'auto'"),
        ("analysis: {samples: 0}", r"analysis.samples: given 0; .*>= 1"),
        ("analysis: {seed: 1.5}", r"analysis.seed: given 1.5; allowed: a whole number"),
        ("analysis: {form: papre}", r"analysis.form: given 'papre'; .*Did you mean 'paper'"),
        ("name: [a]", r"bad.yaml:3: name: given \['a'\]; allowed: one line of text"),
        ('name: "a\\nb"', r"bad.yaml:3: name: given 'a\\nb'; allowed: one line of text"),
        ("name: ''", r"name: given ''; allowed: one line of text"),
        ("<<: {name: x}", r"bad.yaml:3: <<: given .*allowed: no such field"),
        ("3: 4", r"bad.yaml:3: 3: given 4; allowed: no such field"),
    ],
)
def test_bad_section(folder, text, says):
    message = refused_text(folder, GOOD + text + "\n")
    assert re.search(says, message)


@pytest.mark.parametrize(
    ("text", "says"),
    [
        ("", "an empty file"),
        ("# nothing but a comment\n", "an empty file"),
        ("{}", "an empty file"),
        ("- 1\n- 2\n", r"given \[1, 2\]; allowed: a mapping with the sections pipe, wind"),
        ("just text", r"given 'just text'; allowed: a mapping"),
        (b"\x00\x01\x02\xff" * 100, "not text in UTF-8"),
        ("ä".encode("latin-1"), "not text in UTF-8"),
        (GOOD.encode("utf-16"), "not text in UTF-8"),
        ("a: \x07", "Not valid YAML"),
        (GOOD + "name: [\n", r"bad.yaml:\d: case: given 'bad.yaml'.*Not valid YAML"),
        (PIPE + "\twind: 1\n", r"bad.yaml:2: .*Not valid YAML"),
        (GOOD + "pipe: 3\n", r"bad.yaml:3: .*'pipe' is given twice"),
        ("pipe: {mass: 1, mass: 1}\n", r"bad.yaml:1: .*'mass' is given twice"),
        (GOOD + "---\nname: x\n", "a single document"),
        (GOOD + "name: *nowhere\n", "bad.yaml:3: .*undefined alias"),
        ("a: &a [*a]\n", "bad.yaml:1: .*expand beyond"),
        ("a: &a {b: *a}\n", "bad.yaml:1: .*expand beyond"),
        (LAUGHS, r"bad.yaml:\d+: .*expand beyond"),
        ("[" * 5000, "nested too deeply"),
        ("a: " + "[" * 60 + "]" * 60, "expand beyond"),
        (GOOD + "name: !!python/object/apply:os.system [ls]\n", r"bad.yaml:3: .*tag .*python/object.* has no meaning"),
        (GOOD + "name: !mine x\n", r"bad.yaml:3: .*tag '!mine' has no meaning"),
        (GOOD + "name: !!binary aGVsbG8=\n", r"bad.yaml:3: .*tag .*binary' has no meaning"),
        (GOOD + "? [a]\n: 1\n", "bad.yaml:3: .*A name must be plain text"),
        ("a: " + "9" * 5000, "cannot be read as int"),
        ("#" * 300_000, "at most 256 kB"),
    ],
)
def test_bad_file(folder, text, says):
    assert re.search(says, refused_text(folder, text))


@pytest.mark.parametrize(
    ("text", "says"),
    [
        ("pipe = ", r"bad.toml:1: .*Not valid TOML"),
        ("a = 1\na = 2\n", r"bad.toml:\d: .*Not valid TOML"),
        ("[pipe]\nmass = 1\nfrequency = -1\n", r"bad.toml:3: pipe.frequency: given -1; .*> 0"),
        ("[pipe]\nmass = 2022-07-01\n", r"bad.toml:2: pipe.mass: given datetime.date"),
        ("[[absorbers]]\nmass = 1\n[[absorbers]]\nmass = nan\n", r"bad.toml:4: absorbers\[1\].mass: given nan"),
        ("[[absorbers]]\n[absorbers.law]\nkind = 'cubik'\n", r"bad.toml:3: absorbers\[0\].law.kind: given 'cubik'"),
        ("a = " + "[" * 5000 + "]" * 5000, "nested too deeply"),
        ("", "an empty file"),
    ],
)
def test_bad_toml(folder, text, says):
    assert re.search(says, refused_text(folder, text, "bad.toml"))


def test_bad_source(folder):
    (folder / "folder.yaml").mkdir()
    (folder / "case.json").write_text("{}")
    assert "This is a directory" in refused("folder.yaml")
    assert "The ending '.json' is not known" in refused("case.json")
    assert "There is no such file" in refused("missing.yaml")
    assert "Did you mean 'jacket-pipe'" in refused("jacketpipe")
    assert "Did you mean 'jacket-pipe'" in refused("jacket_pipe.yaml")
    assert "built-in case (jacket-pipe, " in refused("")
    assert "built-in case (jacket-pipe, " in refused("a" * 5000 + ".yaml")
    assert "not a regular file" in refused("/dev/null")
    os.mkfifo(folder / "pipe.yaml")
    assert "not a regular file" in refused("pipe.yaml")


@pytest.mark.parametrize("source", [None, 3, [], b"jacket-pipe", object(), ("jacket-pipe",)])
def test_no_source(source):
    with pytest.raises(frahm.ParameterError, match=r"^case: given .*jacket-pipe.*a dictionary or a frahm.Case"):
        frahm.load_case(source)


@pytest.mark.parametrize("data", [{}, {1: 2}, {"pipe": {1: 2}, "wind": {}}, {"a\0b": 1}, {"self": 1}, {"_with": 1}])
def test_odd_dictionaries(data):
    with pytest.raises(frahm.ParameterError):
        frahm.load_case(data)


def test_null_character_in_a_path():
    with pytest.raises(frahm.ParameterError, match=r"^case: given"):
        frahm.load_case("a\0b.yaml")


def test_all_problems_of_a_case_are_told_at_once(folder):
    text = GOOD.replace("mass: 1", "mass: -1").replace("speed: 1", "speed: fast").replace("diameter", "diametre")
    first, *others = refused_text(folder, text).split("\n")
    assert re.search(r"bad.yaml:1: pipe.diametre: given 1; .*Did you mean 'diameter'", first)
    assert [re.search(r"bad.yaml:\d: (\S+): given", line)[1] for line in others] == ["pipe.mass", "wind.speed"]


@pytest.mark.parametrize(
    ("path", "value", "bound"),
    [
        (("absorbers", 0, "law", "stiffness"), 0, "> 0"),
        (("analysis", "periods"), 11_000_000, "<= 1000000"),
        (("analysis", "periods"), 0, ">= 1"),
    ],
)
def test_bounds_that_a_later_step_would_run_into_are_checked_at_the_door(path, value, bound):
    data = frahm.load_case("jacket-pipe").to_dict()
    place = data
    for key in path[:-1]:
        place = place[key]
    place[path[-1]] = value
    with pytest.raises(frahm.ParameterError) as caught:
        frahm.load_case(data)
    assert str(path[-1]) in str(caught.value)
    assert bound in str(caught.value)
