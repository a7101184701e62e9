"""What the fields say, what the figures draw, and what the competitor does: without a browser."""

import json
import time

import numpy as np
import pytest

import frahm
from frahm import readable
from frahm.analysis import STEPS, Work, analyse
from frahm.analysis.largest import FIXED_LIFT
from frahm.analysis.section import Section
from frahm.design.tuned import textbook_damper
from frahm.harmonic_balance import linear_response
from frahm.loads import operating_range
from frahm.systems import build_system
from frahm.web import answers, words
from frahm.web.controls import controls_of, field_texts, reading, spans
from frahm.web.deciding import _ONLY_SHOWN
from frahm.web.drawing import MOST_POINTS, curve_lines
from frahm.web.jobs import attractors, do, exact_response, first_sink, motion
from frahm.web.live import manifold_lines, responses_at, slow_curve, stability_map
from frahm.web.looks import EXACT_KINDS, KINDS, MAP_CLASSES, SLOW_KINDS
from frahm.web.presets import PRESETS
from frahm.web.scope import DETUNING, PLACE, Axis, has_slow_flow
from frahm.web.tuned import bare_response, tuned_mass_damper_response

CASE = frahm.load_case("jacket-pipe")
TEXTS = field_texts(CASE, 0.1)


def silent(*step):
    pass


def changed(case, *names):
    """The case with a title that names what is not as it was opened."""
    return case.with_name(case.name, f"{CASE.title} (changed: {', '.join(names)})")


def test_untouched_fields_leave_the_case_as_it_is():
    found = reading(CASE, TEXTS)
    assert found.problems == {}
    assert found.case.digest == CASE.digest
    assert found.at == 0.1


@pytest.mark.parametrize(
    ("name", "text", "expected"),
    [
        ("kappa", "250.5", CASE.with_absorber(kappa=250.5)),
        ("xi2", " 0.01 ", CASE.with_absorber(xi2=0.01)),
        ("rho2", "3 %", CASE.with_absorber(rho2=0.03)),
        ("wind.speed", "9 km/h", CASE.with_wind(speed=2.5)),
        ("pipe.frequency", "0.8 Hz", CASE.with_pipe(frequency="0.8 Hz")),
        ("pipe.damping_ratio", "0.002", CASE.with_pipe(damping_ratio=0.002)),
    ],
)
def test_fields_read_numbers_and_text_with_units(name, text, expected):
    found = reading(CASE, TEXTS | {name: text})
    assert found.problems == {}
    assert found.case.digest == changed(expected, name).digest


def test_the_title_names_what_was_changed():
    one = reading(CASE, TEXTS | {"kappa": "250.5"}).case
    both = reading(one, field_texts(one, 0.0) | {"xi2": "0.01", "kappa": "260"}).case
    assert both.title == f"{CASE.title} (changed: kappa, xi2)"
    assert both.name == CASE.name
    same = reading(CASE, TEXTS | {"wind.speed": TEXTS["wind.speed"] + " m/s", "rho2": "2 %"})
    assert same.case.digest == CASE.digest
    untitled = reading(CASE.with_name("mine", ""), TEXTS | {"wind.speed": "0.7", "xi2": "0.01"}).case
    assert untitled.title == "(changed: xi2, wind.speed)"
    long = reading(CASE.with_name("mine", 200 * "a"), TEXTS | {"wind.speed": "0.7"}).case
    assert long.title.endswith("a… (changed: wind.speed)")
    assert len(long.title) == 200


def test_the_page_and_its_map_follow_a_change_of_title_only_as_far_as_they_must():
    def asked(kappa, answer):
        values = TEXTS | {"kappa": kappa}
        wanted = {"case": json.dumps(CASE.to_dict()), "values": values, "tuned": False, "plane": "kappa", "drawn": ""}
        return answer(wanted)

    assert asked(TEXTS["kappa"], answers.response)["heading"] == f"{CASE.name}: {CASE.title}"
    assert asked("260", answers.response)["heading"] == f"{CASE.name}: {CASE.title} (changed: kappa)"
    assert asked("260", answers.beside)["key"] == asked(TEXTS["kappa"], answers.beside)["key"]


