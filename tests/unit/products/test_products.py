"""Kinds of absorber for several members: against the exact linear response, brute force, and the single design."""

import math
from dataclasses import replace

import numpy as np
import pytest

import frahm
from frahm.analysis import plain
from frahm.design import DesignSettings, verified_designs
from frahm.harmonic_balance import linear_response
from frahm.loads import operating_range
from frahm.plotting.products import products_figure
from frahm.products import FAIL, NOT_VERIFIED, PASS, designing
from frahm.products.checking import checked
from frahm.products.product import product_of
from frahm.products.search import ProductSearch
from frahm.products.served import served_member
from frahm.readable import YEAR
from frahm.systems import build_system
from frahm.time_integration import integrate_batch

MARGIN = 1.05


def member(name, length, limit=0.01, **changes):
    row = {
        "name": name, "diameter": 0.508, "wall thickness": 0.0127, "length": length, "ends": "fixed",
        "damping ratio": 0.003, "highest wind": 20.0, "displacement limit": limit, "modes": 1,
    }  # fmt: skip
    return row | changes


def served(*rows, mass_ratio=0.02):
    screen = frahm.screen_members(list(rows))
    return tuple(served_member(screen[row["name"]], mass_ratio, MARGIN) for row in rows)


def exact_peak(case):
    """Largest amplitude of a pipe with a linear absorber over its winds, from its equations of motion [m]."""
    within, system = operating_range(case), build_system(case)
    W = np.linspace(*within.frequency, 4001)
    lift = np.array([within.lift_factor(one) for one in W])
    return float(np.max(np.abs(linear_response(system, W) @ system.output) * lift))


def tuned(member, ratio=0.97, damping=0.09, mass=1.0):
    """A tuned mass damper (5,) by frequency ratio and damping ratio."""
    m, w = mass * member.most_mass, ratio * member.frequency
    return np.array([m, m * w * w, 0.0, 2 * damping * m * w, 0.0])


def test_the_closed_form_is_the_exact_response_of_a_tuned_device():
    (one,) = served(member("A1", 25.0))
    device = tuned(one)
    limit = one.case.limits.displacement
    assert one.utilisation(device[None])[0] == pytest.approx(exact_peak(one.with_device(device)) / limit, rel=2e-3)


def test_the_closed_form_counts_damage_as_the_fatigue_of_the_case_does():
    row = {"weibull scale": 7.5, "weibull shape": 2.0, "design life": 3.15e7, "s-n curve": "F1",
           "design fatigue factor": 3.0}  # fmt: skip
    fatigue = {name: value for name, value in member("A1", 25.0, **row).items() if name != "highest wind"}
    (one,) = served(fatigue)
    device = tuned(one)
    exact = frahm.fatigue_damage(one.with_device(device))
    assert one.utilisation(device[None])[0] == pytest.approx(
        max(3 * exact.damage_with, exact_peak(one.with_device(device)) / 0.01), rel=0.02
    )
    nothing = np.array([[1e-9, 1e-9, 0.0, 1e-12, 0.0]])
    assert one.utilisation(nothing)[0] == pytest.approx(one.screened.utilisation, rel=0.05)


def test_a_device_that_is_too_heavy_or_has_a_detached_curve_is_out_of_the_question():
    light, heavy = served(member("A1", 22.0), member("A2", 28.0))
    between = tuned(heavy)
    assert np.isinf(light.utilisation(between[None])[0])
    assert np.isfinite(heavy.utilisation(between[None])[0])
    space = heavy.space("sink", heavy.most_mass)
    devices = space.designs(np.random.default_rng(1).random((200, space.size)))
    births, used = heavy.births(devices), heavy.utilisation(devices)
    assert np.any(births < MARGIN)
    np.testing.assert_array_equal(np.isinf(used), births < MARGIN)


def test_no_device_of_a_fine_grid_serves_two_members_better():
    members = served(member("A1", 24.0), member("A2", 26.0))
    found = ProductSearch(members, "tuned").best(1)
    mass = min(one.most_mass for one in members)
    grid = np.array([tuned(replace(members[0], most_mass=mass), ratio, damping)
                     for ratio in np.linspace(0.75, 1.15, 81) for damping in np.linspace(0.02, 0.4, 39)])  # fmt: skip
    brute = np.max([one.utilisation(grid) for one in members], axis=0)
    assert found.worst <= np.min(brute) * 1.002
    exact = [exact_peak(one.with_device(found.devices[0])) / 0.01 for one in members]
    np.testing.assert_allclose(found.used, exact, rtol=2e-3)


