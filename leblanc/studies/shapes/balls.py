"""A machine with balls as a picture draws it: races as rings, balls where `run` or a run-up finds them."""

from __future__ import annotations

import math
from collections.abc import Sequence

import numpy as np

from leblanc.liquid.choose import axial_gravity
from leblanc.plotting.bodies import BallView, DrawnRace
from leblanc.scene.chambers import Chamber
from leblanc.scene.races import BallRace
from leblanc.scene.rotors import JeffcottRotor
from leblanc.scene.scene import Scene, Speeds, dry_rotor
from leblanc.studies.balls.study import run_balls
from leblanc.studies.shapes.equilibrium import liquid_at, places_of
from leblanc.studies.shapes.scale import choose_scale, given_scale
from leblanc.studies.shapes.supports import machine_parts
from meshes.arrays import Array
from meshes.errors import InputError
from solvers.rotor.vibration import orbit

STEEL = 7850.0  # kg/m^3, of balls whose size a scene does not give
_ROOM = 0.95  # of the largest radius at which such balls fit in their race


def ball_radius(race: BallRace) -> float:
    """Radius of a ball as drawn, m: what the scene says, or that of a steel ball that fits."""
    if race.diameter is not None:
        return 0.5 * race.diameter
    fits = race.radius * (math.sin(math.pi / race.count) if race.count > 1 else 0.5)
    steel = math.cbrt(0.75 * race.each / (math.pi * STEEL))
    return min(steel, _ROOM * fits)


def ringed(scene: Scene) -> Scene:
    """The scene with a ring-shaped chamber without liquid, as wide as the balls, in place of each race."""
    rings = [
        Chamber(
            radius=race.radius + ball,
            inner_radius=race.radius - ball,
            height=2.0 * ball,
            plane=race.plane,
            liquid="water",
            volume=0.0,
        )
        for race in scene.balls
        for ball in [ball_radius(race)]
    ]
    return scene.altered(chambers=(*scene.liquids, *rings))


def drawn_races(scene: Scene) -> tuple[DrawnRace, ...]:
    """The races of a scene as they are drawn, behind its chambers with liquid."""
    first, found = 0, []
    for k, race in enumerate(scene.balls):
        own = (first, first + race.count)
        ball = ball_radius(race)
        found.append(DrawnRace(len(scene.liquids) + k, race.radius, ball, race.diameter is None, own))
        first += race.count
    return tuple(found)


def side_by_side(races: Sequence[DrawnRace], angle: Array) -> Array:
    """Angles at which balls of one race that would cover one another touch; the others stay.

    Those that overlap move apart about their middle, again and again until none does.
    """
    found = angle.copy()
    for race in races:
        own = slice(*race.balls)
        apart = 2.0 * math.asin(min(1.0, race.ball / race.radius))
        # Begin behind the widest gap, so that no group lies across the beginning.
        turn = np.mod(found[own], 2.0 * math.pi)
        order = np.argsort(turn, kind="stable")
        gaps = np.diff(turn[order], append=turn[order[0]] + 2.0 * math.pi)
        order = np.roll(order, -1 - int(np.argmax(gaps)))
        line = np.unwrap(turn[order])
        groups: list[list[float]] = []  # middle and number of balls
        for at in line.tolist():
            groups.append([at, 1.0])
            while len(groups) > 1 and groups[-1][0] - groups[-2][0] < 0.5 * apart * (
                groups[-1][1] + groups[-2][1]
            ) * (1.0 - 1e-9):
                (low, n), (high, m) = groups[-2:]
                groups[-2:] = [[(n * low + m * high) / (n + m), n + m]]
        spread = [
            middle + apart * (k - 0.5 * (count - 1.0)) for middle, count in groups for k in range(int(count))
        ]
        placed = found[own]
        # Balls that stay keep their angle as it is.
        moved = np.abs(np.array(spread) - line) > 1e-9
        placed[order[moved]] = np.array(spread)[moved]
    return found


def ball_view(
    scene: Scene, speed: float | None = None, factor: float | None = None, every: bool = False
) -> BallView:
    """A machine with balls at one speed, or at all its own, and what is drawn of it."""
    if not every:
        spin = scene.speeds.stop if speed is None else speed
        if not (math.isfinite(spin) and spin > 0.0):
            raise InputError("--speed", spin, "a finite number above 0")
        scene = scene.altered(speeds=Speeds.at(spin))
    result, rings = run_balls(scene, families=False, edges=False), ringed(scene)
    places, moved = places_of(rings)
    rows, chosen = np.arange(result.speed.size), np.maximum(result.chosen, 0)
    # Without a state the machine is drawn where it rests.
    coordinates = np.where(result.converged[:, None], result.states.coordinates[rows, chosen], 0.0)
    system, fills = dry_rotor(scene).system(), rings.fills
    deflection = np.stack([orbit(system, coordinates, fill.chamber.plane).forward for fill in fills], axis=1)
    lean = np.zeros(rows.size, dtype=complex)
    if not isinstance(scene.rotor, JeffcottRotor):
        low, high = (orbit(system, coordinates, place).forward for place in (-0.5, 0.5))
        lean = high - low
    gravity = axial_gravity(scene)
    if factor is None:
        span = float(np.ptp(places))
        scale = choose_scale(fills, deflection, result.speed, gravity, span)
    else:
        scale = given_scale(factor, fills, deflection, result.speed, gravity)
    races = drawn_races(scene)
    known = np.where(np.isfinite(result.ball_angle), result.ball_angle, 0.0)
    angle = np.array([side_by_side(races, row) for row in known])
    return BallView(
        result=result,
        fills=fills,
        places=places,
        moved=moved,
        races=races,
        deflection=deflection,
        lean=lean,
        angle=angle,
        apart=tuple(np.any(angle != known, axis=1).tolist()),
        scale=scale,
        bodies=tuple(
            tuple(
                liquid_at(fill, complex(found), float(spin), gravity, scale)
                for fill, found in zip(fills, row, strict=True)
            )
            for spin, row in zip(result.speed, deflection, strict=True)
        ),
        parts=machine_parts(rings, places),
    )
