"""Pictures of chambers with baffles and of sections of any shape: volumes, surfaces, walls.

Sides of a turn/180 and less replace arcs by chords: of a layer between two circles (2 pi/180)^2/6 is lost.
"""

from __future__ import annotations

import math
from functools import cache
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from fluid.fill import Fill
from fluid.liquid import known_liquid
from fluid.waves import free_wave_frequencies
from leblanc.plotting.bodies import LiquidBodies
from leblanc.scene.scene import Speeds, scene_from_table
from leblanc.studies.shapes.bodies import AROUND, bodies_at_rest, sections_of, surfaces, wall_is_dry
from leblanc.studies.shapes.machine import drawn_liquid, machine_motion, mode_view
from leblanc.studies.shapes.scale import choose_scale, drawn_volume, scale_of
from leblanc.view.film import shape_of, sweep_film
from leblanc.view.scene import outline
from meshes.baffles import Baffles
from meshes.bodies.body import body_integrals
from meshes.chamber import Chamber
from meshes.chamber_section import chamber_section, layer_depth
from meshes.errors import InputError
from meshes.files.exchange import write_section
from meshes.rings.sectors import compartment
from meshes.section import Section, annulus, disc
from tests.leblanc.scene.test_baffles import BASE
from tests.leblanc.view.views import Shown, show

CHORD = (2.0 * math.pi / AROUND) ** 2 / 6.0
WATER = known_liquid("water")
RADIUS, HEIGHT, VOLUME = 0.18, 0.06, 1e-3


def closed(count: int, inner: float = 0.14, first: float = 0.3) -> Fill:
    """Compartments between baffles from the wall through the surface."""
    return Fill(Chamber(RADIUS, HEIGHT, inner, baffles=Baffles(count, 0.0, 0.0, first)), WATER, VOLUME)


def lobes(size: float = 0.03, inner: float = 0.0, volume: float = VOLUME) -> Fill:
    """A wall that waves six times round, with a shaft if `inner` is not 0."""
    base = annulus(RADIUS, inner, 72, order=2)
    away, angle = np.hypot(*base.points.T), np.arctan2(base.points[:, 1], base.points[:, 0])
    stretch = 1.0 + size * np.cos(6.0 * angle) * ((away - inner) / (RADIUS - inner)) ** 2
    shape = chamber_section("lobes.msh", Section(base.points * stretch[:, None], base.triangles))
    return Fill(Chamber(shape.farthest, HEIGHT, section=shape), WATER, volume)


def drawn_circle(volume: float = VOLUME) -> Fill:
    """A circular chamber given as a mesh."""
    shape = chamber_section("disc.msh", disc(RADIUS, 96, order=2))
    return Fill(Chamber(shape.farthest, HEIGHT, section=shape), WATER, volume)


# Fill, deflection, speed, gravity along the axis: wet, standing, slow bowls on floor and inner wall.
CASES: list[tuple[Fill, complex, float, float]] = [
    (closed(6), 0.006 - 0.004j, 120.0, 0.0),
    (closed(3, 0.0), -0.01j, 120.0, 9.81),
    (closed(4), 0.003 + 0j, 4.0, 9.81),
    (closed(5, 0.0), 0.003 + 0j, 12.0, 9.81),
    (lobes(), 0.005 + 0.003j, 120.0, 0.0),
    (lobes(0.05, 0.07), 0.004j, 60.0, 9.81),
    (lobes(), 0.002 + 0j, 10.0, 9.81),
]


def fresh() -> None:
    """Forget what was solved, which a seeded fault may have spoilt."""
    for cached in (surfaces, sections_of):
        cached.cache_clear()


def distance(fill: Fill, radius: float, moved: complex, angle: np.ndarray) -> np.ndarray:
    """From the chamber's centre to the circle about the axis at rest, at some angles."""
    toward = -moved * np.exp(-1j * angle)
    return np.asarray(toward.real + np.sqrt(radius**2 - toward.imag**2))


