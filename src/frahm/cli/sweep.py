"""The command sweep: a parameter study into a store, and what a store says."""

from __future__ import annotations

import contextlib
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from frahm.cli.guarded import ExitCode, held_interrupts
from frahm.cli.notes import say_notes

if TYPE_CHECKING:
    from concurrent.futures import Executor

    from frahm.sweep import SweepSummary


def sweep(
    study: Annotated[str, typer.Argument(metavar="STUDY", help="YAML or TOML file of a study; see frahm new --study.")],
    store: Annotated[Path, typer.Option("--store", help="Folder of the zarr store to write.")],
    scheduler: Annotated[
        str | None, typer.Option(metavar="ADDRESS", help="Of a Dask scheduler, such as tcp://127.0.0.1:8786.")
    ] = None,
    processes: Annotated[
        int | None, typer.Option(metavar="N", help="Processes on this machine; without it, threads.")
    ] = None,
    resume: Annotated[bool, typer.Option("--resume", help="Go on with the store where it stopped.")] = False,
    force: Annotated[bool, typer.Option("--force", help="Replace the store of another study, or of this one.")] = False,
) -> None:
    """Compute a parameter study into a store, on this machine or on a Dask cluster."""
    import warnings

    from frahm.cli.progress import shown_progress

    with shown_progress() as progress:
        progress("loading", 0, 1)
        with held_interrupts():
            import xarray  # noqa: F401 - imported here, where nothing can stop it half-way

            from frahm.sweep import SweepWarning, load_study, summary_of
            from frahm.sweep import sweep as compute
        loaded = load_study(study)
        say_notes(loaded.case)
        progress.weigh(())
        try:
            with warnings.catch_warnings(record=True) as caught, _workers(scheduler, processes) as executor:
                warnings.simplefilter("always", SweepWarning)
                compute(loaded, store=store, executor=executor, resume=resume, force=force, progress=progress)
        except KeyboardInterrupt:
            _interrupted(study, store, scheduler, processes)
    sentences = [str(warning.message) for warning in caught if issubclass(warning.category, SweepWarning)]
    _conclude(summary_of(store), store, sentences)


def _workers(
    scheduler: str | None, processes: int | None
) -> contextlib.AbstractContextManager[Executor] | contextlib.AbstractContextManager[None]:
    """The cluster or the processes asked for; without either the threads of this machine."""
    from frahm.errors import ParameterError
    from frahm.sweep import processes as local

    if scheduler is None:
        return contextlib.nullcontext() if processes is None else local(processes)
    if processes is not None:
        raise ParameterError("--processes", processes, "nothing beside --scheduler, whose workers do the work")
    from frahm.sweep.cluster import scheduler as cluster

    return cluster(scheduler)


def _interrupted(study: str, store: Path, scheduler: str | None, processes: int | None) -> None:
    """Say how far it came and how to go on."""
    from frahm.sweep import is_sweep, summary_of

    if not is_sweep(store):
        raise KeyboardInterrupt
    more = f" --scheduler {scheduler}" if scheduler else f" --processes {processes}" if processes else ""
    typer.echo(f"frahm: interrupted. {summary_of(store).counts}.", err=True)
    typer.echo(f"frahm: go on with: frahm sweep {study} --store {store}{more} --resume", err=True)
    raise typer.Exit(ExitCode.INTERRUPTED)


def _conclude(summary: SweepSummary, store: Path, sentences: list[str]) -> None:
    for line in _extremes(summary):
        typer.echo(line)
    typer.echo(f"{summary.counts}.")
    typer.echo(f"Store: {store} (frahm show {store}; in Python: xarray.open_zarr({str(store)!r}))")
    for sentence in sentences:
        typer.echo(f"frahm: {sentence}", err=True)
    if not summary.good:
        raise typer.Exit(ExitCode.UNVERIFIED)


def stored_sweep_text(folder: Path) -> str | None:
    """What a store of `frahm sweep` says, as text; None if the folder holds something else."""
    from frahm.cli.folder import holds_sweep

    if not holds_sweep(folder):
        return None
    from frahm.sweep import summary_of

    summary = summary_of(folder)
    study = summary.study
    lines = [f"{study.name}: {study.title}" if study.title else study.name, ""]
    lines += [f"Case {study.case.name}; made by frahm {summary.version}", "", "Axes", *_axes(summary)]
    lines += ["", "Points", f"  {summary.counts}", *(f"  {trouble}" for trouble in summary.troubles)]
    found = list(_extremes(summary))
    lines += ["", "Best and worst", *(f"  {line}" for line in found)] if found else []
    return "\n".join(lines)


def _axes(summary: SweepSummary) -> list[str]:
    from frahm.sweep import values_text

    axes = summary.study.axes_given
    width = max(map(len, axes))
    return [
        f"  {name:<{width}}  {len(values)} values, {values_text({name: values[0]}).removeprefix(name).strip()}"
        + (f" to {values_text({name: values[-1]}).removeprefix(name).strip()}" if len(values) > 1 else "")
        for name, values in axes.items()
    ]


def _extremes(summary: SweepSummary) -> list[str]:
    from frahm.sweep import values_text

    lines = []
    for e in summary.extremes:
        unit = f" {e.variable.units}" if e.variable.units != "1" else ""
        lines.append(f"{e.variable.name}, the {e.variable.long_name}")
        for word, value, at, sure in (("best ", e.best, e.best_at, e.best_verified),
                                      ("worst", e.worst, e.worst_at, e.worst_verified)):  # fmt: skip
            doubt = "" if sure else "   UNVERIFIED"
            lines.append(f"  {word} {value:#.4g}{unit} at {values_text(at)}{doubt}")
    return lines
