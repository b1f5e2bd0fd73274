"""Draw the pictures of docs/howto/chamber.md.

python docs/mesh_pictures.py --out DIR
"""

from __future__ import annotations

import argparse
import math
import sys
from pathlib import Path
from typing import Any

import numpy as np

ROOT = Path(__file__).resolve().parents[1]
sys.path.insert(0, str(ROOT))

from meshes.baffles import Baffles  # noqa: E402
from meshes.bodies.paraboloid import paraboloid_body  # noqa: E402
from meshes.bodies.wave import wave_body  # noqa: E402
from meshes.grids import boundary_grid, grid, wall_grid  # noqa: E402
from meshes.refine.waterline import liquid_outside  # noqa: E402
from meshes.rings.sectors import compartment  # noqa: E402
from meshes.rings.triangles import ring  # noqa: E402
from meshes.section import Section, annulus, disc  # noqa: E402

WATER, METAL, RIM = "#a6cee3", "#8c8c8c", "#b2182b"


def sections(out: Path) -> None:
    """Six sections: rings with baffles, a square with a shaft, a compartment, an oval chamber."""
    coarse = {"segments": 32, "layers": 3, "tip_size": 0.005, "growth": 2.0}
    panels = [
        ("baffles on the wall", ring(0.2, 0.14, baffles=Baffles(5, 0.17), **coarse)),
        ("gap at the wall", ring(0.2, 0.14, baffles=Baffles(5, 0.0, 0.015), **coarse)),
        ("standing free", ring(0.2, 0.14, baffles=Baffles(5, 0.16, 0.015), **coarse)),
        ("oval, with a shaft", liquid_outside(oval(), 0.11, surface_size=0.02)),
        ("one compartment", compartment(Baffles(5, first_angle=0.3), 0, 0.2, 0.05, 12)),
        ("finer at the wall", liquid_outside(disc(0.2, 32, order=2), 0.12, wall_size=0.01)),
    ]
    plotter = _plotter((2, 3), (1020, 720))
    for k, (title, mesh) in enumerate(panels):
        plotter.subplot(k // 3, k % 3)
        plotter.add_text(title, font_size=9, position="upper_edge", color="black")
        plotter.add_mesh(grid(mesh), color=WATER, show_edges=True, edge_color="#4d4d4d", lighting=False)
        if not isinstance(mesh, Section):
            plotter.add_mesh(boundary_grid(mesh, "wall"), color="black", line_width=4)
            plotter.add_mesh(boundary_grid(mesh, "surface"), color=RIM, line_width=4)
        plotter.view_xy()
        plotter.camera.zoom(1.25)
    plotter.screenshot(out / "meshes_sections.png")
    plotter.close()


def oval() -> Section:
    """A chamber that is wider than high, around a round shaft off its middle."""
    section = annulus(0.2, 0.06, 40, order=2)
    r = np.hypot(*section.points.T)
    stretch = section.points * np.array([1.0, 0.75])
    outwards = ((r - 0.06) / 0.14)[:, None]
    shaft = section.points * 0.5 + np.array([0.02, 0.01])
    return Section(outwards * stretch + (1.0 - outwards) * shaft, section.triangles)


def bodies(out: Path) -> None:
    """Three bodies: at medium speed about a displaced axis, at high speed with a dry wall, under a wave."""
    theta = 2.0 * math.pi * np.arange(160) / 160
    wave = 0.178 + 0.012 * np.cos(theta) ** 3 + 0.004 * np.cos(2 * theta + 1.0)
    drum = disc(0.2, 64, order=2)
    panels = [
        (
            "floor and lid wetted in part",
            paraboloid_body(drum, 0.08, 6.0, -0.03, axis=(-0.03, 0.0), size=0.012),
        ),
        (
            "fast, wall dry on one side",
            paraboloid_body(drum, 0.08, 60.0, -2.2, axis=(-0.03, 0.0), size=0.012),
        ),
        ("under a wave of the layer", wave_body(0.2, 0.08, wave)),
    ]
    plotter = _plotter((1, 3), (1260, 440))
    for k, (title, body) in enumerate(panels):
        plotter.subplot(0, k)
        plotter.add_text(title, font_size=9, position="upper_edge", color="black")
        plotter.add_mesh(
            boundary_grid(body, "surface"), color=WATER, show_edges=True, edge_color="#6f9fc0", ambient=0.4
        )
        for part, opacity in (("side", 0.35), ("floor", 0.6), ("lid", 0.25)):
            plotter.add_mesh(wall_grid(body, part), color=METAL, opacity=opacity)
        plotter.view_vector((0.5, -1.0, 1.1))
        plotter.reset_camera(bounds=(-0.2, 0.2, -0.2, 0.2, 0.0, 0.08))
        plotter.camera.zoom(1.3)
    plotter.screenshot(out / "meshes_bodies.png")
    plotter.close()


def _plotter(shape: tuple[int, int], size: tuple[int, int]) -> Any:
    import pyvista

    plotter = pyvista.Plotter(off_screen=True, shape=shape, window_size=size, border=False)
    plotter.set_background("white", all_renderers=True)
    return plotter


def main() -> int:
    """Draw both pictures into a folder."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--out", type=Path, required=True)
    out = parser.parse_args().out
    out.mkdir(parents=True, exist_ok=True)
    sections(out)
    bodies(out)
    return 0


if __name__ == "__main__":
    sys.exit(main())
