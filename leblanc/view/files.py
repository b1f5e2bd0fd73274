"""A picture as a file (PNG, a page that turns it), in a window, or as a page with a slider for the speed.

The page of a slider is rendered here and sent as images by trame, which is imported here alone; it needs
nothing from elsewhere. All speeds of the scene are solved before the page opens; the slider steps through
them.
"""

from __future__ import annotations

import asyncio
import math
import re
import secrets
import sys
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from dataclasses import dataclass
from html import escape
from importlib.util import find_spec
from pathlib import Path
from typing import Any

import numpy as np

from leblanc.core.files import writing
from leblanc.core.interrupts import given_back
from leblanc.plotting.bodies import DrawnLiquid, MachineMotion, Scale
from leblanc.view.access import address_of, gate, launched
from leblanc.view.camera import VIEWS, layout
from leblanc.view.parts import Picture
from leblanc.view.picture import (
    Plotter,
    fill,
    pixels,
    plotter,
    point_camera,
    require_screen,
    write_png,
)
from leblanc.view.scene import describe_speed, describe_state, stage_of, still
from meshes.errors import InputError

ROOMIER = 1.2  # of a page's view, in which what is near looks larger

# A page loads nothing from elsewhere: the icon of the viewer is dropped, and a policy refuses the rest.
FOREIGN_ICON = "https://kitware.github.io/vtk-js/icon/favicon-"
CLOSED = (
    '<meta http-equiv="Content-Security-Policy" content="default-src data: blob: '
    "'unsafe-inline' 'unsafe-eval'\">"
)

PAGE_SIZE = (1200, 900)  # pixels, until the browser tells its own
STYLE = """
html, body, #app { margin: 0; height: 100%; }
.page { display: flex; flex-direction: column; height: 100vh; font: 15px sans-serif; color: #262626; }
.tools { display: flex; flex-wrap: wrap; gap: 0.8em; align-items: center; padding: 0.6em 1em;
  border-bottom: 1px solid #cccccc; background: #f6f6f6; }
.tools input[type=range] { flex: 1 1 20em; min-width: 12em; }
.tools output { min-width: 13em; font-variant-numeric: tabular-nums; }
.words { padding: 0.4em 1em; min-height: 1.4em; }
.sight { flex: 1 1 auto; min-height: 0; position: relative; }
"""


def write_picture(picture: Picture, path: Path) -> None:
    """Write a picture as .png, or as .html, a page that turns it in a browser.

    An `InputError` for another ending, without anything to draw with, without the page's libraries.
    """
    kind = require_picture(path)
    plot = plotter(picture)
    try:
        if kind == ".html":
            fill(plot, picture)  # its viewer has no names
            write_html(plot, picture, path)
        else:
            write_png(pixels(plot), path)
    finally:
        plot.close()


def require_picture(path: Path) -> str:
    """Ending of a picture's path; an `InputError` if it is neither .png nor .html."""
    kind = path.suffix.lower()
    if kind not in (".png", ".html"):
        raise InputError("--screenshot", str(path), "a file that ends in .png or .html")
    return kind


def open_window(picture: Picture) -> None:
    """Show a picture in a window until the user closes it; an `InputError` without a screen."""
    require_screen()
    plot = plotter(picture, off_screen=False)
    plot.show(title=picture.title)


def write_html(plot: Plotter, picture: Picture, path: Path) -> None:
    """Write a page that turns the picture in a browser, without a server and without a network.

    The page has the picture's texts; its folder is made if it is missing. An `InputError` without its
    libraries.
    """
    if find_spec("trame_pyvista") is None:
        allowed = "a .png without the extra: pip install leblanc[browser]"
        raise InputError("--screenshot", str(path), allowed)
    _in_perspective(plot)
    with given_back():  # its server hears Ctrl-C and SIGTERM in its own way, and goes on doing so
        page = plot.trame.export_html(filename=None).read()
    lines = [f"<b>{escape(picture.title)}</b>", *map(escape, picture.state.split("\n"))]
    lines += [escape(picture.caption), escape(_key(picture))]
    style = "position:absolute;left:1em;top:1em;font:14px sans-serif;pointer-events:none;z-index:9"
    text = f'<div id="words" style="{style}">{"<br>".join(lines)}</div>'
    # The viewer empties what it fills: the body, unless there is something of this class.
    text += '<div class="content" style="position:absolute;inset:0"></div>'
    page = f"{text}</body>".join(page.rsplit("</body>", 1)).replace(FOREIGN_ICON, "data:,")
    title = f"{CLOSED}<title>{escape(picture.title)}</title>"
    page = re.sub("<title>.*?</title>", lambda _: title, page, count=1)
    with writing(path) as part:
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
    """The view of the page's viewer, which has no other projection, as near as the picture's own."""
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


@dataclass(frozen=True)
class Frames:
    """Pictures of a machine, one for each position of the slider."""

    count: int  #: how many
    first: int  #: which one is shown first
    picture: Callable[[int, bool], Picture]  #: draws one, with the scale common to all or fitted to each
    values: tuple[str, ...]  #: what stands beside the slider for each
    texts: tuple[str, ...]  #: what stands below it for each


