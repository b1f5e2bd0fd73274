"""The page of `leblanc app` in a headless Chromium: every control, random walks, two pages at once.

Needs a Chromium (Debian: chromium) and the extra `app`; skipped without, but not where CI is set.
"""

from __future__ import annotations

import json
import os
import random
import signal
import subprocess
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from http.client import HTTPConnection
from importlib.util import find_spec
from pathlib import Path
from typing import Any
from urllib.parse import urlsplit

import pytest

import leblanc as lb
from leblanc import cli
from leblanc.cli import main
from tests.oracles.browser import Browser, browser, found, serving

ROOT = Path(cli.__file__).parents[2]
SCENE = ROOT / "examples" / "washing_machine.toml"
MEASURED = ROOT / "docs" / "examples" / "measured.csv"
PATIENCE = 20.0  # s until something must have happened
TELEPHONE = (390, 844)

if not os.environ.get("NEED_BROWSER"):  # there a missing library fails
    pytest.importorskip("trame_vuetify")


class App:
    """The page of a process of its own, in a tab."""

    def __init__(self, tab: Browser, address: str, width: int = 1400, height: int = 900) -> None:
        self.tab, self.address = tab, address
        tab.open(address, width, height)
        self.until("!!document.querySelector('#wet') && !!document.querySelector('#words table')")

    def until(self, expression: str, patience: float = PATIENCE) -> Any:
        """Wait until an expression is true on the page."""
        end = time.monotonic() + patience
        while time.monotonic() < end:
            if value := self.tab.value(expression):
                return value
            time.sleep(0.05)
        raise AssertionError(f"never: {expression}; {self.shown('said')}")

    def shown(self, name: str) -> Any:
        """What the server has told the page."""
        return json.loads(self.tab.value(f"JSON.stringify(trame.state.get({name!r}))"))

    def scene(self) -> lb.Scene:
        """The machine as it would be saved."""
        return lb.Scene.from_toml(self.shown("form")["text"], str(SCENE))

    def press(self, selector: str) -> None:
        """A real click in the middle of an element."""
        self.until(f"!!document.querySelector({json.dumps(selector)})")
        x, y = self.tab.value(
            f"(() => {{ const e = document.querySelector({selector!r});"
            " e.scrollIntoView({block: 'center'});"
            " const b = e.getBoundingClientRect(); return [b.x + b.width / 2, b.y + b.height / 2]; })()"
        )
        for kind in ("mousePressed", "mouseReleased"):
            self.tab.ask("Input.dispatchMouseEvent", type=kind, x=x, y=y, button="left", clickCount=1)

    def key(self, key: str, code: int, modifiers: int = 0) -> None:
        """A key on the keyboard."""
        for kind in ("keyDown", "keyUp"):
            self.tab.ask(
                "Input.dispatchKeyEvent", type=kind, key=key, windowsVirtualKeyCode=code, modifiers=modifiers
            )

    def type(self, path: str, text: str) -> None:
        """A value typed into a field, which is left then."""
        self.tab.value(
            f"(() => {{ const e = document.getElementById('field-' + {path!r}); e.value = {text!r};"
            " e.dispatchEvent(new Event('change', {bubbles: true})); return true; })()"
        )

    def slide(self, path: str, places: list[int], let_go: bool = True) -> None:
        """A slider drawn along some places, and let go."""
        self.tab.value(
            f"(() => {{ const e = document.querySelector('[data-path=\"{path}\"] input[type=range]');"
            f" for (const place of {places}) {{ e.value = place; e.dispatchEvent(new Event('input')); }}"
            f" if ({str(let_go).lower()}) e.dispatchEvent(new Event('change')); return true; }})()"
        )

    def choose(self, button: str, *files: Path) -> None:
        """A file handed over behind a button."""
        self.tab.ask("Page.setInterceptFileChooserDialog", enabled=True)
        self.press(button)
        kind = "open" if button == "#open" else "measured"
        self.until(f"!!document.querySelector('#pick-{kind}')")
        place = f"[...document.querySelectorAll('#pick-{kind}')].pop()"  # of several the newest
        node = self.tab.ask("Runtime.evaluate", expression=place)["result"]["objectId"]
        self.tab.ask("DOM.setFileInputFiles", objectId=node, files=[str(one) for one in files])

    def answered(self) -> None:
        """Wait until the curve is that of the machine as it would be saved."""
        end, peaks = time.monotonic() + PATIENCE, dict[str, dict[str, float]]()
        while True:
            text, curve = self.shown("form")["text"], self.shown("curve")["curve"]
            if text not in peaks:
                try:
                    peaks[text] = lb.run(lb.Scene.from_toml(text, str(SCENE))).peak
                except lb.InputError as error:
                    assert self.until("trame.state.get('said').text") == str(error)  # the page says it too
                    return
            drawn = {} if curve is None else curve["peak"]
            if drawn == pytest.approx(peaks[text], rel=1e-5):
                return
            assert time.monotonic() < end, (peaks[text], drawn)
            time.sleep(0.05)

    def is_sound(self) -> None:
        """Nothing has gone wrong in the browser, and nothing was asked for elsewhere."""
        told = [one for one in self.tab.complaints() if '"type": "info"' not in one]
        assert told == []
        own = (self.address.partition("?")[0], "blob:", "about:", "ws:")
        assert all(one.startswith(own) for one in self.tab.requests()), self.tab.requests()
        assert self.tab.value("document.getElementById('gone') === null")
        assert "NaN" not in self.tab.value("document.querySelector('.lb-middle').innerHTML")


