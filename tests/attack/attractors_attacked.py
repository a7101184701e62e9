"""`find_attractors` of a random system against brute force."""

from __future__ import annotations

import numpy as np
from scipy.stats import fisher_exact

import frahm
from brute_force import (
    ALIKE,
    MOST,
    NEARLY,
    WINDOW,
    ends,
    exponent,
    looks_apart,
    looks_of,
    random_states,
    repeating,
    scattered,
    size_of,
)
from extremes_attacked import expected_peaks_attacked
from frahm.attractors.regions import sample_region
from oracle import Oracle

MISSED = 0.02  # basins that must be found
OTHERS = 400  # random states besides those of the sample
_CHAOTIC = 2e-3  # growth per period that the documentation calls chaos
_CONFIRM = 200  # periods after which a periodic attractor is still itself
_MEMBERS, _LOOKS, _AFTER = 32, 16, 8  # of what is no orbit: motions, windows of each, windows that tell who has left
_HOLDS = 0.25  # of the members, at least, that stay on it for a window
_AGAIN = 8  # further windows of a motion that is on nothing known; most must show the same attractor
_STAYING = 40  # stretches over which the growth on a set that motions leave is counted
_MOVED = 1e-7  # of a state: what moves the end of a motion from near a boundary
_STRETCHES, _FALLS = 2, 0.02  # of motions that are slow: stretches more, least fall of the distance in each


def attack(drawn, others=OTHERS, rare=True):
    """What brute force says against the attractors of a drawn system and, if `rare`, their rare peaks; plain data."""
    system, W = drawn.system, drawn.frequency
    found = frahm.find_attractors(system, frequency=W)
    oracle = Oracle(system)
    known = [Known(oracle, attractor, W) for attractor in found if attractor.kind != "unsettled"]
    lost = sum(a.basin_fraction for a in found if a.kind == "unsettled" and a.outcome is frahm.Outcome.DIVERGED)
    open_ended = sum(a.basin_fraction for a in found if a.kind == "unsettled") - lost
    states = sample_region(system, found.region, found.samples, found.seed)
    random = np.random.default_rng([7, drawn.number])
    other = ends(oracle, random_states(system, found.region, others, random), W, found.periods)
    labels, labels_other = labelled(known, oracle, W, found.periods, states), label(known, other)
    labels_other = _later(known, oracle, W, found.periods, other, labels_other)
    labels_other = _again(known, oracle, W, other, labels_other)
    rows = [_row(item, index, found, labels, labels_other, rare) for index, item in enumerate(known)]
    shifted = _shift([row["paired"] for row in rows], [row["fraction"] for row in rows])
    nudged = 0.0
    if shifted:
        moved = labelled(known, oracle, W, found.periods, (1 + _MOVED) * states)
        nudged = _shift([row["paired"] for row in rows], [np.mean(moved == index) for index in range(len(rows))])
    return {
        "number": drawn.number, "family": drawn.family, "periods": found.periods, "attractors": rows,
        "unsettled": open_ended, "escaped": lost, "escaped_brute": float(np.mean(other.lost)),
        "shifted": shifted, "shifted_by_a_nudge": nudged, "missed": missed(other, labels_other, open_ended),
    }  # fmt: skip


