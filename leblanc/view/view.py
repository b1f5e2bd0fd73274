"""What `leblanc view` makes of a scene: a picture, a film or a page, as files or in a window."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path

from leblanc.scene.scene import Scene
from leblanc.studies.shapes import Sight, look_at, places_of
from leblanc.view.film import Film, require_frames, runup_film, runup_scale, sweep_film
from leblanc.view.page import write_html
from leblanc.view.parts import Picture, Stage
from leblanc.view.picture import pixels, plotter, write_png
from leblanc.view.scale import Scale, choose_scale, drawn_volume, given_scale
from leblanc.view.still import still
from meshes.errors import InputError


@dataclass(frozen=True)
class View:
    """A picture of a machine at one speed and what it shows.

    Parameters
    ----------
    picture : the picture
    sight : the answer behind it
    scale : of its deflection and depth
    """

    picture: Picture
    sight: Sight
    scale: Scale

    def in_numbers(self) -> dict[str, object]:
        """What scripts want to know of it, SI."""
        answer = self.sight.record.response
        return {
            "speed": float(answer.speed[-1]),
            "deflection": self.sight.deflection[-1],
            "dry_patch": bool(answer.dry_patch[-1]),
            "model": str(answer.model[-1]),
            "deflection_factor": self.scale.deflection,
            "depth_factor": self.scale.depth,
            "volume": [fill.volume for fill in self.sight.fills],
            "volume_drawn": [drawn_volume(fill, self.scale.depth) for fill in self.sight.fills],
        }


def scale_of(sight: Sight, factor: float | None) -> Scale:
    """The factor asked for, or one that makes the deflection visible at all speeds of a sight.

    Parameters
    ----------
    sight : answers
    factor : of the deflection; None to choose it

    Raises
    ------
    InputError : a factor out of its range
    """
    if factor is not None:
        return given_scale(factor, sight.fills, sight.deflection)
    return choose_scale(sight.fills, sight.deflection, sight.speed, sight.gravity, sight.length)


def view_scene(scene: Scene, speed: float | None = None, factor: float | None = None) -> View:
    """Picture of a scene's machine at one speed.

    Parameters
    ----------
    scene : the machine, no exciter
    speed : rad/s; the last of its speeds if None
    factor : of the deflection as drawn; chosen if None

    Raises
    ------
    InputError : a value out of its range, an exciter

    Examples
    --------
    >>> from leblanc.scene.scene import load_scene
    >>> view = view_scene(load_scene("examples/runup.toml"), speed=24.0)
    >>> view.scale.in_words()
    'Everything to scale.'
    """
    require_rotor(scene)
    sight = look_at(scene, scene.speeds.stop if speed is None else speed)
    scale = scale_of(sight, factor)
    return View(still(sight, -1, scale), sight, scale)


def require_rotor(scene: Scene) -> None:
    """The scene has a rotor that whirls, and not a table with balls.

    Raises
    ------
    InputError : it is an exciter
    """
    if scene.rotor.kind == "exciter":
        allowed = "jeffcott, two_plane or tub for this; of an exciter only --screenshot shows a picture"
        raise InputError("rotor.kind", "exciter", allowed)


def film_of(scene: Scene, frames: int, factor: float | None, progress: Callable[[float], None]) -> Film:
    """The run-up of a scene, or its steady states over the speeds if it has none.

    Parameters
    ----------
    scene : the machine
    frames : how many at most
    factor : of the deflection as drawn; chosen if None
    progress : called with the share of the run-up that is done

    Raises
    ------
    InputError : a value out of its range, an exciter, a run-up whose liquid has no layer to show
    """
    require_rotor(scene)
    require_frames(frames)
    if scene.runup is None:
        sight = look_at(scene)
        return sweep_film(sight, scale_of(sight, factor), frames)
    from leblanc.studies.runup import runup_scene
    from leblanc.studies.runup_film import film, require_layers

    require_layers(scene)
    record = runup_scene(scene, check=False, progress=progress)
    reel = film(scene, record, frames)
    radius = max((fill.chamber.radius for fill in scene.fills), default=0.1)
    scale = runup_scale(radius, record, reel)
    if factor is not None:
        scale = given_scale(factor, scene.fills, reel.deflection)
    places, _ = places_of(scene)
    stage = Stage(
        scene.fills,
        places,
        scene.rotor.axis == "horizontal",
        scale,
        scale.deflection * float(abs(reel.deflection).max()),
        "unbalance" if scene.rotor.kind == "jeffcott" else "angle 0",
    )
    return runup_film(stage, record, reel)


def write_picture(picture: Picture, path: Path) -> None:
    """Write a picture as PNG, or as a page that turns it in a browser.

    Parameters
    ----------
    picture : what to write
    path : a .png or an .html

    Raises
    ------
    InputError : another ending, nothing to draw with, the page's libraries are missing
    """
    kind = require_picture(path)
    plot = plotter(picture)
    try:
        if kind == ".html":
            write_html(plot, picture, path)
        else:
            write_png(pixels(plot), path)
    finally:
        plot.close()


def require_picture(path: Path) -> str:
    """Ending of a picture's path.

    Raises
    ------
    InputError : it is neither .png nor .html
    """
    kind = path.suffix.lower()
    if kind not in (".png", ".html"):
        raise InputError("--screenshot", str(path), "a file that ends in .png or .html")
    return kind


def open_window(picture: Picture) -> None:
    """Show a picture in a window until the user closes it.

    Parameters
    ----------
    picture : what to show

    Raises
    ------
    InputError : there is no screen
    """
    from leblanc.view.picture import require_screen

    require_screen()
    plot = plotter(picture, off_screen=False)
    plot.show(title=picture.title)
