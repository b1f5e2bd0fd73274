"""`leblanc optimise`: the best volumes of liquid, the best balls, the best layout of mounts."""

from __future__ import annotations

import sys
from pathlib import Path
from time import monotonic
from typing import TYPE_CHECKING, Annotated

import typer

from leblanc.cli.terminal.output import load, processes
from leblanc.core.contents import results_dir
from leblanc.core.terminal import print_json, say

if TYPE_CHECKING:
    from leblanc.results.optimum import OptimumResult
    from leblanc.scene.scene import Scene
    from leblanc.scene.tasks import Optimisation


def optimise(
    scene: Annotated[Path, typer.Argument(help="Scene file (TOML), with or without a table [optimise].")],
    objective: Annotated[
        str | None,
        typer.Option(
            help="working_speed, peak, mean, least_mass, robust, floor_force, walking_margin, "
            "point_clearance, motor_torque, or layout of a tub's mounts [default: the scene's, or "
            "working_speed]."
        ),
    ] = None,
    deflection: Annotated[
        str | None, typer.Option(help="Given deflection: the least liquid that covers the walls at it.")
    ] = None,
    limit: Annotated[
        str | None, typer.Option(help="Vibration limit of the objective least_mass [default: the scene's].")
    ] = None,
    steady: Annotated[
        bool, typer.Option("--steady", help="Peak of the steady response even if the scene has a run-up.")
    ] = False,
    seed: Annotated[int | None, typer.Option(help="Of the random sample of the objective robust.")] = None,
    emulator: Annotated[
        Path | None,
        typer.Option(help="Store of a sweep over the volumes: the search asks an emulator of it."),
    ] = None,
    workers: Annotated[
        int | None,
        typer.Option(
            help="Processes that judge designs of balls where one takes its time [default: all cores]."
        ),
    ] = None,
    no_front: Annotated[
        bool, typer.Option("--no-front", help="Leave out what must be given up for what.")
    ] = False,
    out: Annotated[
        Path | None, typer.Option(help="Folder for the files [default: out/<scene name>].")
    ] = None,
    json: Annotated[bool, typer.Option("--json", help="Print one JSON object instead of words.")] = False,
) -> None:
    """Best volume(s), balls, or layout of a tub's mounts, for an objective. Figures, data file, report."""
    from leblanc.questions import optimisation_of, require_no_emulator
    from leblanc.report.page import command_line
    from leblanc.scene.inputs import about

    machine = load(scene)
    task = optimisation_of(machine, objective, deflection, limit, steady, seed)
    if task.objective == "layout":
        folder = results_dir(machine.name, out, scene, machine.digest, "layout.nc", "layout.html")
        _layout(machine, scene, task, folder, json)
        return
    folder = results_dir(machine.name, out, scene, machine.digest, "optimum.nc", "optimise.html")
    if machine.balls:
        require_no_emulator(emulator)
        options = ("--objective", objective, None), ("--limit", limit, None), ("--steady", steady, False)
        command = command_line("optimise", scene, *options, ("--seed", seed, None))
        _balls(machine, task, scene, folder, command, processes(workers), json)
        return
    result = _run(machine, task, not no_front, emulator)

    from leblanc.core.netcdf import write_netcdf
    from leblanc.figures.optimise import write_figures
    from leblanc.report.optimise import write_optimise_report

    write_netcdf(result.named_arrays(), folder / "optimum.nc")
    files = write_figures(result, folder)
    command = command_line(
        "optimise",
        scene,
        ("--objective", objective, None),
        ("--deflection", deflection, None),
        ("--limit", limit, None),
        ("--steady", steady, False),
        ("--seed", seed, None),
        ("--emulator", emulator, None),
        ("--no-front", no_front, False),
    )
    what = about(machine, command, "optimum.nc", task, () if result.in_time else ("runup",))
    write_optimise_report(result, what, files, folder / "optimise.html")
    if json:
        print_json(result.to_json())
    else:
        from leblanc.text.optimum import describe_optimum

        print("\n".join(describe_optimum(result)))
        print(f"Read {folder / 'optimise.html'}; the data are in {folder / 'optimum.nc'}")
    _finish(result, scene)