@pytest.mark.parametrize(
    ("name", "text", "change"),
    [
        ("pipe.frequency", "0.8 kg", lambda: CASE.with_pipe(frequency="0.8 kg")),
        ("pipe.damping_ratio", "1.5", lambda: CASE.with_pipe(damping_ratio=1.5)),
        ("wind.speed", "-1", lambda: CASE.with_wind(speed=-1.0)),
        ("xi2", "-0.5", lambda: CASE.with_absorber(xi2=-0.5)),
    ],
)
def test_bad_entries_are_explained_in_the_words_of_the_python_interface(name, text, change):
    with pytest.raises(frahm.ParameterError) as caught:
        change()
    assert reading(CASE, TEXTS | {name: text}).problems == {name: str(caught.value)}


@pytest.mark.parametrize("text", ["", "abc", "nan", "inf", "0", "-3", "1e999", "5 m", "<b>5</b>"])
def test_no_bad_entry_gets_through(text):
    found = reading(CASE, TEXTS | {"kappa": text, DETUNING: "7"})
    assert set(found.problems) == {"kappa", DETUNING}
    assert "kappa: given" in found.problems["kappa"]
    assert ">= -0.4 and <= 0.4" in found.problems[DETUNING]


def test_titles_units_and_symbols_come_from_the_fields_of_the_case():
    control = next(control for control in controls_of(CASE) if control.name == "pipe.frequency")
    assert (control.title, control.unit, control.symbol) == ("Natural frequency of the pipe", "rad/s", "omega")
    for name, span in spans(CASE).items():
        assert span.position(float(TEXTS[name])) in range(1001), name


def test_every_point_of_the_curve_is_in_exactly_one_line():
    curve = frahm.frequency_response(PRESETS[3].case(), detuning=(-0.4, 0.4), method="slow-flow", points=300)
    lines = curve_lines(curve, SLOW_KINDS)
    drawn = np.concatenate([np.stack([line["x"], line["pipe_peak"]], axis=1) for line in lines])
    drawn = np.unique(drawn[np.isfinite(drawn[:, 0])], axis=0)
    np.testing.assert_array_equal(drawn, np.unique(np.stack([curve.detuning, curve.pipe_peak], axis=1), axis=0))
    for holds in (True, False):
        chosen = [line["x"] for key, line in zip(SLOW_KINDS, lines, strict=True) if key[2] is holds]
        assert set(curve.detuning[curve.stable == holds]) <= set(np.concatenate(chosen))


def test_no_trace_has_more_points_than_the_browser_can_draw_in_time():
    curve = frahm.frequency_response(CASE, detuning=(-0.4, 0.4), method="slow-flow", points=20000)
    lines = curve_lines(curve, EXACT_KINDS)
    assert max(line["x"].size for line in lines) <= MOST_POINTS
    ends = [float(curve.detuning.min()), float(curve.detuning.max())]
    drawn = np.concatenate([line["x"] for line in lines])
    assert [np.nanmin(drawn), np.nanmax(drawn)] == ends
    assert [KINDS[key].stable for key in EXACT_KINDS] == [key[2] for key in EXACT_KINDS]


def test_the_map_counts_the_responses_of_the_curve():
    found = stability_map(CASE, "kappa", (100.0, 1000.0))
    row, column = 40, 70
    case = CASE.with_absorber(kappa=found.parameter[row])
    responses = frahm.periodic_responses(case, detuning=found.detuning[column], harmonics=1)
    pipe, _, stable = responses_at(case, found.detuning[column])
    assert len(responses) == pipe.size
    np.testing.assert_allclose(sorted(r.pipe_peak for r in responses), np.sort(pipe), rtol=1e-6)
    words_of = {(1, 1): 0, (3, 2): 1, (3, 1): 2, (3, 0): 3, (1, 0): 4}
    assert found.classes[row, column] == words_of[(pipe.size, int(stable.sum()))]
    assert found.classes.min() >= 0
    assert found.classes.max() < len(MAP_CLASSES)


