"""What a chamber figure draws of the liquid lies between the walls that it draws, whatever is enlarged.

The coordinates are read off the artists. Walls are those of the machine about the deflection that the caption
names the factor of: nothing of the drawing's own code is used to judge it.
"""

from __future__ import annotations

import math
import re
from dataclasses import replace
from functools import cache
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from matplotlib.path import Path as Lines
from scipy.spatial import cKDTree

from fluid.liquid import known_liquid
from leblanc.liquid.filled import FilledChamber
from leblanc.plotting.chambers import SURFACE, bodies, chamber_figure
from leblanc.plotting.page import Figure
from leblanc.studies.modes.figure import modes_figure
from leblanc.studies.modes.study import Resolution, SectionSource, answer_modes
from leblanc.studies.run.answer import RunAnswer
from leblanc.studies.runup.answer import RunupFrames
from leblanc.studies.runup.film import film_figure
from meshes.baffles import Baffles
from meshes.chamber import Chamber
from meshes.chamber_section import ChamberSection, chamber_section, level
from meshes.files.exchange import write_section
from meshes.section import Section, annulus, disc, section_area
from solvers.statics.hydrostatics import equilibrium
from tests.leblanc.studies.test_runup import history_of, made_up
from tests.oracles.records import circles, record_of, response_of

HEIGHT = 0.04
ROUNDING = 1e-6  # of the radius


@cache
def sections() -> dict[str, ChamberSection]:
    """A disc, lobes round a core, a core away from the axis."""
    lobes = annulus(0.1, 0.04, 48, order=2)
    angle, away = np.arctan2(*lobes.points.T[::-1]), np.hypot(*lobes.points.T)
    stretch = 1.0 + 0.06 * np.cos(4.0 * angle) * ((away - 0.04) / 0.06) ** 2
    moved = annulus(0.1, 0.03, 48, order=2)
    away = np.hypot(*moved.points.T)
    shifted = moved.points + np.outer((0.1 - away) / 0.07, [0.025, -0.01])
    found = {
        "disc": disc(0.1, 48, order=2),
        "lobes": Section(lobes.points * stretch[:, None], lobes.triangles),
        "core": Section(shifted, moved.triangles),
    }
    return {name: chamber_section(name, section) for name, section in found.items()}


def chamber(kind: str, share: float, inner: float) -> FilledChamber:
    """A chamber so much of which is full."""
    if kind in sections():
        section = sections()[kind]
        volume = share * section.area * HEIGHT
        rest = level(section, volume / HEIGHT)[0]
        return FilledChamber(section.farthest, 0.0, HEIGHT, volume, "water", rest, section=section)
    radius = 0.1
    area = math.pi * radius**2 * (1.0 - inner**2)
    rest = math.sqrt(radius**2 - share * area / math.pi)
    found = FilledChamber(radius, inner * radius, HEIGHT, share * area * HEIGHT, "water", rest)
    if kind == "closed":
        return replace(found, baffles=Baffles(5, 0.5 * (rest + inner * radius)))
    if kind == "open":
        return replace(found, baffles=Baffles(4, 0.5 * (rest + radius)))
    return found


def machine(chambers: tuple[FilledChamber, ...], *deflections: complex, slowest: float = 0.0) -> RunAnswer:
    """An answer at as many speeds; upright, if a slowest speed is given."""
    first = slowest or 100.0
    w, at = np.array(deflections, dtype=complex), response_of(first * np.linspace(1.0, 2.0, len(deflections)))
    shown = replace(at, deflection=w, branch_deflection=w[:, None], **circles(w, w[:, None]))
    axis, gravity = ("vertical", 9.81) if slowest > 0.0 else ("horizontal", 0.0)
    return record_of(shown, chambers=chambers, axis=axis, axial_gravity=gravity)


def surfaces(axes: Any) -> list[Any]:
    """Lines of the free surface."""
    return [line for line in axes.lines if line.get_color() == SURFACE and line.get_marker() == "None"]


