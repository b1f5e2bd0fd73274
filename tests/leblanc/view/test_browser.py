"""The page of `leblanc view --browser` in a headless Chromium: it shows a machine, and its slider moves it.

Needs a Chromium (Debian: chromium) and the extra `browser`; skipped without.
"""

from __future__ import annotations

import base64
import io
import signal
import subprocess
import time
from collections.abc import Callable, Iterator
from contextlib import ExitStack
from http.client import HTTPConnection
from pathlib import Path
from typing import Any
from urllib.parse import urlsplit

import numpy as np
import pytest

from leblanc import cli
from leblanc.cli import main
from leblanc.view.picture import prepare_off_screen
from meshes.errors import InputError
from tests.oracles.browser import Browser, serving

ROOT = Path(cli.__file__).parents[2]
RUNUP = str(ROOT / "examples" / "runup.toml")
VIEW = ("view", RUNUP, "--browser", "--port", "0", "--speed", "90 rad/s")
PATIENCE = 60.0  # seconds until something must have happened

pytest.importorskip("trame")
pytest.importorskip("trame_vtk")


Page = Callable[[], tuple[str, subprocess.Popen[str]]]


@pytest.fixture(scope="module")
def page() -> Iterator[Page]:
    """The page of a process that serves, the same one as long as it lives."""
    try:
        prepare_off_screen()
    except InputError as error:
        pytest.skip(str(error))
    up: list[tuple[str, subprocess.Popen[str]]] = []
    with ExitStack() as stack:

        def served_by() -> tuple[str, subprocess.Popen[str]]:
            if not up or up[-1][1].poll() is not None:
                up.append(
                    stack.enter_context(
                        serving("view", RUNUP, "--browser", "--port", "0", "--speed", "90 rad/s")
                    )
                )
            return up[-1]

        yield served_by


def wait_for(what: Callable[[], Any], words: str) -> Any:
    """The first true value, asked for again and again until patience ends."""
    until = time.monotonic() + PATIENCE
    while time.monotonic() < until:
        value = what()
        if value:
            return value
        time.sleep(0.1)
    raise AssertionError(f"never: {words}")


SIGHT = (
    "(() => { const b = document.querySelector('.sight').getBoundingClientRect();"
    " return [b.x, b.y, b.width, b.height]; })()"
)


def seen(tab: Browser, where: str = SIGHT) -> np.ndarray:
    """Pixels of the part of the page that shows the machine."""
    from PIL import Image

    box = tab.value(where)
    clip = dict(zip(("x", "y", "width", "height"), box, strict=True)) | {"scale": 1}
    data = tab.ask("Page.captureScreenshot", format="png", clip=clip)["data"]
    return np.asarray(Image.open(io.BytesIO(base64.b64decode(data))).convert("RGB")).astype(int)