def test_two_kinds_are_given_to_neighbours_in_frequency():
    members = served(*(member(f"A{i}", length) for i, length in enumerate((20.0, 20.6, 27.0, 28.0))))
    search = ProductSearch(members, "tuned")
    one = search.best(1)
    two = search.best(2, [one])
    assert two.worst < 0.7 * one.worst
    assert two.takes[0] == two.takes[1] != two.takes[2] == two.takes[3]


def test_equal_members_take_the_device_of_the_single_design():
    rows = [member(f"A{i}", 25.0) for i in range(3)]
    study = frahm.design_products(rows, 1, family="tuned", mass_ratio=0.02)
    case = frahm.screen_members(rows)["A0"].case
    (single,) = verified_designs(case, DesignSettings(family="tuned", mass_ratio=0.02), ("tuned",))
    assert study.best.verified
    assert study.best.worst * 0.01 == pytest.approx(single.worst_pipe_peak, rel=5e-3)
    (kind,) = study.best.kinds
    own = math.sqrt(kind.device[1] / kind.device[0])
    assert own == pytest.approx(math.sqrt(single.design.linear / single.design.rho2), rel=5e-3)


def test_the_fewest_kinds_with_which_all_pass():
    rows = [member("A1", 21.0, 0.0025), member("A2", 27.0, 0.0025)]
    study = frahm.design_products(rows, (1, 3), family="tuned")
    counts = {product.count: product for product in study.products}
    assert not counts[1].passes
    assert counts[2].passes
    assert 3 not in counts  # all pass: not asked for more kinds
    assert study.best is counts[2]
    assert [one.verdict for one in study.best.members] == [PASS, PASS]
    for one in study.best.members:
        assert one.check.motion.pipe_peak == frahm.worst_case(one.case).pipe_peak
    assert "2 kinds of tuned mass damper let the 2 members that fail alone pass" in study.sentence
    for thing in (study, study.best, study.best.kinds[0]):
        assert repr(thing).count("\n") < 12
        assert len(repr(thing)) < 1500


def test_products_that_cannot_satisfy_all_name_the_member_that_binds():
    study = frahm.design_products([member("A1", 21.0, 1e-4), member("A2", 27.0, 0.01)], 1, family="tuned")
    assert study.fails
    assert study.verified
    assert study.best.binds.name == "A1"
    assert study.best.binds.verdict == FAIL
    assert "A1 binds, fails" in study.sentence


def test_no_member_that_fails_needs_nothing():
    study = frahm.design_products([member("A1", 8.0)], (1, 3))
    assert study.best is None
    assert study.products == ()
    assert study.verified
    assert not study.fails
    assert "fails alone: nothing is designed" in study.sentence


@pytest.mark.parametrize(
    ("changes", "words"),
    [
        ({"products": 0}, "products"),
        ({"products": (3, 1)}, "the least number of kinds first"),
        ({"products": (1, 2, 3)}, "two of them"),
        ({"family": "tunned"}, "Did you mean 'tuned'"),
        ({"mass_ratio": 0.0}, "mass_ratio"),
        ({"force_margin": 0.5}, "force_margin"),
    ],
)
def test_bad_input_is_refused_before_anything_is_read(changes, words):
    with pytest.raises(frahm.ParameterError, match=words):
        frahm.design_products("no-such-table.csv", **changes)


def test_a_sink_that_fails_beside_a_better_rival_is_given_up_with_the_reason(monkeypatch):
    rows = [member("A1", 22.0, 1e-3), member("A2", 27.0, 1e-3), member("A3", 28.0, 1e-3)]
    asked = []

    def first_is_bad(case):
        asked.append(case)
        return checked(case.without_absorbers() if case.absorbers[0].law.kind == "cubic" else case)

    monkeypatch.setattr(designing, "checked", first_is_bad)
    study = frahm.design_products(rows, 1, family="sink")
    tuned, sink = study.products
    assert tuned.verified
    assert len(asked) == 3 + 1  # of the sink the member that binds
    assert [one.verdict for one in sink.members] == [FAIL, NOT_VERIFIED, NOT_VERIFIED]
    assert not sink.verified
    assert all("1 kind of tuned mass damper" in text for text in sink.unverified)
    assert study.best is sink  # of the family asked for
    assert study.fails
    known = {one.name: one for one in sink.members}
    assert known[sink.binds.name].check is not None


