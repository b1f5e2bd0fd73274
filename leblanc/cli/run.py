"""`leblanc run`: response and liquid centre of mass at each speed of a scene."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from leblanc.cli.output import out_dir, print_json, say

if TYPE_CHECKING:
    from leblanc.scene.scene import Scene


def run(
    scene: Annotated[Path, typer.Argument(help="Scene file (TOML).")],
    out: Annotated[
        Path | None, typer.Option(help="Folder for the files [default: out/<scene name>].")
    ] = None,
    json: Annotated[bool, typer.Option("--json", help="Print one JSON object instead of words.")] = False,
) -> None:
    """Answer of the machine at each speed. Figures, data file, report."""
    from leblanc.scene.scene import load_scene

    machine = load_scene(scene)
    folder = out_dir(machine.name, out)

    if machine.rotor.kind == "exciter":
        _run_exciter(machine, scene, folder, json)
        return

    from leblanc.studies.run import run_scene

    record = run_scene(machine)

    from leblanc.figures import write_figures
    from leblanc.report.page import about, command_line
    from leblanc.report.run import comparisons, write_run_report
    from leblanc.results.netcdf import write_dataset
    from leblanc.results.response import run_json, to_dataset

    write_dataset(to_dataset(record), folder / "response.nc")
    figures = write_figures(record, folder)
    what = about(machine, command_line("run", scene), "response.nc", unused=("runup", "optimise"))
    write_run_report(machine, record, what, figures, folder / "summary.html")
    if json:
        print_json(run_json(record))
    else:
        print(f"{'':34}{'with liquid':>14}{'without':>14}{'ratio':>10}")
        for row in comparisons(record):
            print(f"{row.label:34}{row.wet:>14}{row.dry:>14}{row.ratio:>10}")
        print(f"Read {folder / 'summary.html'}; the data are in {folder / 'response.nc'}")

    answer = record.response
    if not answer.converged.all():
        from leblanc.scene.faults import NotConverged

        lost = answer.speed[~answer.converged]
        raise NotConverged(
            [
                f"{scene}: no bounded deflection found at {lost.size} of {answer.speed.size} speeds: "
                + ", ".join(f"{one:.6g} rad/s" for one in lost[:10])
                + (", ..." if lost.size > 10 else "")
            ]
        )
    say(f"{record.name}: {answer.speed.size} speeds done")


def _run_exciter(machine: Scene, scene: Path, folder: Path, json: bool) -> None:
    """Stuck speeds and vibration of a table with balls."""
    from leblanc.figures.exciter import write_exciter_figure
    from leblanc.report.exciter import write_exciter_report
    from leblanc.report.page import about, command_line
    from leblanc.studies.exciter import describe_exciter, exciter_json, run_exciter

    record = run_exciter(machine)
    figure = write_exciter_figure(record, folder)
    what = about(machine, command_line("run", scene), unused=("model", "runup", "optimise"))
    write_exciter_report(record, what, figure, folder / "summary.html")
    if json:
        print_json(exciter_json(record))
    else:
        print("\n".join(describe_exciter(record)))
        print(f"Read {folder / 'summary.html'}")
    if not record.converged:
        from leblanc.scene.faults import NotConverged

        raise NotConverged([f"{record.name}: a time integration beside the formulas did not stay finite"])
    say(f"{record.name}: {record.speed.size} speeds done")
