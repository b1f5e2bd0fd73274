"""`leblanc sweep`: a grid or a sample of scenes, resumable, on one machine or a cluster."""

from __future__ import annotations

import sys
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from leblanc.core.contents import results_dir
from leblanc.core.terminal import print_json, say

if TYPE_CHECKING:
    from collections.abc import Callable

    from leblanc.results.sweep import SweepResult
    from leblanc.studies.sweep.emulator import Emulator
    from leblanc.studies.sweep.study import Sweep

_SHOWN = 10  # kinds of reasons


def sweep(
    study: Annotated[Path, typer.Argument(help="Study file (TOML).")],
    workers: Annotated[
        int | None, typer.Option(min=0, help="Local processes, 0 for none but this [default: the cores].")
    ] = None,
    scheduler: Annotated[
        str | None, typer.Option(help="Address of a Dask scheduler, in place of local processes.")
    ] = None,
    fresh: Annotated[bool, typer.Option("--fresh", help="Start anew, without what is in the store.")] = False,
    netcdf: Annotated[bool, typer.Option("--netcdf", help="Write a netCDF copy of the store.")] = False,
    emulate: Annotated[
        bool, typer.Option("--emulate", help="Fit emulators to the outputs and tell their errors.")
    ] = False,
    out: Annotated[
        Path | None, typer.Option(help="Folder for the files [default: out/<study name>].")
    ] = None,
    json: Annotated[bool, typer.Option("--json", help="Print one JSON object instead of words.")] = False,
) -> None:
    """Answers of many scenes that differ in a few values. The same command goes on after a stop."""
    from leblanc.studies.models.validity import doubts
    from leblanc.studies.sweep.sampling import sampling_note
    from leblanc.studies.sweep.study import load_sweep

    plan = load_sweep(study)
    for doubt in doubts(plan.scene, plan.table):
        say(f"{plan.scene_path}: warning: {doubt.text}")
    folder = results_dir(plan.name, out, study, plan.scene.digest, *(["sweep.nc"] if netcdf else []))
    note = sampling_note(plan)
    if note is not None:
        say(f"{plan.name}: {note}")

    result = _run(plan, folder, workers, scheduler, fresh)
    if netcdf:
        from leblanc.core.netcdf import write_netcdf

        write_netcdf(result.named_arrays(), folder / "sweep.nc")
    emulators = None
    if emulate:
        from leblanc.studies.sweep.emulator import emulated_outputs
        from leblanc.studies.sweep.store import read_store

        emulators = emulated_outputs(read_store(result.store), plan.seed)
    if json:
        print_json(result.to_json() | _emulator_json(emulators))
    else:
        from leblanc.text.sweep import lines

        print("\n".join([*lines(result), *_emulator_lines(emulators)]))
    _finish(result)


def _emulator_json(emulators: dict[str, Emulator | str] | None) -> dict[str, Any]:
    """Cross-validated errors by output, or why there is none."""
    if emulators is None:
        return {}
    return {
        "emulators": {
            name: {"reason": emulator}
            if isinstance(emulator, str)
            else {"settled": emulator.settled, "error": emulator.error}
            for name, emulator in emulators.items()
        }
    }


def _emulator_lines(emulators: dict[str, Emulator | str] | None) -> list[str]:
    """The same as text."""
    lines = []
    for name, emulator in (emulators or {}).items():
        label = f"emulator of {name.replace('_', ' ')}"
        if isinstance(emulator, str):
            lines.append(f"{label}: none; {emulator}")
            continue
        error, of = emulator.error, "" if emulator.positive else " of the spread"
        lines.append(
            f"{label}: off by {error.root_mean_square:.2g}{of} on unseen samples (root mean square; "
            f"largest {error.largest:.2g}, by the mean alone {error.spread:.2g}), "
            f"{error.within_two:.0%} within twice what it claims"
        )
    return lines


def _run(plan: Sweep, folder: Path, workers: int | None, scheduler: str | None, fresh: bool) -> SweepResult:
    """Do what is missing, with a bar on a terminal."""
    from rich.console import Console
    from rich.progress import BarColumn, MofNCompleteColumn, Progress, TextColumn, TimeRemainingColumn

    from leblanc.studies.sweep.summary import sweep_result

    columns = (TextColumn("samples"), BarColumn(), MofNCompleteColumn(), TimeRemainingColumn())
    console, quiet = Console(stderr=True), not sys.stderr.isatty()
    with Progress(*columns, console=console, transient=True, disable=quiet) as bar:
        task = bar.add_task("samples", total=None)
        show: Callable[[int, int], None] = lambda done, total: bar.update(task, completed=done, total=total)  # noqa: E731
        return sweep_result(plan, folder, workers, scheduler, fresh, show)


def _finish(found: SweepResult) -> None:
    """Say on stderr how it went; with no sample done at all that is a failure."""
    from leblanc.core.answer import NotConverged
    from leblanc.scene.schema.load import SceneError, SceneFault

    for reason, count in found.reasons[:_SHOWN]:
        say(f"{found.name}: {count} of {found.samples} samples: {reason}")
    if found.not_converged == found.samples:
        raise NotConverged([f"{found.name}: no sample converged at every speed"])
    if found.failed == found.samples:
        raise SceneError([SceneFault(found.name, "vary", None, "such that some sample is a scene")])
    say(f"{found.name}: {found.done} of {found.samples} samples done")