def _layout(machine: Scene, scene: Path, task: Optimisation, folder: Path, json: bool) -> None:
    """Where the mounts of a tub sit best."""
    from leblanc.core.netcdf import write_netcdf
    from leblanc.core.progress import working
    from leblanc.core.terminal import print_table
    from leblanc.figures.drawing.page import save
    from leblanc.figures.machine import layout_figure, places_figure
    from leblanc.report.layout import write_layout_report
    from leblanc.report.page import command_line
    from leblanc.scene.inputs import about
    from leblanc.studies.optimise.layout import optimise_layout
    from leblanc.text.layout import MOUNTS, PAIR_HEAD, answer, coupling_rows, facts, mount_rows

    with working("layouts") as update:
        result = optimise_layout(machine, task, lambda count, _: update(what=f"{count} layouts judged"))
    write_netcdf(result.named_arrays(), folder / "layout.nc")
    figures = (
        save(places_figure(result), folder, "places", "Places of springs and dampers"),
        save(layout_figure(result), folder, "layout", "Couplings and natural frequencies"),
    )
    command = command_line("optimise", scene, ("--objective", "layout", None))
    what = about(machine, command, "layout.nc", task, ("runup", "model"))
    write_layout_report(result, what, figures, folder / "layout.html")
    if json:
        print_json(result.to_json())
    else:
        print(answer(result))
        print_table(facts(result)[2:], indent=2)
        print()
        print_table(mount_rows(result), MOUNTS)
        print()
        print_table(coupling_rows(result), PAIR_HEAD)
        print(f"Read {folder / 'layout.html'}; the data are in {folder / 'layout.nc'}")
    if not result.feasible:
        from leblanc.core.answer import NotConverged

        raise NotConverged([f"{machine.name}: {answer(result)}"])
    say(f"{result.name}: {result.evaluations} layouts judged")


def _balls(
    machine: Scene, task: Optimisation, scene: Path, folder: Path, command: str, workers: int, json: bool
) -> None:
    """The best balls of a scene's races."""
    from leblanc.core.netcdf import write_netcdf
    from leblanc.core.progress import working
    from leblanc.core.terminal import print_table
    from leblanc.figures.races.design import write_design_figure
    from leblanc.report.design import write_design_report
    from leblanc.scene.inputs import about
    from leblanc.studies.optimise.balls.search import optimise_balls
    from leblanc.text.races.design import RACE_HEAD, answer, constraint_rows, facts, nearest, paste, race_rows

    with working("designs") as update:
        result = optimise_balls(
            machine, task, lambda count, share: update(share, 1.0, f"{count} designs judged"), workers
        )
    write_netcdf(result.named_arrays(), folder / "optimum.nc")
    figure = write_design_figure(result, folder)
    what = about(machine, command, "optimum.nc", task, ("runup",) if task.objective != "peak" else ())
    write_design_report(result, what, figure, folder / "optimise.html")
    if json:
        print_json(result.to_json())
    else:
        print(answer(result))
        print_table(race_rows(result), RACE_HEAD)
        print()
        print_table(facts(result), indent=2)
        print()
        print_table(constraint_rows(result), ("constraint", "value", "at most", ""))
        for note in result.notes:
            print(f"note: {note.text}")
        for k, keys in enumerate(paste(result)):
            print(f"For race {k + 1} of the scene: {keys}")
        print(f"Read {folder / 'optimise.html'}; the data are in {folder / 'optimum.nc'}")
    if result.interrupted:
        raise KeyboardInterrupt
    if not result.feasible:
        from leblanc.core.answer import NotConverged

        raise NotConverged([f"{scene}: no balls meet every constraint: {nearest(result)}"])
    say(f"{result.name}: {result.evaluations} designs judged")


def _finish(result: OptimumResult, scene: Path) -> None:
    """Say what the answer is not, after all that was found is written."""
    from leblanc.core.answer import NotConverged
    from leblanc.text.optimum import nearest

    if result.interrupted:
        raise KeyboardInterrupt
    if not result.feasible:
        raise NotConverged([f"{scene}: {nearest(result)}"])
    say(f"{result.name}: {result.evaluations} sets of volumes judged")


def _run(machine: Scene, task: Optimisation, front: bool, store: Path | None) -> OptimumResult:
    """The search itself, with a bar on a terminal that says what is left."""
    from rich.progress import BarColumn, Progress, TextColumn

    from leblanc.studies.optimise.emulated import emulated_vibration
    from leblanc.studies.optimise.optimise import optimise_scene

    emulator = None if store is None else emulated_vibration(store, machine, task)
    begin = monotonic()
    columns = BarColumn(), TextColumn("{task.description}")
    with Progress(*columns, transient=True, disable=not sys.stderr.isatty()) as bar:
        task_of_bar = bar.add_task("judging", total=1.0)

        def told(count: int, share: float) -> None:
            left = (
                f", about {(monotonic() - begin) * (1.0 - share) / share:.0f} s left" if share > 0.0 else ""
            )
            bar.update(task_of_bar, completed=share, description=f"{count} sets of volumes judged{left}")

        return optimise_scene(machine, task=task, front=front, progress=told, emulator=emulator)