def test_folds_of_the_drawn_manifold_are_its_turning_points():
    lines = manifold_lines(CASE, 0.0)
    whole = np.where(np.isnan(lines.attracting), lines.repelling, lines.attracting)
    slopes = np.sign(np.diff(whole))
    turns = lines.relative[1:-1][slopes[1:] != slopes[:-1]]
    np.testing.assert_array_equal(turns, lines.folds.relative)
    assert manifold_lines(CASE.with_absorber(xi2=0.1), 0.0).folds is None


def test_the_tuned_mass_damper_is_solved_like_by_harmonic_balance():
    found = tuned_mass_damper_response(CASE)
    ratio, zeta = 0.980391, 0.085829  # equal peaks at mu = 0.02
    omega, mass = ratio * CASE.pipe.frequency, CASE.absorbers[0].mass
    pipe = CASE.pipe
    system = frahm.System(
        mass=np.diag([pipe.mass, mass]),
        damping=np.diag([2 * pipe.damping_ratio * pipe.mass * pipe.frequency, 0.0]),
        stiffness=np.diag([pipe.mass * pipe.frequency**2, 0.0]),
        forcing=frahm.build_system(CASE).forcing,
        elements=[frahm.Element(direction=[-1.0, 1.0], law=frahm.Linear(mass * omega**2, 2 * zeta * mass * omega))],
        reference_frequency=pipe.frequency,
    )
    (response,) = frahm.periodic_responses(system, detuning=float(found.detuning[150]))
    assert found.pipe[150] == pytest.approx(response.pipe_peak, rel=1e-4)  # six digits of the tuning
    assert found.relative[150] == pytest.approx(response.relative_peak, rel=1e-4)
    bare = bare_response(CASE)
    assert bare.pipe.max() == pytest.approx(0.0867, rel=1e-3)
    assert np.isnan(bare_response(CASE.with_pipe(damping_ratio=0)).pipe).sum() == 1


def law(**fields):
    """The case with another force law."""
    return CASE.model_validate({**CASE.to_dict(), "absorbers": [{"mass": 4.94, "law": {"damping": 1.0, **fields}}]})


ELASTIC = frahm.load_case("jacket-pipe-elastic")
OTHERS = {
    "elastic": ELASTIC,
    "linear": law(kind="linear", stiffness=110.0),
    "polynomial": law(kind="polynomial", coefficients=[50.0, 0.0, 90000.0]),
    "bistable": law(kind="bistable", stiffness=90000.0, negative_stiffness=5.0),
    "two": frahm.load_case("two-sinks"),
    "springs": law(kind="transverse-springs", stiffness=5000.0, length=0.3, pretension=20.0),
}


BRACE = {
    "name": "brace",
    "pipe": {
        "kind": "tube", "diameter": "24 inch", "wall": "0.5 inch", "length": "28 m", "damping_ratio": 0.0015,
        "mode_count": 3,
        "supports": [{"at": 0, "kind": "clamped"}, {"at": "28 m", "kind": "pinned"}],
    },
    "wind": {"speed": 12.0, "range": [0.0, 14.0], "strouhal": "en1991", "lift_coefficient": "en1991"},
    "absorbers": [], "limits": {"amplitude_ratio": 0.05, "stroke": 0.05},
}  # fmt: skip
BARE = frahm.load_case(BRACE)
TUNED = textbook_damper(BARE)


def drawn(case, at=None, **values):
    texts = field_texts(case, Axis(case).start if at is None else at) | values
    wanted = {"case": json.dumps(case.to_dict()), "values": texts, "tuned": True, "plane": "kappa", "drawn": ""}
    return answers.response(wanted)


