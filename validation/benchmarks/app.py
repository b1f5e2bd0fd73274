"""`python -m validation.benchmarks.app`: from a slider's move to the picture, in a Chromium.

Each scene's volume is drawn by a slider; the page itself takes the time from the move to the first frame that
shows its answer. Beside it the same question by `lb.run` in a process of its own, in turns, since other work
on the machine slows both alike. Needs a Chromium and a checkout, whose tests drive it.
"""

from __future__ import annotations

import json
import os
import statistics
import subprocess
import sys
import time
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

from leblanc.scene.examples import example_path
from meshes.errors import InputError
from validation.study import launch, write

SCENES = {
    "planar rotor": ("horizontal_rig", "chambers.0.volume"),
    "tub": ("tub", "chambers.0.volume"),
    "two planes": ("two_plane_rig", "chambers.0.volume"),
}
WAIT = 60.0  # s for one picture
BLOCK, REST = 10, 2.0  # moves one after another, as a slider is drawn; s between them
MOVE = """
new Promise((done) => {
  addEventListener('leblanc:drawn', (event) => done(event.detail.ms), { once: true });
  const slider = document.querySelector('[data-path="%s"] input[type=range]');
  slider.value = %d;
  slider.dispatchEvent(new Event('input'));
})
"""
ASK = """
import json, sys, time
import leblanc as lb
base = lb.example(sys.argv[1])
for line in sys.stdin:
    begin = time.perf_counter()
    answer = lb.run(base.replace({sys.argv[2]: float(line)}))
    for what in ("peak", "stable", "whirl_bands"):
        getattr(answer, what)
    print(time.perf_counter() - begin, flush=True)
"""


def main(moves: int = 60, json: Path | None = None) -> Iterator[str]:
    """Median and 95 % of so many moves, of the answer alone, and the server's processor time a move."""
    rows: list[dict[str, Any]] = []
    for title, (name, path) in SCENES.items():
        drawn: list[float] = []
        answered: list[float] = []
        spent: list[float] = []
        with _page(name) as (tab, server), _alone(name, path) as ask:
            value = _value(tab, path)
            for block in range(-1, -(-moves // BLOCK)):  # the first one warms up
                before = _processor(server)
                pictures = [float(tab.value(MOVE % (path, 300 + 20 * k + block))) / 1e3 for k in range(BLOCK)]
                used = (_processor(server) - before) / BLOCK
                time.sleep(REST)  # until its words are made too
                alone = [ask(value * (0.8 + 0.02 * k + 1e-3 * block)) for k in range(BLOCK)]
                if block >= 0:
                    drawn, answered, spent = drawn + pictures, answered + alone, [*spent, used]
        row = {"scene": title, "processor": statistics.median(spent)}
        rows.append(row | _spread("picture", drawn) | _spread("answer", answered))
        yield _line(rows[-1])
    if json is not None:
        write(json, {"moves": moves, "rows": rows})


def _processor(server: int) -> float:
    """Processor time of a process so far, s; of Linux."""
    parts = Path(f"/proc/{server}/stat").read_text(encoding="ascii").rpartition(")")[2].split()
    return (int(parts[11]) + int(parts[12])) / os.sysconf("SC_CLK_TCK")


def _spread(name: str, times: list[float]) -> dict[str, float]:
    late = statistics.quantiles(times, n=20)[-1] if len(times) > 1 else times[0]
    return {f"{name}_median": statistics.median(times), f"{name}_late": late}


def _line(row: dict[str, Any]) -> str:
    found = (
        f"{name} {1e3 * row[f'{name}_median']:6.0f} ms, 95 % {1e3 * row[f'{name}_late']:6.0f} ms"
        for name in ("picture", "answer")
    )
    return f"{row['scene']:13} {'; '.join(found)}; processor {1e3 * row['processor']:4.0f} ms a move"


def _value(tab: Any, path: str) -> float:
    """Value of the machine at a path, SI."""
    import leblanc as lb

    found: Any = lb.Scene.from_toml(tab.value("trame.state.get('form').text"))
    for key in path.split("."):
        found = found[int(key)] if key.isdecimal() else getattr(found, key)
    return float(found)


@contextmanager
def _page(name: str) -> Iterator[tuple[Any, int]]:
    """Tab with the page of an example, once it shows its words, and the number of its server."""
    from tests.oracles.browser import browser, found  # of a checkout

    path = found()
    if path is None:
        raise InputError("chromium", None, "on the path")
    command = [sys.executable, "-m", "leblanc", "app", str(example_path(name)), "--port", "0"]
    server = subprocess.Popen(command, stdout=subprocess.PIPE, stderr=subprocess.DEVNULL, text=True)
    try:
        assert server.stdout is not None
        address = server.stdout.readline().split()[1]
        with browser(path) as tab:
            tab.open(address, 1400)
            until = time.monotonic() + WAIT
            while not tab.value("!!document.querySelector('#words table')"):
                assert time.monotonic() < until, "the page shows no answer"
                time.sleep(0.1)
            yield tab, server.pid
    finally:
        server.terminate()
        server.wait()


@contextmanager
def _alone(name: str, path: str) -> Iterator[Any]:
    """Seconds of an answer at a value, in a process that has answered before."""
    process = subprocess.Popen(
        [sys.executable, "-c", ASK, name, path], stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True
    )

    def ask(value: float) -> float:
        assert process.stdin is not None and process.stdout is not None
        process.stdin.write(f"{value!r}\n")
        process.stdin.flush()
        return float(json.loads(process.stdout.readline()))

    try:
        yield ask
    finally:
        process.communicate()


if __name__ == "__main__":
    launch(main)
