"""Design of nonlinear energy sinks against vortex-induced vibration of pipes, with proof that the design is safe."""

from __future__ import annotations

import importlib
from typing import Any

from frahm.lazy import submodules

__version__ = "0.1.0"

# Public name -> room. Rooms are imported on first use, so that `import frahm` and `frahm --help` stay quick.
_PUBLIC = {
    "Case": "frahm.case",
    "load_case": "frahm.case",
    "plausibility": "frahm.plausibility",
    "ParameterError": "frahm.errors",
    "ConvergenceError": "frahm.errors",
    "Outcome": "frahm.errors",
    "Bistable": "frahm.absorbers",
    "Cubic": "frahm.absorbers",
    "Friction": "frahm.absorbers",
    "Linear": "frahm.absorbers",
    "Polynomial": "frahm.absorbers",
    "Stops": "frahm.absorbers",
    "TransverseSprings": "frahm.absorbers",
    "Element": "frahm.systems",
    "System": "frahm.systems",
    "build_system": "frahm.systems",
    "stress_row": "frahm.systems",
    "Beam": "frahm.structure",
    "BeamModes": "frahm.structure",
    "PointMass": "frahm.structure",
    "Support": "frahm.structure",
    "beam_modes": "frahm.structure",
    "integrate": "frahm.time_integration",
    "TimeHistory": "frahm.time_integration",
    "unsteady_response": "frahm.time_integration",
    "UnsteadyResponse": "frahm.time_integration",
    "WindRecord": "frahm.loads",
    "wake_response": "frahm.time_integration",
    "WakeResponse": "frahm.time_integration",
    "WakeOscillator": "frahm.loads",
    "frequency_response": "frahm.response",
    "periodic_responses": "frahm.response",
    "ResponseCurve": "frahm.response",
    "PeriodicResponse": "frahm.harmonic_balance",
    "slow_flow_map": "frahm.response",
    "stability_boundaries": "frahm.response",
    "bifurcation_curve": "frahm.response",
    "detached_curve_events": "frahm.response",
    "find_attractors": "frahm.attractors",
    "Attractor": "frahm.attractors",
    "AttractorSet": "frahm.attractors",
    "basin_map": "frahm.attractors",
    "worst_case": "frahm.attractors",
    "modulated_response": "frahm.attractors",
    "modulated_branches": "frahm.attractors",
    "ModulatedCurve": "frahm.attractors",
    "WorstCase": "frahm.attractors",
    "fatigue_damage": "frahm.assessment",
    "FatigueDamage": "frahm.assessment",
    "design_absorber": "frahm.design",
    "DesignSettings": "frahm.design",
    "DesignStudy": "frahm.design",
    "DesignedAbsorber": "frahm.design",
    "screen_members": "frahm.screening",
    "MemberScreen": "frahm.screening",
    "ScreenedMember": "frahm.screening",
    "design_products": "frahm.products",
    "ProductStudy": "frahm.products",
    "sweep": "frahm.sweep",
    "Study": "frahm.sweep",
    "SweepWarning": "frahm.sweep",
    "load_study": "frahm.sweep",
    "read_data": "frahm.exchange",
    "read_table": "frahm.exchange",
    "read_time_series": "frahm.exchange",
    "write_data": "frahm.exchange",
    "write_time_history": "frahm.exchange",
}

__all__ = ["__version__", *_PUBLIC]

_room = submodules(__name__)


def __getattr__(name: str) -> Any:
    room = _PUBLIC.get(name)
    if room is None:
        return _room(name)
    module = importlib.import_module(room)
    # A room that is called like its verb can itself be called: `import frahm.sweep` leaves that very attribute.
    value = module if room == f"{__name__}.{name}" else getattr(module, name)
    globals()[name] = value
    return value


def __dir__() -> list[str]:
    return sorted(__all__)
