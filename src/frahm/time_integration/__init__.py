"""Room `time_integration`: trajectories and batches of them, spectra, envelopes and Poincare sections."""

from frahm.time_integration.batch import BatchResult, integrate_batch
from frahm.time_integration.history import TimeHistory, integrate
from frahm.time_integration.signals import Peaks

__all__ = ["BatchResult", "Peaks", "TimeHistory", "integrate", "integrate_batch"]
