"""What claims and figures are made of, each computed once, when it is first asked for."""

from __future__ import annotations

import functools
from collections.abc import Callable
from typing import NamedTuple, TypeVar

from frahm.loads import vortex_shedding
from frahm.published.yang2022 import Sink
from frahm.reproduction.cases import bare_case, case_of
from frahm.reproduction.motions import SettledMotions, motions_from_rest, motions_on_branches
from frahm.response import ResponseCurve, frequency_response, slow_flow_map
from frahm.slow_flow import SlowFlow, SlowMotion, integrate_slow_flow, slow_flow_of
from frahm.slow_flow.kernels import NO_ROOT, STABLE
from frahm.systems import build_system
from frahm.time_integration import TimeHistory, integrate

WINDOW = (-0.5, 0.5)
_POINTS = 8001
PERIODS = 1500
SAMPLES = 32
_T = TypeVar("_T")
State = tuple[float, float, float, float]
REST: State = (0.0, 0.0, 0.0, 0.0)


class Equilibrium(NamedTuple):
    """Amplitudes of pipe and relative displacement [m], and whether the response is stable."""

    pipe: float
    relative: float
    stable: bool


class Computations:
    """Response curves and motions of the paper's sinks, kept once computed."""

    def __init__(self) -> None:
        self.unverified: list[str] = []
        self._kept: dict[tuple[object, ...], object] = {}

    def curve(self, sink: Sink, form: str = "paper") -> ResponseCurve:
        """Every branch of the slow flow over the detuning."""
        return self._once(("curve", sink, form), functools.partial(_curve, sink, form), _curve_doubts)

    def exact_curve(self, sink: Sink) -> ResponseCurve:
        """Every periodic response of the exact equations over the detuning, by harmonic balance."""
        return self._once(("exact", sink), lambda: frequency_response(case_of(sink), detuning=WINDOW), _curve_doubts)

    def from_rest(self, sink: Sink) -> SettledMotions:
        """Exact motions from rest over the detuning."""
        return self._once(("rest", sink), functools.partial(motions_from_rest, sink), _motion_doubts)

    def on_branches(self, sink: Sink) -> SettledMotions:
        """Exact motions over the detuning, started on the stable equilibria of the slow flow."""
        return self._once(("branches", sink), functools.partial(motions_on_branches, sink), _motion_doubts)

    def equilibria(self, sink: Sink, detuning: float) -> list[Equilibrium]:
        """Equilibria of the slow flow of the paper at one detuning, ascending in relative amplitude."""
        found = slow_flow_map(case_of(sink), detuning=detuning, form="paper")
        columns = (found[name].values for name in ("pipe_amplitude", "relative_amplitude", "stability"))
        rows = zip(*columns, strict=True)
        return [Equilibrium(float(x), float(z), bool(code == STABLE)) for x, z, code in rows if code != NO_ROOT]

    def history(self, sink: Sink, detuning: float, state: State = REST) -> TimeHistory:
        """One exact motion in time."""
        return self._once(
            ("history", sink, detuning, state),
            lambda: integrate(
                case_of(sink), detuning=detuning, periods=PERIODS, initial_state=state, samples_per_period=SAMPLES
            ),
            _history_doubts,
        )

    def slow_motion(self, sink: Sink, detuning: float) -> SlowMotion:
        """The slow flow of the paper in time, from rest."""
        slow = self.slow_flow(sink)
        return self._once(
            ("slow", sink, detuning),
            lambda: integrate_slow_flow(slow, slow.omega + detuning, PERIODS, samples_per_period=SAMPLES),
            _history_doubts,
        )

    def slow_flow(self, sink: Sink) -> SlowFlow:
        """Parameters of the slow flow of the paper."""
        return slow_flow_of(build_system(case_of(sink)), "paper")

    @functools.cached_property
    def shedding_hz(self) -> float:
        """Shedding frequency at the paper's wind speed [Hz]."""
        return vortex_shedding(bare_case()).frequency_hz

    def bare_amplitude(self, sink: Sink) -> float:
        """Resonant amplitude F / (xi1 omega) without a sink [m]."""
        slow = self.slow_flow(sink)
        return slow.force / (slow.xi1 * slow.omega)

    def _once(self, key: tuple[object, ...], compute: Callable[[], _T], doubts: Callable[[_T], list[str]]) -> _T:
        if key not in self._kept:
            value = compute()
            self.unverified += [f"{key[1]}: {doubt}" for doubt in doubts(value)]
            self._kept[key] = value
        return self._kept[key]  # type: ignore[return-value]


def _curve(sink: Sink, form: str) -> ResponseCurve:
    return frequency_response(case_of(sink), detuning=WINDOW, method="slow-flow", form=form, points=_POINTS)


def _curve_doubts(curve: ResponseCurve) -> list[str]:
    return list(curve.unverified)


def _motion_doubts(motions: SettledMotions) -> list[str]:
    return [f"the motion at detuning {sigma:g} rad/s did not reach its end" for sigma in motions.detuning[~motions.ok]]


def _history_doubts(history: TimeHistory | SlowMotion) -> list[str]:
    return [] if history.outcome.ok else [history.outcome.value]
