"""Room `structure`: the pipe as an elastic beam, its modes, and the stress they cause."""

from frahm.structure.beam import Beam, PointMass, Support
from frahm.structure.modal import ModalPipe, ShapeTable, modal_pipe
from frahm.structure.modes import BeamModes, beam_modes

__all__ = ["Beam", "BeamModes", "ModalPipe", "PointMass", "ShapeTable", "Support", "beam_modes", "modal_pipe"]