def frames_of_speeds(
    motion: MachineMotion,
    scale: Scale,
    liquid: Callable[[int, bool], DrawnLiquid],
    dry: Sequence[Sequence[bool]],
    speed: float | None = None,
) -> Frames:
    """Pictures of all speeds of a machine, at first the one nearest to `speed`, rad/s; the last if None.

    `liquid` gives it as drawn at the speed of an index, with the common scale or with one that fits; `dry`:
    the wall of each chamber is dry in part, at each speed.
    """
    stage = stage_of(motion, scale)

    def picture(index: int, fitted: bool) -> Picture:
        return still(motion, index, liquid(index, fitted), None if fitted else stage)

    count = motion.speed.size
    values = tuple(describe_speed("", spin).removeprefix(": ") for spin in motion.speed.tolist())
    texts = tuple("; ".join(describe_state(motion, k, dry[k])) for k in range(count))
    first = count - 1 if speed is None else int(np.argmin(np.abs(motion.speed - speed)))
    return Frames(count, first, picture, values, texts)


def require_trame() -> None:
    """Raise an `InputError` where libraries of the page are not installed."""
    for name in ("trame", "trame_vtk"):
        if find_spec(name) is None:
            allowed = "left out without the extra: pip install leblanc[browser]"
            raise InputError("--browser", f"no {name}", allowed)


def serve(name: str, frames: Frames, host: str, port: int, ready: Callable[[str], None]) -> None:
    """Serve the page until interrupted; port 0 takes a free one.

    `ready` is called with the address, which carries a token, once the page can be opened. An `InputError`
    without trame or anything to draw with, an OSError where the address cannot be listened at.
    """
    require_trame()
    plot = plotter(frames.picture(frames.first, False), PAGE_SIZE)
    try:
        asyncio.run(_serve(plot, name, frames, host, port, ready))
    finally:
        plot.close()


async def _serve(
    plot: Any, name: str, frames: Frames, host: str, port: int, ready: Callable[[str], None]
) -> None:
    """Everything that trame ties to the loop it finds running."""
    server = server_named(f"leblanc view {name}")
    _page(server, plot, name, frames)
    await listen(server, host, port, ready)


def server_named(name: str) -> Any:
    """Server of a page, which is not yet up."""
    from trame.app import get_server

    with _no_arguments():
        return get_server(name, client_type="vue3")


async def listen(server: Any, host: str, port: int, ready: Callable[[str], None]) -> None:
    """Let a server answer whoever has its token until it is interrupted; port 0 takes a free one.

    `ready` is called with the address, which carries the token, once the page can be opened. An OSError where
    the address cannot be listened at.
    """
    token = secrets.token_urlsafe(24)

    @server.controller.add("on_server_bind")  # type: ignore[untyped-decorator]
    def _bound(wslink: Any) -> None:
        wslink.app.middlewares.append(gate(host, token))
        wslink.app.router.add_post("/paraview/", launched)  # or the page complains that there is no launcher

    @server.controller.add("on_server_ready")  # type: ignore[untyped-decorator]
    def _ready(**_: object) -> None:
        ready(address_of(host, server.port, token))

    with _no_arguments():
        running = server.start(
            port=port,
            host=host,
            thread=True,  # which leaves Ctrl-C to us
            open_browser=False,
            show_connection_info=False,
            disable_logging=True,
            exec_mode="coroutine",
            timeout=0,
        )
    await running


@contextmanager
def _no_arguments() -> Iterator[None]:
    """Keep trame from reading our command line as its own."""
    kept = sys.argv
    sys.argv = kept[:1]
    try:
        yield
    finally:
        sys.argv = kept


def _page(server: Any, plot: Any, name: str, frames: Frames) -> None:
    """What stands on the page, and what its slider and buttons do."""
    from trame.ui.html import DivLayout
    from trame.widgets import client, html, vtk

    state = server.state
    state.trame__title = f"{name} - leblanc"
    state.index, state.fitted, state.view = frames.first, False, VIEWS[0]
    state.value, state.words = frames.values[frames.first], frames.texts[frames.first]
    with DivLayout(server) as page:
        client.Style(STYLE)
        with html.Div(classes="page"):
            with html.Div(classes="tools"):
                html.Label("Speed", for_="speed")
                html.Input(
                    id="speed", type="range", min=0, max=frames.count - 1, step=1, v_model_number="index"
                )
                html.Output("{{ value }}", id="value")
                with html.Label():
                    html.Input(id="fitted", type="checkbox", v_model="fitted")
                    html.Span("factor fitted to each speed")
                for view in VIEWS:
                    html.Button(view, click=(_turn(plot, frames, server, view), "[]"), classes="view")
            html.Div("{{ words }}", id="words", classes="words")
            with html.Div(classes="sight"):
                shown = vtk.VtkRemoteView(plot.render_window, ref="sight", still_quality=95)
        del page
    server.controller.update_picture = shown.update

    @state.change("index", "fitted")  # type: ignore[untyped-decorator]
    def _moved(index: Any, fitted: Any, **_: object) -> None:
        k = min(max(int(index), 0), frames.count - 1)
        state.value, state.words = frames.values[k], frames.texts[k]
        picture = frames.picture(k, bool(fitted))
        fill(plot, picture, layout(picture, tuple(plot.window_size), state.view))
        shown.update()


def _turn(plot: Any, frames: Frames, server: Any, view: str) -> Callable[[], None]:
    def turn() -> None:
        server.state.view = view
        picture = frames.picture(int(server.state.index), bool(server.state.fitted))
        placed = layout(picture, tuple(plot.window_size), view)
        fill(plot, picture, placed)
        point_camera(plot, picture, placed)
        server.controller.update_picture()

    return turn