@pytest.mark.parametrize("case", [BARE, CASE.without_absorbers()], ids=["wind", "fixed lift"])
def test_a_pipe_without_absorber_is_drawn_and_offered_a_sink(case):
    answer = drawn(case)
    assert answer["problems"] == {}
    assert not answer["absorber"]
    assert "no absorber" in answer["status"]
    assert {line["look"] for line in answer["part"]["lines"]} == {"bare", "tuned"}
    offered = frahm.load_case(first_sink(case, silent)["case"])
    values = offered.absorbers[0].normalised(case.pipe.mass)
    assert values["rho2"] == pytest.approx(0.02, rel=1e-9)
    curve, within = frahm.frequency_response(offered), operating_range(offered)
    bare = bare_response(offered)
    assert within.over_wind == (case is BARE)
    assert curve.largest(stable_only=True)[0] < 0.25 * np.max(bare.pipe)


def test_over_the_wind_every_line_has_the_lift_of_each_wind():
    within = operating_range(TUNED)
    for response, case in (
        (bare_response(TUNED), TUNED.without_absorbers()),
        (tuned_mass_damper_response(TUNED), TUNED),
    ):
        at = int(np.argmax(response.pipe))
        U = float(response.x[at])
        there = case.with_wind(speed=U)
        (exact,) = frahm.periodic_responses(there, frequency=float(response.frequency[at]))
        assert within.wind[0] <= U <= within.wind[1]
        assert response.pipe[at] == pytest.approx(exact.pipe_peak, rel=1e-8)
    curve = frahm.frequency_response(TUNED)
    part = exact_response(TUNED, silent)["part"]
    lines = [line for line in part["lines"] if line["row"] == 0]
    assert {x for line in lines for x in line["x"] if x is not None} <= set(curve.wind_speed)
    assert {y for line in lines for y in line["y"] if y is not None} <= set(curve.pipe_peak)
    hz = [z for line in lines for x, z in zip(line["x"], line["hz"], strict=True) if x is not None]
    assert set(hz) <= set(curve.frequency / (2 * np.pi))
    answer = drawn(TUNED)
    assert (answer["axis"], answer["window"]) == (PLACE, within.wind)
    assert answer["wind"] == 12.0
    assert not answer["slow"]
    assert "knows one lift" in answer["status"]


def test_the_motion_over_the_wind_has_the_lift_of_the_wind_looked_at():
    there = TUNED.with_wind(speed=10.5)
    (response,) = frahm.periodic_responses(there, detuning=Axis(there).driven(10.5)[1])
    found = motion(TUNED, silent, at=10.5, near=(response.pipe_peak, None))
    assert found["pipe_peak"] == pytest.approx(response.pipe_peak, rel=1e-5)
    assert words.motion_status(TUNED, found).startswith("In a wind of 10.5 m/s, ")


def test_the_place_looked_at_is_a_wind_of_the_range():
    lo, hi = operating_range(BARE).wind
    assert reading(BARE, field_texts(BARE, 11.0)).at == 11.0
    assert set(reading(BARE, field_texts(BARE, 30.0)).problems) == {PLACE}
    low, high = Axis(BARE).shown
    assert lo <= low < high <= hi
    assert reading(BARE, field_texts(BARE, high) | {PLACE: f"{high:.4g}"}).problems == {}


def test_sliders_reach_in_proportion_to_the_pipe():
    """A pipe ten times as stiff in a wind ten times as fast has sliders of the same shares."""
    slow = CASE
    sink = slow.absorbers[0].normalised(slow.pipe.mass)
    fast = slow.with_pipe(frequency=10 * slow.pipe.frequency).with_wind(speed=10 * slow.wind.speed)
    fast = fast.with_absorber(kappa=100 * sink["kappa"], xi2=10 * sink["xi2"])
    for control in controls_of(slow):
        one, other = spans(slow)[control.name], spans(fast)[control.name]
        assert one.position(control.value(slow)) == other.position(control.value(fast)), control.name
        assert other.high / one.high == pytest.approx(control.value(fast) / control.value(slow)), control.name


