"""Room `time_integration`: trajectories and batches of them, spectra, envelopes and Poincare sections."""

from frahm.time_integration.batch import BatchResult, integrate_batch
from frahm.time_integration.driven_history import DrivenHistory
from frahm.time_integration.history import TimeHistory, integrate
from frahm.time_integration.signals import Peaks
from frahm.time_integration.unsteady import UnsteadyResponse, unsteady_response
from frahm.time_integration.wake import LockInCurve, WakeResponse, wake_response

__all__ = [
    "BatchResult",
    "DrivenHistory",
    "LockInCurve",
    "Peaks",
    "TimeHistory",
    "UnsteadyResponse",
    "WakeResponse",
    "integrate",
    "integrate_batch",
    "unsteady_response",
    "wake_response",
]
