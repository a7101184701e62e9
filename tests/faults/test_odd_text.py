"""Whatever a file or a dictionary holds, the answer is one message that a terminal can show."""

import time

import pytest

import frahm

BASE = frahm.load_case("jacket-pipe").to_dict()


def nested(kind, depth):
    found = kind()
    for _ in range(depth):
        found = {"a": found} if kind is dict else [found]
    return found


class Unspeakable:
    def __repr__(self):
        raise ZeroDivisionError


FILES = {
    "surrogate.yaml": 'name: "\\ud800"\npipe: {mass: 1}\n',
    "surrogate-in-a-name.yaml": '"\\ud800": 1\n',
    "surrogate-in-a-file-name.yaml": 'pipe: {mass: 1}\nwind: {record: "\\ud800.csv"}\n',
    "five-thousand-digits.yaml": f"pipe: {{mass: {'1' * 5000}}}\n",
    "hexadecimal.yaml": f"pipe: {{mass: 0x{'f' * 6000}}}\n",
    "digits.toml": f"[pipe]\nmass = {'1' * 5000}\n",
    "deep-key.toml": ".".join(["a"] * 1000) + " = 1\n",
    "deep-list.toml": f"x = {'[' * 500}{']' * 500}\n",
    "escape.yaml": '"\\e[31mred": 1\n',
    "direction.yaml": '"\\u202eabc": 1\n',
    "lines.yaml": '"a\\nfrahm: all is well": 1\n',
    "long-name.yaml": f'"{"k" * 60_000}": 1\n',
    "long-toml-name.toml": f"{'k' * 60_000} = 1\n",
    "anchors.yaml": "".join(f"a{i}: &x 1\n" for i in range(5000)),
    "names.yaml": "".join(f"a{i}: 1\n" for i in range(8000)),
    "nul.yaml": 'pipe: {mass: 1}\nwind: {record: "a\\0b.csv"}\n',
    "long-file-name.yaml": f'pipe: {{mass: 1}}\nwind: {{record: "{"a" * 5000}.csv"}}\n',
}
DICTIONARIES = {
    "deep": nested(dict, 1000),
    "deeper": nested(dict, 100_000),
    "deep list": {"pipe": nested(list, 50_000)},
    "deep record": BASE | {"wind": BASE["wind"] | {"record": nested(list, 900)}},
    "digits": {"pipe": {"mass": 10**5000}},
    "digits as a name": {10**5000: 1},
    "surrogate": {"\ud800": 1},
    "surrogate file": BASE | {"wind": BASE["wind"] | {"record": "\ud800.csv"}},
    "cannot be shown": BASE | {"name": Unspeakable()},
    "names": {f"k{i}": 1 for i in range(8000)},
}


def message(load, source):
    with pytest.raises(frahm.ParameterError) as refused:
        load(source)
    return str(refused.value)


def check(text):
    assert all(letter.isprintable() or letter == "\n" for letter in text)
    assert len(text) < 4000
    assert len(text.splitlines()) <= 8


@pytest.mark.parametrize("load", [frahm.load_case, frahm.load_study])
@pytest.mark.parametrize("name", FILES)
def test_odd_files_end_in_one_message(tmp_path, capfd, load, name):
    (tmp_path / name).write_text(FILES[name], encoding="utf-8")
    check(message(load, tmp_path / name).replace(str(tmp_path), ""))
    assert capfd.readouterr() == ("", "")


@pytest.mark.parametrize("load", [frahm.load_case, frahm.load_study])
@pytest.mark.parametrize("name", DICTIONARIES)
def test_odd_dictionaries_end_in_one_message(load, name):
    check(message(load, DICTIONARIES[name]))


def test_a_line_that_a_name_carries_is_not_a_line_of_the_message(tmp_path):
    (tmp_path / "a.yaml").write_text(FILES["lines.yaml"], encoding="utf-8")
    lines = message(frahm.load_case, tmp_path / "a.yaml").splitlines()
    assert r"a\nfrahm: all is well: given 1" in lines[0]
    assert not any(line.startswith("frahm:") for line in lines)


def test_escapes_are_shown_and_long_names_shortened(tmp_path):
    (tmp_path / "a.yaml").write_text(FILES["escape.yaml"], encoding="utf-8")
    assert r"\x1b[31mred: given 1" in message(frahm.load_case, tmp_path / "a.yaml")
    error = frahm.ParameterError("n" * 60_000, "v" * 60_000, "all" * 60_000, where="w" * 60_000, hint="h" * 60_000)
    assert len(str(error)) < 3200
    assert str(frahm.ParameterError("a", 1, "b", also=("one\x07", "two"))) == "a: given 1; allowed: b\none\\x07\ntwo"


@pytest.mark.parametrize("letter", ["\u202e", "\u2066", "\u202c"])
def test_a_title_cannot_turn_the_direction_of_the_text(letter):
    with pytest.raises(frahm.ParameterError, match="title"):
        frahm.load_case(BASE | {"title": f"abc{letter}def"})
    assert frahm.load_case(BASE | {"title": "قسم 3"}).title == "قسم 3"  # text that runs from the right is text


def test_the_cost_of_many_unknown_names_grows_no_faster_than_their_number():
    def seconds(count):
        began = time.process_time()
        message(frahm.load_case, BASE | {f"k{i}": 1 for i in range(count)})
        return time.process_time() - began

    seconds(10)
    few, many = min(seconds(4000) for _ in range(3)), min(seconds(32_000) for _ in range(3))
    assert many < 8 * 2.5 * few + 0.05
