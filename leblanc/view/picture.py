"""Rendering of three-dimensional pictures; PyVista is imported here alone."""

from __future__ import annotations

import ctypes
import os
import sys
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from leblanc.core.files import writing
from leblanc.core.interrupts import held
from leblanc.view.camera import (
    BOTTOM,
    LINE,
    TOP,
    Layout,
    Placed,
    Sight,
    font_file,
    layout,
    letters,
    words_of,
)
from leblanc.view.parts import Label, Picture, Piece, line
from meshes.errors import InputError

Plotter = Any  # pyvista's
Pixels = NDArray[np.uint8]

SIZE = (1200, 900)  # pixels
INK = "#262626"
ROUNDS = 3  # of moving the few colours of a file to where the many of the picture are


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
    "leader": Look("#7A7A7A", 1.0, 1.5),
    "unbalance": Look("#CC0000", 1.0),
    "spin": Look("#4D4D4D", 1.0, 4.0, True),
    "gravity": Look("#4D4D4D", 1.0, 4.0, True),
    "bar": Look(INK, 1.0, 9.0),
    "metal": Look("#B0B0B0", 0.9),
    "ball": Look("#E69F00"),
    "drum": Look("#B8C2CA", 0.16),
    "drum back": Look("#B8C2CA", 0.35),
    "hole": Look("#5F6B75", 0.45),
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
    "foot": Look("#2B2B2B"),
    "cabinet": Look("#A8A294", 1.0, 2.0),
    "point": Look("#CC79A7"),
}


def require_screen() -> None:
    """Raise an `InputError` where there is no screen to open a window on."""
    if sys.platform == "linux" and not (os.environ.get("DISPLAY") or os.environ.get("WAYLAND_DISPLAY")):
        raise InputError("--window", "no display", "left out where there is no screen; a file or --browser")


def prepare_off_screen() -> None:
    """Let VTK draw without a screen; an `InputError` that says what is missing before it crashes."""
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


@held()
def plotter(picture: Picture, size: tuple[int, int] = SIZE, off_screen: bool = True) -> Plotter:
    """PyVista's plotter with the picture in it, `size` in pixels; an `InputError` if nothing can draw."""
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
    placed = layout(picture, size)
    fill(plot, picture, placed)
    point_camera(plot, picture, placed)
    return plot


@held()
def fill(plot: Plotter, picture: Picture, placed: Layout | None = None) -> None:
    """Put a picture into a plotter in place of what is there; the camera stays.

    `placed`: where its names stand; without it there are none.
    """
    import pyvista

    plot.clear_actors()
    leaders = []
    if placed is not None:
        for label, name in zip(picture.labels, placed.names, strict=True):
            leaders += _name(plot, label, name, placed.sight, pyvista)
    for piece in _joined([*picture.pieces, *leaders]):
        _add(plot, piece, pyvista)
    _words(plot, picture, pyvista)


def _name(plot: Plotter, label: Label, name: Placed, sight: Sight, pyvista: Any) -> list[Piece]:
    """Write a name beside the machine; the line from it to what it names, if that is not next to it."""
    anchor = np.array(label.place)
    drawn = pyvista.Label(label.text, position=sight.lift(name.middle, anchor), size=letters(sight.size))
    _write(drawn.prop)
    drawn.prop.justification_horizontal = drawn.prop.justification_vertical = "center"
    # With a name of its own, or PyVista takes the next one for the same.
    plot.add_actor(drawn, name=f"name {label.text}", reset_camera=False, render=False)
    left, _, right, _ = name.box
    there = sight.project(anchor[None])[0]
    start = np.array([right if there[0] > right else left if there[0] < left else there[0], name.middle[1]])
    if np.linalg.norm(there - start) <= letters(sight.size):
        return []
    return [Piece("leader", np.stack([sight.lift(start, anchor), anchor]), line(2), "leader")]


def _write(prop: Any) -> None:
    """Colour and font of a text."""
    prop.color = INK
    path = font_file()
    if path is not None:
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


def _joined(pieces: Sequence[Piece]) -> list[Piece]:
    """Faces and lines of one look as one piece, which is drawn faster; each face keeps its own normals."""
    groups: dict[tuple[str, int], list[Piece]] = {}
    rest = []
    for piece in pieces:
        tipped = piece.cells.shape[1] == 2 and LOOKS[piece.look].tip
        if piece.cells.size and piece.ball == 0.0 and not tipped:
            groups.setdefault((piece.look, piece.cells.shape[1]), []).append(piece)
        else:
            rest.append(piece)
    found = []
    for (look, _), group in groups.items():
        starts = np.cumsum([0, *(len(piece.points) for piece in group[:-1])])
        cells = [piece.cells + start for piece, start in zip(group, starts, strict=True)]
        points = np.concatenate([piece.points for piece in group])
        found.append(Piece(look, points, np.concatenate(cells), look))
    return [*found, *rest]


def normals(piece: Piece) -> NDArray[np.float64]:
    """Normal of a smooth face at each of its points, weighted by area, shape (n, 3)."""
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


def _words(plot: Plotter, picture: Picture, pyvista: Any) -> None:
    """Title, state and caption."""
    above, below = words_of(picture, tuple(plot.window_size))
    size = letters(tuple(plot.window_size))
    step = LINE * size / plot.window_size[1]
    rows = [(line_text, TOP - (1.4 + k) * step, size) for k, line_text in enumerate(above)]
    rows[0] = (above[0], TOP - 1.1 * step, round(1.3 * size))
    rows += [(line_text, BOTTOM + k * step, size) for k, line_text in enumerate(reversed(below))]
    for line_text, height, letters_ in rows:
        text = pyvista.Text(line_text, position=(0.02, height))
        text.GetPositionCoordinate().SetCoordinateSystemToNormalizedDisplay()
        _write(text.prop)
        text.prop.font_size = letters_
        plot.add_actor(text, reset_camera=False, render=False)


def point_camera(plot: Plotter, picture: Picture, placed: Layout) -> None:
    """Point the camera so that the whole picture lies between its texts."""
    sight = placed.sight
    far = 4.0 * float(np.linalg.norm(np.ptp(picture.frame, axis=0)))
    camera = plot.camera
    camera.focal_point, camera.position, camera.up = sight.focus, sight.focus + far * sight.back, sight.over
    camera.parallel_scale = sight.half
    camera.clipping_range = (0.1 * far, 3.0 * far)


@held()
def pixels(plot: Plotter) -> Pixels:
    """What the plotter, off the screen, shows, shape (height, width, 3)."""
    from pyvista.plotting.utilities import image_from_window

    plot.render_window.Render()  # PyVista's screenshot would draw the first picture once more
    return np.asarray(image_from_window(plot.render_window, ignore_alpha=True), dtype=np.uint8)


def write_png(shown: Pixels, path: Path) -> None:
    """Write a picture in 256 colours, whole or not at all, without the time of writing.

    Its folder is made if it is missing.
    """
    from PIL import Image

    with writing(path) as part:
        few = Image.fromarray(shown).quantize(
            256, method=Image.Quantize.MAXCOVERAGE, kmeans=ROUNDS, dither=Image.Dither.NONE
        )
        few.save(part, format="png", optimize=True)
