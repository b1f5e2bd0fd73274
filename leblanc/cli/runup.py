"""`leblanc runup`: rotor and liquid through the speeds in time."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from leblanc.cli.terminal.output import load, processes
from leblanc.core.contents import results_dir
from leblanc.core.files import require_writable
from leblanc.core.progress import working
from leblanc.core.terminal import print_json, print_table, say, show

if TYPE_CHECKING:
    from leblanc.results.runup import RunupResult


def runup(
    scene: Annotated[Path, typer.Argument(help="Scene file (TOML) with a table [runup] or [programme].")],
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
    ensemble: Annotated[
        int, typer.Option(help="Repeat it so often with the unbalance changed in its last digits.")
    ] = 0,
    seed: Annotated[int, typer.Option(help="Of those changes.")] = 0,
    workers: Annotated[
        int | None, typer.Option(help="Processes that repeat it [default: one a core].")
    ] = None,
    json: Annotated[bool, typer.Option("--json", help="Print one JSON object instead of words.")] = False,
) -> None:
    """Through the resonance in time, up and down. Figures, data file, energy balance, report."""

    machine = load(scene)

    from leblanc.studies.runup import planned

    planned(machine)
    if animate is not None:
        from leblanc.figures.drawing.page import require_film
        from leblanc.studies.runup import require_layers

        require_film(animate)
        require_layers(machine)
        require_writable(animate)
    folder = results_dir(machine.name, out, scene, machine.digest, "runup.nc", "runup.html")
    with working("running up") as update:
        from leblanc.studies.runup import FRAMES, runup_scene

        frames = FRAMES if animate is not None else None
        result = runup_scene(
            *(machine, cells, samples, not no_check, lambda done: update(done, 1.0), frames),
            *(ensemble, seed, processes(workers)),
        )

    from leblanc.core.netcdf import write_netcdf
    from leblanc.figures.runup import write_figures
    from leblanc.report.page import command_line
    from leblanc.report.runup import write_runup_report
    from leblanc.scene.inputs import about

    write_netcdf(result.named_arrays(), folder / "runup.nc")
    figures = write_figures(result, folder)
    options = ("--cells", cells, None), ("--samples", samples, None), ("--no-check", no_check, False)
    again = ("--ensemble", ensemble, 0), ("--seed", seed, 0)
    command = command_line("runup", scene, *options, *again)
    unused = ("speeds", *(() if machine.chambers else ("model",)), "optimise")
    what = about(machine, command, "runup.nc", unused=unused)
    write_runup_report(result, what, figures, folder / "runup.html")
    if animate is not None:
        _film(result, animate)
    if json:
        print_json(result.to_json())
    else:
        _tell(result, folder)
    _finish(result, scene)


def _film(result: RunupResult, path: Path) -> None:
    """The film of the layers that the run kept."""
    from leblanc.figures.films import animate

    assert result.frames is not None
    with working("drawing") as update:
        frames = animate(result, result.frames, path, update)
    say(f"wrote {path}, {frames} frames")


def _tell(result: RunupResult, folder: Path) -> None:
    """The run as text."""
    from leblanc.core.units import amplitude_sentence
    from leblanc.studies.loads.answer import load_table
    from leblanc.text.runup import answer_rows, ball_rows, passage_rows

    print_table([*answer_rows(result), *ball_rows(result), *passage_rows(result)])
    print(amplitude_sentence(result.plane))
    if result.loads is not None:
        show([load_table(result.loads)])
    for note in result.notes:
        print(f"note: {note.text}")
    print(f"Read {folder / 'runup.html'}; the data are in {folder / 'runup.nc'}")


def _finish(result: RunupResult, scene: Path) -> None:
    """Say what did not come to its end, after all that was reached is written."""
    from leblanc.core.answer import NotConverged
    from solvers.layer.records import Outcome

    cut = result.spread is not None and result.spread.members < result.spread.asked
    if result.outcome is Outcome.INTERRUPTED or cut:
        raise KeyboardInterrupt
    if not result.converged:
        raise NotConverged([f"{scene}: {result.reason}; what was reached is written"])
    say(f"{result.name}: {result.steps} steps done, energy closed to {result.energy_error:.1e}")
