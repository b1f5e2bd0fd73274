"""The page itself: its buttons by Vuetify, its form and drawings by the script beside it, served by trame."""

from __future__ import annotations

import asyncio
from collections.abc import Callable
from pathlib import Path
from typing import Any

from leblanc.app.jobs import WORKS
from leblanc.app.state import State
from leblanc.view.files import listen, server_named

STATIC = Path(__file__).with_name("static")
SERVED = "__leblanc_app"  # where the browser finds it
MODULE = {
    "serve": {SERVED: str(STATIC)},
    "scripts": [f"{SERVED}/app.js"],
    "styles": [f"{SERVED}/app.css"],
}
EMPTY = {
    "form": {"name": "", "file": "", "groups": [], "text": "", "undo": False, "redo": False, "runup": False},
    "curve": {"curve": None, "mark": ""},
    "words": {"headline": "", "about": "", "error": "", "cautions": [], "notes": [], "tables": []},
    "compared": {"frozen": [], "measured": None},
    "jobs": [],
    "said": {"text": "", "path": "", "mark": ""},
}


def serve(text: str, file: str, host: str, port: int, ready: Callable[[str], None]) -> None:
    """Serve the page of a machine file until interrupted; port 0 takes a free one.

    `ready` is called with the address, which carries a token, once the page can be opened. A `SceneError` for
    a wrong text, an OSError where the address cannot be listened at.
    """
    asyncio.run(_serve(text, file, host, port, ready))


async def _serve(text: str, file: str, host: str, port: int, ready: Callable[[str], None]) -> None:
    loop = asyncio.get_running_loop()
    server = server_named(f"leblanc app {file}")

    def push(name: str, value: Any) -> None:
        def change() -> None:
            with server.state as shown:
                shown[name] = value

        loop.call_soon_threadsafe(change)

    state = State(text, file, push)
    try:
        server.enable_module(MODULE)
        server.state.update(EMPTY)
        _page(server, state)
        state.begin()
        await listen(server, host, port, ready)
    finally:
        state.close()


def _page(server: Any, state: State) -> None:
    """What stands on the page, and what its controls call."""
    from trame.ui.vuetify3 import VAppLayout
    from trame.widgets import html, vuetify3

    for call in (
        *(state.drag, state.edit, state.undo, state.redo, state.freeze, state.clear, state.measured),
        *(state.open, state.start, state.cancel, state.dismiss, state.content, state.take_best),
    ):
        server.controller.trigger(call.__name__)(call)
    server.controller.trigger("alive")(lambda: True)
    server.state.trame__title = f"{state.machine.scene.name} - leblanc"

    def button(text: str, **given: Any) -> None:
        vuetify3.VBtn(text, size="small", variant="tonal", **given)

    with VAppLayout(server), vuetify3.VMain():
        with html.Header(classes="lb-head"):
            html.H1("{{ form.name }}")
            compared = "!compared.frozen.length && !compared.measured"
            with html.Div(classes="lb-tools", role="toolbar"):
                button("Undo", id="undo", click="trigger('undo')", disabled=("!form.undo",))
                button("Redo", id="redo", click="trigger('redo')", disabled=("!form.redo",))
                button("Freeze curve", id="freeze", click="trigger('freeze')")
                button("Measured curve", id="measure")
                button("Clear comparison", id="clear", click="trigger('clear')", disabled=(compared,))
                button("Open", id="open")
                button("Save", id="save")
            with html.Div(classes="lb-tools", role="toolbar", aria_label="Work that takes its time"):
                for kind, work in WORKS.items():
                    missing = ("!form.runup",) if kind == "runup" else ("false",)
                    button(work.title, id=f"start-{kind}", disabled=missing)
        vuetify3.VAlert(
            "{{ said.text }}",
            v_if="said.text && !said.path",
            id="said",
            type="warning",
            density="compact",
            icon=False,
            role="alert",
        )
        with html.Div(classes="lb-page"):
            html.Section(id="form", classes="lb-form")
            with html.Section(classes="lb-middle", aria_label="Answer"):
                html.Div(id="chart", classes="lb-chart")
                html.Div(id="section", classes="lb-section")
                with (
                    html.Div(classes="lb-jobs", id="jobs"),
                    html.Div(
                        v_for="job in jobs", key=("job.kind",), classes="lb-job", id=("'job-' + job.kind",)
                    ),
                ):
                    html.B("{{ job.title }}")
                    html.Span("{{ job.words }}", classes="lb-job-words")
                    vuetify3.VProgressLinear(
                        v_if="job.state === 'runs'",
                        model_value=("job.done || 0",),
                        indeterminate=("job.done === null",),
                        aria_label=("job.title",),
                    )
                    runs = "job.state === 'runs'"
                    button("Cancel", click="trigger('cancel', [job.kind])", v_if=runs, classes="lb-cancel")
                    button("Close", click="trigger('dismiss', [job.kind])", v_else=True, classes="lb-dismiss")
                    html.Div(classes="lb-result")
            html.Section(id="words", classes="lb-words", aria_label="Numbers")
