"""Room `loads`: what the wind does to the pipe."""

from frahm.loads.amplitudes import (
    AmplitudeEstimate,
    AmplitudeEstimates,
    amplitude_estimates,
    forced_amplitude,
    griffin_skop_amplitude,
    sarpkaya_amplitude,
)
from frahm.loads.case_ranges import operating_range, other_ranges
from frahm.loads.climate import Persistence, WindClimate, persistence, wind_climate
from frahm.loads.correlation import Antinodes, antinodes, correlation_length
from frahm.loads.eurocode import LoadCycles, SpectralAmplitude, eurocode_amplitude, load_cycles, spectral_amplitude
from frahm.loads.mode_factors import ModeFactors, mode_factors
from frahm.loads.onset import Criterion, onset_criteria, onset_sentence
from frahm.loads.operating_range import OperatingRange, frequency_range
from frahm.loads.over_wind import (
    ExcitationOverWind,
    WindExcitation,
    excitation_over_wind,
    speed_window,
    wind_excitation,
)
from frahm.loads.record import WindRecord, read_record, spectral_density, turbulent_record
from frahm.loads.reynolds import ReynoldsCurve, lift_curve, strouhal_curve
from frahm.loads.similarity import (
    LockInBand,
    Similarity,
    lock_in_band,
    resonant_shedding,
    scruton_number,
    similarity,
    skop_griffin_number,
)
from frahm.loads.site import excited_bands, locking_wind, site_winds, split_resonances
from frahm.loads.vortex import (
    AIR_VISCOSITY,
    VortexShedding,
    lift_amplitude,
    reduced_velocity,
    reynolds_number,
    shedding_frequency,
    vortex_shedding,
)
from frahm.loads.wake_oscillator import WakeOscillator, WakeState

__all__ = [
    "AIR_VISCOSITY",
    "AmplitudeEstimate",
    "AmplitudeEstimates",
    "Antinodes",
    "Criterion",
    "ExcitationOverWind",
    "LoadCycles",
    "LockInBand",
    "ModeFactors",
    "OperatingRange",
    "Persistence",
    "ReynoldsCurve",
    "Similarity",
    "SpectralAmplitude",
    "VortexShedding",
    "WakeOscillator",
    "WakeState",
    "WindClimate",
    "WindExcitation",
    "WindRecord",
    "amplitude_estimates",
    "antinodes",
    "correlation_length",
    "eurocode_amplitude",
    "excitation_over_wind",
    "excited_bands",
    "forced_amplitude",
    "frequency_range",
    "griffin_skop_amplitude",
    "lift_amplitude",
    "lift_curve",
    "load_cycles",
    "lock_in_band",
    "locking_wind",
    "mode_factors",
    "onset_criteria",
    "onset_sentence",
    "operating_range",
    "other_ranges",
    "persistence",
    "read_record",
    "reduced_velocity",
    "resonant_shedding",
    "reynolds_number",
    "sarpkaya_amplitude",
    "scruton_number",
    "shedding_frequency",
    "similarity",
    "site_winds",
    "skop_griffin_number",
    "spectral_amplitude",
    "spectral_density",
    "speed_window",
    "split_resonances",
    "strouhal_curve",
    "turbulent_record",
    "vortex_shedding",
    "wind_climate",
    "wind_excitation",
]