def factors(figure: Figure) -> list[float]:
    """Of the deflection of each view, as the caption says."""
    if "Everything to scale." in figure.caption.shown:
        return [1.0]
    said = re.search(r"Deflection drawn (.*?), mean depth", figure.caption.shown)
    assert said is not None
    parts = said[1].split(" and ")
    return [1.0 if part.startswith("to scale") else float(part.split()[1]) for part in parts]


def walls_of(chamber: FilledChamber) -> list[np.ndarray]:
    """Lines around and inside a chamber, m."""
    if chamber.section is None:
        turn = np.exp(1j * np.linspace(0.0, 2.0 * math.pi, 7201))
        return [radius * turn for radius in (chamber.radius, chamber.inner_radius) if radius > 0.0]
    return section_walls(chamber.section)


@cache
def section_walls(section: ChamberSection) -> list[np.ndarray]:
    """Sides that one triangle has alone, in eight pieces each, m."""
    mesh = section.mesh
    count: dict[tuple[int, ...], list[int]] = {}
    for nodes in mesh.triangles.tolist():
        for a, b, middle in ((0, 1, 3), (1, 2, 4), (2, 0, 5)):
            count.setdefault(tuple(sorted((nodes[a], nodes[b]))), []).append(nodes[middle])
    sides = [(*pair, middle[0]) for pair, middle in count.items() if len(middle) == 1]
    t = np.linspace(0.0, 1.0, 9)[:, None]
    weights = np.hstack([(1 - t) * (1 - 2 * t), t * (2 * t - 1), 4 * t * (1 - t)])
    points = mesh.points[:, 0] + 1j * mesh.points[:, 1]
    return [weights @ points[list(side)] for side in sides]


def outside(chamber: FilledChamber, points: np.ndarray) -> float:
    """How far the farthest point is on the wrong side of a wall, m; points about the geometric centre."""
    if chamber.section is None:
        away = np.abs(points)
        return float(max((away - chamber.radius).max(), (chamber.inner_radius - away).max()))
    lines = np.concatenate([np.append(line, np.nan) for line in walls_of(chamber)])
    start, end = lines[:-1], lines[1:]
    ok = np.isfinite(start) & np.isfinite(end)
    start, end = start[ok], end[ok]
    # By the number of walls that a ray crosses to the right.
    height = points.imag.copy()[:, None]
    point, side = np.nonzero((start.imag.copy() > height) != (end.imag.copy() > height))
    along = (end - start)[side]
    at = start[side].real + (points[point] - start[side]).imag * along.real / along.imag
    crossed = np.bincount(point[at > points[point].real], minlength=points.size)
    # Those inside are on the right side; of the others, how far they are from the nearest of eight sides.
    z = points[crossed % 2 == 0]
    if not z.size:
        return 0.0
    middle = 0.5 * (start + end)
    tree = cKDTree(np.column_stack([middle.real, middle.imag]))
    near = tree.query(np.column_stack([z.real, z.imag]), 8)[1]
    along, z = (end - start)[near], z[:, None] - start[near]
    share = np.clip((z * along.conj()).real / np.abs(along) ** 2, 0.0, 1.0)
    return float(np.abs(z - share * along).min(axis=1).max())


def check(chambers: tuple[FilledChamber, ...], *deflections: complex, slowest: float = 0.0) -> None:
    """Every drawn point of liquid and surface lies in its chamber."""
    result = machine(chambers, *deflections, slowest=slowest)
    figure = chamber_figure(result)
    said = factors(figure)
    for axes in figure.axes:
        marks = {line.get_label(): line for line in axes.lines}
        centre = complex(*(marks["geometric centre"].get_data()[i][0] for i in (0, 1)))
        # What stands in the caption is what is drawn.
        assert any(
            abs(centre - factor * w * 1e3) < 1e-5 * abs(centre) + 1e-9 for factor in said for w in deflections
        )
        liquid = [patch for patch in axes.patches if patch.get_label() == "liquid"]
        surface = surfaces(axes)
        assert liquid or all(c.volume == 0.0 for c in chambers)
        drawn = [patch.get_path() for patch in liquid]
        points = [path.vertices[path.codes != Lines.CLOSEPOLY] for path in drawn]
        points += [np.column_stack(line.get_data()) for line in surface]
        for found in points:
            z = (found[:, 0] + 1j * found[:, 1] - centre) * 1e-3
            z = z[np.isfinite(z)]
            assert min(outside(c, z) for c in chambers) <= tolerance(chambers), (said, chambers, deflections)