class Known:
    """An attractor of the package as the oracle sees it, started from its representative state."""

    def __init__(self, oracle, attractor, frequency):
        self.attractor, self.oracle, self.frequency = attractor, oracle, frequency
        state = np.array(attractor.representative_state)
        if attractor.kind == "periodic":
            p = attractor.period_multiple
            self.strobes = oracle.watch(state[None], frequency, p, p).strobes[0]
            late = oracle.watch(state[None], frequency, p * -(-_CONFIRM // p), 1).states[0]
            self.size = size_of(self.strobes[None], frequency)[0]
            self.holds = bool(np.max(np.abs(late - self.strobes[-1]) / self.size) < 1e-3)
        else:
            beside = scattered(state, frequency, _MEMBERS, 1e-4)
            windows = _LOOKS + _AFTER
            seen = oracle.watch(beside, frequency, WINDOW * (windows + 1), WINDOW * windows)
            strobes = seen.strobes.reshape(_MEMBERS, windows, WINDOW, -1)
            looks = looks_of(seen.peaks.reshape(_MEMBERS * windows, WINDOW, 2)).reshape(_MEMBERS, windows, 4)
            stayed = _stayed(strobes, frequency)
            counted = looks[np.arange(windows) < np.minimum(stayed, _LOOKS)[:, None]]
            self.least, self.most = counted.min(axis=0, initial=np.inf), counted.max(axis=0, initial=-np.inf)
            self.members = strobes[stayed > 0, 0, -1] if attractor.leaks else strobes[:8, _LOOKS - 1, -1]
            self.holds = np.mean(stayed > 0) >= _HOLDS

    @property
    def periodic(self):
        return self.attractor.kind == "periodic"

    def apart(self, motions):
        """How far motions are from it, 1 being as far as may be."""
        if self.periodic:
            distance = np.abs(motions.states[:, None] - self.strobes) / self.size
            nearest = np.min(np.max(distance, axis=2), axis=1) / NEARLY
            p = self.attractor.period_multiple
            repeats = (motions.nearly > 0) & (p % np.maximum(motions.nearly, 1) == 0)
            return np.where(repeats, nearest, np.inf)
        within = np.clip(motions.looks, self.least, self.most)
        regular = (motions.multiple > 0) & (motions.multiple <= MOST)
        return np.where(regular, np.inf, looks_apart(motions.looks, within) / ALIKE)

    def kind_of_brute(self):
        """Kind that the oracle sees: by the recurrence of the orbit, or by the growth between neighbours."""
        if not self.holds:
            return "unstable"
        if self.periodic:
            return "periodic"
        leaks = self.attractor.leaks
        rate, error = exponent(self.oracle, self.members, self.frequency, *([_STAYING] if leaks else []))
        if rate - 2.4 * error > _CHAOTIC:
            return "chaotic"
        return "quasi-periodic" if rate + 2.4 * error < _CHAOTIC else self.attractor.kind


def _stayed(strobes, frequency):
    """How many windows motions with strobes (N, W, K, 2n) stay before they turn to an orbit, W where they do not.

    From the size of the motion to 3 % of it a decay takes no longer than from there to 1e-4.
    """
    count, windows = strobes.shape[:2]
    each = repeating(strobes.reshape(count * windows, *strobes.shape[2:]), frequency)
    there, near = (((m > 0) & (m <= MOST)).reshape(count, windows) for m in each)
    at, begun = (windows - np.sum(np.cumprod(now[:, ::-1], axis=1), axis=1) for now in (there, near | there))
    return np.where(at < windows, np.maximum(2 * begun - at - 1, 0), windows)


def label(known, motions):
    """Index of the attractor that each motion ends on, -1 for none."""
    if not known:
        return np.full(len(motions.multiple), -1)
    apart = np.array([item.apart(motions) for item in known])
    apart[:, motions.lost] = np.inf
    return np.where(np.min(apart, axis=0) <= 1, np.argmin(apart, axis=0), -1)


def labelled(known, oracle, frequency, periods, states):
    """Index of the attractor that motions from states end on, -1 for none."""
    motions = ends(oracle, states, frequency, periods)
    labels = _later(known, oracle, frequency, periods, motions, label(known, motions))
    return _again(known, oracle, frequency, motions, labels)


def _later(known, oracle, frequency, periods, motions, labels):
    """Labels, those included that nearly repeat and still come nearer to an orbit: decay may be slower than any rate.

    A spring without linear part holds the mean of a small stroke next to not at all.
    """
    orbits = [index for index, item in enumerate(known) if item.periodic]
    slow = np.flatnonzero((labels < 0) & (motions.nearly > 0) & ~motions.lost)
    if not orbits or not slow.size:
        return labels
    found, apart, now = labels.copy(), [], motions[slow]
    for stretch in range(_STRETCHES + 1):
        if stretch:
            now = ends(oracle, now.states, frequency, periods)
        apart.append([known[index].apart(now) for index in orbits])
    with np.errstate(invalid="ignore"):
        nearer = np.diff(apart, axis=0) < -_FALLS * np.array(apart[:-1])
    falls = np.all(nearer, axis=0) & np.isfinite(apart[-1])
    nearest = np.argmin(np.where(falls, apart[-1], np.inf), axis=0)
    found[slow] = np.where(falls.any(axis=0), np.array(orbits)[nearest], -1)
    return found


def _again(known, oracle, frequency, motions, labels):
    """Labels, those included that show one attractor in most of the windows that follow.

    A window may pass the extremes of all those seen of a chaotic attractor, or hold the turn to an orbit.
    """
    found, odd = labels.copy(), np.flatnonzero((labels < 0) & ~motions.lost)
    if not odd.size:
        return labels
    now, shown = motions[odd], []
    for _ in range(_AGAIN):
        now = ends(oracle, now.states, frequency, WINDOW)
        shown.append(label(known, now))
    votes = np.array([np.count_nonzero(np.array(shown) == index, axis=0) for index in range(len(known))])
    if known:
        found[odd] = np.where(votes.max(axis=0) > _AGAIN / 2, np.argmax(votes, axis=0), -1)
    return found


def _shift(shares, others):
    """Share of states that change their attractor between two labellings, at least."""
    return float(0.5 * np.sum(np.abs(np.array(shares) - np.array(others))))


def missed(motions, labels, open_ended):
    """Groups of motions that end alike, on nothing known, with a basin above 2 %."""
    left = np.flatnonzero((labels < 0) & ~motions.lost)
    groups = []
    while left.size:
        first = left[0]
        like = looks_apart(motions.looks[left], motions.looks[first]) < 2.5 * ALIKE
        like &= (motions.multiple[left] > 0) == (motions.multiple[first] > 0)
        share = np.count_nonzero(like) / len(labels)
        if share > MISSED:
            groups.append({
                "share": share, "multiple": int(motions.multiple[first]), "looks": motions.looks[first].tolist(),
                "called": "unsettled" if open_ended >= 0.5 * share else "nothing",
                "state": motions.states[first].tolist(),
            })  # fmt: skip
        left = left[~like]
    return groups


def _row(item, index, found, labels, labels_other, rare):
    attractor = item.attractor
    hits = round(attractor.basin_fraction * found.samples)
    hits_brute = int(np.count_nonzero(labels_other == index))
    row = {
        "kind": attractor.kind, "kind_brute": item.kind_of_brute(), "multiple": attractor.period_multiple,
        "pipe_peak": attractor.pipe_peak, "fraction": attractor.basin_fraction,
        "interval": list(attractor.basin_interval), "leaks": attractor.leaks,
        "paired": float(np.mean(labels == index)), "brute": hits_brute / len(labels_other),
        "agrees": _agrees(hits, found.samples, attractor.basin_interval[1], hits_brute, len(labels_other)),
    }  # fmt: skip
    if rare and attractor.kind == "chaotic":
        row["expected"] = expected_peaks_attacked(item.oracle, attractor, item.frequency)
    return row


def _agrees(hits, samples, high, hits_brute, samples_brute):
    """Whether two samples may have one fraction (Fisher, 5 %), or brute force lies within what is still open."""
    if hits / samples < hits_brute / samples_brute <= high:
        return True
    table = [[hits, samples - hits], [hits_brute, samples_brute - hits_brute]]
    return bool(fisher_exact(table).pvalue >= 0.05)
