"""`leblanc map`: growth of self-excited whirl over speed and liquid volume."""

from __future__ import annotations

import sys
from pathlib import Path
from typing import Annotated

import typer

from leblanc.cli.output import print_json, say
from leblanc.files import out_dir

MOST_LOST = 0.01  # of the points, at which a map still is one; they are marked


def map(
    scene: Annotated[Path, typer.Argument(help="Scene file (TOML).")],
    volumes: Annotated[int, typer.Option(help="How many volumes.")] = 101,
    speeds: Annotated[int, typer.Option(help="How many speeds, over the scene's range.")] = 201,
    max_volume: Annotated[
        str | None, typer.Option(help="Most liquid in all chambers together [default: what fits].")
    ] = None,
    friction: Annotated[
        str | None,
        typer.Option(help="none, stokes, linear:RATE or quadratic:NUMBER [default: the scene's]."),
    ] = None,
    out: Annotated[
        Path | None, typer.Option(help="Folder for the files [default: out/<scene name>].")
    ] = None,
    json: Annotated[bool, typer.Option("--json", help="Print one JSON object instead of words.")] = False,
) -> None:
    """Growth of self-excited whirl over speed and volume. Edges of the unstable bands, figure, report.

    Points at which the growth is not known are marked; the command fails where they are more than one in 100.
    """
    from leblanc.scene.scene import load_scene
    from leblanc.units import VOLUME, parse_friction, parse_option

    machine = load_scene(scene)
    law = None if friction is None else parse_friction(friction, "--friction")
    most = None if max_volume is None else parse_option(max_volume, VOLUME, "--max-volume")

    from rich.progress import Progress

    from leblanc.studies.whirl_map import map_scene

    with Progress(transient=True, disable=not sys.stderr.isatty()) as bar:
        task = bar.add_task("volumes", total=None)
        found = map_scene(
            *(machine, volumes, speeds, most, law),
            progress=lambda done, total: bar.update(task, completed=done, total=total),
        )
    folder = out_dir(machine.name, out)

    from leblanc.figures.whirl_map import map_figure, save
    from leblanc.report.page import about, command_line
    from leblanc.report.run import write_map_report
    from leblanc.results.netcdf import write_netcdf
    from leblanc.studies.whirl_map import SPEEDS, VOLUMES

    write_netcdf(found.named_arrays(), folder / "map.nc")
    files = save(map_figure(found), folder, "map", "Self-excited whirl over speed and volume")
    command = command_line(
        "map",
        scene,
        ("--volumes", volumes, VOLUMES),
        ("--speeds", speeds, SPEEDS),
        ("--max-volume", max_volume, None),
        ("--friction", friction, None),
    )
    what = about(machine, command, "map.nc", unused=("runup", "optimise"))
    write_map_report(found, what, files, folder / "map.html")
    if json:
        print_json(found.to_json())
    else:
        print(f"liquid friction: {found.friction}; support: {found.damping}")
        for note in found.notes:
            print(note)
        print(f"Read {folder / 'map.html'}; the data are in {folder / 'map.nc'}")

    if found.not_known > MOST_LOST * found.growth.size:
        from leblanc.scene.schema.load import NotConverged

        lost = f"{found.not_known} of {found.growth.size} points"
        raise NotConverged([f"{scene}: growth not known at {lost}, marked in the map"])
    say(f"{found.name}: {found.volume.size} volumes by {found.speed.size} speeds done")