def tolerance(chambers: tuple[FilledChamber, ...]) -> float:
    """Curved sides are drawn as four straight pieces: their sagitta over sixteen; circles of 720 sides, m."""
    bend = max(
        (abs(line[4] - 0.5 * (line[0] + line[8])) for c in chambers for line in curved(c)), default=0.0
    )
    radius = max(c.radius for c in chambers)
    return radius * (ROUNDING + math.radians(0.5) ** 2 / 8.0) + bend / 16.0


def curved(chamber: FilledChamber) -> list[np.ndarray]:
    return walls_of(chamber) if chamber.section is not None else []


KINDS = ("ring", "closed", "open", "disc", "lobes", "core")


@pytest.mark.parametrize("seed", range(40))
def test_liquid_stays_between_the_walls(seed: int) -> None:
    rng = np.random.default_rng(seed)
    kind = KINDS[seed % len(KINDS)]
    share = float(rng.choice([rng.uniform(0.001, 0.1), rng.uniform(0.1, 0.9), rng.uniform(0.9, 0.999)]))
    inner = float(rng.choice([0.0, rng.uniform(0.2, 0.95)])) if kind in ("ring", "closed", "open") else 0.0
    here = chamber(kind, share, inner)
    sizes = 10.0 ** rng.uniform(-6.0, -1.2, 2)
    turns = np.exp(1j * rng.uniform(-math.pi, math.pi, 2))
    # Every second machine stands; its liquid may be a shallow bowl.
    slowest = float(10.0 ** rng.uniform(0.0, 2.0)) if seed // len(KINDS) % 2 else 0.0
    check((here,), *(sizes * turns).tolist(), slowest=slowest)


# The first: a deflection of a tenth of the radius in a ring, the starter at resonance.
@pytest.mark.parametrize(
    ("kind", "share", "inner", "size"),
    [
        ("ring", 0.22, 0.8, 0.0104),
        ("ring", 0.5, 0.8, 0.0001),
        ("closed", 0.5, 0.9, 0.0004),
        ("core", 0.55, 0.0, 0.02),
        ("lobes", 0.5, 0.0, 0.03),
    ],
)
def test_a_surface_that_meets_no_inner_wall_is_drawn_meeting_none(
    kind: str, share: float, inner: float, size: float
) -> None:
    here = chamber(kind, share, inner)
    check((here,), size * np.exp(-1.6j), 0.1 * size)
    figure = chamber_figure(machine((here,), size * np.exp(-1.6j), 0.1 * size))
    assert ("reaches an inner wall" in figure.caption.shown) == touches(here, size * np.exp(-1.6j))
    if "reaches an inner wall" in figure.caption.shown:
        assert min(factors(figure)) <= 1.0
        return
    for axes in figure.axes:
        marks = {line.get_label(): line for line in axes.lines}
        centre = complex(*(marks["geometric centre"].get_data()[i][0] for i in (0, 1)))
        for line in surfaces(axes):
            z = (line.get_data()[0] + 1j * line.get_data()[1] - centre) * 1e-3
            assert gap(here, z) > 0.005 * here.radius


def gap(here: FilledChamber, z: np.ndarray) -> float:
    """From a free surface to the nearest inner wall, m."""
    if here.section is None:
        return float(np.abs(z).min()) - here.inner_radius
    inner = [line for line in walls_of(here) if np.abs(line).max() < here.mean_surface_radius]
    if not inner:
        return math.inf
    return float(np.abs(z[:, None] - np.concatenate(inner)[None]).min())