@contextmanager
def served(scene: Path = SCENE, port: int = 0) -> Iterator[tuple[str, subprocess.Popen[str]]]:
    """Address of the page of a process of its own; at the end that has said nothing on stderr."""
    with serving("app", str(scene), "--port", str(port)) as (address, process):
        assert address.startswith("http://127.0.0.1:")
        yield address, process
        if process.poll() is None:
            process.send_signal(signal.SIGINT)
            _, told = process.communicate(timeout=PATIENCE)
            assert process.returncode == 130, told
            assert told.splitlines() == ["leblanc: interrupted"]


@pytest.fixture(scope="module")
def address() -> Iterator[str]:
    """A page that serves all tests of this module."""
    with served() as (place, _):
        yield place


@pytest.fixture
def app(tab: Browser, address: str) -> Iterator[App]:
    """The page with the machine of the file, and nothing beside it."""
    page = App(tab, address)
    page.choose("#open", SCENE)
    page.until("trame.state.get('form').undo === false && trame.state.get('jobs').length === 0")
    page.until("!!document.querySelector('#wet')")
    yield page
    page.is_sound()
    tab.open("about:blank")


VOLUME = "chambers.0.volume"


def test_every_control(app: App) -> None:
    before = app.scene()
    assert app.tab.value("document.querySelectorAll('#form .group').length") == 5
    assert app.tab.value("document.querySelectorAll('#form .assumed').length") > 0
    # A slider moves the curve while it is drawn; let go it is one step.
    app.slide("rotor.unbalance", [500, 600, 700], let_go=False)
    app.until("trame.state.get('curve').mark !== ''")
    assert app.scene() == before
    app.slide("rotor.unbalance", [800])
    app.until("trame.state.get('form').undo")
    app.answered()
    assert app.scene().rotor.unbalance > before.rotor.unbalance
    app.press("#freeze")
    app.until("document.querySelector('#key').textContent.includes('frozen 1')")
    # A bare number has the field's unit; a wrong value says what is allowed and keeps the answer.
    app.type(VOLUME, "0.45")
    app.until("document.getElementById('field-chambers.0.volume').value === '0.45 l'")
    app.answered()
    kept = app.shown("curve")["curve"]
    app.type(VOLUME, "900 l")
    said = app.until("document.querySelector('.wrong .fault')?.textContent")
    assert "must be at most what the chamber holds" in said
    assert app.shown("curve")["curve"] == kept
    assert app.scene().chambers[0].volume == pytest.approx(4.5e-4)
    app.type(VOLUME, "0.45 l")
    app.until("!document.querySelector('.wrong')")
    # Back and forth, by the buttons and by the keyboard.
    app.press("#undo")
    app.until("trame.state.get('form').redo")
    app.press("#redo")
    app.until("!trame.state.get('form').redo")
    app.tab.value("document.activeElement.blur()")
    app.key("z", 90, modifiers=2)
    app.until("trame.state.get('form').redo")
    app.key("z", 90, modifiers=2)
    app.until("!trame.state.get('form').undo")
    assert app.scene() == before
    app.answered()
    # The cursor by the keyboard; the section follows.
    app.tab.value("document.getElementById('cursor').focus()")
    reading = app.tab.value("document.getElementById('reading').textContent")
    section = app.tab.value("document.getElementById('section').innerHTML")
    for _ in range(40):
        app.key("ArrowLeft", 37)
    app.until(f"document.getElementById('reading').textContent !== {reading!r}")
    assert app.tab.value("document.getElementById('section').innerHTML") != section
    drawn = app.tab.value("document.getElementById('wet').getAttribute('d')")
    app.press("#log")
    app.until(f"document.getElementById('wet').getAttribute('d') !== {drawn!r}")
    app.press("#log")
    app.until(f"document.getElementById('wet').getAttribute('d') === {drawn!r}")
    # A measured curve, a wrong one.
    app.choose("#measure", MEASURED)
    app.until("document.querySelectorAll('circle.measured').length > 10")
    app.choose("#measure", SCENE)
    app.until("document.querySelector('#said')?.textContent.includes('must be')")
    app.press("#clear")
    app.until("document.querySelectorAll('circle.measured').length === 0")
    # A choice, a table that is not in the file, an emptied field.
    app.tab.value("document.querySelectorAll('#form details').forEach((one) => one.open = true)")
    app.type("model.friction", "none")
    app.until("trame.state.get('form').undo")
    app.type("model.tolerance", "0.01")
    app.until("trame.state.get('form').text.includes('tolerance')")
    app.type("model.tolerance", "")
    app.until("!trame.state.get('form').text.includes('tolerance')")
    app.answered()


