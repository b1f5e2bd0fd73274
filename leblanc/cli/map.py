"""`leblanc map`: growth of self-excited whirl over speed and liquid volume, or where balls are stable."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from leblanc.cli.terminal.output import load
from leblanc.core.contents import results_dir
from leblanc.core.progress import working
from leblanc.core.terminal import print_json, print_table, say

if TYPE_CHECKING:
    from leblanc.scene.scene import Scene

MOST_LOST = 0.01  # of the points, at which a map still is one; they are marked


def map(
    scene: Annotated[Path, typer.Argument(help="Scene file (TOML).")],
    volumes: Annotated[int | None, typer.Option(help="How many volumes [default: 101].")] = None,
    speeds: Annotated[
        int | None,
        typer.Option(help="How many speeds, over the scene's range [default: 201; with balls 61]."),
    ] = None,
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
    over: Annotated[
        list[str] | None,
        typer.Option(
            help="With balls: path of the number on the second axis; several, each behind its own --over, "
            "keep their ratios [default: the drag in all races]."
        ),
    ] = None,
    start: Annotated[
        str | None, typer.Option("--from", help="Its first value [default: a tenth of the scene's].")
    ] = None,
    stop: Annotated[
        str | None, typer.Option("--to", help="Its last value [default: ten times the scene's].")
    ] = None,
    values: Annotated[int | None, typer.Option(help="How many values of it [default: 31].")] = None,
    log: Annotated[
        bool | None,
        typer.Option("--log/--linear", help="How it is spaced [default: log where it spans a decade]."),
    ] = None,
    state: Annotated[
        str | None,
        typer.Option(
            help="Of the balls: balanced, heavy or light, together on that side [default: balanced]."
        ),
    ] = None,
    out: Annotated[
        Path | None, typer.Option(help="Folder for the files [default: out/<scene name>].")
    ] = None,
    json: Annotated[bool, typer.Option("--json", help="Print one JSON object instead of words.")] = False,
) -> None:
    """Growth of self-excited whirl over speed and volume. Edges of the unstable bands, figure, report.

    With balls in races: where they keep the rotor balanced, over speed and any other number of the scene, the
    number of growing roots and the curves where it changes.

    With --cycles also how large the whirls grow: their branches over speed with amplitude, frequency, folds
    and stability.

    Points at which the growth is not known are marked; the command fails where they are more than one in 100.
    """
    from leblanc.core.units import VOLUME, in_rpm, parse_friction, parse_option

    machine = load(scene)
    if machine.balls:
        _left_out(
            "balls",
            {"volumes": volumes, "max-volume": max_volume, "friction": friction, "cycles": cycles or None},
        )
        paths = tuple(over or ())
        _map_balls(machine, scene, paths, start, stop, values, speeds, log, state, out, json)
        return
    own = {
        "over": ", ".join(over or ()) or None,
        "from": start,
        "to": stop,
        "values": values,
        "log": log,
        "state": state,
    }
    _left_out("no balls", own)
    law = None if friction is None else parse_friction(friction, "--friction")
    most = None if max_volume is None else parse_option(max_volume, VOLUME, "--max-volume")
    folder = results_dir(machine.name, out, scene, machine.digest, "map.nc", "map.html")

    with working("preparing") as update:
        from leblanc.studies.whirl_map import SPEEDS, VOLUMES, map_scene

        volumes = VOLUMES if volumes is None else volumes
        speeds = SPEEDS if speeds is None else speeds

        def progress(done: int, total: int) -> None:
            update(done, total, "volumes" if done < total else "edges of the bands")

        def whirls(count: int, speed: float) -> None:
            update(None, None, f"whirls of finite size: {count} found, at {in_rpm(speed)}")

        found = map_scene(machine, volumes, speeds, most, law, progress, cycles, whirls)

    from leblanc.core.netcdf import write_netcdf
    from leblanc.figures.whirl_map import cycles_figure, map_figure, save
    from leblanc.report.page import command_line
    from leblanc.report.run import write_map_report
    from leblanc.scene.inputs import about

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
        from leblanc.core.answer import NotConverged

        lost = f"{found.not_known} of {found.growth.size} points"
        raise NotConverged([f"{scene}: growth not known at {lost}, marked in the map"])
    say(f"{found.name}: {found.volume.size} volumes by {found.speed.size} speeds done")


def _left_out(what: str, given: Mapping[str, object]) -> None:
    """Refuse options of the other kind of map."""
    from meshes.errors import InputError

    for name, value in given.items():
        if value is not None:
            raise InputError(f"--{name}", value, f"left out for a scene with {what}")


def _map_balls(
    machine: Scene,
    scene: Path,
    over: tuple[str, ...],
    start: str | None,
    stop: str | None,
    values: int | None,
    speeds: int | None,
    log: bool | None,
    state: str | None,
    out: Path | None,
    json: bool,
) -> None:
    """Where a state of the balls is stable."""
    folder = results_dir(machine.name, out, scene, machine.digest, "map.nc", "map.html")
    with working("preparing") as update:
        from leblanc.studies.races.chart import SPEEDS, STATES, VALUES, chart_scene

        found = chart_scene(
            machine,
            over,
            start,
            stop,
            values=VALUES if values is None else values,
            speeds=SPEEDS if speeds is None else speeds,
            log=log,
            state=state or STATES[0],
            progress=lambda done, total: update(done, total, "points" if done < total else "curves"),
        )

    from leblanc.core.netcdf import write_netcdf
    from leblanc.figures.races.chart import write_chart_figure
    from leblanc.report.chart import write_chart_report
    from leblanc.report.page import command_line
    from leblanc.scene.inputs import about
    from leblanc.text.races.chart import HEAD, answer, curves, facts

    write_netcdf(found.named_arrays(), folder / "map.nc")
    figure = write_chart_figure(found, folder)
    spacing = () if log is None else (("--log" if log else "--linear", True, False),)
    command = command_line(
        "map",
        scene,
        *(("--over", path, None) for path in over),
        ("--from", start, None),
        ("--to", stop, None),
        ("--values", values, None),
        ("--speeds", speeds, None),
        *spacing,
        ("--state", state, None),
    )
    what = about(machine, command, "map.nc", unused=("runup", "optimise"))
    write_chart_report(found, what, figure, folder / "map.html")
    if json:
        print_json(found.to_json())
    else:
        print(answer(found))
        print_table(facts(found), indent=2)
        if found.edges:
            print()
            print_table(curves(found), HEAD)
        for note in found.notes:
            print(f"note: {note}")
        print(f"Read {folder / 'map.html'}; the data are in {folder / 'map.nc'}")
    say(f"{found.name}: {found.value.size} values by {found.speed.size} speeds done")
