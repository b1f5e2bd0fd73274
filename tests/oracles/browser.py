"""A headless Chromium for tests of pages, driven over its debugging pipe, without any other library."""

from __future__ import annotations

import base64
import json
import os
import select
import shutil
import signal
import subprocess
import sys
import time
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass, field
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any

import pytest

NAMES = ("chromium", "chromium-browser", "google-chrome", "chrome")
FLAGS = (
    "--headless",
    "--no-sandbox",
    "--disable-gpu",
    "--disable-quic",
    "--no-first-run",
    "--disable-background-networking",
    "--disable-component-update",
    "--disable-sync",
    "--disable-dev-shm-usage",
    "--hide-scrollbars",
)
# Puts the ends of the pipes where the browser looks for them, whatever their numbers are.
LAUNCH = """
import os, sys
ends = [os.dup(os.dup(os.dup(int(one)))) for one in sys.argv[1:3]]
for place, end in zip((3, 4), ends):
    os.dup2(end, place)
os.execv(sys.argv[3], sys.argv[3:])
"""
ROOT = Path(__file__).parents[2]
PATIENCE = 60.0  # seconds for one answer
PAPER = {"A4": (210.0 / 25.4, 297.0 / 25.4), "Letter": (8.5, 11.0)}  # inches


def found() -> str | None:
    """Path of a Chromium, None without one."""
    return next((path for name in NAMES if (path := shutil.which(name))), None)


@contextmanager
def serving(*arguments: str) -> Iterator[tuple[str, subprocess.Popen[str]]]:
    """Address of the page that a command of leblanc serves in a process of its own, gone at the end."""
    code = f"import sys; sys.path.insert(0, {str(ROOT)!r}); from leblanc.cli import main; sys.exit(main())"
    process = subprocess.Popen(
        [sys.executable, "-c", code, *arguments],
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
        text=True,
        # A shell that starts the tests in the background has Ctrl-C ignored, which would be passed on.
        preexec_fn=lambda: signal.signal(signal.SIGINT, signal.default_int_handler),
    )
    try:
        assert process.stdout is not None
        ready, _, _ = select.select([process.stdout], [], [], PATIENCE)
        assert ready, "the page does not come up"
        said = process.stdout.readline()
        assert said.startswith("Open http://"), process.communicate(timeout=PATIENCE)
        yield said.split()[1], process
    finally:
        if process.poll() is None:
            process.kill()
        process.communicate()


