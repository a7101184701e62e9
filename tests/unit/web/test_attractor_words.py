"""Kinds of motion on the page are said in the words of the report."""

from frahm.web.words import _attractor_cells


def test_a_quasi_periodic_attractor_is_called_modulated_on_the_page():
    row = {
        "kind": "quasi-periodic", "pipe_peak": 0.017, "relative_peak": 0.057, "basin_fraction": 1.0,
        "basin_interval": [0.98, 1.0], "from_rest": True, "outcome": "",
    }  # fmt: skip
    assert _attractor_cells(row)[0].children == "modulated; from rest"
