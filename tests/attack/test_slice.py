"""A slice of the standing attack (`make attack`): attractors and verified worsts against an independent integrator."""

import dataclasses
import math

import numpy as np
import pytest

pytest.importorskip("heyoka")

import frahm
from attractors_attacked import Known, attack, label, missed
from brute_force import ends, random_states
from frahm.attractors.orbits import orbit_at, refined
from frahm.attractors.regions import sample_region
from frahm.attractors.settling import Settling
from frahm.attractors.stroboscope import stroboscope
from frahm.loads import frequency_range
from oracle import Oracle
from random_systems import drawn
from run import GENTLE
from worst_attacked import Promise, attack_random, challenge

FOLDED = drawn(17)  # two periodic motions, of about half the states each


@pytest.mark.parametrize("number", [14, 8, 16, 17, 18, 12, 20, 120])
def test_every_attractor_of_a_random_system_is_found(number):
    said = attack(drawn(number), others=96, rare=False)
    assert not [group for group in said["missed"] if group["called"] == "nothing"]
    assert all(row["kind"] == row["kind_brute"] for row in said["attractors"] if row["brute"] > 0)
    assert all(row["agrees"] for row in said["attractors"])


def test_a_share_is_that_of_a_finer_integrator():
    """A system whose basins are interlaced: with steps of relative error 1e-7, 8 % of the sample changed sides."""
    said = attack(drawn(77), others=8, rare=False)
    assert len(said["attractors"]) == 2
    assert said["shifted"] <= 0.03


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
        Promise("low", 0.9 * least, math.inf, 0.05), FOLDED.system, frequency_range(W, 1.0001 * W), found.region, 3
    )
    assert said["larger"] == 3
    assert all(row["breaks"] for row in said["found"])


def test_a_motion_on_an_orbit_is_settled_though_one_of_its_balls_is_tiny():
    """An orbit of four periods, seen after multiples of four where its ball is below the error of the integrator."""
    one = drawn(2)
    strobe = stroboscope(one.system, one.frequency)
    near = (0.255845246622624, 0.20638513783149398, 0.2222208871717066)
    near = np.array([*near, 0.28814247143709726, 0.24314875298975006, 0.24507059112580137])
    orbit = orbit_at(strobe, refined(strobe, near, 4)[0], 4)
    assert orbit.multiple == 4
    tiny = dataclasses.replace(orbit.balls[0], radius=1e-6 * orbit.balls[0].radius)
    orbit = dataclasses.replace(orbit, balls=(tiny, *orbit.balls[1:]))
    beside = near * (1 + 1e-2 * np.random.default_rng(0).uniform(-1, 1, (12, 1)))
    settled = Settling(strobe, 3000, [orbit]).settle(beside)
    assert np.all(settled.labels == 0)
    assert np.all(settled.periods < 1000)


def test_what_is_in_a_ball_settles_though_another_orbit_passes_through_large_ones():
    """Two orbits of 23 periods nearly alike: a shell around a state of one may shrink onto both."""
    one = drawn(149)
    strobe = stroboscope(one.system, one.frequency)
    near = (-0.00278, 0.06579, -0.00553, -0.05286, -0.01148, 0.14016, -0.00936, 0.15628)
    orbit = orbit_at(strobe, refined(strobe, strobe.run(np.array([near]), 2300).states[0], 23)[0], 23)
    steps = np.random.default_rng(0).standard_normal((16, len(near)))
    steps /= np.linalg.norm(steps, axis=1, keepdims=True)
    for ball in orbit.balls:
        states = ball.centre + ball.radius * steps @ np.linalg.inv(ball.root).T
        assert np.all(ball.distance(strobe.run(states, 23 * 40).states) < 0.1)


def test_motions_that_have_not_arrived_at_a_torus_do_not_leave_it():
    """One of ten motions passes near the boundary of an orbit's basin: four of sixteen started on it end there."""
    one = drawn(58)
    strobe = stroboscope(one.system, one.frequency)
    near = np.array([
        -0.03012988128782353, 0.02094099438022754, -0.11099500115743657, 0.1192040319404814,
        -0.07221044711379802, 0.04623747756091579, -0.07304548409089513, 0.03764163827392848,
    ])  # fmt: skip
    orbit = orbit_at(strobe, refined(strobe, near, 41)[0], 41)
    bounds = {"x1": 1.1896234337731646, "v1": 0.8424753340066261, "z": 0.12480100454707986, "w": 0.08838239480259921}
    region = {name: (-bound, bound) for name, bound in bounds.items()}
    settling = Settling(strobe, 3000, [orbit])
    settling.settle(sample_region(one.system, region, 200, 1)[140:150])
    _, *tori = settling.known
    assert tori
    members = Oracle(one.system).watch(tori[-1].members[:, -1], one.frequency, 8000, 1).states
    assert all(orbit.distance(one)[0] > 2 for one in strobe.run(members, 41, strobes=41).strobes)
    assert all(torus.left == 0 for torus in tori)
