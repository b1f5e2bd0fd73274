"""`leblanc run`: response and liquid centre of mass at each speed of a scene."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from leblanc.cli.command import finish
from leblanc.cli.terminal.output import load, processes
from leblanc.core.contents import results_dir
from leblanc.core.progress import working
from leblanc.core.question import called
from leblanc.core.terminal import print_json, print_table, say

if TYPE_CHECKING:
    from leblanc.scene.scene import Scene


def run(
    scene: Annotated[Path, typer.Argument(help="Scene file (TOML).")],
    out: Annotated[
        Path | None, typer.Option(help="Folder for the files [default: out/<scene name>].")
    ] = None,
    workers: Annotated[
        int | None, typer.Option(help="Processes that hold waves in time [default: all cores].")
    ] = None,
    fresh: Annotated[bool, typer.Option(help="Hold anew what an earlier run has left.")] = False,
    solver: Annotated[
        str | None,
        typer.Option(help="Of py-pde, that holds waves in time: runge-kutta, scipy ... [default: coupled]."),
    ] = None,
    cycles: Annotated[
        bool, typer.Option("--cycles", help="Find how large whirls that grow by themselves become.")
    ] = False,
    json: Annotated[bool, typer.Option("--json", help="Print one JSON object instead of words.")] = False,
) -> None:
    """Answer of the machine at each speed. Figures, data file, report."""

    machine = load(scene)
    kind = machine.rotor.kind
    from leblanc.registry import answerer
    from leblanc.report.page import about, command_line

    files = ["summary.html", *([] if kind == "exciter" else ["response.nc"])]
    folder = results_dir(machine.name, out, scene, machine.digest, *files)

    if (address := answerer("run", kind)) is not None:
        with working("preparing"):
            answer = called(address)(machine)
        finish(answer, str(scene), json, folder, machine, command_line("run", scene))
        return
    if machine.balls:
        _run_balls(machine, scene, folder, json)
        return

    with working("preparing") as update:
        from leblanc.studies.held.holding import Holding
        from leblanc.studies.run.study import run_scene
        from solvers.held.state import COUPLED

        holding = Holding(processes(workers), folder, fresh, solver or COUPLED)
        result = run_scene(machine, lambda what: update(what=what), holding, cycles)

    from leblanc.core.netcdf import write_netcdf
    from leblanc.core.units import amplitude_sentence
    from leblanc.report.run import write_run_report
    from leblanc.results.notes.baffles import BaffleCode
    from leblanc.studies.run.figure import write_figures
    from leblanc.studies.run.notes import RunCode
    from leblanc.studies.run.words import amplitude_place, comparison_table, limit_rows, unanswered
    from leblanc.text.closed_forms import closed_form_rows
    from leblanc.text.machine import load_table

    write_netcdf(result.named_arrays(), folder / "response.nc")
    figures = write_figures(result, folder)
    what = about(
        machine,
        command_line("run", scene, ("--cycles", cycles, False)),
        "response.nc",
        unused=(*(("model",) if result.chamberless else ()), "runup", "optimise"),
    )
    write_run_report(result, what, figures, folder / "summary.html")
    if json:
        print_json(result.to_json())
    else:
        heads, rows = comparison_table(result)
        print_table(rows, heads, right=True)
        print(amplitude_sentence(amplitude_place(result)))
        for note in result.notes:
            if note.code in (RunCode.LEFT_OUT, BaffleCode.CLOSED_COMPARTMENTS):
                print(note.text)
        if result.loads is not None:
            head, lines = load_table(result.loads)
            print()
            print_table(lines, head)
        if forms := closed_form_rows(result.closed_forms):
            print("\nClosed forms beside the answer")
            print_table(forms, indent=2)
        print("\nLimits of the answer")
        print_table(limit_rows(result), indent=2)
        print(f"Read {folder / 'summary.html'}; the data are in {folder / 'response.nc'}")

    if not result.converged.all():
        from leblanc.core.answer import NotConverged

        failed = [f"{scene}: {text}" for text in unanswered(result)]
        if result.held is not None and result.held.not_settled.any():
            failed.append(
                "All files are written; what has not settled is marked not_settled, with the numbers of its "
                f"last turns. The states are kept in {folder / 'held'}: another run takes them from there."
            )
        raise NotConverged(failed)
    say(f"{result.name}: {result.speed.size} speeds done")


def _run_balls(machine: Scene, scene: Path, folder: Path, json: bool) -> None:
    """Where the balls of a rotor rest in the drum."""
    from leblanc.core.netcdf import write_netcdf
    from leblanc.figures.races.balls import write_balls_figures
    from leblanc.report.page import about, command_line
    from leblanc.report.run import write_balls_report
    from leblanc.studies.races.balls import run_balls
    from leblanc.text.closed_forms import closed_form_rows
    from leblanc.text.machine import load_table
    from leblanc.text.races.balls import answer, facts, limits

    with working("states of the balls"):
        result = run_balls(machine)
    write_netcdf(result.named_arrays(), folder / "response.nc")
    figures = write_balls_figures(result, folder)
    what = about(machine, command_line("run", scene), "response.nc", unused=("runup", "optimise"))
    write_balls_report(result, what, figures, folder / "summary.html")
    if json:
        print_json(result.to_json())
    else:
        print(answer(result))
        print_table(facts(result))
        if result.loads is not None:
            head, lines = load_table(result.loads)
            print()
            print_table(lines, head)
        if forms := closed_form_rows(result.closed_forms):
            print("\nClosed forms beside the answer")
            print_table(forms, indent=2)
        print("\nLimits of the answer")
        print_table([(limit.label, limit.where) for limit in limits(result)], indent=2)
        for note in result.notes:
            print(f"note: {note.text}")
        print(f"Read {folder / 'summary.html'}; the data are in {folder / 'response.nc'}")
    if not result.converged.all():
        from leblanc.core.answer import NotConverged

        raise NotConverged([f"{scene}: no state of the balls was found at some speeds; they are empty"])
    say(f"{result.name}: {result.speed.size} speeds done")
