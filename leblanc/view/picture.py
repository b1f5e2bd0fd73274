"""Rendering of three-dimensional pictures: the one door of the study to PyVista."""

from __future__ import annotations

import ctypes
import os
import sys
import textwrap
from dataclasses import dataclass
from importlib.util import find_spec
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from leblanc.files import writing
from leblanc.view.parts import Picture, Piece
from meshes.errors import InputError

Plotter = Any  # pyvista's
Pixels = NDArray[np.uint8]

SIZE = (1200, 900)  # pixels
# Shares of the height that words take, and of the room left that the machine fills; names stand beside it.
HEAD, FOOT, HIGH, WIDE = 0.15, 0.11, 0.94, 0.82
LETTER = 1.0 / 52.0  # size of the letters over the height of the picture
FONT = "DejaVuSans.ttf"  # matplotlib's, which knows more characters than VTK's own
INK = "#262626"
ROUNDS = 3  # of moving the few colours of a file to where the many of the picture are

# Directions from which the camera looks, and what is up: standing, lying, lying and long; and other views.
FRONT = {
    "standing": ((0.35, -1.0, 0.75), (0.0, 0.0, 1.0)),
    "above": ((0.35, -1.0, 1.6), (0.0, 0.0, 1.0)),
    "lying": ((1.0, -0.55, 0.42), (0.0, 0.0, 1.0)),
    "long": ((1.0, -1.15, 0.55), (0.0, 0.0, 1.0)),
}
VIEWS = ("oblique", "along the axis", "from the side")


@dataclass(frozen=True)
class Look:
    """How a kind of piece is drawn: colour, opacity, width of lines or size of points in pixels."""

    colour: str
    opacity: float = 1.0
    width: float = 0.0
    tip: bool = False  # an arrow's head at the end
    gloss: float = 0.0  # share of the light that a face reflects like a mirror


LOOKS = {
    "wall": Look("#9AA5AE", 0.13),
    "floor": Look("#9AA5AE", 0.28),
    "lid": Look("#9AA5AE", 0.06),
    "rim": Look("#4D4D4D", 1.0, 2.5),
    "liquid": Look("#74C6F5", 1.0, gloss=0.25),
    "surface": Look("#1282C8", 1.0, gloss=0.7),
    "waterline": Look("#003F66", 1.0, 4.0),
    "axis at rest": Look("#000000", 1.0, 4.0),
    "axis of the drum": Look("#D55E00", 1.0, 6.0),
    "arm": Look(INK, 1.0, 3.0),
    "unbalance": Look("#CC0000", 1.0),
    "spin": Look("#4D4D4D", 1.0, 4.0, True),
    "gravity": Look("#4D4D4D", 1.0, 4.0, True),
    "bar": Look(INK, 1.0, 9.0),
    "metal": Look("#B0B0B0", 0.9),
    "ball": Look("#E69F00"),
    "drum": Look("#B8C2CA", 0.16),
    "drum back": Look("#B8C2CA", 0.35),
    "rib": Look("#C3CBD1", 0.9),
    "edge": Look("#6F7A83", 1.0, 2.0),
    "housing": Look("#D9D3C7", 0.55),
    "lug": Look("#8D8676"),
    "shaft": Look("#8A8F94"),
    "bearing": Look("#5C6268"),
    "spring": Look("#3F7F5F"),
    "damper": Look("#4A4A4A"),
    "rod": Look("#B9BDC1"),
    "bush": Look("#2B2B2B"),
    "ground": Look("#A8A294"),
}


def require_screen() -> None:
    """There is a screen to open a window on.

    Raises
    ------
    InputError : there is none
    """
    if sys.platform == "linux" and not (os.environ.get("DISPLAY") or os.environ.get("WAYLAND_DISPLAY")):
        raise InputError("--window", "no display", "left out where there is no screen; a file or --browser")


