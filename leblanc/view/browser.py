"""A page in the browser with a machine's picture and a slider for its speed: the one door to trame.

The picture is rendered here and sent as an image; the page needs nothing from elsewhere. All speeds of the
scene are solved before the page opens, and the slider steps from one to the next.
"""

from __future__ import annotations

import asyncio
import sys
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from dataclasses import dataclass
from importlib.util import find_spec
from typing import Any

import numpy as np

from leblanc.results.drawn.scale import Scale
from leblanc.results.drawn.shapes import DrawnLiquid, MachineMotion
from leblanc.view.parts import Picture
from leblanc.view.picture import VIEWS, aim, fill, plotter
from leblanc.view.still import describe_speed, describe_state, stage_of, still
from meshes.errors import InputError

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


@dataclass(frozen=True)
class Frames:
    """Pictures of a machine, one for each position of the slider.

    Parameters
    ----------
    count : how many
    first : which one is shown first
    picture : draws one, with the scale common to all or fitted to each
    values : what stands beside the slider for each
    words : what stands below it for each
    """

    count: int
    first: int
    picture: Callable[[int, bool], Picture]
    values: tuple[str, ...]
    words: tuple[str, ...]


def frames_of_speeds(
    motion: MachineMotion,
    scale: Scale,
    liquid: Callable[[int, bool], DrawnLiquid],
    dry: Sequence[Sequence[bool]],
    speed: float | None = None,
) -> Frames:
    """Pictures of all speeds of a machine.

    Parameters
    ----------
    motion : the machine
    scale : common to all pictures
    liquid : gives it as drawn at a speed, by the index of that, with the common scale or with one that fits
    dry : the wall of each chamber is dry in part, at each speed
    speed : the one nearest to it is shown first, rad/s; the last if None
    """
    stage = stage_of(motion, scale)

    def picture(index: int, fitted: bool) -> Picture:
        return still(motion, index, liquid(index, fitted), None if fitted else stage)

    count = motion.speed.size
    values = tuple(describe_speed("", spin).removeprefix(": ") for spin in motion.speed.tolist())
    words = tuple("; ".join(describe_state(motion, k, dry[k])) for k in range(count))
    first = count - 1 if speed is None else int(np.argmin(np.abs(motion.speed - speed)))
    return Frames(count, first, picture, values, words)


def require_trame() -> None:
    """The libraries of the page are installed.

    Raises
    ------
    InputError : one of them is not
    """
    for name in ("trame", "trame_vtk"):
        if find_spec(name) is None:
            allowed = "left out without the extra: pip install leblanc[browser]"
            raise InputError("--browser", f"no {name}", allowed)


def serve(name: str, frames: Frames, host: str, port: int, ready: Callable[[str], None]) -> None:
    """Serve the page until interrupted.

    Parameters
    ----------
    name : of the machine
    frames : its pictures
    host, port : where to listen; port 0 takes a free one
    ready : called with the address once the page can be opened

    Raises
    ------
    InputError : trame is not installed, or there is nothing to draw with
    OSError : the address cannot be listened at
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
    from trame.app import get_server

    with _no_arguments():
        server = get_server(f"leblanc view {name}", client_type="vue3")
        _page(server, plot, name, frames)

        @server.controller.add("on_server_ready")  # type: ignore[untyped-decorator]
        def _ready(**_: object) -> None:
            ready(f"http://{host}:{server.port}/")

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
    state.index, state.fitted = frames.first, False
    state.value, state.words = frames.values[frames.first], frames.words[frames.first]
    with DivLayout(server) as layout:
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
        del layout
    server.controller.update_picture = shown.update

    @state.change("index", "fitted")  # type: ignore[untyped-decorator]
    def _moved(index: Any, fitted: Any, **_: object) -> None:
        k = min(max(int(index), 0), frames.count - 1)
        state.value, state.words = frames.values[k], frames.words[k]
        fill(plot, frames.picture(k, bool(fitted)))
        shown.update()


def _turn(plot: Any, frames: Frames, server: Any, view: str) -> Callable[[], None]:
    def turn() -> None:
        aim(plot, frames.picture(int(server.state.index), bool(server.state.fitted)), view)
        server.controller.update_picture()

    return turn
