"""`leblanc view`: three-dimensional picture, film or page of a machine."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from leblanc.cli.terminal.output import FORCE, SET, load
from leblanc.core.contents import results_dir
from leblanc.core.files import require_writable
from leblanc.core.progress import working
from leblanc.core.question import called
from leblanc.core.terminal import print_json, say

if TYPE_CHECKING:
    from leblanc.scene.scene import Scene
    from leblanc.view.film import Film
    from leblanc.view.parts import Picture


def view(
    scene: Annotated[Path, typer.Argument(help="Scene file (TOML).")],
    speed: Annotated[
        str | None,
        typer.Option(
            help="Spin speed, rad/s or with a unit [default: the last]; of a spindle: the natural motion "
            "next to this frequency."
        ),
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
    mode: Annotated[
        int | None,
        typer.Option(help="Number of a sloshing mode to show instead; of a spindle of its natural motion."),
    ] = None,
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
    force: Annotated[bool, typer.Option("--force", help=FORCE)] = False,
    set_: Annotated[list[str] | None, typer.Option("--set", help=SET)] = None,
    json: Annotated[bool, typer.Option("--json", help="Print one JSON object instead of words.")] = False,
) -> None:
    """Three-dimensional picture, film or browser page."""
    from leblanc.core.units import ANGULAR_SPEED, parse_option
    from leblanc.registry import answerer

    machine = load(scene, set_ or ())
    spin = None if speed is None else parse_option(speed, ANGULAR_SPEED, "--speed")
    _check_choices(screenshot, animate, frames, mode, window, browser, port)
    if browser:
        _serve(machine, spin, factor, host, port)
        return
    if not window:
        screenshot = _target(machine, scene, screenshot, animate, out, force)
    wave = None  # what has a film of its own
    with working("solving"):
        if (special := answerer("view", machine.rotor.kind)) is not None:
            wave = special(machine, mode, spin, factor)
        elif mode is not None:
            from leblanc.studies.shapes.machine import mode_view

            wave = mode_view(machine, mode, spin, chamber)
        if wave is None:
            picture, numbers = _still(machine, spin, factor)
        else:
            picture, numbers = called(wave.picture)(wave), wave.to_json()
    if window:
        from leblanc.view.files import open_window

        open_window(picture)
        return
    made = _files(machine, picture, wave, screenshot, animate, frames, factor)
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
        from leblanc.view.files import require_picture

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


def _target(
    machine: Scene,
    source: Path,
    screenshot: Path | None,
    animate: Path | None,
    out: Path | None,
    force: bool,
) -> Path | None:
    """Where the picture goes, if there is one; whatever is to be written is tried."""
    if screenshot is None and animate is None:
        screenshot = results_dir(machine.name, out, source, machine.digest, force=force) / "view.png"
    if screenshot is not None:
        require_writable(screenshot)
    if animate is not None:
        require_writable(animate if animate.suffix else animate / "frame_0001.png")
    return screenshot


def _still(machine: Scene, speed: float | None, factor: float | None) -> tuple[Picture, dict[str, object]]:
    """Picture of a machine at one speed and its numbers."""
    if machine.rotor.kind == "exciter":
        from leblanc.studies.shapes.machine import table_view
        from leblanc.view.exciter import table_picture

        table = table_view(machine, speed)
        return table_picture(table), table.to_json()
    if machine.balls:
        from leblanc.studies.shapes.balls import ball_view
        from leblanc.view.balls import ball_still

        seen = ball_view(machine, speed, factor)
        return ball_still(seen, -1), seen.to_json()
    from leblanc.studies.shapes.machine import machine_view
    from leblanc.view.scene import still

    found = machine_view(machine, speed, factor)
    return still(found.motion, -1, found.liquid), found.to_json()


def _files(
    machine: Scene,
    picture: Picture,
    wave: Any,
    screenshot: Path | None,
    animate: Path | None,
    frames: int | None,
    factor: float | None,
) -> dict[str, Path | None]:
    """Write what the options name."""
    from leblanc.view.files import write_picture

    made: dict[str, Path | None] = {"screenshot": None, "animation": None}
    if screenshot is not None:
        write_picture(picture, screenshot)
        made["screenshot"] = screenshot
    if animate is not None:
        made["animation"] = animate
        _film(machine, wave, animate, frames, factor)
    return made


def _film(machine: Scene, wave: Any, path: Path, frames: int | None, factor: float | None) -> None:
    """Write a film, with a bar on a terminal."""
    from leblanc.view.film import FRAMES, require_frames, write_film

    if wave is None:
        require_frames(frames or FRAMES)
    with working("solving") as update:
        if wave is not None:
            film = called(wave.film)(wave, **({} if frames is None else {"frames": frames}))
        else:
            film = _film_of(machine, frames or FRAMES, factor)
        update(0.0, film.count, "drawing")
        count = write_film(film, path, update)
    say(f"wrote {path}, {count} frames")


def _film_of(machine: Scene, frames: int, factor: float | None) -> Film:
    """The run-up of a scene, or its steady states over the speeds if it has none."""
    from leblanc.view.film import runup_film, sweep_film

    if machine.runup is not None and machine.rotor.kind != "exciter":
        from leblanc.studies.shapes.machine import runup_view

        return runup_film(runup_view(machine, frames, factor))
    if machine.balls:
        from leblanc.studies.shapes.balls import ball_view
        from leblanc.view.film import ball_film

        return ball_film(ball_view(machine, factor=factor, every=True), frames)
    from leblanc.studies.shapes.machine import drawn_liquid, machine_motion
    from leblanc.studies.shapes.scale import scale_of

    motion = machine_motion(machine)
    scale = scale_of(motion, factor)
    return sweep_film(motion, scale, lambda k: drawn_liquid(motion, k, scale), frames)


def _serve(machine: Scene, speed: float | None, factor: float | None, host: str, port: int) -> None:
    """Serve the page until interrupted."""
    from leblanc.studies.shapes.machine import drawn_liquid, dry_walls, machine_motion
    from leblanc.studies.shapes.scale import scale_at, scale_of
    from leblanc.view.access import HERE
    from leblanc.view.files import frames_of_speeds, require_trame, serve

    require_trame()
    motion = machine_motion(machine)
    scale = scale_of(motion, factor)
    frames = frames_of_speeds(
        motion,
        scale,
        lambda k, fitted: drawn_liquid(motion, k, scale_at(motion, k) if fitted else scale),
        [dry_walls(motion, k) for k in range(motion.speed.size)],
        speed,
    )
    say(f"{machine.name}: {frames.count} speeds solved; the page stays until Ctrl-C")
    if host.lower() not in HERE:
        say(f"{host} is not this machine alone: who reads the address below on its way can open the page")
    serve(machine.name, frames, host, port, lambda address: print(f"Open {address}", flush=True))
