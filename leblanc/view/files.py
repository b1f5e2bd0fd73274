"""A picture as a file, PNG or a page that turns it in a browser, or in a window."""

from __future__ import annotations

import math
import re
from html import escape
from importlib.util import find_spec
from pathlib import Path

import numpy as np

from leblanc.results.netcdf import replacing
from leblanc.view.parts import Picture
from leblanc.view.picture import Plotter, pixels, plotter, require_screen, write_png
from meshes.errors import InputError

ROOMIER = 1.2  # of a page's view, in which what is near looks larger

# A page asks nobody for anything: the viewer's icon is dropped, and the browser is told to refuse the rest.
FOREIGN_ICON = "https://kitware.github.io/vtk-js/icon/favicon-"
CLOSED = (
    '<meta http-equiv="Content-Security-Policy" content="default-src data: blob: '
    "'unsafe-inline' 'unsafe-eval'\">"
)


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
    require_screen()
    plot = plotter(picture, off_screen=False)
    plot.show(title=picture.title)


def write_html(plot: Plotter, picture: Picture, path: Path) -> None:
    """Write a page that turns the picture in a browser, without a server and without a network.

    Parameters
    ----------
    plot, picture : what to write; its words stand in the text of the page
    path : an .html; its folder is made if it is missing

    Raises
    ------
    InputError : the libraries for it are not installed
    """
    if find_spec("trame_pyvista") is None:
        allowed = "a .png without the extra: pip install leblanc[browser]"
        raise InputError("--screenshot", str(path), allowed)
    _in_perspective(plot)
    page = plot.trame.export_html(filename=None).read()
    words = [f"<b>{escape(picture.title)}</b>", *map(escape, picture.state.split("\n"))]
    words += [escape(picture.caption), escape(_key(picture))]
    style = "position:absolute;left:1em;top:1em;font:14px sans-serif;pointer-events:none;z-index:9"
    text = f'<div id="words" style="{style}">{"<br>".join(words)}</div>'
    # The viewer empties what it fills: the body, unless there is something of this class.
    text += '<div class="content" style="position:absolute;inset:0"></div>'
    page = f"{text}</body>".join(page.rsplit("</body>", 1)).replace(FOREIGN_ICON, "data:,")
    title = f"{CLOSED}<title>{escape(picture.title)}</title>"
    page = re.sub("<title>.*?</title>", lambda _: title, page, count=1)
    with replacing(path) as part:
        part.write_text(page, encoding="utf-8")


def _key(picture: Picture) -> str:
    """What the colours are, where names cannot stand beside things."""
    names = [label.text for label in picture.labels]
    bar = next((name for name in names if name.endswith(" mm")), "")
    mark = next((name for name in ("unbalance", "angle 0") if name in names), "")
    return (f"Red ball: {mark}. " if mark else "") + (
        "Black line: axis of rotation. Orange line: axis of the drum. " + (f"Bar: {bar}." if bar else "")
    )


def _in_perspective(plot: Plotter) -> None:
    """The view of the page's viewer, which knows no other projection, as near as the picture's own."""
    camera = plot.camera
    plot.disable_parallel_projection()
    focus, position = np.array(camera.focal_point), np.array(camera.position)
    back = (position - focus) / np.linalg.norm(position - focus)
    half = ROOMIER * camera.parallel_scale
    camera.position = focus + back * half / math.tan(math.radians(0.5 * camera.view_angle))
    plot.reset_camera_clipping_range()
    for actor in plot.actors.values():
        if hasattr(actor, "prop") and hasattr(actor.prop, "line_width"):
            actor.prop.line_width = max(1.0, 0.5 * actor.prop.line_width)