@pytest.mark.parametrize("case", [BARE, TUNED, ELASTIC.without_absorbers()], ids=["bare", "tuned", "fixed lift"])
def test_the_decision_is_that_of_frahm_run(case):
    results = analyse(case).results
    bare = do("decision", case.to_dict(), {"device": "bare"}, silent)
    assert bare["worst"]["pipe_peak"] == pytest.approx(results["without_absorber"]["worst"]["pipe_peak"], rel=1e-9)
    this = do("decision", case.to_dict(), {"device": "this"}, silent)
    for name in ("pipe_peak", "wind_speed", "detuning"):
        assert this["worst"][name] == pytest.approx(results["worst_case"][name], rel=1e-9, nan_ok=True), name
    assert this["acceptance"]["utilisation"] == pytest.approx(results["acceptance"]["utilisation"], rel=1e-9)
    assert this["acceptance"]["verdict"] == results["acceptance"]["verdict"]
    assert this["lock_in"] == results["lock_in"]
    row = words.decision_row(case, "this", this)
    assert row["peak"] == readable.length(results["worst_case"]["pipe_peak"])
    if "amplitude_ratio" in this["acceptance"]["utilisation"]:
        assert row["verdict"] == results["acceptance"]["verdict"].upper()
    damped = do("decision", case.to_dict(), {"device": "tuned"}, silent)
    assert damped["worst"]["pipe_peak"] == pytest.approx(
        analyse(textbook_damper(case)).results["worst_case"]["pipe_peak"], rel=1e-9
    )


def test_the_verdict_counts_the_checks_of_quick_steps():
    # the winds that shed in the window move this pipe more than the one lift does: only a check of another step says so
    case = CASE.without_absorbers().with_wind(speed=2.4)
    case = frahm.load_case(case.to_dict() | {"limits": {"displacement": 1.0}})
    done = analyse(case)
    assert [check.name for check in done.checks if check.status != "pass"] == [FIXED_LIFT]
    this = do("decision", case.to_dict(), {"device": "this"}, silent)
    assert this["acceptance"]["verdict"] == done.results["acceptance"]["verdict"] == "not verified"
    assert words.decision_row(case, "this", this)["verdict"] == "NOT VERIFIED"


def test_the_verdict_leaves_no_step_out_that_has_checks_or_doubts():
    done = analyse(CASE.without_absorbers())
    named = {step.run.__name__ for step in STEPS}
    assert set(_ONLY_SHOWN) < named
    work = Work(done.case, Section(results=done.results, data=done.data))
    for step in STEPS:
        if step.run.__name__ in _ONLY_SHOWN:
            section = step.run(work)
            assert (section.checks, section.unverified) == ((), ())


def test_a_pipe_without_damping_has_no_bounded_worst():
    found = do("decision", CASE.with_pipe(damping_ratio=0).to_dict(), {"device": "bare"}, silent)
    row = words.decision_row(CASE, "bare", found)
    assert row["verdict"] == "NOT VERIFIED"
    assert "no bounded response" in row["sentence"]


def test_the_slow_flow_is_known_without_building_it():
    assert has_slow_flow(CASE)
    stopped = CASE.model_validate(
        {**CASE.to_dict(), "absorbers": [CASE.to_dict()["absorbers"][0] | {"stops": {"gap": 0.1, "stiffness": 1e4}}]}
    )
    for case in (*OTHERS.values(), stopped):
        assert not has_slow_flow(case)
        if case is not ELASTIC:
            with pytest.raises(frahm.ParameterError, match="one mode"):
                frahm.slow_flow_map(case)


