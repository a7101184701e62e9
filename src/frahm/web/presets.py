"""The sinks of the paper (doi 10.3390/app12147272), one for each figure with a response curve."""

from __future__ import annotations

from dataclasses import dataclass

from frahm.case import Case, load_case
from frahm.published.yang2022 import MIDDLE, SOFT, STIFF, STIFF_LESS_DAMPED, STIFF_MORE_DAMPED, Sink


@dataclass(frozen=True)
class Preset:
    """One figure of the paper.

    Attributes
    ----------
    figure : int
        Number of the figure.
    sink : Sink
        Its sink; the pipe and the wind are those of the built-in case.
    """

    figure: int
    sink: Sink

    def case(self) -> Case:
        """The built-in case with this sink."""
        sink = self.sink
        case = load_case("jacket-pipe").with_absorber(kappa=sink.kappa, xi2=sink.xi2, rho2=sink.rho2)
        return case.with_name(f"yang2022-fig{self.figure}", f"Fig. {self.figure} of Yang et al. (2022)")


PRESETS = (
    Preset(5, MIDDLE),
    Preset(6, SOFT),
    Preset(7, STIFF),
    Preset(10, STIFF_LESS_DAMPED),
    Preset(11, STIFF_MORE_DAMPED),
)
