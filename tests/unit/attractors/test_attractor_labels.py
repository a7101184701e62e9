"""Which motion a state is said to end on, against following it to the end; systems that once got wrong answers."""

import numpy as np
import pytest

import frahm
from frahm.attractors.repetition import repeats
from frahm.time_integration import integrate_batch

OMEGA, FORCE = 2 * np.pi * 0.78, 0.0062469645


def pipe(force, *sinks):
    """The pipe of the paper with sinks (mass, kappa, xi2)."""
    n = 1 + len(sinks)
    elements = []
    for k, (_, kappa, xi2) in enumerate(sinks, start=1):
        direction = np.zeros(n)
        direction[[0, k]] = -1, 1
        elements.append(frahm.Element(direction, frahm.Cubic(kappa, xi2)))
    host = np.zeros((n, n))
    host[0, 0] = 1
    mass = np.diag([1.0, *(sink[0] for sink in sinks)])
    return frahm.System(mass, 0.003 * OMEGA * host, OMEGA**2 * host, FORCE * force * host[0], elements)


CHAOS_BESIDE_SIXTEEN = pipe(1.7257733, (0.0180368841, 2087.547324, 0.00464051314)), OMEGA + 0.1557552269
LEAK = pipe(1.038, (0.0485, 624.69, 0.00255)), OMEGA + 0.0149


def followed(system, frequency, states, periods):
    """States after the periods, and the period, 0 for none up to 64, that each motion repeats with by then."""
    batch = integrate_batch(system, frequency=frequency, initial_states=states, periods=periods, strobes=200)
    strobes = batch.strobes
    size = np.max(np.abs(strobes), axis=(0, 1))
    moved = [np.max(np.abs(strobes[:, m:] - strobes[:, :-m]) / size, axis=(1, 2)) < 1e-5 for m in range(1, 65)]
    return batch.final_states, np.where(np.any(moved, axis=0), 1 + np.argmax(moved, axis=0), 0)


def sample(system, found, count, seed):
    """States of the region sampled, drawn anew; the output is coordinate 0 and the first element's is coordinate 1."""
    region = [found.region[name] for name in ("x1", "v1", "z", "w")]
    x1, v1, z, w = np.random.default_rng(seed).uniform(*np.transpose(region), (count, 4)).T
    return np.column_stack([x1, v1, x1 + z, v1 + w])


def within(share, hits, count):
    """Whether a share and `hits` of another sample of `count` differ by no more than 3.3 standard errors."""
    p = (share * count + hits) / (2 * count)
    return abs(share - hits / count) <= 3.3 * np.sqrt(2 * max(p * (1 - p), 1 / count) / count)


def test_motions_that_pass_a_chaotic_cloud_and_go_on_to_an_orbit_are_on_the_orbit():
    system, frequency = CHAOS_BESIDE_SIXTEEN
    found = frahm.find_attractors(system, frequency=frequency, samples=100)
    periodic = sum(a.basin_fraction for a in found if a.period_multiple == 16)
    assert periodic + sum(a.basin_fraction for a in found if a.kind == "chaotic") == pytest.approx(1)
    _, multiples = followed(system, frequency, sample(system, found, 100, 2), 3000)
    assert np.count_nonzero(multiples == 16) > 15
    assert within(periodic, np.count_nonzero(multiples == 16), 100)


def test_orbits_whose_strobes_pass_near_each_other_are_told_apart():
    system = pipe(
        1.2109138, (0.0435332698, 755.4827848, 0.00342138370), (0.0161976354, 263.0273496, 0.00353236857)
    )  # fmt: skip
    found = frahm.find_attractors(system, frequency=OMEGA - 0.1051859525, samples=400)
    assert not any(a.kind == "unsettled" for a in found)
    shares = {round(a.pipe_peak, 6): a.basin_fraction for a in found if a.period_multiple == 3}
    assert shares[0.006132] == pytest.approx(0.16, abs=0.08)
    assert shares[0.005855] == pytest.approx(0.10, abs=0.07)
    assert {1, 2, 3, 4, 6, 9, 12} <= {a.period_multiple for a in found}


def test_a_chaotic_set_that_leaks_says_how_fast():
    system, frequency = LEAK
    found = frahm.find_attractors(system, frequency=frequency, samples=200)
    chaos, periodic = found
    assert chaos.kind == "chaotic"
    assert chaos.leaks
    assert not periodic.leaks
    states, early = followed(system, frequency, sample(system, found, 200, 3), 3000)
    assert within(periodic.basin_fraction, np.count_nonzero(early == 1), 200)
    _, late = followed(system, frequency, states[early == 0], 6000)
    rate = np.count_nonzero(late == 1) / (6000 * 2 * np.pi / frequency * np.count_nonzero(early == 0))
    assert chaos.escape_interval[0] / 1.5 < rate < 1.5 * chaos.escape_interval[1]
    assert "is left in the end" in found.statement
    assert "after 3000 periods" in found.statement


def test_a_set_that_attracts_says_nothing_of_leaving():
    found = frahm.find_attractors(frahm.load_case("jacket-pipe"), detuning=0.0, samples=32)
    assert found[0].kind == "quasi-periodic"
    assert not found[0].leaks
    assert found[0].escape_rate == 0
    assert 0 < found[0].escape_interval[1] < 1e-4
    assert "left" not in found.statement


def test_motions_without_a_label_may_belong_to_any_attractor():
    """After 200 periods of slow decay hardly any motion has settled: no interval may exclude what they will do."""
    case = frahm.load_case("jacket-pipe").with_absorber(kappa=367.38, xi2=0.0085, rho2=0.02)
    short, full = (frahm.find_attractors(case, detuning=-0.144, samples=100, periods=n) for n in (150, 3000))
    open_ended = sum(a.basin_fraction for a in short if a.kind == "unsettled")
    assert open_ended > 0.2
    truth = {round(a.pipe_peak, 5): a.basin_fraction for a in full if a.basin_fraction > 0.05}
    said = {round(a.pipe_peak, 5): a.basin_interval for a in short if a.kind == "periodic"}
    assert len(truth) == 2
    assert all(said[peak][0] <= fraction <= said[peak][1] for peak, fraction in truth.items())


def test_a_doubled_orbit_is_told_from_the_one_it_nearly_is():
    n = np.arange(200)
    doubled = (1.0 + 0.004 * (-1) ** n)[:, None]
    tripled = np.cos(2 * np.pi * n / 3)[:, None]
    drifting = np.cos(2 * np.pi * n / np.sqrt(47))[:, None]
    noise = np.random.default_rng(0).uniform(-1, 1, (200, 1))
    assert repeats(np.array([doubled, tripled, np.ones((200, 1)), noise])) == [[1, 2], [3], [1], []]
    (beat,) = repeats(drifting[None])
    assert beat == [48]
