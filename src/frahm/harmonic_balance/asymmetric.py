"""Branches that lack the symmetry of the equations: from where it is lost, and about other means."""

from __future__ import annotations

import numpy as np

from frahm.arrays import Floats
from frahm.continuation.dense import factorise, solve_factorised
from frahm.harmonic_balance.completing import complete, described
from frahm.harmonic_balance.condensation import unknowns
from frahm.harmonic_balance.events import LocatedEvent, Point
from frahm.harmonic_balance.following import followed, lies_on, track_of
from frahm.harmonic_balance.kernels import fourier_tables, residual_and_jacobian, sample_count
from frahm.harmonic_balance.newton import correct
from frahm.harmonic_balance.search import Search, Track
from frahm.harmonic_balance.seeds import Seed
from frahm.harmonic_balance.starts import solve_seed

_REACH = 2.0  # steps of a branch within which its end lies of the point where it is born
_SAME = 1e-7
_SYMMETRIC = 1e-3  # even part, in units of the scale, below which an orbit of any parity is a symmetric one
_PUSHES = (0.02, 0.005, 0.05)  # off the symmetric orbit, in units of the scale, tried in this order
_KEPT = 0.3  # share of a push that must be left as even part: else Newton's method fell back on the symmetric branch
_RESIDUAL, _MOST_STEPS = 1e-9, 15  # of Newton's method
_TILT = 1e-14  # of a singular matrix, relative, so that it can be factorised
_ALL_BUT_SYMMETRIC = 0.05  # even part at an end over that of its neighbour


def asymmetric_branches(search: Search, parent: Track, known: list[Track]) -> list[Track]:
    """Branches with even harmonics that leave an odd branch where it loses its symmetry.

    One of each mirrored pair is followed, between the points at which it meets odd branches.
    """
    if not parent.odd:
        return []
    tracks: list[Track] = []
    own = zip(parent.events, parent.event_points, strict=True)
    births = [(event, point) for event, point in own if event.kind == "branch-point" and point is not None]
    for event, point in births + parent.births:
        ends = [c for t in known + tracks if not t.odd for c in (t.columns[0], t.columns[-1])]
        if any(np.allclose(c[[0, 4]], event.columns[[0, 4]], rtol=_SAME) for c in ends):
            continue
        start = None if search.budget.reached else _asymmetric_start(search, *point)
        if start is None:
            continue
        track = _half_of_pair(search, followed(search, False, *start))
        track.parent = parent
        if complete(search, track) and not any(_is_same(search, track, t) for t in known + tracks if not t.odd):
            _begin_at_births(search, track, [t for t in known if t.odd])
            tracks.append(track)
    return tracks


def _begin_at_births(search: Search, track: Track, odd: list[Track]) -> None:
    """Put the points at which the symmetry is lost on the ends of a branch that leaves there."""
    births = [
        (event, point) for t in odd for event, point in zip(t.events, t.event_points, strict=True)
        if event.kind == "branch-point" and point is not None
    ]  # fmt: skip
    places = [_scaled(search, y, H, True) for _, (y, _, H) in births]
    for end, beside in ((0, 1), (-1, -2)):
        a, b = (_scaled(search, track.ys[i], int(track.Hs[i]), False) for i in (end, beside))
        away = [float(np.linalg.norm(place - a)) for place in places]
        if away and min(away) < _REACH * float(np.linalg.norm(b - a)):
            event, point = births[int(np.argmin(away))]
            _put_at_end(search, track, end, point, event)


def _put_at_end(search: Search, track: Track, end: int, birth: Point, event: LocatedEvent) -> None:
    """Add a symmetric point to an end of an asymmetric branch, which leaves it along its even part."""
    y, _, H = birth
    r, size = search.problem.M11.shape[0], search.size(False)
    n = unknowns(search.problem, H, False)
    point, tangent = np.zeros(size), np.zeros(size)
    point[: n + 1] = _with_even(search, y, H)
    even = track.ys[end, :n].copy().reshape(-1, 2 * r)
    even[1::2] = 0.0
    tangent[:n] = even.ravel() / np.linalg.norm(even) * (1.0 if end == 0 else -1.0)
    at = 0 if end == 0 else len(track.Hs)
    multipliers = described(search, False, point[None], np.array([H]))[1][0]
    track.ys, track.ts = np.insert(track.ys, at, point, axis=0), np.insert(track.ts, at, tangent, axis=0)
    track.Hs = np.insert(track.Hs, at, H)
    track.truncations = np.insert(track.truncations, at, track.truncations[end])
    track.columns = np.insert(track.columns, at, event.columns, axis=0)
    track.multipliers = np.insert(track.multipliers, at, multipliers, axis=0)