def touches(here: FilledChamber, moved: complex) -> bool:
    """In truth: a circle about the axis of rotation, found by counting points of a grid."""
    side = np.linspace(-1.05, 1.05, 601) * here.radius  # the area to 1e-4 of it
    grid = (side[:, None] + 1j * side[None, :]).ravel()
    if here.section is None:
        inside = (np.abs(grid) < here.radius) & (np.abs(grid) > here.inner_radius)
        wall = here.inner_radius * np.exp(1j * np.linspace(0.0, 6.3, 361))
    else:
        lines = walls_of(here)
        ends = {complex(np.round(line[0], 9)): line for line in lines}
        inside = np.zeros(grid.shape, dtype=bool)
        while ends:
            line = ends.pop(next(iter(ends)))
            loop = [line]
            while complex(np.round(loop[-1][-1], 9)) in ends:
                loop.append(ends.pop(complex(np.round(loop[-1][-1], 9))))
            path = np.concatenate(loop)
            inside ^= Lines(np.column_stack([path.real, path.imag])).contains_points(
                np.column_stack([grid.real, grid.imag])
            )
        near = [line for line in lines if np.abs(line).max() < here.mean_surface_radius]
        wall = np.concatenate(near) if near else np.zeros(0)
    if wall.size == 0 or here.baffles is not None:
        return False
    away = np.sort(np.abs(grid[inside] + moved))[::-1]
    cell = (side[1] - side[0]) ** 2
    level_here = away[min(int(here.volume / HEIGHT / cell), away.size - 1)]
    return bool(np.abs(wall + moved).max() > level_here)


def test_a_bowl_is_the_equilibrium_of_its_volume() -> None:
    """Where it meets the floor, against the solver of equilibria; shades end there, the higher the later."""
    for inner, share, size, speed in (
        (0.0, 0.1, 0.01, 12.0),
        (0.08, 0.3, 0.004, 9.0),
        (0.05, 0.6, 0.0, 20.0),
    ):
        here = chamber("ring", share, inner / 0.1)
        exact = equilibrium(Chamber(0.1, HEIGHT, inner), here.volume, size, speed, 9.81)
        floor = 0.1 + size - float(exact.farthest_depth)
        (body,) = bodies(here, complex(size), 1.0, 2.0 * 9.81 / speed**2)
        # The area is counted at 24 heights; its growth bends where the surface meets a wall.
        assert body.level == pytest.approx(floor, abs=2e-4 * 0.1)
        reach = [min(float(np.abs(z).min()) for z in tier.loops) for tier in body.higher if tier.loops]
        assert reach == sorted(reach)
        figure = chamber_figure(machine((here,), size, slowest=speed))
        assert f"a bowl at {speed * 60.0 / 2.0 / math.pi:.4g} rpm" in figure.caption.shown
    assert "bowl" not in chamber_figure(machine((here,), size, slowest=500.0)).caption.shown


def test_chambers_inside_one_another_and_dry_ones() -> None:
    outer, middle = chamber("ring", 0.3, 0.7), chamber("ring", 0.6, 0.5)
    middle = replace(middle, radius=0.06, inner_radius=0.03, mean_surface_radius=0.045)
    dry = replace(outer, volume=0.0, mean_surface_radius=outer.radius)
    check((outer, middle), 0.004 - 0.002j, 1e-4j)
    check((dry,), 0.004 - 0.002j, 1e-4j)


def test_a_film_is_drawn_deep_enough_to_be_seen() -> None:
    radius, film = 0.1, 50e-6
    volume = math.pi * (radius**2 - (radius - film) ** 2) * HEIGHT
    here = FilledChamber(radius, 0.08, HEIGHT, volume, "water", radius - film)
    for size, least in ((1e-5, 0.05), (0.01, 0.01)):
        figure = chamber_figure(machine((here,), size + 0j, 1j * size))
        said = re.search(r"layer \S\N{NO-BREAK SPACE}([\d.]+)", figure.caption.shown)
        assert said is not None
        assert float(said[1]) * film > least * radius


