"""`python -m validation.benchmarks.app`: from a slider's move to the picture, in a Chromium.

Each scene's volume is drawn by a slider; the page itself takes the time from the move to the first frame that
shows its answer. Beside it the same question by `lb.run` in a process of its own, in turns, since other work
on the machine slows both alike. Needs a Chromium and a checkout, whose tests drive it.
"""

from __future__ import annotations

import json
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
    """Median and 95 % of so many moves each, ms, and of the answer alone."""
    rows: list[dict[str, Any]] = []
    for title, (name, path) in SCENES.items():
        with _page(name) as tab, _alone(name, path) as ask:
            drawn, answered = [], []
            volume = _volume(tab, path)
            for k in range(-5, moves):  # the first five warm up
                place = 300 + 400 * (k % 20) // 20 + (k + 5) // 20
                seconds = float(tab.value(MOVE % (path, place))) / 1e3
                alone = ask(volume * (0.8 + 0.4 * (k + 5) / (moves + 5)))
                if k >= 0:
                    drawn.append(seconds)
                    answered.append(alone)
        rows.append({"scene": title} | _spread("picture", drawn) | _spread("answer", answered))
        yield _line(rows[-1])
    if json is not None:
        write(json, {"moves": moves, "rows": rows})


def _spread(name: str, times: list[float]) -> dict[str, float]:
    late = statistics.quantiles(times, n=20)[-1] if len(times) > 1 else times[0]
    return {f"{name}_median": statistics.median(times), f"{name}_late": late}


def _line(row: dict[str, Any]) -> str:
    found = (
        f"{name} {1e3 * row[f'{name}_median']:6.0f} ms, 95 % {1e3 * row[f'{name}_late']:6.0f} ms"
        for name in ("picture", "answer")
    )
    return f"{row['scene']:13} {'; '.join(found)}"


def _volume(tab: Any, path: str) -> float:
    """Value of the machine at a path, SI."""
    import leblanc as lb

    found: Any = lb.Scene.from_toml(tab.value("trame.state.get('form').text"))
    for key in path.split("."):
        found = found[int(key)] if key.isdecimal() else getattr(found, key)
    return float(found)


@contextmanager
def _page(name: str) -> Iterator[Any]:
    """The page of an example in a browser, once it shows an answer and its words."""
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
            yield tab
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