@cache
def drawn_cases() -> list[LiquidBodies]:
    """The liquid of each case."""
    fresh()
    return [bodies_at_rest(fill, fill.volume, *rest) for fill, *rest in CASES]


def test_each_compartment_keeps_its_volume() -> None:
    for (fill, *_), drawn in zip(CASES, drawn_cases(), strict=True):
        assert len(drawn.bodies) == fill.compartments
        for body in drawn.bodies:
            # Shallow bowls bend across the cells as well.
            assert abs(body_integrals(body).volume * fill.compartments / fill.volume - 1.0) < 10.0 * CHORD
        assert drawn.volume() == pytest.approx(fill.volume, rel=10.0 * CHORD)


def test_surfaces_are_about_the_axis() -> None:
    for (fill, moved, speed, gravity), drawn in zip(CASES, drawn_cases(), strict=True):
        found = []
        for body in drawn.bodies:
            points = body.points[np.unique(body.surface)]
            square = np.abs(points[:, 0] + 1j * points[:, 1] + moved) ** 2
            if gravity == 0.0:
                # The nodes are on the circle to rounding.
                assert np.ptp(np.sqrt(square)) < 1e-9 * RADIUS
                found.append(math.sqrt(square.mean()))
            else:
                beta = speed**2 / (2.0 * gravity)
                constant = points[:, 2] - beta * square
                inside = (points[:, 2] > 1e-9) & (points[:, 2] < HEIGHT - 1e-9)
                # A node between two others may stand a little off where a cell would fold.
                assert np.ptp(constant[inside]) < 1e-6 * beta * RADIUS**2 if inside.any() else True
                found.append(float(np.median(constant[inside])) if inside.any() else 0.0)
        assert np.ptp(found) > 1e-4 if fill.compartments > 1 and gravity == 0.0 else True


def test_radius_of_each_compartment() -> None:
    fresh()
    # The area of a sector between wall and circle, by a rule of its own.
    fill, moved = closed(5, 0.0), 0.008 * np.exp(0.4j)
    assert fill.chamber.baffles is not None
    for start, one in zip(
        fill.chamber.baffles.angles, surfaces(fill, VOLUME, complex(moved), 100.0, 0.0), strict=True
    ):
        angle = start + np.linspace(0.0, 2.0 * math.pi / 5.0, 4001)
        inner = distance(fill, one.dry_radius, complex(moved), angle)
        area = np.trapezoid(0.5 * (RADIUS**2 - inner**2), angle)
        # Trapezoids over 4000 steps: 1e-7; walls as parabolas of 3.75 degrees: b^4/60 R^2 of a thin layer.
        assert area * HEIGHT * 5.0 == pytest.approx(VOLUME, rel=1e-5)


def test_added_mass() -> None:
    fresh()
    # The first moment of the drawn liquid about the axis is that of the added mass [theory: sections, eq. 8].
    for fill in (closed(3, 0.0), closed(6), lobes()):
        moved = 5e-4 * complex(math.cos(1.0), math.sin(1.0))
        moment = 0j
        for body in bodies_at_rest(fill, VOLUME, moved, 300.0, 0.0).bodies:
            found = body_integrals(body)
            moment += complex(found.x, found.y) + moved * found.volume
        # Chords of both circles, over the depth of the layer, and the square of the deflection over it.
        assert abs(moment / moved * WATER.density / fill.added_mass - 1.0) < 5e-3