def test_work(app: App) -> None:
    app.press("#start-best")
    app.press("#start-runup")
    app.until("document.querySelectorAll('.lb-job .v-progress-linear').length > 0")
    app.press("#job-runup .lb-cancel")
    app.until("!!document.querySelector('#job-runup .lb-dismiss')")
    app.slide("rotor.unbalance", [640])  # sliders go on meanwhile
    app.until("trame.state.get('form').undo")
    app.until("!!document.querySelector('#take-best')")
    app.press("#take-best")
    best = app.shown("jobs")[0]["result"]["volume"][0]
    area = best / app.scene().chambers[0].height
    app.until(f"Math.abs(trame.state.get('curve').curve.chambers[0].area / {area} - 1) < 1e-5")  # six digits
    app.answered()
    app.press("#start-map")
    app.press("#start-report")
    app.until("!!document.querySelector('#job-map canvas')")
    app.until("!!document.querySelector('#job-report a[download]')")
    size = "fetch(document.querySelector('#job-report a').href).then((a) => a.text()).then((a) => a.length)"
    assert app.tab.value(size) > 10_000
    for kind in ("best", "runup", "map", "report"):
        app.press(f"#job-{kind} .lb-dismiss")
        app.until(f"!document.querySelector('#job-{kind}')")


def test_what_is_saved_runs(app: App, tmp_path: Path) -> None:
    app.type(VOLUME, "321 ml")
    app.until("trame.state.get('form').undo")
    app.tab.ask("Browser.setDownloadBehavior", behavior="allow", downloadPath=str(tmp_path))
    app.press("#save")
    end = time.monotonic() + PATIENCE
    file = tmp_path / "washing_machine.toml"
    while not file.is_file():
        assert time.monotonic() < end
        time.sleep(0.05)
    text = file.read_text(encoding="utf-8")
    assert [
        one for one in SCENE.read_text(encoding="utf-8").splitlines() if "#" in one and "volume" not in one
    ] == [one for one in text.splitlines() if "#" in one and "volume" not in one]
    assert 'volume = "321 ml"' in text
    assert main(["run", str(file), "--out", str(tmp_path / "out")]) == 0