def machine(pixels: np.ndarray) -> np.ndarray:
    """Its middle, without the words at head and foot."""
    height = pixels.shape[0]
    return pixels[height // 5 : 4 * height // 5]


def move(tab: Browser, selector: str, value: str) -> None:
    tab.value(
        f"(() => {{ const e = document.querySelector({selector!r}); {value};"
        " e.dispatchEvent(new Event('input', {bubbles: true}));"
        " e.dispatchEvent(new Event('change', {bubbles: true})); return true; })()"
    )


def is_still(tab: Browser) -> np.ndarray | None:
    """The picture once two looks in a row agree: the server sends a coarse image first."""
    first = seen(tab)
    again = seen(tab)
    return again if np.array_equal(first, again) else None


def test_the_slider_moves_the_liquid(page: Page, tab: Browser) -> None:
    address, _ = page()
    tab.open(address)
    said = "(document.querySelector('#value') || {}).textContent || ''"
    wait_for(lambda: "(90 rad/s)" in tab.value(said), "the speed asked for is shown")
    shown = wait_for(lambda: np.ptp(machine(seen(tab))) > 100, "a picture")
    assert shown
    before = wait_for(lambda: is_still(tab) is not None and [seen(tab)], "a picture at rest")[0]
    # The machine is there, blue liquid with it, on white.
    body = machine(before)
    assert 0.05 < np.mean(np.any(body < 240, axis=2)) < 0.95
    assert np.mean(body[..., 2] > body[..., 0] + 40) > 0.01

    move(tab, "#speed", "e.value = 76")  # 24 rad/s: at resonance, the wall dry in part
    wait_for(lambda: "(24 rad/s)" in tab.value(said), "the speed chosen is shown")
    words = tab.value("document.querySelector('#words').textContent")
    assert "dry in part" in words
    assert "mm at" in words

    def changed() -> bool:
        now = machine(seen(tab))
        return now.shape == body.shape and bool(np.mean(np.abs(now - body).max(axis=2) > 60) > 0.02)

    wait_for(changed, "the slider moves the liquid")

    # Buttons turn the machine, the box changes the factor.
    oblique = machine(seen(tab))
    tab.value("document.querySelectorAll('button.view')[1].click()")
    wait_for(lambda: np.mean(np.abs(machine(seen(tab)) - oblique).max(axis=2) > 60) > 0.05, "another view")

    # Nothing is asked for elsewhere, and nothing goes wrong on the page.
    own = (address.partition("?")[0], "blob:", "data:", "about:")
    assert all(one.startswith(own) for one in tab.requests()), tab.requests()
    assert not [one for one in tab.complaints() if "exception" in one.lower()]
    tab.open("about:blank")  # or it goes on drawing


def test_a_page_without_a_server(tmp_path: Path, tab: Browser) -> None:
    pytest.importorskip("trame_pyvista")
    try:
        prepare_off_screen()
    except InputError as error:
        pytest.skip(str(error))
    file, heard = tmp_path / "page.html", [signal.getsignal(one) for one in (signal.SIGINT, signal.SIGTERM)]
    assert main(["view", RUNUP, "--speed", "24 rad/s", "--screenshot", str(file)]) == 0
    assert [signal.getsignal(one) for one in (signal.SIGINT, signal.SIGTERM)] == heard
    assert signal.set_wakeup_fd(-1) == -1  # of nobody who is gone
    tab.open(file.as_uri())

    def drawn() -> bool:
        box = "[0, 0, innerWidth, innerHeight]"
        body = machine(seen(tab, box))
        return bool(np.mean(body[..., 2] > body[..., 0] + 40) > 0.01)

    wait_for(drawn, "blue liquid")
    assert "dry in part" in tab.value("document.querySelector('#words').textContent")
    assert all(one.startswith(("file:", "blob:")) for one in tab.requests()), tab.requests()
    tab.open("about:blank")


def status(address: str, **headers: str) -> tuple[int, dict[str, str]]:
    """Status and headers of the answer to one request, redirections not followed."""
    place = urlsplit(address)
    connection = HTTPConnection("localhost", place.port, timeout=PATIENCE)
    try:
        connection.request("GET", f"{place.path}?{place.query}".rstrip("?"), headers=headers)
        answer = connection.getresponse()
        return answer.status, dict(answer.getheaders())
    finally:
        connection.close()


def test_who_has_no_token_sees_nothing(page: Page) -> None:
    upgrade = {
        "Connection": "Upgrade",
        "Upgrade": "websocket",
        "Sec-WebSocket-Version": "13",
        "Sec-WebSocket-Key": base64.b64encode(bytes(16)).decode(),
    }
    address, _ = page()
    place, _, token = address.partition("?token=")
    socket = f"{place}ws"
    assert len(token) >= 32
    for asked in (place, f"{place}index.html", socket, f"{place}?token=", f"{place}?token={token[:-1]}"):
        assert status(asked)[0] == 403, asked
    assert status(socket, **upgrade)[0] == 403

    code, headers = status(address)
    assert (code, headers["Location"]) == (302, "/index.html")
    assert {"HttpOnly", "SameSite=Lax"} <= set(headers["Set-Cookie"].split("; "))
    cookie = headers["Set-Cookie"].partition(";")[0]
    own = place.rstrip("/")
    assert status(f"{place}index.html", Cookie=cookie)[0] == 200
    assert status(socket, Cookie=cookie, Origin=own, **upgrade)[0] == 101

    # With the token, but from another page, or by a name that came to mean this machine.
    assert status(socket, Cookie=cookie, Origin="http://evil.example", **upgrade)[0] == 403
    assert status(socket, Cookie=cookie, Origin="null", **upgrade)[0] == 403
    port = urlsplit(place).port
    for host in (f"evil.example:{port}", f"localhost.evil.example:{port}", "[", ""):
        assert status(f"{place}index.html", Cookie=cookie, Host=host)[0] in (400, 403), host


def test_a_port_that_is_taken(capsys: pytest.CaptureFixture[str]) -> None:
    try:
        prepare_off_screen()
    except InputError as error:
        pytest.skip(str(error))
    import socket

    with socket.socket() as taken:
        taken.bind(("127.0.0.1", 0))
        taken.listen()
        port = str(taken.getsockname()[1])
        assert main(["view", RUNUP, "--browser", "--host", "127.0.0.1", "--port", port]) == 2
    last = capsys.readouterr().err.splitlines()[-1]
    assert "Traceback" not in last
    assert port in last


def test_ctrl_c_ends_the_page_quietly(page: Page) -> None:
    _, process = page()
    process.send_signal(signal.SIGINT)
    _, said = process.communicate(timeout=PATIENCE)
    assert process.returncode == 130, said
    assert "Traceback" not in said
    assert said.splitlines()[-1] == "leblanc: interrupted"