def test_what_winds_outside_all_bands_do_counts():
    """A strut of the example: the absorber changes nothing in winds that excite no mode, and the search knows."""
    row = {
        "name": "RS-601", "diameter": 0.2191, "wall thickness": 0.0063, "length": 11.2, "ends": "pinned",
        "damping ratio": 0.003, "weibull scale": 7.5, "weibull shape": 2.0, "design life": YEAR, "s-n curve": "F1",
        "stress concentration": 1.0, "design fatigue factor": 3.0,
    }  # fmt: skip
    (one,) = served(row)
    screened, outside = one.screened, 3 * one.screened.findings.damage["outside"]
    nothing = np.array([[1e-9, 1e-9, 0.0, 1e-12, 0.0]])
    assert outside > 0.3
    assert one.utilisation(nothing)[0] == pytest.approx(screened.utilisation + outside, rel=0.03)
    device = tuned(one, damping=0.1)
    check = checked(one.with_device(device))
    assert check.utilisation == pytest.approx(one.utilisation(device[None])[0], rel=0.01)
    assert check.utilisation > outside
    assert check.unverified == ()
    small = np.array([tuned(one, ratio=1.0, damping=0.05, mass=mass) for mass in np.geomspace(1e-4, 1, 40)])
    poor_used = one.utilisation(small)
    at = int(np.argmin(np.abs(poor_used - 1.2)))  # below the limit without those winds
    poor = checked(one.with_device(small[at]))
    assert not poor.exceeds
    assert poor.utilisation > 1
    assert any("Winds outside all bands" in doubt for doubt in poor.unverified)


def test_random_states_in_random_winds_never_exceed_what_a_sink_promises():
    (one,) = served(member("A1", 25.0, 0.003, **{"damping ratio": 0.01}), mass_ratio=0.05)
    (device,) = ProductSearch((one,), "sink").best(1).devices
    case = one.with_device(device).with_analysis(samples=8)
    promised = checked(case)
    assert promised.unverified == ()
    rng, within, count = np.random.default_rng(7), operating_range(case), 96
    W = rng.uniform(*within.frequency, count)
    lift = np.array([within.lift_factor(w) for w in W])
    sizes = np.array([[3.0, 3.0, 3.0, 3.0]]) * promised.motion.relative_peak * np.array([[1, one.frequency] * 2])
    states = rng.uniform(-1, 1, (count, 4)) * sizes
    batch = integrate_batch(
        build_system(case), frequency=W, initial_states=states, periods=600, window=60, force_scale=lift
    )
    assert np.max(batch.pipe_peak) <= promised.motion.pipe_peak * (1 + 1e-3)
    assert np.max(batch.pipe_peak) > 0.8 * promised.motion.pipe_peak  # and the attack comes near it


def test_an_interruption_keeps_the_products_that_are_known():
    rows = [member("A1", 21.0, 0.0025), member("A2", 27.0, 0.0025)]

    def stopped_at(step):
        def progress(title, done, total):
            if done == step:
                raise KeyboardInterrupt

        return frahm.design_products(rows, (1, 3), family="tuned", progress=progress)

    with pytest.raises(KeyboardInterrupt):
        stopped_at(0)
    study = stopped_at(1)
    assert study.interrupted
    assert [one.count for one in study.products] == [1]
    assert not study.verified


def test_a_member_that_no_kind_suits_is_never_verified():
    (one,) = served(member("A1", 25.0))
    device = tuned(one, mass=2.0)  # twice as heavy as it may be
    used = one.utilisation(device[None])
    product = product_of("tuned", 1, (one,), device[None], np.array([0]), used)
    assert np.isinf(used[0])
    fitted = replace(product.members[0], check=checked(one.with_device(device)))
    assert fitted.check.unverified == ()
    assert fitted.verdict == NOT_VERIFIED
    assert "light enough" in fitted.unverified[0]
    assert products_figure(plain(product.row())) is not None