@pytest.mark.parametrize("seed", range(6))
def test_every_frame_of_a_run_up_stays_between_the_walls(seed: int) -> None:
    """Layers with a bore in one frame of many, and pools round the inner wall."""
    rng = np.random.default_rng(seed)
    count, theta = 30, (np.arange(90) + 0.5) * 2.0 * math.pi / 90
    inner = float(rng.uniform(0.05, 0.24))
    record = made_up(history_of(2, 1))
    volume = float(rng.uniform(0.01, 0.9)) * math.pi * (0.25**2 - inner**2) * HEIGHT
    here = FilledChamber(0.25, inner, HEIGHT, volume, "water", math.sqrt(0.25**2 - volume / HEIGHT / math.pi))
    room = 0.25 - inner
    depth = room * rng.uniform(0.0, 0.05, (count, 1, 90))
    depth[17] = room * rng.uniform(0.0, 0.9, (1, 90))
    depth[20:25] = math.nan
    reel = RunupFrames(
        time=np.linspace(0.0, 1.0, count),
        speed=np.full(count, 30.0),
        deflection=1e-3 * np.exp(1j * rng.uniform(0.0, 6.0, (count, 1))),
        amplitude=np.full(count, 1e-3),
        theta=theta,
        depth=depth,
        down=rng.uniform(0.0, 6.0, count),
        pool=rng.uniform(0.0, 6.0, (count, 1)),
    )
    figure, show = film_figure(replace(record, chambers=(here,)), reel)
    axes = figure.axes[0]
    (liquid,) = [patch for patch in axes.patches if patch.get_label() == "liquid"]
    marks = {line.get_label(): line for line in axes.lines}
    for k in range(count):
        show(k)
        centre = complex(*(marks["geometric centre"].get_data()[i][0] for i in (0, 1)))
        x, y = liquid.get_path().vertices.T
        away = np.abs(x + 1j * y - centre) * 1e-3
        assert away.max() <= 0.25 * (1.0 + 1e-9)
        # The inner wall is drawn by 360 sides, that of a pool by 720.
        assert away.min() >= inner * (1.0 - math.radians(0.5) ** 2 / 8.0 - 1e-9), k


@pytest.mark.parametrize("height", [0.02, 0.08])
def test_the_surface_of_a_mode_stays_inside_a_wall_that_waves(height: float, tmp_path: Path) -> None:
    base = disc(0.1, 96, order=2)
    angle, away = np.arctan2(*base.points.T[::-1]), np.hypot(*base.points.T)
    stretch = 1.0 + height * np.cos(4.0 * angle) * (away / 0.1) ** 4
    write_section(Section(base.points * stretch[:, None], base.triangles), tmp_path / "waves.msh")
    # The surface lies a little inside the nearest places of the wall.
    rest = 0.1 * (1.0 - height) - 0.004
    volume = (section_area(base) * (1.0 + 0.5 * height**2) - math.pi * rest**2) * HEIGHT
    source = SectionSource(tmp_path / "waves.msh", 1.0)
    answer = answer_modes(
        Chamber(0.1, HEIGHT), volume, known_liquid("water"), 100.0, 6, Resolution(64, 4), source
    )
    outer = float(np.hypot(*answer.section.points.T).max())
    for axes in modes_figure(answer).axes:
        moved = [line for line in axes.lines if line.get_linewidth() == 1.6]
        walls = [line for line in axes.lines if line.get_color() == "black" and line.get_linewidth() == 1.4]
        if not moved:
            continue
        x, y = moved[0].get_data()
        wx, wy = walls[0].get_data()
        found = np.interp(
            np.arctan2(y, x)[np.isfinite(x)],
            *_around(np.arctan2(wy, wx)[np.isfinite(wx)], np.hypot(wx, wy)[np.isfinite(wx)]),
            period=2.0 * math.pi,
        )
        assert np.all(np.hypot(x, y)[np.isfinite(x)] < found + 1e-4 * outer)


def _around(angle: np.ndarray, away: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    order = np.argsort(angle)
    return angle[order], away[order]
