"""`leblanc runup`: rotor and liquid through the speeds in time."""

from __future__ import annotations

import sys
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from leblanc.cli.output import out_dir, print_json, say

if TYPE_CHECKING:
    from leblanc.scene.scene import Scene
    from leblanc.studies.runup import RunupRecord


def runup(
    scene: Annotated[Path, typer.Argument(help="Scene file (TOML) with a table [runup].")],
    cells: Annotated[int | None, typer.Option(help="Cells round each wall [default: the scene's].")] = None,
    samples: Annotated[
        int | None, typer.Option(help="How many times are recorded [default: the scene's].")
    ] = None,
    out: Annotated[
        Path | None, typer.Option(help="Folder for the files [default: out/<scene name>].")
    ] = None,
    animate: Annotated[
        Path | None, typer.Option(help="GIF or MP4 of the chambers and of the amplitude.")
    ] = None,
    no_check: Annotated[
        bool, typer.Option("--no-check", help="Do not run again with half the cells to estimate the error.")
    ] = False,
    json: Annotated[bool, typer.Option("--json", help="Print one JSON object instead of words.")] = False,
) -> None:
    """Through the resonance in time, up and down. Figures, data file, energy balance, report."""
    from leblanc.scene.scene import load_scene

    machine = load_scene(scene)

    from leblanc.studies.runup import planned

    planned(machine)
    if animate is not None:
        from leblanc.figures.page import require_film
        from leblanc.studies.runup_film import require_layers

        require_film(animate)
        require_layers(machine)
    folder = out_dir(machine.name, out)
    record = _run(machine, cells, samples, not no_check)

    from leblanc.figures.runup import write_figures
    from leblanc.report.page import about, command_line
    from leblanc.report.runup import write_runup_report
    from leblanc.results.runup import runup_json, write_runup

    write_runup(record, folder / "runup.nc")
    figures = write_figures(record, folder)
    options = ("--cells", cells, None), ("--samples", samples, None), ("--no-check", no_check, False)
    command = command_line("runup", scene, *options)
    what = about(machine, command, "runup.nc", unused=("speeds", "optimise"))
    write_runup_report(record, what, figures, folder / "runup.html")
    if animate is not None:
        _film(machine, record, animate)
    if json:
        print_json(runup_json(record))
    else:
        _tell(record, folder)
    _finish(record, scene)


def _run(machine: Scene, cells: int | None, samples: int | None, check: bool) -> RunupRecord:
    """The run itself, with a bar on a terminal."""
    from rich.progress import Progress

    from leblanc.studies.runup import runup_scene

    with Progress(transient=True, disable=not sys.stderr.isatty()) as bar:
        task = bar.add_task("running up", total=1.0)
        return runup_scene(machine, cells, samples, check, lambda done: bar.update(task, completed=done))


def _film(machine: Scene, record: RunupRecord, path: Path) -> None:
    """The film, run once more with the layers kept."""
    from rich.progress import Progress

    from leblanc.figures.runup_film import animate
    from leblanc.studies.runup_film import film

    with Progress(transient=True, disable=not sys.stderr.isatty()) as bar:
        task = bar.add_task("drawing", total=None)
        reel = film(machine, record)
        frames = animate(
            record, reel, path, lambda done, total: bar.update(task, completed=done, total=total)
        )
    say(f"wrote {path}, {frames} frames")


def _tell(record: RunupRecord, folder: Path) -> None:
    """The run in words."""
    from leblanc.units import MM, RPM

    h = record.history
    rows = [("largest amplitude", record.peak()), ("at the end", h.time.size - 1)]
    if record.turning < h.time.size - 1:
        rows.insert(1, ("largest on the way down", record.peak(back=True)))
    for label, k in rows:
        print(f"{label:26}{h.amplitude[k] * MM:10.4g} mm at {h.speed[k] * RPM:8.5g} rpm, {h.time[k]:.4g} s")
    for note in record.notes:
        print(f"note: {note}")
    print(f"Read {folder / 'runup.html'}; the data are in {folder / 'runup.nc'}")


def _finish(record: RunupRecord, scene: Path) -> None:
    """Say what did not come to its end, after all that was reached is written."""
    from leblanc.scene.faults import NotConverged

    history = record.history
    if history.reason.startswith("interrupted"):
        raise KeyboardInterrupt
    if not history.converged:
        raise NotConverged([f"{scene}: {history.reason}; what was reached is written"])
    say(f"{record.name}: {history.steps} steps done, energy closed to {history.audit.closure:.1e}")