def test_dry_walls() -> None:
    fresh()
    # A circle falls dry where the deflection passes the depth of the layer.
    fill = drawn_circle()
    for part, dry in ((0.999, False), (1.001, True)):
        moved = part * fill.depth * complex(0.6, -0.8)
        assert wall_is_dry(fill, VOLUME, moved, 100.0, 0.0) is dry
    # The factor leaves a tenth of the depth where the layer is thinnest, to two digits.
    fill = lobes()
    moved = np.array([[0.3 * fill.depth]], dtype=complex)
    factor = choose_scale((fill,), moved, np.array([100.0]), 9.81).deflection
    assert 0.8 < 0.3 * factor <= 0.9
    # In compartments later, or elsewhere: where the near wall leaves the circle of its sector.
    fill = closed(3, 0.0)
    assert fill.chamber.baffles is not None
    for size in (0.9, 1.1, 1.3):
        moved = size * fill.depth * complex(math.cos(2.0), math.sin(2.0))
        found = surfaces(fill, VOLUME, moved, 100.0, 0.0)
        near = [
            np.abs(RADIUS * np.exp(1j * (start + np.linspace(0.0, 2.0 * math.pi / 3.0, 999))) + moved).min()
            for start in fill.chamber.baffles.angles
        ]
        dry = any(away < one.dry_radius for away, one in zip(near, found, strict=True))
        assert wall_is_dry(fill, VOLUME, moved, 100.0, 0.0) is dry
    assert dry and not wall_is_dry(fill, VOLUME, moved / 1.3 * 0.9, 100.0, 0.0)


def test_outline() -> None:
    fresh()
    # A parabola leaves cos(6 theta) by h^3/6 times 6^3 times 0.048 over sides h = 2 pi/72, here 3.5e-5.
    shape = lobes().chamber.section
    assert shape is not None
    sides = outline(shape.mesh)
    angle = np.angle(sides.walls)
    assert np.abs(np.abs(sides.walls) / (RADIUS * (1.0 + 0.03 * np.cos(6.0 * angle))) - 1.0).max() < 4e-5
    assert sides.walls.shape[0] == 72 and not sides.plates.size
    # Out of the section: away from the axis, and square to the wall.
    slope = -0.18 * np.sin(6.0 * angle) / (1.0 + 0.03 * np.cos(6.0 * angle))
    normal = np.exp(1j * angle) * (1.0 - 1j * slope) / np.abs(1.0 - 1j * slope)
    assert np.abs(sides.outwards - normal).max() < 0.01
    inner = outline(annulus(RADIUS, 0.05, 36, order=2))
    shaft = np.abs(inner.walls) < 0.06
    assert shaft.any() and np.all((inner.outwards / inner.walls).real[shaft] < 0.0)
    # A slit is a plate once, and no wall.
    slit = outline(compartment(Baffles(1, first_angle=0.7), 0, RADIUS, 0.05, 24))
    assert slit.plates.size
    assert np.allclose(np.angle(slit.plates), 0.7)
    assert np.abs(slit.plates).min() == pytest.approx(0.05) and np.abs(slit.plates).max() == pytest.approx(
        RADIUS
    )
    lengths = np.abs(np.diff(slit.plates, axis=1)).sum()
    assert lengths == pytest.approx(RADIUS - 0.05)
    assert np.abs(np.abs(slit.walls) - RADIUS)[np.abs(slit.walls) > 0.1].max() < 1e-4 * RADIUS


def test_a_deeper_layer() -> None:
    fresh()
    # A drawn circle is a circle; in other sections the thinnest place grows by the factor.
    plain = Fill(Chamber(RADIUS, HEIGHT), WATER, VOLUME)
    for factor in (1.0, 1.5):
        # Least depth by the nodes of a wall of 96 sides.
        assert drawn_volume(drawn_circle(), factor) == pytest.approx(drawn_volume(plain, factor), rel=1e-5)
    fill = lobes(volume=7e-4)
    shape = fill.chamber.section
    assert shape is not None
    deeper = layer_depth(shape, drawn_volume(fill, 1.5) / HEIGHT)
    assert deeper == pytest.approx(1.5 * fill.depth, rel=1e-6)


def scene_of(**chamber: Any) -> Any:
    """A machine with one such chamber."""
    table = {"height": "60 mm", "volume": "1 l", "liquid": "water"} | chamber
    return scene_from_table(BASE | {"chambers": [table]})


