"""Pictures of the page of `leblanc app` on two screens, by a headless Chromium.

python docs/app_pictures.py --out docs/images
"""

from __future__ import annotations

import argparse
import base64
import io
import subprocess
import sys
import time
from pathlib import Path

from PIL import Image

ROOT = Path(__file__).resolve().parents[1]
sys.path.insert(0, str(ROOT))

from tests.oracles.browser import Browser, browser, found  # noqa: E402 - of this repository

SCENE = ROOT / "examples" / "horizontal_rig.toml"
COLOURS = 128  # of a picture, which makes its file a third as large
START = f"import sys; sys.path.insert(0, {str(ROOT)!r}); from leblanc.cli import main; sys.exit(main())"
TYPED = """(() => { const box = document.getElementById('field-rotor.unbalance'); box.value = '0.5 kg*mm';
box.dispatchEvent(new Event('change')); return true; })()"""


def main() -> int:
    """Draw both pictures into a folder."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--out", type=Path, required=True)
    out = parser.parse_args().out
    out.mkdir(parents=True, exist_ok=True)
    path = found()
    if path is None:
        raise SystemExit("no Chromium on the path")
    command = [sys.executable, "-c", START, "app", str(SCENE), "--port", "0"]
    server = subprocess.Popen(command, stdout=subprocess.PIPE, text=True)
    try:
        assert server.stdout is not None
        address = server.stdout.readline().split()[1]
        with browser(path) as tab:
            tab.open(address, 1400, 900)
            until(tab, "!!document.querySelector('#words table') && !!document.querySelector('#wet')")
            tab.value("document.querySelector('#freeze').click()")
            until(tab, "document.querySelector('#key').textContent.includes('frozen 1')")
            tab.value("void (window.before = document.querySelector('#headline').textContent)")
            tab.value(TYPED)
            until(tab, "document.querySelector('#headline').textContent !== window.before")
            save(tab, out / "app_wide.png")
            tab.open(address, 390, 844)
            until(tab, "!!document.querySelector('#words table') && !!document.querySelector('#wet')")
            tab.value("scrollTo(0, document.querySelector('.lb-head').offsetHeight)")
            save(tab, out / "app_telephone.png")
    finally:
        server.terminate()
        server.wait()
    return 0


def until(tab: Browser, expression: str) -> None:
    """Wait for something on the page."""
    end = time.monotonic() + 60.0
    while not tab.value(expression):
        if time.monotonic() > end:
            raise SystemExit(f"never: {expression}")
        time.sleep(0.1)


def save(tab: Browser, path: Path) -> None:
    """What the window shows, once it rests, in few colours."""
    time.sleep(1.0)
    data = base64.b64decode(tab.ask("Page.captureScreenshot", format="png")["data"])
    image = Image.open(io.BytesIO(data)).convert("RGB").quantize(COLOURS, dither=Image.Dither.NONE)
    image.save(path, optimize=True)


if __name__ == "__main__":
    sys.exit(main())
