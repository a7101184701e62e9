"""Many trajectories through a few lanes: a lane that is done, or has failed, takes the next trajectory.

Every trajectory keeps its own step and its own error control, so that its result is the same number for number whatever
runs beside it and however many threads there are.
"""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np

from frahm.compiled import kernel
from frahm.lanes import LANES, any_positive, lane_room, load, maximum, square_root, store, where_at_most
from frahm.time_integration.stepper import (
    blend,
    dense_coefficients,
    derivative,
    error_estimate,
    run_stages,
    sizes,
)
from frahm.time_integration.window import ROWS, clear_window, watch_window

DONE, DIVERGED, STEP_LIMIT, STEP_TOO_SMALL = 0, 1, 2, 3

# Rows of a block, a number for every lane each, by where they begin.
(
    _WHOLE, _PART, _STEP, _TARGET_WHOLE, _TARGET_PART,  # turns done, next step, turns to reach
    _PERIOD, _PHASE, _NEXT_WHOLE, _NEXT_PART,  # [s], [turns] at the start, turns at the next sample
    _X_SIZE, _V_SIZE, _X_LEAST, _V_LEAST, _X_BOUND, _V_BOUND,
    _ACCEPTED, _ATTEMPTED, _GROWTH, _WATCHING, _LANDED, _EVENT, _LIVE,
    _DUE, _TURNS, _ERROR, _GOOD, _X_NEW, _V_NEW,  # the step being judged
    _BLOCK,
) = range(0, 29 * LANES, LANES)  # fmt: skip

_FIRST_STEP = 0.01  # [turns]; the error control corrects it within a few steps
_SMALLEST_STEP = 1e-15  # [turns]; the phase within a period resolves 1e-16
_LARGEST_STEP = 0.9  # [turns]; the error estimate must not overlook the forcing
_DISPLACEMENT_BOUND = 1e12  # times the size a trajectory starts from
_VELOCITY_BOUND = 1e15  # a stiff law turns displacement into far more velocity
_LEAST_SIZE = 1e-6  # of what the force does within a period: the size of a trajectory at rest
_SLACK = 1e-12  # [turns] by which a sample may miss the end of a step
_SAFETY = 0.8
_MEMORY = 0.8  # the size errors are measured by forgets by this factor a step


class Runs(NamedTuple):
    """Trajectories to run, one row each; `state` is (x_0 ... x_n-1, v_0 ... v_n-1) and is replaced by the last one."""

    state: Any
    system: Any  # column of the tables
    period: Any  # of the forcing [s]
    phase: Any  # of the forcing at the start [turns]
    force_scale: Any


class Plan(NamedTuple):
    """What all of them have in common: turns to run (whole, part), the turns of the window at the end, the samples."""

    whole: float
    part: float
    window: float
    first_sample: int
    samples_per_turn: int
    tolerance: float
    max_steps: float


class Kept(NamedTuple):
    """What is kept of each trajectory."""

    outcome: Any
    steps: Any  # accepted, rejected
    turns: Any  # reached
    window: Any  # rows as in `frahm.time_integration.window`
    samples: Any  # (runs, samples, 2n)


class Room(NamedTuple):
    """Where the lanes work; as arrays, and once more as addresses for the inner loops."""

    lanes: Any
    start: Any
    y: Any
    scratch: Any
    k: Any
    dense: Any
    projected: Any
    window: Any


