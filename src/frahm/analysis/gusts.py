"""Step `gusts`: the pipe in the unsteady wind of the case, if it names one."""

from __future__ import annotations

from frahm.analysis.section import Section, Work
from frahm.errors import ParameterError
from frahm.time_integration import UnsteadyResponse, unsteady_response


def gusts(work: Work) -> Section:
    """Motion in the wind record or the turbulence of a case, with and without absorbers."""
    wind = work.case.wind
    if not wind.record and wind.turbulence is None:
        return Section()
    try:
        found = unsteady_response(work.case)
    except ParameterError as error:
        return Section(unverified=(f"The motion in unsteady wind was not computed: {error}.",))
    doubt = () if found.outcome.ok else (f"The motion in unsteady wind: {found.outcome.value}",)
    return Section(
        results={"unsteady_wind": _results(found)},
        data={"unsteady_wind": found.to_dataset()},
        unverified=doubt,
        notes=found.notes,
    )


def _results(found: UnsteadyResponse) -> dict[str, object]:
    with_them, without = found.reduction_by_gusts
    return {
        "record": found.record.source,
        "duration": found.duration,
        "mean_speed": found.record.mean_speed,
        "intensity": found.record.intensity,
        "pipe_peak": found.history.pipe_peak,
        "pipe_rms": found.history.pipe_rms(found.since),
        "relative_peak": found.history.relative_peak,
        "bare_pipe_peak": found.bare.pipe_peak,
        "bare_pipe_rms": found.bare.pipe_rms(found.since),
        "steady_pipe_rms": found.steady.pipe_rms(found.since),
        "bare_steady_pipe_rms": found.bare_steady.pipe_rms(found.since),
        "resonant_amplitude": found.resonant_amplitude,
        "reduction_by_absorbers": found.reduction_by_absorbers,
        "reduction_by_gusts": {"with_absorbers": with_them, "without_absorbers": without},
        "time_constant": found.time_constant,
        "build_up_time": found.build_up_time,
        "outcome": found.outcome.name,
    }
