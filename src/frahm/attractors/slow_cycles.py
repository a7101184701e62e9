"""One limit cycle of the slow flow: multiple shooting, multipliers, envelope.

The unknowns y are the states of M nodes along the cycle, the times between them, and Omega, all scaled. Nodes are set
so that an arc between two of them holds the same share of steps and time, so that neither the fast jumps of a
relaxation cycle nor its slow passages amplify an error by much within an arc.

Multiple shooting for cycles: Kuznetsov (2004), doi 10.1007/978-1-4757-3978-7, chapter 10.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from frahm.arrays import Floats, eigenvalues
from frahm.attractors.slow_arcs import MOST_STEPS, envelope, shoot, velocities
from frahm.attractors.slow_arcs import arc as slow_arc
from frahm.slow_flow import SlowFlow

NODES = 16
TOLERANCE = 1e-10
_MOST_ROWS = 20_000


@dataclass(frozen=True)
class Scales:
    """Sizes of |X|, |Z| [m] and of a change of Omega [rad/s]."""

    pipe: float
    relative: float
    frequency: float

    @property
    def state(self) -> Floats:
        """Sizes of the four numbers of a state."""
        return np.array([self.pipe, self.pipe, self.relative, self.relative])


@dataclass(frozen=True)
class SlowCycle:
    """A limit cycle of the slow flow.

    Attributes
    ----------
    frequency, period : float
        Omega [rad/s] and the period of the modulation [s].
    nodes : ndarray, shape (nodes, 4)
        States (Re X, Im X, Re Z, Im Z) [m] along the cycle.
    durations : ndarray, shape (nodes,)
        Times from each node to the next [s].
    multipliers : ndarray of complex, shape (3,)
        Floquet multipliers besides the trivial one.
    trivial_error : float
        How far the computed trivial multiplier is from 1.
    pipe, relative : tuple of float
        Smallest and largest |X| and |Z| [m].
    slowest : float
        Least speed along the cycle relative to the mean speed; small where it passes close to an equilibrium.
    """

    frequency: float
    period: float
    nodes: Floats
    durations: Floats
    multipliers: np.ndarray
    trivial_error: float
    pipe: tuple[float, float]
    relative: tuple[float, float]
    slowest: float

    @property
    def stable(self) -> bool:
        """Whether all multipliers lie inside the unit circle."""
        return bool(np.max(np.abs(self.multipliers)) < 1)


class Shooting:
    """Equations of a limit cycle through fixed sections: `residual` for the continuation, `cycle` for what is known.

    Every node stays in the plane across the cycle nearby, so that it does not slide along the cycle while the jumps of
    a relaxation cycle come earlier or later.

    Parameters
    ----------
    slow : SlowFlow
    scales : Scales
    nodes, durations : ndarray
        A cycle nearby, see `SlowCycle`; it fixes the sections.
    frequency : float
        Its Omega [rad/s].
    """

    def __init__(self, slow: SlowFlow, scales: Scales, nodes: Floats, durations: Floats, frequency: float):
        self.slow, self.scales = slow, scales
        self.head = (slow.code, *slow.host, slow.force, slow.kappa)
        self.count = len(nodes)
        self._root = np.sqrt(self.count)
        self._size = scales.state * self._root
        self._nodes = nodes
        speed = self.velocities(nodes, frequency) / scales.state
        self._across = speed / np.linalg.norm(speed, axis=1, keepdims=True)
        self.start = self.pack(nodes, durations, frequency)
        self._known: dict[bytes, tuple[Floats, Floats, bool]] = {}

    def velocities(self, states: Floats, frequency: float) -> Floats:
        """Time derivatives (M, 4) of states (M, 4) [m/s]."""
        found = np.empty_like(states)
        velocities(*self.head, frequency, states, found)
        return found

    def pack(self, nodes: Floats, durations: Floats, frequency: float) -> Floats:
        """Scaled unknowns y (5 M + 1,): nodes, logarithms of the durations, Omega."""
        turns = np.log(durations * self.slow.omega) / self._root
        return np.concatenate([(nodes / self._size).ravel(), turns, [frequency / self.scales.frequency]])

    def unpack(self, y: Floats) -> tuple[Floats, Floats, float]:
        """Nodes (M, 4) [m], durations (M,) [s] and Omega [rad/s]."""
        M = self.count
        nodes, turns = y[: 4 * M].reshape(M, 4) * self._size, y[4 * M : 5 * M] * self._root
        return nodes, np.exp(turns) / self.slow.omega, float(y[-1] * self.scales.frequency)

    def _arcs(self, y: Floats) -> tuple[Floats, Floats, bool]:
        """Ends (M, 4) of the arcs, their derivatives by start and Omega (M, 4, 5), and whether all could be made."""
        key = y.tobytes()
        if key not in self._known:
            if len(self._known) > 3:
                del self._known[next(iter(self._known))]
            nodes, durations, W = self.unpack(y)
            ends, maps = np.empty_like(nodes), np.empty((self.count, 4, 5))
            sizes = self.scales.pipe, self.scales.relative
            good = shoot(*self.head, W, nodes, durations, *sizes, TOLERANCE, ends, maps)
            self._known[key] = ends, maps, bool(good)
        return self._known[key]

    def residual(self, y: Floats) -> tuple[Floats, Floats]:
        """Gaps between arcs and nodes, and distances from the sections (5 M,), with the Jacobian (5 M, 5 M + 1)."""
        M, size = self.count, self._size
        R, J = np.full(5 * M, np.nan), np.zeros((5 * M, 5 * M + 1))
        if not (np.all(np.isfinite(y)) and np.max(np.abs(y[4 * M : 5 * M])) < 50 / self._root and y[-1] > 0):
            return R, J
        nodes, durations, W = self.unpack(y)
        ends, maps, good = self._arcs(y)
        if not good:
            return R, J
        off = (nodes - self._nodes) / size
        R[: 4 * M] = ((ends - np.roll(nodes, -1, axis=0)) / size).ravel()
        R[4 * M :] = np.vecdot(self._across, off)
        own = np.arange(4 * M).reshape(M, 4)
        rows, lengths = own[:, :, None], np.arange(4 * M, 5 * M)
        J[rows, own[:, None]] = maps[:, :, :4] * size / size[:, None]
        J[rows, np.roll(own, -1, axis=0)[:, None]] -= np.eye(4)
        J[own, lengths[:, None]] = self.velocities(ends, W) * durations[:, None] * self._root / size
        J[: 4 * M, -1] = (maps[:, :, 4] * self.scales.frequency / size).ravel()
        J[lengths[:, None], own] = self._across
        return R, J

    def cycle(self, y: Floats) -> SlowCycle | None:
        """What is known of the cycle at y; None if an arc cannot be integrated."""
        nodes, durations, W = self.unpack(y)
        _, maps, good = self._arcs(y)
        if not good:
            return None
        trivial, B = _deflated(maps, self.velocities(nodes[:1], W)[0], self.scales.state)
        times, states = self._path(nodes, durations, W)
        sizes = np.empty(4)
        envelope(*self.head, W, times, states, sizes)
        scaled = np.linalg.norm(np.diff(states, axis=0) / self.scales.state, axis=1)
        slowest = float(np.min(scaled / np.diff(times)) / (np.sum(scaled) / times[-1]))
        return SlowCycle(
            frequency=W, period=float(times[-1]), nodes=nodes, durations=durations, multipliers=eigenvalues(B),
            trivial_error=abs(trivial - 1), pipe=(float(sizes[0]), float(sizes[1])),
            relative=(float(sizes[2]), float(sizes[3])), slowest=slowest,
        )  # fmt: skip

    def _path(self, nodes: Floats, durations: Floats, W: float) -> tuple[Floats, Floats]:
        """Step ends of one turn: times (rows,), states (rows, 4)."""
        times, states, start = [], [], 0.0
        for node, duration in zip(nodes, durations, strict=True):
            t, s = integrated(self.slow, self.scales, node, duration, W)
            times.append(start + t[:-1])
            states.append(s[:-1])
            start += duration
        return np.append(np.concatenate(times), start), np.concatenate([*states, nodes[:1]])

    def durations_anew(self, y: Floats) -> Floats:
        """Durations that share steps and time evenly among the arcs of the cycle at y."""
        nodes, durations, W = self.unpack(y)
        times, _ = self._path(nodes, durations, W)
        return even_durations(times, self.count)

    def nodes_at(self, y: Floats, durations: Floats) -> Floats:
        """Nodes (M, 4) of the cycle at y where its period is divided like `durations`."""
        nodes, old, W = self.unpack(y)
        starts = np.concatenate([[0.0], np.cumsum(old)])
        marks = np.concatenate([[0.0], np.cumsum(durations)[:-1]]) * starts[-1] / np.sum(durations)
        found = np.empty((len(durations), 4))
        for i, mark in enumerate(marks):
            m = int(np.searchsorted(starts, mark, side="right")) - 1
            found[i] = integrated(self.slow, self.scales, nodes[m], mark - starts[m], W)[1][-1]
        return found

    def on_sections(self, direction: Floats) -> Floats:
        """A direction in y at `start` without sliding of the nodes along the cycle."""
        M = self.count
        moves = direction[: 4 * M].reshape(M, 4)
        slide = np.sum(self._across * moves, axis=1)
        nodes, durations, W = self.unpack(self.start)
        speed = self.velocities(nodes, W) / self._size
        late = slide / np.sqrt(np.vecdot(speed, speed))
        turns = direction[4 * M : 5 * M] - (np.roll(late, -1) - late) / (durations * self._root)
        return np.concatenate([(moves - slide[:, None] * self._across).ravel(), turns, direction[-1:]])

    def crossing(self, y: Floats) -> float:
        """Least cosine between the flow and the normal of a section: where it comes to 0 a section is lost."""
        nodes, _, W = self.unpack(y)
        speed = self.velocities(nodes, W) / self.scales.state
        return float(np.min(np.sum(self._across * speed, axis=1) / np.linalg.norm(speed, axis=1)))

    def tests(self, y: Floats) -> tuple[float, float]:
        """Test functions of period doubling (a multiplier -1) and torus (a pair on the unit circle)."""
        nodes, _, W = self.unpack(y)
        _, maps, _ = self._arcs(y)
        _, B = _deflated(maps, self.velocities(nodes[:1], W)[0], self.scales.state)
        return multiplier_tests(eigenvalues(B))


def even_durations(times: Floats, count: int) -> Floats:
    """Durations of `count` arcs that share the steps and the time of a path evenly, from its step ends [s]."""
    share = 0.5 * np.linspace(0, 1, times.size) + 0.5 * times / times[-1]
    marks = np.interp(np.arange(count + 1) / count, share, times)
    return np.asarray(np.diff(marks))


def multiplier_tests(multipliers: np.ndarray) -> tuple[float, float]:
    """Products of mu + 1 and of mu_i mu_j - 1, scaled to stay finite: zero at period doubling and torus."""
    size = np.maximum(1, np.abs(multipliers))
    i, j = np.triu_indices(len(multipliers), 1)
    pairs = (multipliers[i] * multipliers[j] - 1) / (size[i] * size[j])
    return float(np.prod((multipliers + 1) / size).real), float(np.prod(pairs).real)


def integrated(
    slow: SlowFlow, scales: Scales, node: Floats, duration: float, W: float, rows: int = _MOST_ROWS
) -> tuple[Floats, Floats]:
    """Step ends (times, states) of the slow flow from a state; the last row is the state at the end [s], [m].

    Steps beyond `rows` are not kept; a motion that cannot be integrated gives NaN at the end.
    """
    head = (slow.code, *slow.host, slow.force, slow.kappa)
    times, states = np.empty(rows), np.empty((rows, 4))
    y = np.array(node, dtype=float)
    if duration <= 0:
        return np.zeros(1), y[None]
    steps = slow_arc(*head, W, y, 1, duration, scales.pipe, scales.relative, TOLERANCE, MOST_STEPS, times, states)
    if steps < 0:
        return np.array([0.0, duration]), np.array([node, np.full(4, np.nan)])
    kept = min(steps, rows - 1)
    return np.append(times[:kept], duration), np.concatenate([states[:kept], y[None]])


def _deflated(maps: Floats, along: Floats, size: Floats) -> tuple[float, Floats]:
    """The trivial multiplier and the map (3, 3) across the cycle, whose eigenvalues are the other ones."""
    total = np.eye(4)
    for G in maps[:, :, :4]:
        total = (G * size / size[:, None]) @ total
    Q, _ = np.linalg.qr(np.column_stack([along / size, np.eye(4)[:, :3]]))
    turned = Q.T @ total @ Q
    return float(turned[0, 0]), turned[1:, 1:]
