"""`FatigueDamage`: damage with and without absorbers over a wind climate, and how far it can be trusted."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np

from frahm import readable
from frahm.arrays import Floats, labelled
from frahm.assessment.rainflow_cycles import CONVENTION
from frahm.attractors.attractor import KINDS
from frahm.case import Case
from frahm.loads import Persistence
from frahm.published.dnv_rp_c203 import SOURCE
from frahm.readable import YEAR

if TYPE_CHECKING:
    import xarray as xr


@dataclass(frozen=True, eq=False)
class FatigueDamage:
    """Palmgren-Miner damage over the duration of a wind climate, vortex shedding in a band of wind speeds only.

    Attributes
    ----------
    damage_with : float
        With the absorbers of the case, the worst attractor found at every wind: a bound over the basins [-].
    damage_with_weighted : float
        The same with every attractor weighted by its basin fraction [-].
    damage_without : float
        Without absorbers, closed form [-].
    locked_in_with, locked_in_without : float
        If at every wind of the lock-in band the pipe moved as it does at the worst of them [-]: lock-in can hold the
        shedding at the natural frequency over a whole band of speeds, which the forced model does not know. Secondary.
    lock_in : (float, float)
        That band [m/s].
    outside_without : float
        Damage by winds outside the band, without absorbers [-]; not part of the others. Where the damage of several
        modes is summed, by winds outside the band of every mode.
    outside_wind : float
        Wind that does most of it [m/s]; NaN if none does any.
    speeds, lower, upper : ndarray, shape (b,)
        Middle and ends of the wind bins [m/s].
    frequencies, detunings : ndarray, shape (b,)
        Shedding at the middles [rad/s].
    probabilities : ndarray, shape (b,)
        Share of the time [-].
    bin_with, bin_weighted, bin_without : ndarray, shape (b,)
        Damage by bin [-].
    range_with, range_without : ndarray, shape (b,)
        Largest hot-spot stress range [Pa]: of the worst attractor at the middle; anywhere in the bin.
    kinds : tuple of str, length b
        Kind of the worst attractor.
    attractors : ndarray of int, shape (b,)
        How many were found.
    unsettled : ndarray, shape (b,)
        Share of the sampled motions that ended on none [-].
    binning : float
        Relative change of `damage_with` if the rates are linear between the middles instead of even in each bin.
    persistence : Persistence
        How long the wind stays in the lock-in band, against the time the response needs to build up; secondary.
    stress_range_without : float
        Hot-spot stress range of the resonance in the band without absorbers [Pa].
    section : float or None
        Where the stress is taken along an elastic pipe [m].
    unverified : tuple of str
        Sentences: what speaks against the numbers.
    notes : tuple of str
        Sentences: what a reader must know.
    case : Case
    settings : dict
    """

    __repr__ = readable.summary

    damage_with: float
    damage_with_weighted: float
    damage_without: float
    locked_in_with: float
    locked_in_without: float
    outside_without: float
    outside_wind: float
    lock_in: tuple[float, float]
    speeds: Floats
    lower: Floats
    upper: Floats
    frequencies: Floats
    detunings: Floats
    probabilities: Floats
    bin_with: Floats
    bin_weighted: Floats
    bin_without: Floats
    range_with: Floats
    range_without: Floats
    kinds: tuple[str, ...]
    attractors: np.ndarray
    unsettled: Floats
    binning: float
    persistence: Persistence
    stress_range_without: float
    section: float | None
    unverified: tuple[str, ...]
    notes: tuple[str, ...]
    case: Case
    settings: dict[str, Any]

    @property
    def verified(self) -> bool:
        """Whether nothing speaks against the numbers."""
        return not self.unverified

    @property
    def duration_years(self) -> float:
        """Duration of the climate [years]."""
        return float(self.settings["duration"]) / YEAR

    @property
    def design_fatigue_factor(self) -> float:
        """Factor on the damage before it is held against one [-]."""
        return float(self.settings["design_fatigue_factor"])

    @property
    def life_years(self) -> float:
        """Years until `damage_with` times the design fatigue factor is one; infinite without damage."""
        return self._life(self.damage_with)

    @property
    def life_years_without(self) -> float:
        """The same without absorbers."""
        return self._life(self.damage_without)

    def to_dataset(self) -> xr.Dataset:
        """All wind bins, labelled, along the dimension `bin`."""
        import xarray as xr

        from frahm import __version__

        columns = {name: labelled("bin", getattr(self, field), *rest) for name, (field, *rest) in _COLUMNS.items()}
        codes = np.array([_KINDS.index(kind) for kind in self.kinds], dtype=np.int8)
        columns["kind"] = labelled("bin", codes, "kind of the worst attractor", "1", kinds=", ".join(_KINDS))
        numbers = {name: getattr(self, name) for name in _SCALARS}
        settings = {key: value for key, value in self.settings.items() if value is not None}
        return xr.Dataset(
            columns,
            attrs={
                "frahm": __version__, "case": self.case.name, **numbers, **settings, "rainflow": CONVENTION,
                "sn_curve_source": SOURCE, "verified": int(self.verified), "unverified": " ".join(self.unverified),
            },
        )  # fmt: skip

    def _life(self, damage: float) -> float:
        used = damage * self.design_fatigue_factor
        return float("inf") if used == 0 else self.duration_years / used


_KINDS = (*KINDS, "linear")
_SCALARS = (
    "damage_with", "damage_with_weighted", "damage_without", "locked_in_with", "locked_in_without", "outside_without",
    "life_years", "life_years_without",
)  # fmt: skip
_COLUMNS = {
    "speed": ("speeds", "wind speed at the middle of the bin", "m/s"),
    "speed_lower": ("lower", "lowest wind speed of the bin", "m/s"),
    "speed_upper": ("upper", "highest wind speed of the bin", "m/s"),
    "frequency": ("frequencies", "shedding frequency Omega at the middle of the bin", "rad/s"),
    "detuning": ("detunings", "detuning sigma = Omega - omega at the middle of the bin", "rad/s"),
    "probability": ("probabilities", "share of the time the wind is in the bin", "1"),
    "damage_with": ("bin_with", "damage with absorbers, worst attractor", "1"),
    "damage_with_weighted": ("bin_weighted", "damage with absorbers, weighted by basin fractions", "1"),
    "damage_without": ("bin_without", "damage without absorbers", "1"),
    "stress_range_with": ("range_with", "largest hot-spot stress range of the worst attractor", "Pa"),
    "stress_range_without": ("range_without", "largest hot-spot stress range without absorbers", "Pa"),
    "attractors": ("attractors", "number of attractors found", "1"),
    "unsettled": ("unsettled", "share of the sampled motions that ended on no attractor", "1"),
}
