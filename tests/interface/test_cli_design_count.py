"""`frahm design --count`: what is refused, and how."""

import pytest
from typer.testing import CliRunner

from frahm.cli import app


@pytest.mark.parametrize(
    ("options", "said"),
    [
        (["--count", "0"], "count"),
        (["--count", "two"], "--count"),
        (["--count", "3-1"], "count"),
        (["--count", "2", "--mass-shares", "0.5,0.4"], "add up to 0.9"),
        (["--count", "3", "--mass-shares", "0.5,0.5"], "mass_shares"),
        (["--count", "2", "--mass-shares", "equall"], "Did you mean 'equal'?"),
        (["--count", "2", "--mass-shares", "0.6,0.4", "--devices", "equal"], "one device"),
        (["--count", "2", "--mass-shares", "0.6,half"], "--mass-shares"),
    ],
)
def test_a_number_of_absorbers_that_cannot_be_is_refused_before_anything_is_written(tmp_path, options, said):
    folder = tmp_path / "out"
    result = CliRunner().invoke(app, ["design", "jacket-pipe", "--out", str(folder), *options])
    assert result.exit_code == 2
    assert said in result.stderr
    assert not folder.exists()
