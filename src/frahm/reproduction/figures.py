"""Figures 3 to 12 of the paper, from the computations."""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING

import numpy as np

from frahm.published.yang2022 import (
    MIDDLE,
    PIPE,
    SOFT,
    SOFT_LESS_DAMPED,
    SOFT_MORE_DAMPED,
    STIFF,
    STIFF_LESS_DAMPED,
    STIFF_MORE_DAMPED,
    Sink,
)
from frahm.reproduction.claims_of_motions import THREES
from frahm.reproduction.computations import Computations
from frahm.reproduction.motions import SettledMotions
from frahm.slow_flow import SlowMotion
from frahm.time_integration import TimeHistory

if TYPE_CHECKING:
    from matplotlib.figure import Figure

    from frahm.plotting.paper_figures import Motions
    from frahm.plotting.paper_motions import Spectrum, Trace

_LOWER_STATE_DETUNING = -0.144  # [rad/s], of Fig. 8
_SPECTRUM_PERIODS = 1000
_HALF_SPACING = 4  # every eighth motion is drawn from rest, every eighth in between from a branch
_SETTLED = 20  # periods at the end


def figures() -> dict[str, Callable[[Computations], Figure]]:
    """Return the figures by file name, each as a function that draws it."""
    return {
        "fig03": _histories,
        "fig04": _spectra,
        "fig05": lambda computed: _response(computed, MIDDLE, (-0.2, 0.2)),
        "fig06": lambda computed: _response(computed, SOFT, (-0.2, 0.2)),
        "fig07": lambda computed: _response(computed, STIFF, (-0.3, 0.3)),
        "fig08": _two_starts,
        "fig09": _comparison,
        "fig10": lambda computed: _response(computed, STIFF_LESS_DAMPED, (-0.4, 0.4)),
        "fig11": lambda computed: _response(computed, STIFF_MORE_DAMPED, (-0.3, 0.3)),
        "fig12": _dampings,
    }


def _histories(computed: Computations) -> Figure:
    from frahm.plotting.paper_motions import histories_figure

    slow, exact = computed.slow_motion(MIDDLE, 0.0), computed.history(MIDDLE, 0.0)
    return histories_figure(_slow_trace(slow), _trace(exact), end=600.0)


def _spectra(computed: Computations) -> Figure:
    from frahm.plotting.paper_motions import Spectrum, spectra_figure

    exact = computed.history(MIDDLE, 0.0).last(_SPECTRUM_PERIODS)
    lines = exact.spectrum()
    frequency = lines["frequency_hz"].values
    slow = computed.slow_motion(MIDDLE, 0.0)
    count = 2 * (frequency.size - 1)
    return spectra_figure(
        _slow_spectrum(slow, count),
        Spectrum(frequency, lines["pipe_amplitude"].values, lines["relative_amplitude"].values),
        PIPE.natural_frequency_hz,
        (0.7, 0.86),
    )


def _two_starts(computed: Computations) -> Figure:
    from frahm.plotting.paper_motions import two_starts_figure

    rest = computed.history(STIFF, _LOWER_STATE_DETUNING)
    pushed = computed.history(STIFF, _LOWER_STATE_DETUNING, THREES)
    largest, final = pushed.peaks(), pushed.last(_SETTLED).peaks()
    return two_starts_figure(_trace(rest), _trace(pushed), largest, final, end=1200.0)


def _response(computed: Computations, sink: Sink, window: tuple[float, float]) -> Figure:
    from frahm.plotting.paper_figures import response_figure

    title = rf"$\kappa$ = {sink.kappa:g} 1/(m$^2$ s$^2$), $\xi_2$ = {sink.xi2:g} 1/s"
    motions = _thinned(computed.from_rest(sink), computed.on_branches(sink))
    curves = (computed.curve(sink), computed.curve(sink, "averaged"), computed.exact_curve(sink))
    return response_figure(*curves, motions, window, title)


def _comparison(computed: Computations) -> Figure:
    from frahm.plotting.paper_figures import comparison_figure

    slow, sigma = computed.slow_flow(SOFT), np.linspace(-0.5, 0.5, 4001)
    bare = slow.force / (2 * slow.omega * np.hypot(sigma, slow.xi1 / 2))
    curves = [(rf"$\kappa$ = {sink.kappa:g} 1/(m$^2$ s$^2$)", computed.curve(sink)) for sink in (SOFT, MIDDLE, STIFF)]
    return comparison_figure((sigma, bare), curves)


def _dampings(computed: Computations) -> Figure:
    from frahm.plotting.paper_figures import damping_figure

    families = ((STIFF_LESS_DAMPED, STIFF, STIFF_MORE_DAMPED), (SOFT_LESS_DAMPED, SOFT, SOFT_MORE_DAMPED))
    left, right = ([(rf"$\xi_2$ = {sink.xi2:g} 1/s", computed.curve(sink)) for sink in family] for family in families)
    titles = tuple(rf"$\kappa$ = {family[0].kappa:g} 1/(m$^2$ s$^2$)" for family in families)
    return damping_figure(left, right, (titles[0], titles[1]))


def _thinned(rest: SettledMotions, branches: SettledMotions) -> Motions:
    """Motions from rest at every eighth detuning, those on branches half-way between them."""
    from frahm.plotting.paper_figures import Motions

    parts = []
    for motions, offset in ((rest, 0), (branches, _HALF_SPACING)):
        index = np.searchsorted(np.unique(rest.detuning), motions.detuning)
        parts.append(motions.where((index % (2 * _HALF_SPACING) == offset) & motions.ok))
    columns = ("detuning", "pipe_peak", "relative_peak", "modulated")
    return Motions(*(np.concatenate([getattr(part, name) for part in parts]) for name in columns))


def _trace(history: TimeHistory) -> Trace:
    from frahm.plotting.paper_motions import Trace

    return Trace(history.time, history.x1, history.z)


def _slow_trace(motion: SlowMotion) -> Trace:
    from frahm.plotting.paper_motions import Trace

    return Trace(motion.time, motion.x1(), motion.z())


def _slow_spectrum(motion: SlowMotion, count: int) -> Spectrum:
    """One-sided amplitudes of the last `count` samples under a Hann window."""
    from frahm.plotting.paper_motions import Spectrum

    weights = np.asarray(np.hanning(count + 1)[:-1], dtype=float)
    spacing = float(motion.time[1] - motion.time[0])
    x1, z = (2 * np.abs(np.fft.rfft(weights * values[-count:])) / weights.sum() for values in (motion.x1(), motion.z()))
    return Spectrum(np.asarray(np.fft.rfftfreq(count, spacing), dtype=float), x1, z)