def _with_even(search: Search, y: Floats, H: int) -> Floats:
    """A point with odd harmonics only, as one with all harmonics."""
    r = search.problem.M11.shape[0]
    odd_n, n = unknowns(search.problem, H, True), unknowns(search.problem, H, False)
    full = np.zeros(n + 1)
    for m in range(odd_n // (2 * r)):
        full[2 * r * (2 * m + 1) : 2 * r * (2 * m + 2)] = y[2 * r * m : 2 * r * (m + 1)]
    full[n] = y[odd_n]
    return full


def _scaled(search: Search, y: Floats, H: int, odd: bool) -> Floats:
    """A point with all harmonics and Omega in the scales of the search, as long as any."""
    full = _with_even(search, y, H) if odd else y
    n, scaled = unknowns(search.problem, H, False), np.zeros(search.size(False))
    scaled[:n], scaled[-1] = full[:n] / search.x_scale, full[n] / search.w_scale
    return scaled


def buckled_branches(search: Search, seeds: list[Seed], known: list[Track]) -> list[Track]:
    """Branches of an odd system about another mean than 0 that no loss of symmetry in the window has led to.

    One of each mirrored pair is followed.
    """
    tracks: list[Track] = []
    for seed in seeds:
        start = None if search.budget.reached else solve_seed(search, seed, False)
        if start is None or np.linalg.norm(_even_part(search, *start)) < _SYMMETRIC * search.x_scale:
            continue
        others = [track for track in known + tracks if not track.odd]
        if any(meets(search, track, *start) for track in others):
            continue
        track = _half_of_pair(search, followed(search, False, *start))
        if complete(search, track):
            tracks.append(track)
    return tracks


def _is_same(search: Search, track: Track, other: Track) -> bool:
    """Whether two asymmetric branches are one, or mirror images of one another, judged where the first is least odd."""
    i = int(np.argmax([np.linalg.norm(_even_part(search, y, H)) for y, H in zip(track.ys, track.Hs, strict=True)]))
    return meets(search, other, track.ys[i], int(track.Hs[i]))


def meets(search: Search, other: Track, y: Floats, H: int) -> bool:
    """Whether a solution or its mirror image lies on an asymmetric branch."""
    pb, r = search.problem, search.problem.M11.shape[0]
    mirrored = y.copy()
    mirrored[: unknowns(pb, H, False)].reshape(-1, 2 * r)[::2] *= -1
    return lies_on(search, other, y, H) or lies_on(search, other, mirrored, H)


def _asymmetric_start(search: Search, y: Floats, _: Floats, H: int) -> tuple[Floats, int] | None:
    """A point beside a loss of symmetry, off along the even null vector of the full Jacobian."""
    pb = search.problem
    full, n = np.zeros(search.size(False)), unknowns(pb, H, False)
    full[: n + 1] = _with_even(search, y, H)
    R, J, A = np.empty(n + 1), np.empty((n + 1, n + 1)), np.empty((n + 1, n + 1))
    tables = fourier_tables(H, False, sample_count(pb, H, False))
    residual_and_jacobian(pb, H, False, full[n], full, *tables, R, J)
    normal = np.zeros(n + 1)
    normal[:n] = _null_vector(J[:n, :n])
    for push in _PUSHES:
        trial = full.copy()
        trial[:n] += push * search.x_scale * normal[:n]
        offset = float(normal[:n] @ trial[:n]) / search.x_scale
        ok, _, _ = correct(
            pb, H, False, trial, normal, offset, search.x_scale, search.w_scale, *tables, J, A,
            np.empty(n + 1, np.int64), _RESIDUAL, _MOST_STEPS,
        )  # fmt: skip
        if ok and np.linalg.norm(_even_part(search, trial, H)) > _KEPT * push * search.x_scale:
            return trial, H
    return None


def _null_vector(J: Floats) -> Floats:
    """Unit vector that a nearly singular matrix maps to nearly nothing, by inverse iteration."""
    factors, pivots = J + _TILT * np.linalg.norm(J) * np.eye(len(J)), np.empty(len(J), np.int64)
    factorise(factors, pivots, len(J))
    null = np.random.default_rng(1).standard_normal(len(J))
    for _ in range(3):
        null /= np.linalg.norm(null)
        solve_factorised(factors, pivots, len(J), null)
    return np.asarray(null / np.linalg.norm(null))


def _even_part(search: Search, y: Floats, H: int) -> Floats:
    """Mean and even harmonics of a point with all harmonics, flat."""
    r = search.problem.M11.shape[0]
    n = unknowns(search.problem, H, False)
    return y[:n].reshape(-1, 2 * r)[::2].ravel()


def _half_of_pair(search: Search, track: Track) -> Track:
    """Cut an asymmetric branch where it passes through a symmetric orbit into its mirror image."""
    parts = [_even_part(search, y, H) for y, H in zip(track.ys, track.Hs, strict=True)]
    flips = [
        i for i in range(len(parts) - 1)
        if float(np.dot(*(p[: min(parts[i].size, parts[i + 1].size)] for p in parts[i : i + 2]))) < 0
    ]  # fmt: skip
    sizes = np.array([np.linalg.norm(p) for p in parts])
    if not flips:
        keep = np.arange(len(parts))
    elif track.closed:
        order = np.concatenate([np.arange(flips[0] + 1, len(parts) - 1), np.arange(flips[0] + 1)])
        keep = order[: ((flips[1] if len(flips) > 1 else flips[0]) - flips[0]) or len(order)]
    else:
        start = int(np.argmax(sizes))
        low = max([i + 1 for i in flips if i < start], default=0)
        keep = np.arange(low, min([i + 1 for i in flips if i >= start], default=len(parts)))
    if flips or not track.closed:  # an end that is all but symmetric lies on the point where the branch was born
        keep = keep[int(sizes[keep[0]] < _ALL_BUT_SYMMETRIC * sizes[keep[1]]) :] if len(keep) > 2 else keep
        keep = keep[: -1 if sizes[keep[-1]] < _ALL_BUT_SYMMETRIC * sizes[keep[-2]] else None] if len(keep) > 2 else keep
    if len(keep) == len(parts):
        return track
    part = [track.ys[keep], track.ts[keep], track.Hs[keep], track.truncations[keep]]
    return track_of(search, False, [tuple(part)], False, track.endings)
