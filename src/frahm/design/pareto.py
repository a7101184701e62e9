"""Trade-off of pipe amplitude, absorber mass and stroke: the Pareto front of the closed form."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

import numpy as np

from frahm.arrays import Floats, labelled
from frahm.case import Case, load_case
from frahm.design.absorber import UNITS, DesignedAbsorber, with_design
from frahm.design.disturbance import Disturbance
from frahm.design.host import host_of
from frahm.design.problem import WIDE
from frahm.design.screening import Screening
from frahm.design.settings import DesignSettings
from frahm.design.space import design_space
from frahm.errors import ParameterError, check_count, check_number
from frahm.loads import operating_range
from frahm.systems import build_system

if TYPE_CHECKING:
    import xarray as xr

_POINTS, _WIDE_POINTS = 101, 321


def pareto_front(
    case: Case | str,
    mass_ratio: tuple[float, float] = (0.005, 0.05),
    *,
    settings: DesignSettings | None = None,
    population: int = 60,
    generations: int = 60,
) -> xr.Dataset:
    """Designs no other beats in pipe amplitude, mass and stroke at once, by the closed form of one harmonic (NSGA-II).

    Every design keeps the force margin of the settings (no detached curve by the closed form) and is stable by the slow
    flow. Nothing here is verified: `design_absorber` at a mass of the front is.

    Parameters
    ----------
    case : Case or str
        A pipe in the wind.
    mass_ratio : tuple of float
        Range of the mass of the absorber over that of the pipe [-].
    settings : DesignSettings, optional
        Family, force margin, ranges and seed.
    population, generations : int
        Of the search.

    Returns
    -------
    xarray.Dataset
        Over `design`, ascending in mass: `rho2`, `linear`, `kappa`, `xi2`, `pipe_amplitude`, `relative_amplitude`.

    Raises
    ------
    ParameterError
        For bad input, or if pymoo is not installed.
    """
    case = load_case(case)
    asked = settings or DesignSettings()
    lo = check_number("mass_ratio[0]", mass_ratio[0], above=0, at_most=1)
    hi = check_number("mass_ratio[1]", mass_ratio[1], above=lo, at_most=1)
    population = check_count("population", population, at_least=8, at_most=10_000)
    generations = check_count("generations", generations, at_least=1, at_most=10_000)
    rows, judged = _searched(case, asked, (lo, hi), population, generations)
    order = np.argsort(rows[:, 0], kind="stable")
    return _dataset(case, rows[order] / case.pipe.mass, judged[order])


def _searched(
    case: Case, settings: DesignSettings, masses: tuple[float, float], population: int, generations: int
) -> tuple[Floats, Floats]:
    """Designs (D, 4) in SI units, and their amplitudes (D, 2) [m]."""
    try:
        from pymoo.algorithms.moo.nsga2 import NSGA2
        from pymoo.core.problem import Problem
        from pymoo.optimize import minimize
    except ImportError:
        hint = "Install it with: pip install 'frahm[uq]'."
        raise ParameterError("pareto_front", "pymoo is missing", "the package pymoo", hint=hint) from None
    host = host_of(build_system(with_design(case, DesignedAbsorber(masses[0], 0.0, 1.0, 0.0))))
    omega, nominal = host.frequency, [Disturbance()]
    within = operating_range(case, most_mass_ratio=masses[1])
    lift = np.vectorize(within.lift_factor, otypes=[float]) if within.over_wind else None
    wide = within.frequency if within.over_wind else (WIDE[0] * omega, WIDE[1] * omega)
    screening = Screening(
        host,
        host.conditions(nominal, within.frequency, _POINTS, moving=False, lift=lift),
        host.conditions(nominal, wide, _WIDE_POINTS, lift=lift),
    )
    space = design_space(host, case.pipe.mass, settings.family, settings.changed(mass_ratio=masses))

    def judged(rows: Floats) -> tuple[Floats, Floats]:
        peaks, others = screening.responses(rows)
        objectives = np.column_stack([peaks[:, 0], rows[:, 0], others[:, 0]])
        births = np.minimum(screening.births(rows), 10.0)
        limit = settings.most_stroke
        stroke = np.minimum(others[:, 0] - limit, 1.0) if math.isfinite(limit) else np.full(len(rows), -1.0)
        return objectives, np.column_stack([settings.force_margin - births, others[:, 1], stroke])

    class Designs(Problem):
        def __init__(self) -> None:
            super().__init__(n_var=space.size, n_obj=3, n_ieq_constr=3, xl=0.0, xu=1.0)

        def _evaluate(self, x: Floats, out: dict, *args: object, **kwargs: object) -> None:
            out["F"], out["G"] = judged(space.designs(np.asarray(x)))

    result = minimize(Designs(), NSGA2(pop_size=population), ("n_gen", generations), seed=settings.seed)
    if result.X is None:
        raise ParameterError("limits", f"force margin {settings.force_margin:g}", "limits that a design can keep")
    return space.designs(np.atleast_2d(result.X)), np.atleast_2d(result.F)[:, [0, 2]]


def _dataset(case: Case, rows: Floats, judged: Floats) -> xr.Dataset:
    import xarray as xr

    from frahm import __version__

    variables = {
        name: labelled("design", rows[:, column], f"{name} over mass of the pipe", unit)
        for column, (name, unit) in enumerate(UNITS.items())
    }
    variables["pipe_amplitude"] = labelled("design", judged[:, 0], "largest first-harmonic pipe amplitude", "m")
    variables["relative_amplitude"] = labelled("design", judged[:, 1], "largest first-harmonic stroke", "m")
    attributes = {"frahm": __version__, "case": case.name, "tier": "closed form of one harmonic, unverified"}
    return xr.Dataset(variables, attrs=attributes)
