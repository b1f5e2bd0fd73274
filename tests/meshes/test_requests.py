"""Meshes beyond a million nodes are refused before they are made."""

from __future__ import annotations

import math
import tracemalloc
from collections.abc import Callable
from functools import partial
from pathlib import Path

import numpy as np
import pytest

import meshes.errors
from meshes.baffles import Baffles
from meshes.bodies.paraboloid import paraboloid_body
from meshes.bodies.wave import wave_body
from meshes.errors import InputError
from meshes.refine.waterline import liquid_outside
from meshes.rings import quadrilaterals, triangles
from meshes.rings.sectors import sector
from meshes.section import annulus, disc

FEW = disc(0.1, 16)
LEVEL = np.full(16, 0.08)
PLATES = Baffles(4, 0.09, 0.005)
HUGE = 10**9

REQUESTS: dict[str, tuple[Callable[[], object], str]] = {
    "disc": (partial(disc, 0.1, HUGE), "segments"),
    "disc, curved": (partial(disc, 0.1, 60_000, order=2), "segments"),
    "annulus": (partial(annulus, 0.1, 0.05, 400_000), "segments"),
    "annulus, even layers": (
        partial(annulus, 0.1, 0.05, 900_000, wall_layer=2e-7, growth=1.0, order=2),
        "segments",
    ),
    "ring": (partial(triangles.ring, 0.1, 0.05, HUGE), "segments"),
    "ring, layers": (partial(triangles.ring, 0.1, 0.05, layers=HUGE), "layers"),
    "ring, grading": (partial(triangles.ring, 0.1, 0.05, wall_depth=1e-12, growth=1.0 + 1e-9), "growth"),
    "ring, tips": (
        partial(triangles.ring, 0.1, 0.05, baffles=PLATES, tip_size=1e-12, growth=1.003),
        "segments",
    ),
    "quadrilaterals": (partial(quadrilaterals.ring, 0.1, 0.05, HUGE), "around"),
    "quadrilaterals across": (partial(quadrilaterals.ring, 0.1, 0.05, 8, HUGE), "across"),
    "quadrilaterals halved": (partial(quadrilaterals.ring, 0.1, 0.05, times=HUGE), "times"),
    "sector": (partial(sector, 0.1, 0.0, 1.0, 0.0, HUGE), "segments"),
    "sector, curved": (partial(sector, 0.1, 0.0, 6.0, 0.0, 4000), "segments"),
    "wave": (partial(wave_body, 0.1, 0.1, LEVEL, across=HUGE), "across"),
    "wave, layers": (partial(wave_body, 0.1, 0.1, LEVEL, layers=HUGE), "layers"),
    "paraboloid": (partial(paraboloid_body, FEW, 0.1, 1.0, 0.05, size=1e-7), "size"),
    "paraboloid, layers": (partial(paraboloid_body, FEW, 0.1, 1.0, 0.05, layers=HUGE), "layers"),
    "liquid": (partial(liquid_outside, FEW, 0.09, surface_size=1e-8), "size"),
}


@pytest.mark.parametrize("name", REQUESTS)
def test_too_many_nodes_are_refused_before_they_are_made(name: str) -> None:
    """A million nodes have 16 MB, their cells more: nothing of that size is made."""
    make, field = REQUESTS[name]
    tracemalloc.start()
    try:
        with pytest.raises(InputError, match="a million nodes") as fault:
            make()
        peak = tracemalloc.get_traced_memory()[1]
    finally:
        tracemalloc.stop()
    assert fault.value.field == field
    assert peak < 1.6e7


@pytest.mark.parametrize("inside", [math.inf, 0.02])
def test_what_an_outline_asks_for_is_known_before(
    inside: float, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """The nodes of the mesh that is made are those counted beforehand, within a tenth."""
    ezdxf = pytest.importorskip("ezdxf")
    pytest.importorskip("gmsh", exc_type=ImportError)
    from meshes.files.outline import outline_section

    document = ezdxf.new(units=4)
    for x, radius in ((0, 100), (30, 20)):
        document.modelspace().add_circle((x, 0), radius)
    document.saveas(tmp_path / "a.dxf")
    make = partial(outline_section, tmp_path / "a.dxf", 0.005, inside_size=inside)
    nodes = len(make().points)
    monkeypatch.setattr(meshes.errors, "MOST_NODES", round(1.1 * nodes))
    make()
    monkeypatch.setattr(meshes.errors, "MOST_NODES", round(nodes / 1.1))
    with pytest.raises(InputError, match=r"wall_size = 0\.005"):
        make()