CLOSED = {
    "radius": "180 mm", "inner_radius": "140 mm", "baffles": {"count": 6, "first_angle": "10 deg"},
}  # fmt: skip


def across(view: Shown, name: str) -> np.ndarray:
    points = np.concatenate([one.points for one in view.picture.pieces if one.name == name])
    return np.asarray(points[:, 0] + 1j * points[:, 1])


def test_picture_of_compartments() -> None:
    fresh()
    view = show(scene_of(**CLOSED))
    centre = 1e3 * view.scale.deflection * complex(view.motion.deflection[-1, 0])
    plates = [one for one in view.picture.pieces if one.name == "baffle 1"]
    assert len(plates) == 6
    for k, plate in enumerate(plates):
        ends = plate.points[:, 0] + 1j * plate.points[:, 1] - centre
        assert np.allclose(np.angle(ends * np.exp(-1j * (math.radians(10.0) + k * math.pi / 3.0))), 0.0)
        assert np.abs(ends).min() == pytest.approx(140.0) and np.abs(ends).max() == pytest.approx(180.0)
        assert np.ptp(plate.points[:, 2]) > 60.0
    assert np.abs(across(view, "liquid 1") - centre).max() == pytest.approx(180.0, rel=1e-6)
    # The plates alone show where the liquid stands against them.
    for piece in view.picture.pieces:
        if piece.name != "liquid 1":
            continue
        middle = piece.points[piece.cells].mean(axis=1)
        turned = (middle[:, 0] + 1j * middle[:, 1] - centre) * np.exp(-1j * math.radians(10.0))
        off = np.abs(np.remainder(np.angle(turned) + math.pi / 6.0, math.pi / 3.0) - math.pi / 6.0)
        assert off.min() > 1e-6
    assert "each keeps its volume" in view.picture.caption
    assert f"{view.scale.deflection:g} times" in view.picture.caption
    assert "wet all round" in view.picture.state


def check_picture_of_a_section(folder: Path) -> None:
    fresh()
    shape = lobes(0.05, 0.07).chamber.section
    assert shape is not None
    write_section(shape.mesh, folder / "lobes.msh")
    view = show(scene_of(section=str(folder / "lobes.msh")))
    centre = 1e3 * view.scale.deflection * complex(view.motion.deflection[-1, 0])
    for name in ("wall 1", "rim 1"):
        wall = across(view, name) - centre
        outer = wall[np.abs(wall) > 120.0]
        lobed = 180.0 * (1.0 + 0.05 * np.cos(6.0 * np.angle(outer)))
        # Outside the liquid by three thousandths of the radius, along the normal.
        assert np.abs(np.abs(outer) - lobed - 0.003 * 189.0).max() < 0.05
        assert np.abs(np.abs(wall[np.abs(wall) < 120.0]) - 70.0 + 0.003 * 189.0).max() < 1e-3
    assert np.ptp(np.abs(across(view, "surface 1"))) > 0.0
    assert "Section from lobes.msh." in view.picture.caption and "wet all round" in view.picture.state
    # No further than 90 % of the depth at the thinnest place.
    fill = view.motion.fills[0]
    assert np.abs(centre) <= 900.0 * view.scale.depth * fill.depth * (1.0 + 1e-9)
    assert view.liquid.volume == (pytest.approx(fill.volume),)