def make_room(size: int) -> Room:
    """Room for systems of `size` coordinates."""
    m = 2 * size
    return Room(*(lane_room(rows) for rows in (_BLOCK // LANES, m, m, m, 16 * m, 8 * m, 16, ROWS)))


@kernel
def propagate(structure, systems, numbers, numbers_at, room, room_at, runs, plan, findings):
    """Run all trajectories; `numbers` is room for a system in every lane, `systems` the tables it is filled from."""
    lanes, start, window = room.lanes, room.start, room.window
    run, sample = np.full(LANES, -1), np.zeros(LANES, dtype=np.int64)
    lanes[:] = 0.0
    lanes[_PERIOD : _PERIOD + LANES] = 1.0
    lanes[_EVENT : _EVENT + LANES] = 1.0
    waiting, busy = 0, 0
    while True:
        for lane in range(LANES):
            if lanes[_EVENT + lane] <= 0.0:
                continue
            if run[lane] >= 0:
                if lanes[_LANDED + lane] > 0.0 and _next_leg(lanes, lane, plan):
                    continue
                _finish(lanes, lane, run[lane], start, window, runs, findings)
                findings.samples[run[lane], sample[lane] :] = np.nan  # of a trajectory that failed
                busy -= 1
            run[lane] = -1
            if waiting < runs.state.shape[0]:
                run[lane], waiting, busy = waiting, waiting + 1, busy + 1
                _fill_numbers(numbers, systems, lane, runs.system[run[lane]], runs.force_scale[run[lane]])
                _fill_lane(lanes, lane, run[lane], runs, plan, findings, numbers.forcing, start)
                clear_window(window, lane)
                sample[lane] = 0
                derivative(structure, numbers_at, load(room_at.lanes, _PHASE), room_at.start, room_at.scratch)
                for i in range(lane, start.size, LANES):
                    room.k[i] = room.scratch[i]
            else:
                _idle(lanes, lane, start)
        if busy == 0:
            return
        attention = False
        while not attention:
            if _try_step(structure, numbers_at, plan.tolerance, room_at):
                _take_samples(lanes, run, sample, plan, room.dense, findings.samples)
            attention = _move_on(structure, plan.max_steps, room_at)


@kernel
def _try_step(structure, numbers, tolerance, room):
    """Make one step in every lane and judge it; whether a sample is due in one of them."""
    at, m = room.lanes, 2 * structure.size * LANES
    whole, part, step = load(at, _WHOLE), load(at, _PART), load(at, _STEP)
    phase = part + load(at, _PHASE)
    ahead = (load(at, _TARGET_WHOLE) - whole) + (load(at, _TARGET_PART) - part)
    turns = where_at_most(ahead, 1.05 * step, ahead, step)
    h = turns * load(at, _PERIOD)
    run_stages(structure, numbers, 2, 13, phase, turns, h, room.start, room.k, room.y)
    x_size, v_size = sizes(m, room.y)
    x_size, v_size = maximum(x_size, load(at, _X_SIZE)), maximum(v_size, load(at, _V_SIZE))
    x_scale, v_scale = maximum(x_size, load(at, _X_LEAST)), maximum(v_size, load(at, _V_LEAST))
    error = error_estimate(m, h, room.k, tolerance * x_scale, tolerance * v_scale)
    good = where_at_most(error, 1.0, 1.0, 0.0)
    store(at, _TURNS, turns)
    store(at, _ERROR, error)
    store(at, _GOOD, good)
    store(at, _X_NEW, x_size)
    store(at, _V_NEW, v_size)
    store(at, _LANDED, good * where_at_most(ahead, 1.05 * step, 1.0, 0.0))
    watched = good * load(at, _WATCHING)
    next_sample = (load(at, _NEXT_WHOLE) - whole) + (load(at, _NEXT_PART) - part)
    due = good * where_at_most(next_sample, turns, 1.0, 0.0)
    if not any_positive(watched + due):
        return False
    run_stages(structure, numbers, 14, 16, phase, turns, h, room.start, room.k, room.scratch)
    dense_coefficients(m, h, room.start, room.y, room.k, room.dense)
    if any_positive(watched):
        watch_window(room.window, watched, numbers.monitor, m, turns, room.dense, room.projected)
    store(at, _DUE, due)
    return any_positive(due)


@kernel
def _move_on(structure, max_steps, room):
    """Take over the new state where the step was good and choose the next step; whether a lane needs attention."""
    at, m = room.lanes, 2 * structure.size * LANES
    turns, error, good, landed = load(at, _TURNS), load(at, _ERROR), load(at, _GOOD), load(at, _LANDED)
    for i in range(0, m, LANES):
        store(room.start, i, where_at_most(1.0, good, load(room.y, i), load(room.start, i)))
        store(room.k, i, where_at_most(1.0, good, load(room.k, 12 * m + i), load(room.k, i)))
    part = load(at, _PART) + turns * good
    carry = where_at_most(1.0, part, 1.0, 0.0)
    store(at, _PART, part - carry)
    store(at, _WHOLE, load(at, _WHOLE) + carry)
    x_size, v_size = load(at, _X_NEW), load(at, _V_NEW)
    store(at, _X_SIZE, where_at_most(1.0, good, _MEMORY * x_size, load(at, _X_SIZE)))
    store(at, _V_SIZE, where_at_most(1.0, good, _MEMORY * v_size, load(at, _V_SIZE)))
    step = _next_step(at, turns, error, good, landed)
    store(at, _STEP, step)
    attempted = load(at, _ATTEMPTED) + 1.0
    store(at, _ACCEPTED, load(at, _ACCEPTED) + good)
    store(at, _ATTEMPTED, attempted)
    inside = where_at_most(x_size, load(at, _X_BOUND), where_at_most(v_size, load(at, _V_BOUND), 1.0, 0.0), 0.0)
    stuck = where_at_most(step, _SMALLEST_STEP, 1.0, 0.0) + where_at_most(max_steps, attempted, 1.0, 0.0)
    event = (landed + good * (1.0 - inside) + stuck) * load(at, _LIVE)
    store(at, _EVENT, event)
    return any_positive(event)


@kernel
def _next_step(at, turns, error, good, landed):
    """Next step [turns] from the error of this one, in units of the tolerance."""
    root = square_root(square_root(square_root(maximum(error, 1e-12))))  # error^(1/8); a NaN stays
    growth, most = where_at_most(root, 1e30, _SAFETY / root, 0.1), load(at, _GROWTH)
    growth = maximum(0.1, where_at_most(growth, most, growth, most))
    store(at, _GROWTH, where_at_most(1.0, good, 6.0, 1.0))
    step = turns * growth
    # A step cut short by the target says nothing against the step that was planned.
    step = where_at_most(1.0, landed, maximum(step, load(at, _STEP)), step)
    return where_at_most(step, _LARGEST_STEP, step, _LARGEST_STEP)


@kernel
def _take_samples(lanes, run, sample, plan, dense, samples):
    """Samples of the state that fall into the step just made, for the lanes where one is due."""
    m = samples.shape[2] * LANES
    for lane in range(LANES):
        if lanes[_DUE + lane] <= 0.0:
            continue
        turns, first = lanes[_TURNS + lane], sample[lane]
        ahead = (lanes[_NEXT_WHOLE + lane] - lanes[_WHOLE + lane]) + (lanes[_NEXT_PART + lane] - lanes[_PART + lane])
        s, spacing = ahead / turns, 1.0 / (plan.samples_per_turn * turns)
        count = int((1.0 + _SLACK / turns - s) / spacing) + 1
        count = max(0, min(count, samples.shape[1] - first))
        taken = samples[run[lane], first : first + count]
        for i in range(samples.shape[2]):
            at = i * LANES + lane
            d0, d1, d2, d3 = dense[at], dense[m + at], dense[2 * m + at], dense[3 * m + at]
            d4, d5, d6, d7 = dense[4 * m + at], dense[5 * m + at], dense[6 * m + at], dense[7 * m + at]
            for j in range(count):
                taken[j, i] = blend(min(s + j * spacing, 1.0), d0, d1, d2, d3, d4, d5, d6, d7)
        sample[lane] = first + count
        _next_sample(lanes, lane, sample[lane], plan, samples.shape[1])


@kernel
def _next_sample(lanes, lane, index, plan, count):
    grid = plan.first_sample + index
    lanes[_NEXT_WHOLE + lane] = grid // plan.samples_per_turn if index < count else np.inf
    lanes[_NEXT_PART + lane] = (grid % plan.samples_per_turn) / plan.samples_per_turn


@kernel
def _fill_numbers(numbers, systems, lane, system, force_scale):
    """Copy the tables of one system into a lane."""
    _fill_column(numbers.linear, systems.linear, lane, system)
    _fill_column(numbers.reach, systems.reach, lane, system)
    _fill_column(numbers.input, systems.input, lane, system)
    _fill_column(numbers.law, systems.law, lane, system)
    _fill_column(numbers.monitor, systems.monitor, lane, system)
    _fill_column(numbers.forcing, systems.forcing, lane, system)
    for i in range(lane, numbers.forcing.size, LANES):
        numbers.forcing[i] *= force_scale


@kernel
def _fill_column(into, source, lane, column):
    for row in range(source.shape[0]):
        into[row * LANES + lane] = source[row, column]


@kernel
def _fill_lane(lanes, lane, run, runs, plan, findings, forcing, start):
    """Start a trajectory in a lane."""
    n = runs.state.shape[1] // 2
    omega = 2.0 * np.pi / runs.period[run]
    x, v, push = 0.0, 0.0, 0.0
    for i in range(n):
        start[i * LANES + lane], start[(n + i) * LANES + lane] = runs.state[run, i], runs.state[run, n + i]
        x, v = max(x, abs(runs.state[run, i])), max(v, abs(runs.state[run, n + i]))
        push = max(push, abs(forcing[i * LANES + lane]))
    for row in range(0, _BLOCK, LANES):
        lanes[row + lane] = 0.0
    lanes[_STEP + lane], lanes[_GROWTH + lane], lanes[_LIVE + lane] = _FIRST_STEP, 6.0, 1.0
    lanes[_PERIOD + lane], lanes[_PHASE + lane] = runs.period[run], runs.phase[run]
    lanes[_X_SIZE + lane], lanes[_V_SIZE + lane] = x, v
    lanes[_X_LEAST + lane], lanes[_V_LEAST + lane] = _LEAST_SIZE * push / omega**2, _LEAST_SIZE * push / omega
    size = max(x, v / omega, push / omega**2)
    lanes[_X_BOUND + lane] = _DISPLACEMENT_BOUND * size
    lanes[_V_BOUND + lane] = _VELOCITY_BOUND * size * omega
    lanes[_TARGET_WHOLE + lane], lanes[_TARGET_PART + lane] = plan.whole - plan.window, plan.part
    if plan.window == 0.0 or plan.window >= plan.whole + plan.part:
        lanes[_TARGET_WHOLE + lane] = plan.whole
        lanes[_WATCHING + lane] = 1.0 if plan.window > 0.0 else 0.0
    _next_sample(lanes, lane, 0, plan, findings.samples.shape[1])


@kernel
def _idle(lanes, lane, start):
    """Leave a lane at rest without moving: nothing is left for it to do."""
    for row in range(0, _BLOCK, LANES):
        lanes[row + lane] = 0.0
    lanes[_PERIOD + lane] = 1.0
    lanes[_TARGET_WHOLE + lane] = lanes[_NEXT_WHOLE + lane] = np.inf
    lanes[_X_BOUND + lane] = lanes[_V_BOUND + lane] = np.inf
    for i in range(lane, start.size, LANES):
        start[i] = 0.0


@kernel
def _next_leg(lanes, lane, plan):
    """Whether a lane that has landed goes on: at the start of the window it does."""
    whole, part = lanes[_TARGET_WHOLE + lane], lanes[_TARGET_PART + lane]
    lanes[_WHOLE + lane], lanes[_PART + lane] = whole, part
    if whole == plan.whole:
        return False
    lanes[_TARGET_WHOLE + lane], lanes[_WATCHING + lane] = plan.whole, 1.0
    return True


@kernel
def _finish(lanes, lane, run, start, window, runs, findings):
    """Write down what a lane has found."""
    n = runs.state.shape[1]
    for i in range(n):
        runs.state[run, i] = start[i * LANES + lane]
    for row in range(ROWS):
        findings.window[run, row] = window[row * LANES + lane]
    findings.steps[run, 0] = int(lanes[_ACCEPTED + lane])
    findings.steps[run, 1] = int(lanes[_ATTEMPTED + lane] - lanes[_ACCEPTED + lane])
    findings.turns[run] = lanes[_WHOLE + lane] + lanes[_PART + lane]
    stuck = lanes[_STEP + lane] <= _SMALLEST_STEP
    far = lanes[_X_NEW + lane] > lanes[_X_BOUND + lane] * (1e-9 if stuck else 1.0)
    fast = lanes[_V_NEW + lane] > lanes[_V_BOUND + lane] * (1e-9 if stuck else 1.0)
    if lanes[_LANDED + lane] > 0.0:
        findings.outcome[run] = DONE
    elif far or fast:
        findings.outcome[run] = DIVERGED
    elif stuck:
        findings.outcome[run] = STEP_TOO_SMALL
    else:
        findings.outcome[run] = STEP_LIMIT