@pytest.mark.parametrize("name", OTHERS)
def test_every_control_shows_and_changes_what_it_is_named_after(name):
    case = OTHERS[name]
    texts = field_texts(case, 0.0)
    assert reading(case, texts).case.digest == case.digest
    for control in controls_of(case):
        value = control.value(case)
        assert spans(case)[control.name].position(value) in range(1001)
        other = 0.97 * value
        found = reading(case, texts | {control.name: repr(other)})
        assert found.problems == {}, control.name
        assert control.value(found.case) == pytest.approx(other, rel=1e-12)
        for same in controls_of(case):
            if same.name != control.name and control.name != "pipe.wall":
                assert same.value(found.case) == pytest.approx(same.value(case), rel=1e-12), same.name


def test_controls_are_those_that_the_case_has():
    names = {name: [control.name for control in controls_of(case)] for name, case in OTHERS.items()}
    assert names["elastic"] == ["kappa", "xi2", "rho2", "position", "wind.speed", "pipe.wall", "pipe.damping_ratio"]
    assert names["linear"][:3] == ["law.stiffness", "xi2", "rho2"]
    assert names["polynomial"][:3] == ["law.c1", "law.c3", "xi2"]
    assert names["bistable"][:2] == ["law.stiffness", "law.negative_stiffness"]
    assert names["springs"][:3] == ["law.stiffness", "law.length", "law.pretension"]


def test_bad_values_of_a_law_are_explained():
    found = reading(OTHERS["linear"], field_texts(OTHERS["linear"], 0.0) | {"law.stiffness": "-3"})
    assert "law.stiffness" in found.problems
    assert "> 0" in found.problems["law.stiffness"]
    found = reading(ELASTIC, field_texts(ELASTIC, 0.0) | {"position": "0"})  # clamped there: it would not move
    assert "a section that moves" in found.problems["position"]


def test_an_elastic_pipe_without_absorber_responds_as_the_linear_equations_say():
    found = bare_response(ELASTIC)
    curve = frahm.frequency_response(ELASTIC.without_absorbers(), detuning=ELASTIC.analysis.detuning)
    expected = np.interp(found.detuning[::45], curve.detuning, curve.pipe_peak)
    np.testing.assert_allclose(found.pipe[::45], expected, rtol=2e-3)  # between the points of the curve
    damper = tuned_mass_damper_response(ELASTIC)
    peaks = np.sort(damper.pipe[1:-1][(damper.pipe[1:-1] > damper.pipe[:-2]) & (damper.pipe[1:-1] > damper.pipe[2:])])
    assert len(peaks) == 2  # tuned for equal peaks of an undamped pipe of one mode
    assert peaks[0] == pytest.approx(peaks[1], rel=0.03)
    assert np.nanmax(found.pipe) > 15 * peaks[1]


def test_the_exact_job_draws_what_python_computes():
    found = exact_response(CASE, silent)
    curve = frahm.frequency_response(CASE, detuning=(-0.4, 0.4))
    assert found["largest"] == curve.largest()[0]
    assert found["part"]["points"][0]["x"] == [point.detuning for point in curve.special_points]
    drawn = [line["y"] for line in found["part"]["lines"] if line["row"] == 0]
    assert {value for values in drawn for value in values if value is not None} <= set(curve.pipe_peak)
    assert words.exact_status(CASE, found).startswith("Exact response: 1 branch;")


def test_a_motion_starts_where_the_curve_was_clicked():
    upper = max(frahm.periodic_responses(PRESETS[2].case(), detuning=-0.144), key=lambda r: r.pipe_peak)
    found = motion(PRESETS[2].case(), silent, at=-0.144, near=(upper.pipe_peak * 1.01, None))
    assert found["kind"] == "periodic"
    assert found["pipe_peak"] == pytest.approx(upper.pipe_peak, rel=1e-4)
    rest = motion(PRESETS[2].case(), silent, at=-0.144)
    assert rest["pipe_peak"] == pytest.approx(0.0045, rel=0.05)  # printed for this state
    assert rest["history"].startswith("time [s]\tpipe [m]\tz [m]")
    assert max(len(trace["x"]) if isinstance(trace["x"], list) else 0 for trace in rest["figure"]["data"]) <= 1000


