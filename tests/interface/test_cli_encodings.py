"""Every command prints, whatever letters the place it prints to knows."""

import os
import subprocess
import sys

import pytest

import frahm

CODE_PAGES = ("cp1252", "cp850", "latin-1", "utf-8")


def run(*arguments, encoding, folder, code=None):
    environment = {**os.environ, "PYTHONIOENCODING": encoding, "PYTHONUTF8": "0"}
    start = ["-c", code] if code else ["-m", "frahm"]
    return subprocess.run(
        [sys.executable, *start, *arguments], capture_output=True, cwd=folder, env=environment, check=False
    )


@pytest.fixture(scope="module")
def folder(tmp_path_factory):
    """A case in Cyrillic, Greek and Chinese."""
    path = tmp_path_factory.mktemp("folder")
    case = frahm.load_case("jacket-pipe")
    data = case.to_dict() | {"name": "труба", "title": "Rohr Ø 762 – σ ≥ 0, κ² naïve 管道"}
    frahm.load_case(data).to_yaml(path / "pipe.yaml")
    return path


@pytest.mark.parametrize("encoding", CODE_PAGES)
def test_a_case_in_another_script_is_checked(folder, encoding):
    done = run("check", "pipe.yaml", encoding=encoding, folder=folder)
    assert (done.returncode, done.stderr) == (0, b"")
    text = done.stdout.decode(encoding)
    assert "The case is valid" in text
    assert ("σ" if encoding == "utf-8" else "sigma") in text
    assert "naïve" in text


def test_a_name_no_encoding_knows_ends_in_its_message(folder):
    done = run("check", os.fsdecode(b"a\xff.yaml"), encoding="utf-8", folder=folder)
    assert done.returncode == 2
    assert b"Traceback" not in done.stderr


def test_a_mistake_of_the_program_is_visible_as_one(folder):
    code = (
        "import sys, frahm.case, frahm.cli\n"
        "def broken(source): undefined_name\n"
        "frahm.case.load_case = broken\n"
        "sys.argv = ['frahm', 'check', 'jacket-pipe']\n"
        "frahm.cli.main()"
    )
    done = run(encoding="utf-8", folder=folder, code=code)
    assert done.returncode == 1
    assert b"NameError" in done.stderr
