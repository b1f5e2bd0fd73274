"""`leblanc map`: growth of self-excited whirl over speed and liquid volume."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from leblanc.cli.terminal.output import load, print_json, print_table, say
from leblanc.cli.terminal.progress import working
from leblanc.contents import results_dir

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
        typer.Option(
            help="none, stokes, wall[:ROUGHNESS], linear:RATE or quadratic:NUMBER [default: the scene's]."
        ),
    ] = None,
    cycles: Annotated[
        bool, typer.Option("--cycles", help="Find how large the whirls of the scene as it stands grow.")
    ] = False,
    out: Annotated[
        Path | None, typer.Option(help="Folder for the files [default: out/<scene name>].")
    ] = None,
    json: Annotated[bool, typer.Option("--json", help="Print one JSON object instead of words.")] = False,
) -> None:
    """Growth of self-excited whirl over speed and volume. Edges of the unstable bands, figure, report.

    With --cycles also how large the whirls grow: their branches over speed with amplitude, frequency, folds
    and stability.

    Points at which the growth is not known are marked; the command fails where they are more than one in 100.
    """
    from leblanc.units import VOLUME, in_rpm, parse_friction, parse_option

    machine = load(scene)
    law = None if friction is None else parse_friction(friction, "--friction")
    most = None if max_volume is None else parse_option(max_volume, VOLUME, "--max-volume")
    folder = results_dir(machine.name, out, scene, machine.digest, "map.nc", "map.html")

    with working("preparing") as update:
        from leblanc.studies.whirl_map import map_scene

        def progress(done: int, total: int) -> None:
            update(done, total, "volumes" if done < total else "edges of the bands")

        def whirls(count: int, speed: float) -> None:
            update(None, None, f"whirls of finite size: {count} found, at {in_rpm(speed)}")

        found = map_scene(machine, volumes, speeds, most, law, progress, cycles, whirls)

    from leblanc.figures.whirl_map import cycles_figure, map_figure, save
    from leblanc.report.page import about, command_line
    from leblanc.report.run import write_map_report
    from leblanc.results.netcdf import write_netcdf
    from leblanc.studies.whirl_map import SPEEDS, VOLUMES

    write_netcdf(found.named_arrays(), folder / "map.nc")
    files = [save(map_figure(found), folder, "map", "Self-excited whirl over speed and volume")]
    if found.branches:
        files.append(save(cycles_figure(found), folder, "cycles", "How large the whirl grows, over speed"))
    command = command_line(
        "map",
        scene,
        ("--volumes", volumes, VOLUMES),
        ("--speeds", speeds, SPEEDS),
        ("--max-volume", max_volume, None),
        ("--friction", friction, None),
        ("--cycles", cycles, False),
    )
    what = about(machine, command, "map.nc", unused=("runup", "optimise"))
    write_map_report(found, what, files, folder / "map.html")
    if json:
        print_json(found.to_json())
    else:
        from leblanc.text.whirl_map import answer, facts

        print(answer(found))
        print_table(facts(found), indent=2)
        for note in found.notes:
            print(f"note: {note}")
        print(f"Read {folder / 'map.html'}; the data are in {folder / 'map.nc'}")

    if found.not_known > MOST_LOST * found.growth.size:
        from leblanc.scene.schema.load import NotConverged

        lost = f"{found.not_known} of {found.growth.size} points"
        raise NotConverged([f"{scene}: growth not known at {lost}, marked in the map"])
    say(f"{found.name}: {found.volume.size} volumes by {found.speed.size} speeds done")
