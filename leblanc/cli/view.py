"""`leblanc view`: three-dimensional picture, film or page of a machine."""

from __future__ import annotations

import sys
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from leblanc.cli.output import out_dir, print_json, say

if TYPE_CHECKING:
    from leblanc.scene.scene import Scene
    from leblanc.view.film import Film
    from leblanc.view.modes import Mode
    from leblanc.view.parts import Picture


def view(
    scene: Annotated[Path, typer.Argument(help="Scene file (TOML).")],
    speed: Annotated[
        str | None, typer.Option(help="Spin speed, rad/s or with a unit [default: the last].")
    ] = None,
    factor: Annotated[
        float | None, typer.Option(help="How many times larger the deflection is drawn [default: chosen].")
    ] = None,
    screenshot: Annotated[
        Path | None, typer.Option(help="PNG or HTML of the picture [default: view.png in the folder].")
    ] = None,
    animate: Annotated[
        Path | None,
        typer.Option(
            help="GIF, MP4 or folder of PNG: the run-up, the scene's speeds, or a period of a mode."
        ),
    ] = None,
    frames: Annotated[
        int | None, typer.Option(help="Of the film, at most [default: 60; of a mode 48].")
    ] = None,
    mode: Annotated[int | None, typer.Option(help="Number of a sloshing mode to show instead.")] = None,
    chamber: Annotated[int, typer.Option(help="Whose mode, from 1.")] = 1,
    window: Annotated[bool, typer.Option("--window", help="Open a window and write nothing.")] = False,
    browser: Annotated[
        bool, typer.Option("--browser", help="Serve a page with a slider for the speed, until Ctrl-C.")
    ] = False,
    host: Annotated[str, typer.Option(help="Address that the page is served at.")] = "localhost",
    port: Annotated[int, typer.Option(help="Port of the page; 0 takes a free one.")] = 8080,
    out: Annotated[
        Path | None, typer.Option(help="Folder for the files [default: out/<scene name>].")
    ] = None,
    json: Annotated[bool, typer.Option("--json", help="Print one JSON object instead of words.")] = False,
) -> None:
    """Three-dimensional picture, film or browser page."""
    from leblanc.scene.scene import load_scene
    from leblanc.units import ANGULAR_SPEED, parse_option

    machine = load_scene(scene)
    spin = None if speed is None else parse_option(speed, ANGULAR_SPEED, "--speed")
    _check_choices(screenshot, animate, frames, mode, window, browser, port)
    if browser:
        _serve(machine, spin, factor, host, port)
        return
    numbers: dict[str, object] = {}
    wave: Mode | None = None
    if mode is not None:
        from leblanc.view.modes import mode_picture, solve_mode

        wave = solve_mode(machine, mode, spin, chamber)
        picture = mode_picture(machine, wave)
        numbers = {"speed": wave.speed, "frequency": wave.frequency, "crests": wave.crests}
    elif machine.rotor.kind == "exciter":
        picture, numbers = _table(machine, spin)
    else:
        from leblanc.view.view import view_scene

        shown = view_scene(machine, spin, factor)
        picture, numbers = shown.picture, shown.in_numbers()
    if window:
        from leblanc.view.view import open_window

        open_window(picture)
        return
    made = _files(machine, picture, wave, screenshot, animate, frames, factor, out)
    if json:
        print_json({"scene": machine.name} | numbers | made)
    else:
        if made["screenshot"]:
            print("\n".join([picture.title, *picture.state.split("\n"), picture.caption]))
        print(f"Look at {', '.join(str(path) for path in made.values() if path)}")


def _check_choices(
    screenshot: Path | None,
    animate: Path | None,
    frames: int | None,
    mode: int | None,
    window: bool,
    browser: bool,
    port: int,
) -> None:
    """What does not go together, before any work."""
    from meshes.errors import InputError

    if screenshot is not None:
        from leblanc.view.view import require_picture

        require_picture(screenshot)
    if animate is not None:
        from leblanc.view.film import require_film

        require_film(animate)
    if frames is not None:
        from leblanc.view.film import require_frames

        require_frames(frames)
    if browser and (screenshot or animate or window or mode is not None):
        raise InputError(
            "--browser", "with another", "alone: without --screenshot, --animate, --window, --mode"
        )
    if window and (screenshot or animate):
        raise InputError("--window", "with a file", "alone: without --screenshot and --animate")
    if window:
        from leblanc.view.picture import require_screen

        require_screen()
    if not 0 <= port <= 65535:
        raise InputError("--port", port, "from 0 to 65535")


def _table(machine: Scene, speed: float | None) -> tuple[Picture, dict[str, object]]:
    """Picture of a table with balls."""
    from leblanc.view.exciter import exciter_picture

    return exciter_picture(machine, speed)


def _files(
    machine: Scene,
    picture: Picture,
    wave: Mode | None,
    screenshot: Path | None,
    animate: Path | None,
    frames: int | None,
    factor: float | None,
    out: Path | None,
) -> dict[str, Path | None]:
    """Write what was asked for; without a choice a picture in the folder."""
    from leblanc.view.view import write_picture

    made: dict[str, Path | None] = {"screenshot": None, "animation": None}
    if screenshot is not None or animate is None:
        path = screenshot or out_dir(machine.name, out) / "view.png"
        write_picture(picture, path)
        made["screenshot"] = path
    if animate is not None:
        made["animation"] = animate
        _film(machine, wave, animate, frames, factor)
    return made


def _film(machine: Scene, wave: Mode | None, path: Path, frames: int | None, factor: float | None) -> None:
    """Write a film, with a bar on a terminal."""
    from rich.progress import Progress

    from leblanc.view.film import FRAMES, write_film
    from leblanc.view.view import film_of

    with Progress(transient=True, disable=not sys.stderr.isatty()) as bar:
        task = bar.add_task("solving", total=1.0)
        film: Film
        if wave is not None:
            from leblanc.view.modes import ROUND, mode_film

            film = mode_film(machine, wave, frames or ROUND)
        else:
            film = film_of(machine, frames or FRAMES, factor, lambda done: bar.update(task, completed=done))
        bar.update(task, description="drawing", completed=0.0)
        count = write_film(film, path, lambda done, total: bar.update(task, completed=done / total))
    say(f"wrote {path}, {count} frames")


def _serve(machine: Scene, speed: float | None, factor: float | None, host: str, port: int) -> None:
    """Serve the page until interrupted."""
    from leblanc.studies.shapes import look_at
    from leblanc.view.browser import frames_of_speeds, require_trame, serve
    from leblanc.view.view import require_rotor, scale_of

    require_trame()
    require_rotor(machine)
    sight = look_at(machine)
    frames = frames_of_speeds(sight, scale_of(sight, factor), speed)
    say(f"{machine.name}: {frames.count} speeds solved; the page stays until Ctrl-C")
    serve(machine.name, frames, host, port, lambda address: print(f"Open {address}", flush=True))