def check_modes_of_a_section(folder: Path) -> None:
    fresh()
    write_section(disc(RADIUS, 96, order=2), folder / "disc.msh")
    drawn = scene_of(section=str(folder / "disc.msh"))
    fill = Fill(Chamber(RADIUS, HEIGHT), WATER, VOLUME)
    for number in (1, 2):
        mode = mode_view(drawn, number)
        both = free_wave_frequencies(mode.crests, math.log(RADIUS / fill.surface_radius), mode.speed)
        assert mode.frequency == pytest.approx(float(both[0 if mode.frequency > 0.0 else 1]), rel=1e-4)
        lift = mode.lift
        # The wave moves three quarters of the area outside the surface: per angle a times its height.
        rest = fill.surface_radius
        assert lift == pytest.approx(0.75 * (RADIUS**2 - rest**2) / (2.0 * rest), rel=1e-4)
        volumes = []
        for phase in (0.0, 0.7):
            body = shape_of(mode, phase, lift)
            assert isinstance(body, LiquidBodies)
            (one,) = body.bodies
            volumes.append(body.volume())
            wall = one.points[np.unique(one.wall[one.wall_part == 2])]
            assert np.abs(np.hypot(*wall.T[:2]) / RADIUS - 1.0).max() < 1e-6
            free = one.points[np.unique(one.surface)]
            away, turn = np.hypot(free[:, 0], free[:, 1]), np.arctan2(free[:, 1], free[:, 0])
            # The zero of the phase is the solver's.
            harmonic = np.mean((away**2 - mode.fill.surface_radius**2) * np.exp(1j * mode.crests * turn))
            if phase == 0.0:
                first = harmonic
        # Simpson's rule on 120 curved sides: the wave has no mean.
        assert volumes == [pytest.approx(VOLUME, rel=1e-4)] * 2
        # Re(e^{i (n theta - sigma t)}): the phase of the harmonic is sigma t. Sides are nearly even.
        assert np.angle(harmonic / first) == pytest.approx(0.7, abs=0.02)


@pytest.mark.parametrize("check", [check_picture_of_a_section, check_modes_of_a_section])
def test_sections(check: Any, tmp_path: Path) -> None:
    check(tmp_path)


def test_a_film_over_the_speeds_has_bodies_in_every_frame(monkeypatch: pytest.MonkeyPatch) -> None:
    # Which whirls grow by themselves between the speeds is not drawn.
    monkeypatch.setattr("leblanc.studies.run.study.unstable_bands", lambda *_: ((),))
    scene = scene_of(**CLOSED).altered(speeds=Speeds(start=5.0, stop=150.0, count=3))
    motion = machine_motion(scene)
    scale = scale_of(motion)
    liquid = [drawn_liquid(motion, k, scale) for k in range(3)]
    film = sweep_film(motion, scale, liquid.__getitem__, 3)
    for k in range(3):
        assert sum(one.name == "surface 1" for one in film.picture(k).pieces) == 6
        (drawn,) = liquid[k].bodies
        assert isinstance(drawn, LiquidBodies)
        assert drawn.volume() == pytest.approx(VOLUME, rel=10.0 * CHORD)


def test_a_mode_whose_surface_meets_a_wall_is_refused(tmp_path: Path) -> None:
    write_section(compartment(Baffles(1), 0, RADIUS, 0.05, 36), tmp_path / "slit.msh")
    with pytest.raises(InputError, match="meets no wall"):
        mode_view(scene_of(section=str(tmp_path / "slit.msh")), 1)


def test_an_empty_and_a_full_section() -> None:
    full = lobes(volume=lobes().chamber.capacity)
    assert not is_dry_drawn(full) and drawn_volume(full, 2.0) == full.volume
    drawn = bodies_at_rest(full, full.volume, 0.002j, 100.0, 0.0)
    assert drawn.volume() == pytest.approx(full.volume, rel=10.0 * CHORD)
    assert not len(drawn.bodies[0].surface)


def is_dry_drawn(fill: Fill) -> bool:
    return wall_is_dry(fill, fill.volume, 0.002j, 100.0, 0.0)


def test_low_baffles_are_plates_in_one_body() -> None:
    view = show(scene_of(**CLOSED | {"baffles": {"count": 3, "tip_radius": "174 mm"}}))
    assert sum(one.name == "baffle 1" for one in view.picture.pieces) == 3
    assert sum(one.name == "surface 1" for one in view.picture.pieces) == 1
    assert "compartments" not in view.picture.caption
