"""An object shows itself in twelve lines at a prompt, whatever it holds."""

import pytest

import frahm

CASE = frahm.load_case("jacket-pipe")


@pytest.fixture(scope="module")
def objects():
    curve = frahm.frequency_response(CASE)
    responses = frahm.periodic_responses(CASE, detuning=0.0)
    attractors = frahm.find_attractors(CASE, detuning=-0.14, samples=16)
    return {
        "curve": curve, "branch": curve.branches[0], "slow": frahm.frequency_response(CASE, method="slow-flow"),
        "responses": responses, "response": responses[0], "attractors": attractors, "attractor": attractors[0],
        "history": frahm.integrate(CASE, detuning=0.0, periods=20), "system": frahm.build_system(CASE), "case": CASE,
        "worst": frahm.worst_case(CASE, detuning=(-0.3, -0.2), samples=8),
        "events": frahm.detached_curve_events(CASE, "force", (1.0, 1.3)),
        "modulated": frahm.modulated_branches(CASE, detuning=(-0.1, 0.1)),
    }  # fmt: skip


def test_no_object_fills_a_screen(objects):
    shown = {name: repr(one) for name, one in objects.items()}
    assert [name for name, text in shown.items() if text.count("\n") > 11 or len(text) > 1500] == []
    lines = [line for one in objects.values() for line in repr(one).split("\n") if one is not CASE]
    assert max(map(len, lines)) <= 260


def test_what_is_shown_is_what_it_holds(objects):
    curve, worst, attractors = (objects[name] for name in ("curve", "worst", "attractors"))
    assert f"array of shape ({len(curve.frequency)},), {curve.frequency.min():.4g}" in repr(curve)
    assert f"{1000 * worst.pipe_peak:.3g} mm" in repr(worst)
    assert "UNVERIFIED" in repr(worst)  # the window ends on the flank
    assert worst.unverified[0][:60] in repr(worst)
    assert repr(attractors).count("basin") == len(attractors)
    assert repr(objects["responses"]).startswith("Found: 1 of PeriodicResponse")
