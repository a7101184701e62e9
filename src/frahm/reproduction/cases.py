"""The pipe of the paper with each of its sinks, as cases."""

from __future__ import annotations

from frahm.case import Case, load_case
from frahm.published.yang2022 import PIPE, Sink


def bare_case() -> Case:
    """The pipe of the paper in its wind, without a sink."""
    case = load_case("jacket-pipe").without_absorbers()
    case = case.with_pipe(
        mass=PIPE.mass,
        length=1.0,
        frequency=f"{PIPE.natural_frequency_hz} Hz",
        damping_ratio=PIPE.damping_ratio,
        diameter=PIPE.diameter,
    )
    return case.with_wind(
        speed=PIPE.wind_speed,
        air_density=PIPE.air_density,
        strouhal=PIPE.strouhal,
        lift_coefficient=PIPE.lift_coefficient,
    )


def case_of(sink: Sink) -> Case:
    """The pipe of the paper with one of its sinks."""
    name = f"kappa {sink.kappa:g}, xi2 {sink.xi2:g}"
    return bare_case().with_absorber(kappa=sink.kappa, xi2=sink.xi2, rho2=sink.rho2).with_name(name, title="")
