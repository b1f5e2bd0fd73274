"""No point of the liquid that a view draws is outside the chamber that it draws, whatever is enlarged.

The points are those of the meshes that VTK draws, the walls those of the machine about the deflection by the
factor in the caption.
"""

from __future__ import annotations

import cmath
import math
import re
from dataclasses import replace
from functools import cache
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from leblanc.liquid.filled import FilledChamber
from leblanc.plotting.bodies import MachineMotion, Scale, pool
from leblanc.scene.scene import scene_from_table
from leblanc.studies.runup import film as films
from leblanc.studies.runup.answer import RunupFrames
from leblanc.studies.shapes.layer import body_of_pool
from leblanc.studies.shapes.machine import drawn_liquid, machine_motion, mode_view
from leblanc.studies.shapes.scale import scale_of
from leblanc.view.film import mode_picture
from leblanc.view.parts import Picture
from leblanc.view.picture import LOOKS, plotter
from leblanc.view.scene import still
from meshes.chamber import Chamber
from meshes.files.exchange import write_section
from meshes.section import Section, annulus
from tests.leblanc.figures.test_walls import outside
from tests.leblanc.scene.test_baffles import BASE

RADIUS, HEIGHT = 0.18, 0.06
CHORD = 2.0 * math.pi / 180  # of a circle that sides replace


def core() -> Section:
    """A shaft beside the axis in a wall that waves four times round."""
    base = annulus(RADIUS, 0.05, 72, order=2)
    away, angle = np.hypot(*base.points.T), np.arctan2(base.points[:, 1], base.points[:, 0])
    share = (away - 0.05) / (RADIUS - 0.05)
    points = base.points * (1.0 + 0.04 * np.cos(4.0 * angle) * share**2)[:, None]
    return Section(points + np.outer(1.0 - share, [0.03, 0.01]), base.triangles)


KINDS: dict[str, dict[str, Any]] = {
    "drum": {"radius": RADIUS, "volume": 0.002},
    "ring": {"radius": RADIUS, "inner_radius": 0.15, "volume": 0.0006},
    "nearly full": {"radius": RADIUS, "inner_radius": 0.12, "volume": 0.0033},
    "deep": {"radius": RADIUS, "volume": 0.0056},
    "closed": {"radius": RADIUS, "inner_radius": 0.14, "volume": 0.001, "baffles": {"count": 5}},
    "core": {"section": "core.msh", "volume": 0.0024},
}


@cache
def motion_of(kind: str, axis: str) -> MachineMotion:
    """A machine of that kind at one speed."""
    folder = Path(SECTIONS[0])
    chamber = {"height": HEIGHT, "liquid": "water", **KINDS[kind]}
    if "section" in chamber:
        write_section(core(), folder / "core.msh")
        chamber["section"] = str(folder / "core.msh")
    table = {**BASE, "rotor": {**BASE["rotor"], "axis": axis}, "chambers": [chamber]}
    return machine_motion(scene_from_table(table), 60.0)


SECTIONS: list[str] = []


@pytest.fixture(autouse=True)
def _folder(tmp_path_factory: pytest.TempPathFactory) -> None:
    if not SECTIONS:
        SECTIONS.append(str(tmp_path_factory.mktemp("sections")))


def liquid_points(picture: Picture) -> np.ndarray:
    """Of all meshes in the colours of the liquid, mm, shape (n, 3)."""
    import pyvista

    liquid = {LOOKS[look].colour for look in ("surface", "liquid")}
    shown = tuple(piece for piece in picture.pieces if LOOKS[piece.look].colour in liquid)
    plot = plotter(replace(picture, pieces=shown, labels=()))
    try:
        colours = {pyvista.Color(colour).int_rgb for colour in liquid}
        found = []
        for actor in plot.actors.values():
            if not hasattr(actor, "mapper") or not hasattr(actor.prop, "color"):
                continue
            data = getattr(actor.mapper, "dataset", None)
            if data is None or pyvista.Color(actor.prop.color).int_rgb not in colours or data.n_cells == 0:
                continue
            if data.GetNumberOfPolys() > 0:
                used = np.unique(data.regular_faces) if data.is_all_triangles else np.unique(data.faces)
                found.append(np.asarray(data.points)[used[used < data.n_points]])
        return np.concatenate(found) if found else np.zeros((0, 3))
    finally:
        plot.close()


def wrong(motion: MachineMotion, points: np.ndarray, factor: float) -> float:
    """How far the farthest point of the liquid is outside the only chamber, m."""
    chamber = motion.fills[0].chamber
    moved = complex(motion.deflection[0, 0]) * factor
    if motion.response.axis == "horizontal":
        # A lying machine is drawn with its axis along x; angle 0 to y, a quarter turn to z.
        along, plane = points[:, 0] * 1e-3, points[:, 1] + 1j * points[:, 2]
    else:
        along, plane = points[:, 2] * 1e-3, points[:, 0] + 1j * points[:, 1]
    floor = motion.places[0] - 0.5 * chamber.height
    high = max(float((along - floor - chamber.height).max()), float((floor - along).max()))
    like = FilledChamber(
        chamber.radius, chamber.inner_radius, chamber.height, 1.0, "", 0.0, section=chamber.section
    )
    return max(high, outside(like, plane * 1e-3 - moved))


def asked(picture: Picture) -> float:
    """Factor of the deflection in the caption."""
    found = re.search(r"drawn (?:at )?([\d.e+-]+) (?:times|of)", picture.caption)
    return 1.0 if found is None or "Everything to scale" in picture.caption else float(found[1])