def test_a_telephone(tab: Browser, address: str) -> None:
    page = App(tab, address, *TELEPHONE)
    assert tab.value("document.documentElement.scrollWidth") <= TELEPHONE[0]
    page.tab.value("document.querySelectorAll('#form details').forEach((one) => one.open = true)")
    assert tab.value("document.documentElement.scrollWidth") <= TELEPHONE[0]
    # The curve stays in sight while a field far below is changed.
    assert tab.value(
        "(() => { const all = document.querySelectorAll('#form .field'); [...all].pop().scrollIntoView();"
        " const b = document.querySelector('#chart svg').getBoundingClientRect();"
        " return b.top >= -1 && b.bottom < innerHeight; })()"
    )
    small = tab.value(
        "[...document.querySelectorAll('.lb-tools button, #form input, #form select')].filter((one) =>"
        " one.offsetParent && one.type !== 'checkbox' && one.getBoundingClientRect().height < 24)"
        ".map((one) => one.outerHTML)"
    )
    assert small == []
    page.is_sound()
    tab.open("about:blank")


def test_by_the_keyboard_alone(app: App) -> None:
    """Tab reaches every control in sight, and each has a name."""
    app.tab.value("document.activeElement.blur(); scrollTo(0, 0); 1")
    wanted = app.tab.value(
        "[...document.querySelectorAll('button, input, select, summary')].filter((one) =>"
        " one.offsetParent && !one.disabled && (one.checkVisibility ? one.checkVisibility() : true)).length"
    )
    reached = set()
    for _ in range(wanted + 20):
        app.key("Tab", 9)
        reached.add(
            app.tab.value(
                "[...document.querySelectorAll('button, input, select, summary')]"
                ".indexOf(document.activeElement)"
            )
        )
    assert len(reached - {-1}) >= wanted
    nameless = app.tab.value(
        "[...document.querySelectorAll('input, select, button')]"
        ".filter((one) => !(one.labels && one.labels.length)"
        " && !one.getAttribute('aria-label') && !one.textContent.trim()).map((one) => one.outerHTML)"
    )
    assert nameless == []


def test_two_pages_show_one_machine(app: App) -> None:
    path = found()
    assert path is not None
    with browser(path) as other_tab:
        other = App(other_tab, app.address)
        app.type(VOLUME, "111 ml")
        other.until("document.getElementById('field-chambers.0.volume').value === '111 ml'")
        other.slide("rotor.unbalance", [900])
        other.until("trame.trigger('alive', [])")  # what it asked for before has been heard
        app.answered()
        other.answered()
        assert app.scene() == other.scene()
        # Both at once, at odds.
        for place in range(300, 700, 40):
            app.slide("rotor.unbalance", [place])
            other.slide("rotor.mass", [place])
        for page in (app, other):
            page.until("trame.trigger('alive', [])")
        app.answered()
        other.answered()
        assert app.scene() == other.scene()
        other.is_sound()


def test_a_server_that_is_killed_and_started_again(tab: Browser) -> None:
    with served() as (place, process):
        page = App(tab, place)
        port = urlsplit(place).port
        assert port is not None
        page.type(VOLUME, "222 ml")
        page.until("trame.state.get('form').undo")
        process.kill()
        process.wait(PATIENCE)
        assert "start leblanc app again" in page.until("document.getElementById('gone')?.textContent")
        assert page.scene().chambers[0].volume == pytest.approx(2.22e-4)  # what Save keeps
        tab.open("about:blank")
    with served(port=port) as (again, _):
        assert again != place
        page = App(tab, again)
        assert page.scene() == lb.load_scene(SCENE)
        page.is_sound()
        tab.open("about:blank")


def status(address: str, **headers: str) -> int:
    place = urlsplit(address)
    connection = HTTPConnection("127.0.0.1", place.port or 0, timeout=PATIENCE)
    try:
        connection.request("GET", f"{place.path}?{place.query}".rstrip("?"), headers=headers)
        return connection.getresponse().status
    finally:
        connection.close()


