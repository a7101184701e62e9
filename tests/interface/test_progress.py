"""How long it will take: judged by what is done, said once beforehand, shown on a terminal and never in a pipe."""

import io
import math

import pytest
from rich.console import Console
from rich.progress import Progress as Bar
from rich.progress import TextColumn

import frahm
from frahm.analysis import STEPS, step_weights
from frahm.cli.progress import Pace, Progress, shown_progress
from frahm.design import step_weights as design_weights

CASE = frahm.load_case("jacket-pipe")


class Clock:
    def __init__(self):
        self.now = 100.0

    def __call__(self):
        return self.now


@pytest.fixture
def clock():
    return Clock()


def test_nothing_is_known_before_something_is_done(clock):
    pace = Pace(clock)
    assert math.isnan(pace.left(0, 10))
    clock.now += 50
    assert math.isnan(pace.left(0, 10))


def test_steps_that_are_alike_take_as_long_as_the_first(clock):
    pace = Pace(clock)
    pace.left(0, 10)
    clock.now += 4
    assert pace.left(1, 10) == pytest.approx(36)
    clock.now += 4
    assert pace.left(2, 10) == pytest.approx(32)


def test_steps_that_are_not_alike_are_weighed(clock):
    pace = Pace(clock)
    pace.weigh([1, 0.0, 9])
    pace.left(0, 3)
    clock.now += 4
    assert pace.left(1, 3) == pytest.approx(36)
    assert pace.left(2, 3) == pytest.approx(36)


def test_what_was_done_before_work_went_on_does_not_count(clock):
    pace = Pace(clock)
    pace.left(0, 1)
    clock.now += 100  # loading
    pace.weigh(())
    pace.left(800, 1000)
    clock.now += 10
    assert pace.left(900, 1000) == pytest.approx(10)


def _shown(clock):
    out = io.StringIO()
    bar = Bar(TextColumn("{task.fields[left]}"), console=Console(file=out, force_terminal=True, width=120))
    return Progress(bar, Pace(clock)), bar, out


def test_the_length_is_said_once_beforehand_and_shown_all_along(clock):
    progress, bar, out = _shown(clock)
    progress("points", 0, 100)
    clock.now += 6
    for done in (2, 3, 4):
        progress("points", done, 100)
    assert out.getvalue().count("About 5 min to go, by the first 2 of 100 steps on this machine.") == 1
    assert out.getvalue().count("to go") == 1
    assert bar.tasks[0].fields["left"] == "about 2 min left"
    progress("points", 100, 100)
    assert bar.tasks[0].fields["left"] == ""


def test_short_work_has_no_word_on_its_length(clock):
    progress, _, out = _shown(clock)
    progress("points", 0, 10)
    clock.now += 1.5
    progress("points", 1, 10)
    assert "to go" not in out.getvalue()


def test_a_pipe_hears_nothing(capsys):
    with shown_progress() as progress:
        progress.weigh([1.0])
        progress("points", 1, 10)
    assert capsys.readouterr() == ("", "")


def test_every_step_has_a_weight_and_what_a_case_lacks_next_to_none():
    alone, whole = step_weights(CASE.without_absorbers()), step_weights(CASE)
    assert len(alone) == len(whole) == len(STEPS)
    assert sum(alone) < 0.3 * sum(whole)
    gusty = CASE.with_wind(record=[[0, 2.6], [30, 2.7]])
    assert sum(step_weights(gusty)) > sum(whole)


@pytest.mark.parametrize(
    ("case", "asked", "steps"),
    [(CASE, {}, 13), (CASE.without_absorbers(), {}, 11), (CASE, {"family": "tuned"}, 12), (CASE, {"errors": ()}, 8)],
)
def test_a_design_has_a_weight_for_every_step_it_tells(case, asked, steps):
    assert len(design_weights(case, **asked)) == steps


def test_scatter_and_a_mixed_spring_make_a_design_longer():
    plain = sum(design_weights(CASE))
    assert sum(design_weights(CASE, family="mixed")) > plain
    assert sum(design_weights(CASE, scatter=0.03)) > 1.2 * plain
