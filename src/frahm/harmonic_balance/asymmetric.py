"""Branches that lack the symmetry of the equations: from where it is lost, and about other means."""

from __future__ import annotations

import numpy as np
import scipy.linalg

from frahm.arrays import Floats
from frahm.harmonic_balance.completing import complete
from frahm.harmonic_balance.condensation import unknowns
from frahm.harmonic_balance.following import followed, lies_on, track_of
from frahm.harmonic_balance.kernels import fourier_tables, residual_and_jacobian, sample_count
from frahm.harmonic_balance.newton import correct
from frahm.harmonic_balance.search import Search, Track
from frahm.harmonic_balance.seeds import Seed
from frahm.harmonic_balance.starts import solve_seed


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
        if any(np.allclose(c[[0, 4]], event.columns[[0, 4]], rtol=2e-3) for c in ends):
            continue
        start = None if search.budget.reached else _asymmetric_start(search, *point)
        if start is None:
            continue
        track = _half_of_pair(search, followed(search, False, *start))
        track.parent = parent
        if complete(search, track) and not any(_is_same(search, track, t) for t in known + tracks if not t.odd):
            tracks.append(track)
    return tracks


def buckled_branches(search: Search, seeds: list[Seed], known: list[Track]) -> list[Track]:
    """Branches of an odd system about another mean than 0 that no loss of symmetry in the window has led to.

    One of each mirrored pair is followed.
    """
    tracks: list[Track] = []
    for seed in seeds:
        start = None if search.budget.reached else solve_seed(search, seed, False)
        if start is None or np.linalg.norm(_even_part(search, *start)) < 1e-3 * search.x_scale:
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
    r = pb.M11.shape[0]
    full = np.zeros(search.size(False))
    odd_n, n = unknowns(pb, H, True), unknowns(pb, H, False)
    for m in range(odd_n // (2 * r)):
        full[2 * r * (2 * m + 1) : 2 * r * (2 * m + 2)] = y[2 * r * m : 2 * r * (m + 1)]
    full[n] = y[odd_n]
    R, J, A = np.empty(n + 1), np.empty((n + 1, n + 1)), np.empty((n + 1, n + 1))
    tables = fourier_tables(H, False, sample_count(pb, H, False))
    residual_and_jacobian(pb, H, False, full[n], full, *tables, R, J)
    normal = np.zeros(n + 1)
    normal[:n] = _null_vector(J[:n, :n])
    for push in (0.02, 0.005, 0.05):
        trial = full.copy()
        trial[:n] += push * search.x_scale * normal[:n]
        offset = float(normal[:n] @ trial[:n]) / search.x_scale
        ok, _, _ = correct(
            pb, H, False, trial, normal, offset, search.x_scale, search.w_scale, *tables, J, A,
            np.empty(n + 1, np.int64), 1e-9, 15,
        )  # fmt: skip
        if ok and np.linalg.norm(_even_part(search, trial, H)) > 0.3 * push * search.x_scale:
            return trial, H
    return None


def _null_vector(J: Floats) -> Floats:
    """Unit vector that a nearly singular matrix maps to nearly nothing, by inverse iteration."""
    factors = scipy.linalg.lu_factor(J + 1e-14 * np.linalg.norm(J) * np.eye(len(J)), check_finite=False)
    null = np.random.default_rng(1).standard_normal(len(J))
    for _ in range(3):
        null = scipy.linalg.lu_solve(factors, null / np.linalg.norm(null), check_finite=False)
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
        keep = keep[int(sizes[keep[0]] < 0.05 * sizes[keep[1]]) :] if len(keep) > 2 else keep
        keep = keep[: -1 if sizes[keep[-1]] < 0.05 * sizes[keep[-2]] else None] if len(keep) > 2 else keep
    if len(keep) == len(parts):
        return track
    part = [track.ys[keep], track.ts[keep], track.Hs[keep], track.truncations[keep]]
    return track_of(search, False, [tuple(part)], False, track.endings)