def test_who_has_no_token_sees_nothing(address: str) -> None:
    place, _, _ = address.partition("?token=")
    for asked in (place, f"{place}index.html", f"{place}ws", f"{place}__leblanc_app/app.js", f"{address}x"):
        assert status(asked) == 403, asked
    assert status(address) == 302
    assert status(address, Origin="http://evil.example") == 403
    assert status(address, Host="evil.example") == 403


@pytest.mark.parametrize("seed", [0])
def test_a_walk(seed: int, app: App) -> None:
    walk(app, random.Random(seed), 100)


@pytest.mark.slow
@pytest.mark.parametrize("seed", range(1, 21))
def test_walks(seed: int, app: App) -> None:
    walk(app, random.Random(seed), 200)


WRONG = ("", "-1", "abc", "1e99 m", "12 parsec", "{", '"', "nan", "0 mm", "<b>x</b>", "١٢ ml")


def walk(app: App, draw: random.Random, count: int) -> None:
    """Random actions without waiting; then the page shows what the saved machine answers."""
    app.tab.value("document.querySelectorAll('#form details').forEach((one) => one.open = true)")
    done: list[str] = []

    def paths(slider: bool) -> list[str]:
        groups = app.shown("form")["groups"]
        every = [one for group in groups for part in group["sets"] for one in part["fields"]]
        return [one["path"] for one in every if (one["slider"] is not None or not slider)]

    def slide() -> None:
        start = draw.randrange(1000)
        app.slide(
            draw.choice(paths(True)), [start, draw.randrange(1000), draw.randrange(1000)], draw.random() < 0.9
        )

    def kind(name: str) -> str:
        return draw.choice(["map", "best", "report"]) if name == "start" else name

    actions: list[tuple[int, str, Callable[[], object]]] = [
        (30, "slide", slide),
        (8, "type", lambda: app.type(draw.choice(paths(False)), draw.choice(WRONG))),
        (8, "type", lambda: app.type(VOLUME, f"{draw.uniform(1, 900):.3g} ml")),
        (10, "undo", lambda: app.tab.value("document.querySelector('#undo').click()")),
        (6, "redo", lambda: app.tab.value("document.querySelector('#redo').click()")),
        (5, "freeze", lambda: app.tab.value("document.querySelector('#freeze').click()")),
        (3, "clear", lambda: app.tab.value("document.querySelector('#clear').click()")),
        (3, "measure", lambda: app.choose("#measure", MEASURED)),
        (
            8,
            "cursor",
            lambda: app.tab.value(
                f"(() => {{ const e = document.getElementById('cursor'); e.value = {draw.randrange(1000)};"
                " e.dispatchEvent(new Event('input')); return true; })()"
            ),
        ),
        (3, "log", lambda: app.tab.value("document.querySelector('#log').click()")),
        (2, "start", lambda: app.tab.value(f"document.querySelector('#start-{kind('start')}').click()")),
        (3, "cancel", lambda: app.tab.value("document.querySelector('.lb-cancel')?.click()")),
        (2, "take", lambda: app.tab.value("document.querySelector('#take-best')?.click()")),
        (2, "dismiss", lambda: app.tab.value("document.querySelector('.lb-dismiss')?.click()")),
        (
            2,
            "narrow",
            lambda: app.tab.ask(
                "Emulation.setDeviceMetricsOverride",
                width=draw.choice([390, 800, 1400]),
                height=844,
                deviceScaleFactor=1,
                mobile=False,
            ),
        ),
    ]
    for _ in range(count):
        ((_, name, action),) = draw.choices(actions, [weight for weight, _, _ in actions])
        done.append(name)
        action()
    try:
        app.tab.value("[...document.querySelectorAll('.lb-cancel')].map((one) => one.click()).length")
        app.until("trame.trigger('alive', [])")
        # What a slider was left at without letting go is taken back by a step.
        app.tab.value("trame.trigger('undo', []).then(() => 1)")
        app.answered()
        app.is_sound()
    except AssertionError as error:
        raise AssertionError(f"after {done}: {error}") from error


def test_where_ci_is_set_a_browser_must_be_there() -> None:
    if os.environ.get("NEED_BROWSER"):
        assert found() is not None and find_spec("trame_vuetify") is not None
