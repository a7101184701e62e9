"""A slice of the standing attack (`make attack`): attractors and verified worsts against an independent integrator."""

import math

import numpy as np
import pytest

pytest.importorskip("heyoka")

import frahm
from attractors_attacked import Known, attack, label, missed
from brute_force import ends, random_states
from frahm.loads import frequency_range
from oracle import Oracle
from random_systems import FAMILIES, drawn
from run import GENTLE
from worst_attacked import Promise, attack_random, challenge

FOLDED = drawn(17)  # two periodic motions, of about half the states each


@pytest.mark.parametrize("number", range(14, 14 + len(FAMILIES)))
def test_every_attractor_of_a_random_system_is_found(number):
    said = attack(drawn(number), others=96, rare=False)
    assert not [group for group in said["missed"] if group["called"] == "nothing"]
    assert all(row["kind"] == row["kind_brute"] for row in said["attractors"] if row["brute"] > 0)
    assert all(row["agrees"] for row in said["attractors"])


@pytest.mark.parametrize("number", [1, 8])
def test_no_random_motion_passes_a_verified_worst(number):
    said = attack_random(drawn(number, GENTLE), samples=32, states=96)
    assert said["verified"], said["unverified"]
    assert not any(found["breaks"] for found in said["found"])


def test_an_attractor_left_out_is_missed():
    found = frahm.find_attractors(FOLDED.system, frequency=FOLDED.frequency, samples=32)
    oracle = Oracle(FOLDED.system)
    known = [Known(oracle, attractor, FOLDED.frequency) for attractor in found]
    states = random_states(FOLDED.system, found.region, 96, np.random.default_rng(0))
    motions = ends(oracle, states, FOLDED.frequency, 1000)
    assert not missed(motions, label(known, motions), 0.0)
    assert sum(group["share"] for group in missed(motions, label(known[1:], motions), 0.0)) > 0.2


def test_a_promise_too_low_is_broken():
    found = frahm.find_attractors(FOLDED.system, frequency=FOLDED.frequency, samples=32)
    least, W = min(attractor.pipe_peak for attractor in found), FOLDED.frequency
    said = challenge(
        Promise("low", 0.9 * least, math.inf, 0.05), FOLDED.system, frequency_range(W, 1.0001 * W), found.region, 16
    )
    assert said["larger"] == 16
    assert all(row["breaks"] for row in said["found"])


def test_a_motion_on_an_orbit_is_settled_though_one_of_its_balls_is_tiny():
    """An orbit of four periods, one ball of which is below the error of the integrator, where all were seen."""
    found = frahm.find_attractors(drawn(2).system, frequency=drawn(2).frequency, samples=64)
    assert sum(attractor.period_multiple == 4 for attractor in found) == 2
    assert not [attractor for attractor in found if attractor.kind == "unsettled"]
