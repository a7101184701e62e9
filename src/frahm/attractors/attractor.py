"""What a long-term motion is to a designer: `Attractor`, and the set of them at one excitation frequency.

Share of a region as the stability of an attractor: Menck et al. (2013), doi 10.1038/nphys2516. Intervals: Clopper and
Pearson (1934), doi 10.1093/biomet/26.4.404; of rates, Garwood (1936), doi 10.1093/biomet/28.3-4.437.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, overload

import numpy as np
from scipy.stats import beta

from frahm import readable
from frahm.arrays import Floats, labelled
from frahm.attractors.extremes import RarePeaks
from frahm.attractors.regions import Region
from frahm.errors import Outcome

if TYPE_CHECKING:
    import xarray as xr

KINDS = ("periodic", "quasi-periodic", "chaotic", "unsettled")
CONFIDENCE = 0.95


@dataclass(frozen=True, eq=False)
class Attractor:
    """A long-term motion and how likely it is.

    Attributes
    ----------
    kind : str
        "periodic", "quasi-periodic" (modulated), "chaotic", or "unsettled": not an attractor but the share of motions
        that end on none within the periods allowed, escape, or cannot be integrated; `outcome` says which.
    frequency, detuning : float
        Of the excitation [rad/s].
    pipe_peak, relative_peak : float
        Largest |x| of the output and |z| of the first element [m] over the window kept. Where the motion does not
        repeat, that is all of eight motions of 1000 periods each; a longer time may show a larger one, see
        `pipe_peak_expected`. Infinite for an escaping motion, NaN for one that cannot be integrated.
    rare_peaks : RarePeaks
        What a longer time may show, see `pipe_peak_expected`.
    return_time : float
        10 000 periods of the forcing [s].
    pipe_rms, relative_rms : float
        Root mean square over the same windows [m].
    envelope, relative_envelope : tuple of float
        Smallest and largest peak of a single period over all eight windows [m].
    period_multiple : int
        Periods of the forcing after which a periodic motion repeats; 0 for others.
    beat_period : float
        Period of the strongest modulation of the pipe's amplitude [s]; NaN for a periodic motion.
    frequencies : tuple of float
        Base frequencies [rad/s]: Omega/p of a periodic motion; Omega and that of the beat for the others.
    lyapunov : float
        Largest Lyapunov exponent [1/s].
    lyapunov_interval : tuple of float
        95 % interval of it [1/s].
    basin_fraction : float
        Share of the uniform sample of initial states whose motions are here after the periods they were followed [-].
    basin_interval : tuple of float
        95 % interval of it (Clopper-Pearson) [-]. Motions that had not settled by then may belong to any attractor: the
        upper end counts them in.
    escape_rate : float
        Motions that leave for a periodic one, or escape, per motion and time [1/s]: of a chaotic set that does not
        attract for ever. What is left of it after a time t is e^(-rate t). 0 for a periodic motion, NaN if unsettled.
    escape_interval : tuple of float
        95 % interval of it [1/s].
    representative_state : ndarray, shape (2n,)
        State (x_0, v_0, ...) on the attractor at phase 0 of the forcing [m, m/s].
    from_rest : bool
        Whether the motion from rest ends here.
    outcome : Outcome
        DONE, or why the motion is unsettled.
    """

    __repr__ = readable.summary

    kind: str
    frequency: float
    detuning: float
    pipe_peak: float
    relative_peak: float
    rare_peaks: RarePeaks
    return_time: float
    pipe_rms: float
    relative_rms: float
    envelope: tuple[float, float]
    relative_envelope: tuple[float, float]
    period_multiple: int
    beat_period: float
    frequencies: tuple[float, ...]
    lyapunov: float
    lyapunov_interval: tuple[float, float]
    basin_fraction: float
    basin_interval: tuple[float, float]
    escape_rate: float
    escape_interval: tuple[float, float]
    representative_state: Floats
    from_rest: bool
    outcome: Outcome

    @property
    def pipe_peak_expected(self) -> float:
        """Level [m] that |x| exceeds once, on average, in `return_time`.

        The quantile of the peaks of stretches of 50 periods, of motions followed for 64 000 periods in all or longer,
        which is done when it is first asked for. The peak itself for a periodic motion, NaN for an unsettled one.
        """
        return self.rare_peaks.levels[0].value

    @property
    def pipe_peak_expected_interval(self) -> tuple[float, float]:
        """95 % interval of it [m], of no assumed distribution; infinite above where 256 000 periods bound it not."""
        return self.rare_peaks.levels[0].interval

    @property
    def relative_peak_expected(self) -> float:
        """As `pipe_peak_expected`, of |z| of the first element [m]."""
        return self.rare_peaks.levels[1].value

    @property
    def relative_peak_expected_interval(self) -> tuple[float, float]:
        """95 % interval of it [m]."""
        return self.rare_peaks.levels[1].interval

    @property
    def leaks(self) -> bool:
        """Whether motions were seen to leave, so that this is a long transient and no attractor."""
        return self.escape_interval[0] > 0


@dataclass(frozen=True, eq=False)
class AttractorSet(Sequence[Attractor]):
    """All long-term motions found at one excitation frequency, the largest pipe peak first.

    Attributes
    ----------
    attractors : tuple of Attractor
    frequency, detuning : float
        Of the excitation [rad/s].
    region : dict of str to tuple of float
        The region sampled.
    samples : int
        Number of initial states labelled.
    seed : int
    periods : int
        Most periods a motion was followed.
    outcome : Outcome
        INTERRUPTED if the sample was not finished.
    unverified : tuple of str
        What the search for the periodic responses behind them could not verify; empty if nothing.
    """

    def __repr__(self) -> str:
        rows = [
            f"{readable.motion(one.kind, one.period_multiple)}: pipe peak {readable.length(one.pipe_peak)},"
            f" basin {100 * one.basin_fraction:.3g} %"
            for one in self
        ]
        where = f"at {self.frequency:.6g} rad/s, {self.samples} initial states"
        return readable.listed(self.attractors, where, *rows, *self.unverified, name=type(self).__name__)

    attractors: tuple[Attractor, ...]
    frequency: float
    detuning: float
    region: Region
    samples: int
    seed: int
    periods: int
    outcome: Outcome
    unverified: tuple[str, ...] = ()

    @overload
    def __getitem__(self, index: int) -> Attractor: ...

    @overload
    def __getitem__(self, index: slice) -> tuple[Attractor, ...]: ...

    def __getitem__(self, index: int | slice) -> Attractor | tuple[Attractor, ...]:
        """One attractor, or several."""
        return self.attractors[index]

    def __len__(self) -> int:
        """Number of attractors."""
        return len(self.attractors)

    def __iter__(self) -> Iterator[Attractor]:
        """Over the attractors, the largest pipe peak first."""
        return iter(self.attractors)

    @property
    def missed_below(self) -> float:
        """Basin fraction p above which an attractor was missed with probability below 5 %: 1 - 0.05^(1/N) [-]."""
        return 1.0 - (1 - CONFIDENCE) ** (1 / self.samples) if self.samples else 1.0

    @property
    def statement(self) -> str:
        """What the sample says about attractors it has not met, and for which time its shares hold."""
        missed = (
            f"An attractor with basin fraction above {100 * self.missed_below:.2g} % of the region was missed with "
            f"probability below 5 % ({self.samples} initial states)."
        )
        return " ".join([missed, *(self._leak(attractor) for attractor in self if attractor.leaks)])

    def _leak(self, attractor: Attractor) -> str:
        thousand = 2 * np.pi / self.frequency * 1000
        rates = np.array([attractor.escape_rate, *attractor.escape_interval])
        rate, low, high = -100 * np.expm1(-rates * thousand)
        return (
            f"The {readable.motion(attractor.kind)} motion with a pipe peak of {attractor.pipe_peak:.4g} m is left in "
            f"the end: in 1000 periods by {rate:.3g} % of the motions on it (95 % interval {low:.2g} to {high:.2g} %). "
            f"Its share is that after {self.periods} periods."
        )

    def unsettled(self, least: float, where: str = "") -> list[str]:
        """A sentence for every share of the motions, of at least `least`, of which no attractor is known."""
        sentences = []
        for one in self:
            if one.kind == "unsettled" and one.basin_fraction >= least:
                waited = f"they had not settled after {self.periods} periods of the excitation."
                why = waited if one.outcome is Outcome.NOT_CONVERGED else one.outcome.value
                sentences.append(f"{100 * one.basin_fraction:.3g} % of the motions{where} are unsettled: {why}")
        return sentences

    def to_dataset(self) -> xr.Dataset:
        """All attractors, labelled, along the dimension `attractor`."""
        import xarray as xr

        numbers = {name: self._column(name) for name in _NUMBERS}
        variables = {name: labelled("attractor", values, *_NUMBERS[name]) for name, values in numbers.items()}
        for name, (field, long_name, units) in _PAIRS.items():
            variables[name] = labelled(("attractor", "bound"), self._column(field, 2), long_name, units)
        kinds = np.array([KINDS.index(attractor.kind) for attractor in self], dtype=np.int8)
        variables["kind"] = labelled("attractor", kinds, "kind of motion", "1", kinds=", ".join(KINDS))
        width = self.attractors[0].representative_state.size if self.attractors else 0
        variables["representative_state"] = labelled(
            ("attractor", "component"), self._column("representative_state", width),
            "state on the attractor, displacements and velocities in turn", "m, m/s",
        )  # fmt: skip
        return xr.Dataset(variables, attrs=self._attributes())

    def _column(self, name: str, *width: int) -> Floats:
        return np.array([getattr(attractor, name) for attractor in self], dtype=float).reshape(len(self), *width)

    def _attributes(self) -> dict[str, Any]:
        from frahm import __version__

        bounds = {f"region_{name}": list(pair) for name, pair in self.region.items()}
        return {
            "frahm": __version__, "frequency": self.frequency, "detuning": self.detuning, **bounds,
            "samples": self.samples, "seed": self.seed, "periods": self.periods, "outcome": self.outcome.value,
            "statement": self.statement, "unverified": " ".join(self.unverified),
        }  # fmt: skip


_NUMBERS = {
    "pipe_peak": ("largest displacement of the pipe", "m"),
    "relative_peak": ("largest displacement of the first element", "m"),
    "pipe_peak_expected": ("displacement of the pipe exceeded once in the return time", "m"),
    "relative_peak_expected": ("displacement of the first element exceeded once in the return time", "m"),
    "return_time": ("return time", "s"),
    "pipe_rms": ("root mean square displacement of the pipe", "m"),
    "relative_rms": ("root mean square displacement of the first element", "m"),
    "period_multiple": ("periods of the forcing after which the motion repeats, 0 if it does not", "1"),
    "beat_period": ("period of the strongest modulation", "s"),
    "lyapunov": ("largest Lyapunov exponent", "1/s"),
    "basin_fraction": ("share of the initial states that ends here", "1"),
    "escape_rate": ("motions that leave, per motion and time", "1/s"),
    "from_rest": ("whether the motion from rest ends here", "1"),
}
_PAIRS = {
    "pipe_peak_expected_interval": (
        "pipe_peak_expected_interval", "95 % interval of the displacement of the pipe exceeded once", "m",
    ),
    "relative_peak_expected_interval": (
        "relative_peak_expected_interval", "95 % interval of the displacement of the first element exceeded once", "m",
    ),
    "envelope": ("envelope", "smallest and largest peak of a period of the pipe", "m"),
    "relative_envelope": ("relative_envelope", "smallest and largest peak of a period of the first element", "m"),
    "lyapunov_interval": ("lyapunov_interval", "95 % interval of the largest Lyapunov exponent", "1/s"),
    "basin_interval": ("basin_interval", "95 % interval of the basin fraction", "1"),
    "escape_interval": ("escape_interval", "95 % interval of the rate at which motions leave", "1/s"),
}  # fmt: skip


def clopper_pearson(hits: int, samples: int, doubtful: int = 0) -> tuple[float, float]:
    """95 % interval of a probability from `hits` out of `samples`, of which `doubtful` more may be hits, too."""
    tail = (1 - CONFIDENCE) / 2
    low = float(beta.ppf(tail, hits, samples - hits + 1)) if hits else 0.0
    most = hits + doubtful
    high = float(beta.ppf(1 - tail, most + 1, samples - most)) if most < samples else 1.0
    return low, high
