"""A chamber with four lobes round a shaft: its mesh, written beside its scene, and its picture.

python docs/examples/lobes.py --out DIR
"""

from __future__ import annotations

import argparse
import shutil
from pathlib import Path

import numpy as np

from leblanc.cli import main
from meshes.files.exchange import write_section
from meshes.section import Section, annulus

WALL, SHAFT = 0.18, 0.07  # m


def lobes() -> Section:
    """Section whose wall waves four times round it."""
    base = annulus(WALL, SHAFT, 72, order=2)
    away, angle = np.hypot(*base.points.T), np.arctan2(base.points[:, 1], base.points[:, 0])
    stretch = 1.0 + 0.04 * np.cos(4.0 * angle) * ((away - SHAFT) / (WALL - SHAFT)) ** 2
    return Section(base.points * stretch[:, None], base.triangles)


if __name__ == "__main__":
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--out", type=Path, default=Path("out/lobes"))
    out = parser.parse_args().out
    out.mkdir(parents=True, exist_ok=True)
    write_section(lobes(), out / "lobes.msh")
    shutil.copy(Path(__file__).with_name("lobes.toml"), out / "lobes.toml")
    raise SystemExit(main(["view", str(out / "lobes.toml"), "--screenshot", str(out / "view.png")]))
