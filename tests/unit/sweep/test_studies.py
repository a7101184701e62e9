"""What a study says: axes, points, seeds, cases; and the same study whichever way it comes in."""

import json

import numpy as np
import pytest

import frahm
from frahm.sweep import load_study, study_schema, study_template
from frahm.sweep.batch import batch_size
from frahm.sweep.store import chunk_shape

CASE = frahm.load_case("jacket-pipe")


def study(axes, quantities=None, **more):
    return load_study({"case": "jacket-pipe", "axes": axes, "quantities": quantities or {"slow_flow": {}}, **more})


def test_spans_and_lists_with_units():
    axes = study({
        "kappa": {"from": 10, "to": 1000, "count": 3, "spacing": "log"},
        "pipe_frequency": ["0.78 Hz", 5],
        "detuning": {"from": -0.3, "to": 0.3, "count": 7},
        "wind_speed": ["9.72 km/h"],
    }).axes_given  # fmt: skip
    assert axes["kappa"] == (10.0, 100.0, 1000.0)
    assert axes["pipe_frequency"] == (pytest.approx(4.900884539), 5.0)
    assert axes["detuning"] == (-0.3, -0.2, -0.1, 0.0, 0.1, 0.2, 0.3)  # nothing like 0.30000000000000004
    assert axes["wind_speed"] == (pytest.approx(2.7),)
    assert list(axes) == ["pipe_frequency", "wind_speed", "kappa", "detuning"]  # whatever the order in the file


def test_points_run_through_the_last_axis_first():
    given = study({"xi2": [1.0, 2.0], "kappa": [10.0, 20.0, 30.0]})
    assert (given.shape, given.size) == ((3, 2), 6)
    assert [tuple(given.values_at(i).values()) for i in range(3)] == [(10.0, 1.0), (10.0, 2.0), (20.0, 1.0)]


def test_a_point_is_a_case():
    axes = {"pipe_frequency": [5.0], "pipe_damping": [0.003], "wind_speed": [3.0], "lift_coefficient": [0.5],
            "rho2": [0.03], "kappa": [100.0], "xi2": [0.02]}  # fmt: skip
    expected = CASE.with_pipe(frequency=5.0, damping_ratio=0.003).with_wind(speed=3.0, lift_coefficient=0.5)
    assert study(axes).case_at(0) == expected.with_absorber(kappa=100.0, xi2=0.02, rho2=0.03)


def test_the_absorber_that_varies_is_the_one_named():
    given = load_study({"case": "two-sinks", "absorber": frahm.load_case("two-sinks").absorbers[1].name,
                        "axes": {"xi2": [0.5]}, "quantities": {"response": {}}})  # fmt: skip
    case = given.case_at(0)
    assert case.absorbers[0] == given.case.absorbers[0]
    assert case.absorbers[1].law.damping == pytest.approx(0.5 * case.pipe.mass)


def test_a_study_is_rebuilt_from_its_own_text():
    given = study({"kappa": {"from": 7, "to": 11, "count": 5, "spacing": "log"}, "detuning": [0.1]},
                  {"attractors": {"samples": 7}, "response": None}, seed=5)  # fmt: skip
    again = load_study(json.loads(given.text))
    assert again == given
    assert again.text == given.text
    assert again.digest == given.digest


def test_a_name_does_not_make_another_study_but_all_else_does():
    base = {"axes": {"kappa": [10.0]}, "quantities": {"slow_flow": {}}}
    given = study(**base)
    assert study(**base, name="other", title="Title").digest == given.digest
    others = [study({"kappa": [10.5]}), study(base["axes"], {"slow_flow": {"detuning": 0.0}}), study(**base, seed=2),
              load_study({**base, "case": CASE.with_analysis(detuning=(-0.1, 0.1))})]  # fmt: skip
    assert len({given.digest, *(other.digest for other in others)}) == 5


def test_the_case_may_stand_in_a_file_beside_the_study(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path.parent)
    CASE.with_name("mine").to_yaml(tmp_path / "pipe.yaml")
    text = 'case = "pipe.yaml"\n[axes]\nkappa = [10, 20]\n[quantities.response]\ndetuning = [-0.1, "0.1 rad/s"]\n'
    (tmp_path / "study.toml").write_text(text)
    given = load_study(tmp_path / "study.toml")
    assert given.case.name == "mine"
    assert given.quantities.response.detuning == (-0.1, 0.1)


def test_seeds_differ_from_point_to_point_and_from_study_to_study():
    first, second = study({"kappa": [1, 2, 3]}), study({"kappa": [1, 2, 3]}, seed=2)
    seeds = [given.seed_at(i) for given in (first, second) for i in range(3)]
    assert len(set(seeds)) == 6
    assert seeds[1] == int(np.random.SeedSequence((1, 1)).generate_state(1)[0]) // 2
    assert all(0 <= seed < 2**31 for seed in seeds)


def test_cheap_points_go_many_to_a_task_and_dear_ones_alone():
    axes = {"kappa": {"from": 1, "to": 1000, "count": 100}, "xi2": {"from": 0.001, "to": 0.1, "count": 100}}
    sizes = [batch_size(study(axes, {name: {"detuning": place}}))
             for name, place in (("slow_flow", 0.0), ("slow_flow", "window"), ("response", "window"),
                                 ("attractors", 0.0), ("attractors", "window"))]  # fmt: skip
    assert sizes[0] >= 500
    assert min(sizes[:3]) >= 50
    assert sizes[3:] == [3, 1]


@pytest.mark.parametrize("shape", [(3,), (100_000,), (10, 100, 200), (5, 20_000), (1, 1)])
def test_chunks_hold_whole_runs_of_the_fastest_axes(shape):
    chunks = chunk_shape(shape)
    assert np.prod(chunks) <= 16_384
    cut = max((i for i, (size, length) in enumerate(zip(chunks, shape, strict=True)) if size < length), default=0)
    assert set(chunks[:cut]) <= {1}
    assert chunks[cut + 1 :] == shape[cut + 1 :]


def test_the_schema_lets_the_template_in_and_mistakes_out():
    jsonschema = pytest.importorskip("jsonschema")
    from frahm.case.yaml_text import read_yaml

    check = jsonschema.Draft202012Validator(study_schema())
    good = read_yaml(study_template("a"))[0]
    assert list(check.iter_errors(good)) == []
    for bad in ({"axes": {"kapa": [1]}}, {"axes": {"kappa": {"from": 1, "to": 2}}}, {"quantities": {"all": {}}}):
        assert list(check.iter_errors({**good, **bad}))


def test_the_template_is_a_study():
    given = load_study_text(study_template("a: #b"))
    assert (given.name, given.size) == ("a: #b", 45)


def load_study_text(text):
    from frahm.case.yaml_text import read_yaml

    return load_study(read_yaml(text)[0])