@pytest.mark.parametrize(
    "seed", [*range(12), *(pytest.param(k, marks=pytest.mark.slow) for k in range(12, 24))]
)
def test_liquid_stays_between_the_walls(seed: int) -> None:
    rng = np.random.default_rng(seed)
    kind, axis = list(KINDS)[seed % len(KINDS)], ("vertical", "horizontal")[seed // 6 % 2]
    base = motion_of(kind, axis)
    speed = 10.0 ** rng.uniform(0.3, 2.2)
    size = 10.0 ** rng.uniform(-6.0, -1.4) * cmath.exp(1j * rng.uniform(-math.pi, math.pi))
    response = replace(base.response, response=replace(base.response.response, speed=np.array([speed])))
    motion = replace(base, response=response, deflection=np.array([[size]]))
    most = 0.8 * (base.fills[0].chamber.inner_radius or 0.05) / abs(size)
    factor = None if seed % 3 else float(min(10.0 ** rng.uniform(0.0, 4.0), most))
    scale = scale_of(motion, factor)
    picture = still(motion, 0, drawn_liquid(motion, 0, scale))
    points = liquid_points(picture)
    assert len(points)
    # Nodes of straight sides lie on the walls; those that a cut puts between them on their chords.
    bend = RADIUS * CHORD**2 / 8.0
    assert wrong(motion, points, asked(picture)) < bend
    if scale.asked is not None:
        assert f"{scale.asked:g} times larger it would" in picture.caption


def reach(motion: MachineMotion, scale: Scale) -> float:
    """From the axis at rest to the nearest point of the free surface as drawn, m."""
    picture = still(motion, 0, drawn_liquid(motion, 0, scale))
    surface = [piece.points[np.unique(piece.cells)] for piece in picture.pieces if piece.look == "surface"]
    points = np.concatenate(surface) * 1e-3
    return float(np.abs(points[:, 0] + 1j * points[:, 1]).min())


@pytest.mark.parametrize("factor", [None, 30.0])
def test_a_surface_that_meets_no_inner_wall_meets_none_as_drawn(factor: float | None) -> None:
    base = motion_of("ring", "vertical")
    response = replace(base.response, response=replace(base.response.response, speed=np.array([150.0])))
    # Of a layer of 13.7 mm in a room of 30 mm.
    motion = replace(base, response=response, deflection=np.array([[0.0035 - 0.001j]]))
    scale = scale_of(motion, factor)
    assert scale.deflection > 1.0
    assert (scale.asked is not None) == (factor is not None)
    moved = scale.deflection * abs(motion.deflection[0, 0])
    assert reach(motion, scale) > 0.15 + moved + 0.005 * RADIUS
    # Without the limit it would have met the wall.
    assert reach(motion, Scale(30.0)) < 0.15 + 30.0 * moved / scale.deflection


def test_a_mode_stays_between_the_walls_and_keeps_its_area() -> None:
    for kind in ("drum", "ring", "nearly full", "deep"):
        chamber = {"height": HEIGHT, "liquid": "water", **KINDS[kind]}
        scene = scene_from_table({**BASE, "chambers": [chamber]})
        mode = mode_view(scene, 3)
        rest = RADIUS - mode.drawn_depth
        for phase in (0.0, 1.1):
            picture = mode_picture(mode, phase)
            surface = next(piece for piece in picture.pieces if piece.name == "surface 1")
            away = np.hypot(*surface.points[np.unique(surface.cells)].T[:2]) * 1e-3
            inner = mode.fill.chamber.inner_radius
            assert inner + 1e-3 * RADIUS < away.min() < rest < away.max() < RADIUS * (1.0 - 1e-3)
            # Nothing was cut off: the displaced area swings about that at rest.
            assert away.max() ** 2 - rest**2 == pytest.approx(rest**2 - away.min() ** 2, rel=0.05)
        # Crests can be told from troughs at a glance, where there is room for it.
        if kind in ("drum", "ring"):
            assert 2.0 * mode.lift > 0.5 * min(RADIUS - inner, 0.5 * RADIUS)
        assert f"{100.0 * mode.lift / mode.drawn_depth:.0f} % of the layer's depth" in picture.caption


@pytest.mark.parametrize("inner", [0.03, 0.15])
@pytest.mark.parametrize("share", [0.05, 0.5, 0.95])
def test_a_pool_lies_outside_the_inner_wall(inner: float, share: float) -> None:
    chamber, down = Chamber(RADIUS, HEIGHT, inner), -1.3
    volume = share * chamber.capacity
    body = body_of_pool(chamber, volume, 0.002 + 0.001j, down)
    # Chords of 240 sides: a^2/6 of the disc each way, in the thinnest ring a third of it.
    assert body.volume() == pytest.approx(volume, rel=2e-3)
    found, level = pool(RADIUS, inner, volume / HEIGHT, down)
    assert found.area == pytest.approx(volume / HEIGHT, rel=2e-4)
    for loop in found.loops:
        assert np.abs(loop).min() >= inner * (1.0 - 1e-4) or share < 0.1
        assert np.abs(loop).max() <= RADIUS * (1.0 + 1e-9)
        assert (loop * cmath.exp(-1j * down)).real.min() >= level - 1e-4 * RADIUS
    frames = RunupFrames(
        **{name: np.zeros(1) for name in ("time", "speed", "amplitude")},
        down=np.array([down]),
        pool=np.array([[down]]),
        theta=np.zeros(3),
        depth=np.full((1, 1, 3), np.nan),
        deflection=np.zeros((1, 1), dtype=complex),
    )
    filled = FilledChamber(RADIUS, inner, HEIGHT, volume, "water", 0.17)
    edge, _ = films.liquid_shape(filled, frames, 0, 0, 1.0)
    inside = np.abs(edge) < inner * 1e3 * (1.0 - 1e-4)
    # The line to a hole and back does not cross it.
    assert not inside.any()