@dataclass
class Browser:
    """One tab of a headless browser.

    Parameters
    ----------
    send, receive : file descriptors of its debugging pipe
    events : what it told unasked
    """

    send: int
    receive: int
    session: str | None = None
    events: list[dict[str, Any]] = field(default_factory=list)
    count: int = 0
    rest: bytes = b""

    def ask(self, method: str, **parameters: Any) -> dict[str, Any]:
        """Result of one command."""
        self.count += 1
        message: dict[str, Any] = {"id": self.count, "method": method, "params": parameters}
        if self.session is not None:
            message["sessionId"] = self.session
        data = json.dumps(message).encode() + b"\0"
        while data:
            data = data[os.write(self.send, data) :]
        while True:
            answer = self._next()
            if answer.get("id") == self.count:
                assert "error" not in answer, answer["error"]
                return dict(answer["result"])
            self.events.append(answer)

    def _next(self) -> dict[str, Any]:
        until = time.monotonic() + PATIENCE
        while b"\0" not in self.rest:
            ready, _, _ = select.select([self.receive], [], [], max(0.0, until - time.monotonic()))
            assert ready, "the browser does not answer"
            data = os.read(self.receive, 1 << 20)
            assert data, "the browser is gone"
            self.rest += data
        first, _, self.rest = self.rest.partition(b"\0")
        return dict(json.loads(first))

    def open(self, address: str, width: int = 1280, height: int = 900) -> None:
        """Load a page in a window of some size, pixels, and wait until it is there."""
        self.events.clear()
        self.ask(
            "Emulation.setDeviceMetricsOverride",
            width=width,
            height=height,
            deviceScaleFactor=1,
            mobile=False,
        )
        self.ask("Page.navigate", url=address)
        while not any(one.get("method") == "Page.loadEventFired" for one in self.events):
            self.events.append(self._next())

    def value(self, expression: str) -> Any:
        """What a script of the tester finds on the page, whatever scripts the page itself allows."""
        found = self.ask("Runtime.evaluate", expression=expression, returnByValue=True, awaitPromise=True)
        assert "exceptionDetails" not in found, found
        return found["result"].get("value")

    def requests(self) -> list[str]:
        """Addresses asked for since the page was opened, data in the page itself left out."""
        asked = [one for one in self.events if one.get("method") == "Network.requestWillBeSent"]
        urls = [str(one["params"]["request"]["url"]) for one in asked]
        return [url for url in urls if not url.startswith("data:")]

    def complaints(self) -> list[str]:
        """Errors and warnings that the browser or the page told since it was opened."""
        told = [one for one in self.events if one.get("method") == "Log.entryAdded"]
        said = [one for one in self.events if one.get("method", "").startswith("Runtime.")]
        return [str(one["params"]["entry"]["text"]) for one in told] + [
            json.dumps(one["params"])
            for one in said
            if one["method"] in ("Runtime.exceptionThrown", "Runtime.consoleAPICalled")
        ]

    def picture(self, path: Path) -> None:
        """The whole page as PNG."""
        data = self.ask("Page.captureScreenshot", format="png", captureBeyondViewport=True)["data"]
        path.write_bytes(base64.b64decode(data))

    def paper(self, path: Path, size: str = "A4") -> int:
        """The page as PDF on paper of a size, and how many sheets it takes."""
        wide, high = PAPER[size]
        data = self.ask(
            "Page.printToPDF",
            paperWidth=wide,
            paperHeight=high,
            printBackground=False,
            preferCSSPageSize=False,
            displayHeaderFooter=False,
        )["data"]
        content = base64.b64decode(data)
        path.write_bytes(content)
        return (
            content.count(b"/Type /Page\n") or content.count(b"/Type /Page ") or content.count(b"/Type/Page/")
        )


@contextmanager
def browser(path: str) -> Iterator[Browser]:
    """A tab of the browser at a path, gone at the end."""
    ours_read, theirs_write = os.pipe()
    theirs_read, ours_write = os.pipe()
    with TemporaryDirectory(ignore_cleanup_errors=True) as profile:
        options = [*FLAGS, f"--user-data-dir={profile}", "--remote-debugging-pipe"]
        process = subprocess.Popen(
            [sys.executable, "-c", LAUNCH, str(theirs_read), str(theirs_write), path, *options],
            pass_fds=(theirs_read, theirs_write),
            stdout=subprocess.DEVNULL,
            stderr=subprocess.DEVNULL,
        )
        os.close(theirs_read)
        os.close(theirs_write)
        try:
            yield _tab(Browser(ours_write, ours_read))
        finally:
            os.close(ours_write)
            os.close(ours_read)
            process.terminate()
            try:
                process.wait(PATIENCE)
            except subprocess.TimeoutExpired:
                process.kill()
                process.wait()


@pytest.fixture(scope="session")
def tab() -> Iterator[Browser]:
    """One tab for all tests, empty between them."""
    path = found()
    if path is None:
        missing = pytest.fail if os.environ.get("NEED_BROWSER") else pytest.skip
        missing("no Chromium found; Debian: apt install chromium")
    with browser(path) as one:
        yield one


def _tab(one: Browser) -> Browser:
    """The same, attached to a fresh tab that tells what it does."""
    target = one.ask("Target.createTarget", url="about:blank")["targetId"]
    one.session = one.ask("Target.attachToTarget", targetId=target, flatten=True)["sessionId"]
    for domain in ("Page", "Network", "Log", "Runtime"):
        one.ask(f"{domain}.enable")
    return one