def prepare_off_screen() -> None:
    """Let VTK draw without a screen, and say what is missing before it crashes.

    Raises
    ------
    InputError : no library to draw with
    """
    if sys.platform != "linux" or os.environ.get("DISPLAY"):
        return
    if _loads("libEGL.so.1"):
        kind = "vtkEGLRenderWindow"
    elif any(_loads(f"libOSMesa.so.{version}") for version in (8, 6)):
        kind = "vtkOSOpenGLRenderWindow"
    else:
        raise InputError("display", "none", "a screen, or the libraries libegl1 and libgl1-mesa-dri, to draw")
    os.environ.setdefault("VTK_DEFAULT_OPENGL_WINDOW", kind)


def _loads(library: str) -> bool:
    try:
        ctypes.CDLL(library)
    except OSError:
        return False
    return True


def plotter(picture: Picture, size: tuple[int, int] = SIZE, off_screen: bool = True) -> Plotter:
    """PyVista's plotter with the picture in it.

    Parameters
    ----------
    picture : what to draw
    size : pixels
    off_screen : without a window

    Raises
    ------
    InputError : nothing to draw with
    """
    if off_screen:
        prepare_off_screen()
    import pyvista

    plot = pyvista.Plotter(
        off_screen=off_screen, window_size=list(size), theme=pyvista.themes.DocumentTheme()
    )
    plot.set_background("white")
    plot.enable_parallel_projection()
    plot.enable_depth_peeling(8)
    plot.enable_anti_aliasing("ssaa")
    fill(plot, picture)
    point_camera(plot, picture, VIEWS[0])
    return plot


def fill(plot: Plotter, picture: Picture) -> None:
    """Put a picture into a plotter in place of what is there; the camera stays.

    Parameters
    ----------
    plot, picture : where, what
    """
    import pyvista

    plot.clear_actors()
    for piece in picture.pieces:
        _add(plot, piece, pyvista)
    size = round(LETTER * plot.window_size[1])
    for label in picture.labels:
        drawn = pyvista.Label(label.text, position=label.place, size=size)
        _write(drawn.prop)
        drawn.prop.justification_horizontal = drawn.prop.justification_vertical = "center"
        drawn.prop.background_color, drawn.prop.background_opacity = "white", 0.6
        plot.add_actor(drawn, reset_camera=False, render=False)
    _words(plot, picture, size, pyvista)


def _write(prop: Any) -> None:
    """Colour and font of a text."""
    prop.color = INK
    spec = find_spec("matplotlib")
    path = Path(spec.origin).parent / "mpl-data" / "fonts" / "ttf" / FONT if spec and spec.origin else None
    if path is not None and path.exists():
        prop.set_font_file(str(path))


def _add(plot: Plotter, piece: Piece, pyvista: Any) -> None:
    look = LOOKS[piece.look]
    options: dict[str, Any] = {
        "color": look.colour,
        "opacity": look.opacity,
        "reset_camera": False,
        "render": False,
    }
    if piece.ball > 0.0:
        for point in piece.points:
            plot.add_mesh(pyvista.Sphere(radius=piece.ball, center=point), **options)
    if piece.cells.size == 0:
        return
    count = piece.cells.shape[1]
    cells = np.insert(piece.cells, 0, count, axis=1)
    if count == 2:
        mesh = pyvista.PolyData(piece.points, lines=cells.ravel())
        plot.add_mesh(mesh, line_width=look.width, lighting=False, **options)
        if look.tip:
            _tip(plot, piece, pyvista, options)
        return
    mesh = pyvista.PolyData(piece.points, faces=cells.ravel())
    mesh.point_data.active_normals = normals(piece)
    light = {"ambient": 0.3, "diffuse": 0.72, "specular": look.gloss, "specular_power": 18.0}
    plot.add_mesh(mesh, smooth_shading=True, **light, **options)


def normals(piece: Piece) -> NDArray[np.float64]:
    """Normal of a smooth face at each of its points, weighted by area, shape (n, 3).

    Parameters
    ----------
    piece : of faces
    """
    corners = piece.points[piece.cells]
    across = np.cross(corners[:, 2] - corners[:, 0], corners[:, -1] - corners[:, 1])
    total = np.zeros_like(piece.points)
    for corner in piece.cells.T:
        np.add.at(total, corner, across)
    size = np.linalg.norm(total, axis=1, keepdims=True)
    return np.asarray(np.divide(total, size, out=np.zeros_like(total), where=size > 0.0))


