"""A slice of the standing attack (`make attack`): attractors and a verified worst against an independent integrator."""

import pytest

pytest.importorskip("heyoka")

from attractors_attacked import attack
from random_systems import FAMILIES, drawn


@pytest.mark.parametrize("number", range(14, 14 + len(FAMILIES)))
def test_every_attractor_of_a_random_system_is_found(number):
    said = attack(drawn(number), others=200)
    assert not [group for group in said["missed"] if group["called"] == "nothing"]
    assert all(row["kind"] == row["kind_brute"] for row in said["attractors"] if row["brute"] > 0)
    assert all(row["agrees"] for row in said["attractors"])