def test_what_is_computed_on_demand_names_the_values_it_belongs_to():
    case = CASE.with_absorber(kappa=250.5).with_pipe(frequency=4.95).with_wind(speed=2.6)
    found = motion(case, silent, at=-0.144)
    said = words.motion_status(case, found)
    values = (
        "At σ = -0.144 rad/s, κ = 250.5, ξ₂ = 0.0117, ρ₂ = 0.02, ω = 4.95 rad/s, ζ = 0.0015, wind 2.6 m/s, "
        f"from rest: {found['kind']};"
    )
    assert said.startswith(values)
    table = words.attractor_table(case, {"at": -0.144, "samples": 5, "seed": 1, "attractors": []})
    assert table.children[0].children == f"{values.split(', from rest')[0]}; 5 starts, seed 1:"
    others = {"elastic": ("s = 31.2 m", "t = 0.0134 m"), "linear": ("k = 110 N/m",), "polynomial": ("c₃ = 90000 N/m³",)}
    for name, parts in others.items():
        assert all(part in words.motion_status(OTHERS[name], found) for part in parts), name


def test_attractors_are_those_of_the_python_interface():
    case = CASE.with_analysis(samples=40)
    found = attractors(case, silent, at=-0.02)
    expected = frahm.find_attractors(case, detuning=-0.02, samples=40, seed=1)
    assert [row["pipe_peak"] for row in found["attractors"]] == [one.pipe_peak for one in expected]
    assert f"{len(expected)} attractor" in words.attractors_status(found)


def test_presets_draw_the_curves_of_the_paper():
    """Printed ranges of Figs. 5-11 against special points of the slow flow (bounds read off curves: 0.005 rad/s)."""
    curves = {preset.figure: slow_curve(preset.case()) for preset in PRESETS}

    def points(figure, kind):
        return [p.detuning for p in curves[figure].special_points if p.kind == kind]

    assert points(6, "saddle-node") == []
    assert points(6, "hopf") == []
    assert curves[6].largest()[0] == pytest.approx(0.0493, rel=0.02)
    assert points(7, "saddle-node")[:2] == pytest.approx([-0.164, -0.1], abs=0.005)
    assert points(7, "hopf")[0] == pytest.approx(-0.012, abs=0.005)
    assert points(10, "saddle-node")[:2] == pytest.approx([-0.34, -0.088], abs=0.015)
    assert min(points(11, "saddle-node")) > 0
    assert points(11, "hopf")[0] == pytest.approx(-0.016, abs=0.005)
    assert len(points(5, "hopf")) == 2


def test_a_sink_with_next_to_no_damping_moves_with_the_slider():
    for xi2 in (1e-6, 1e-9):
        case = CASE.with_absorber(xi2=xi2)
        slow_curve(case)  # compiled
        began = time.perf_counter()
        curve = slow_curve(case)
        assert time.perf_counter() - began < 0.3
        assert curve.unverified == ()


def test_the_tuned_damper_of_the_page_is_that_of_the_report():
    """One damper, of the mass of all absorbers of a case, in the page as in `frahm run`."""
    several = BRACE | {"absorbers": [
        {"name": "a", "mass": "10 kg", "law": {"kind": "cubic", "stiffness": 1e6, "damping": 3.0}},
        {"name": "b", "mass": "6 kg", "law": {"kind": "cubic", "stiffness": 2e6, "damping": 3.0}},
    ]}  # fmt: skip
    case = frahm.load_case(several)
    damper = textbook_damper(case)
    assert damper.absorbers[0].mass == pytest.approx(16.0)
    drawn_curve = tuned_mass_damper_response(case)
    direct = build_system(damper)
    at = int(np.argmax(drawn_curve.pipe))
    W = float(drawn_curve.frequency[at])
    (X,) = linear_response(direct, np.array([W]))
    factor = operating_range(case).lift_factor(W)
    assert drawn_curve.pipe[at] == pytest.approx(factor * abs(direct.output @ X), rel=1e-6)