def _tip(plot: Plotter, piece: Piece, pyvista: Any, options: dict[str, Any]) -> None:
    """Head of an arrow, in proportion to the arrow."""
    end, before = piece.points[-1], piece.points[-2]
    length = float(np.linalg.norm(np.diff(piece.points, axis=0), axis=1).sum())
    cone = pyvista.Cone(center=end, direction=end - before, height=0.16 * length, radius=0.045 * length)
    plot.add_mesh(cone, **options)


def _words(plot: Plotter, picture: Picture, size: int, pyvista: Any) -> None:
    """Title, state and caption."""
    wide, high = plot.window_size
    line = 1.4 * size / high
    most = int(wide / (0.58 * size)) - 3
    above = [textwrap.shorten(picture.title, int(most / 1.3), placeholder="..."), *picture.state.split("\n")]
    below = textwrap.wrap(picture.caption, most)
    rows = [(line_text, 0.985 - (1.4 + k) * line, size) for k, line_text in enumerate(above)]
    rows[0] = (above[0], 0.985 - 1.1 * line, round(1.3 * size))
    rows += [(line_text, 0.012 + k * line, size) for k, line_text in enumerate(reversed(below))]
    for line_text, height, letters in rows:
        text = pyvista.Text(line_text, position=(0.02, height))
        text.GetPositionCoordinate().SetCoordinateSystemToNormalizedDisplay()
        _write(text.prop)
        text.prop.font_size = letters
        plot.add_actor(text, reset_camera=False, render=False)


def point_camera(plot: Plotter, picture: Picture, view: str) -> None:
    """Point the camera so that the whole picture lies between its texts.

    Parameters
    ----------
    plot, picture : where, what
    view : one of `VIEWS`
    """
    towards, up = _direction(picture, view)
    middle = picture.frame.mean(axis=0)
    back = np.array(towards) / np.linalg.norm(towards)
    right = np.cross(np.array(up), back)
    right /= np.linalg.norm(right)
    over = np.cross(back, right)
    spread_right, spread_up = ((picture.frame - middle) @ axis for axis in (right, over))
    wide, tall = plot.window_size
    room = 1.0 - HEAD - FOOT
    half = 0.5 * max(np.ptp(spread_up) / (room * HIGH), np.ptp(spread_right) * tall / (wide * WIDE))
    shift = 0.5 * (spread_up.max() + spread_up.min()) + (HEAD - FOOT) * half
    aside = 0.5 * (spread_right.max() + spread_right.min())
    focus = middle + shift * over + aside * right
    far = 4.0 * float(np.linalg.norm(np.ptp(picture.frame, axis=0)))
    camera = plot.camera
    camera.focal_point, camera.position, camera.up = focus, focus + far * back, up
    camera.parallel_scale = half
    camera.clipping_range = (0.1 * far, 3.0 * far)


def _direction(picture: Picture, view: str) -> tuple[tuple[float, ...], tuple[float, ...]]:
    if view == VIEWS[1]:
        return ((1.0, 0.0, 0.0), (0.0, 0.0, 1.0)) if picture.lying else ((0.0, 0.0, 1.0), (0.0, 1.0, 0.0))
    if view == VIEWS[2]:
        return (0.0, -1.0, 0.0), (0.0, 0.0, 1.0)
    if not picture.lying:
        return FRONT["above" if picture.above else "standing"]
    return FRONT["long" if picture.long else "lying"]


def pixels(plot: Plotter) -> Pixels:
    """What the plotter shows, shape (height, width, 3).

    Parameters
    ----------
    plot : off the screen
    """
    plot.render_window.Render()  # what was put in since the last time is not drawn by itself
    return np.asarray(plot.screenshot(return_img=True), dtype=np.uint8)


def write_png(shown: Pixels, path: Path) -> None:
    """Write a picture in 256 colours, whole or not at all, without the time of writing.

    Parameters
    ----------
    shown : as from `pixels`
    path : a .png; its folder is made if it is missing
    """
    from PIL import Image

    with writing(path) as part:
        few = Image.fromarray(shown).quantize(
            256, method=Image.Quantize.MAXCOVERAGE, kmeans=ROUNDS, dither=Image.Dither.NONE
        )
        few.save(part, format="png", optimize=True)
