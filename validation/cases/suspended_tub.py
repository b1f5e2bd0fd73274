"""The washing machine of DG21 with six degrees of freedom: what the source gives, and all that it does not.

The drum spins about y, x lies across, z is up, and positions count from the tub's centre of mass.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from meshes.arrays import Array
from solvers.rotor.tub import Mount, Tub, Vector
from solvers.rotor.vibration import unbalance_response

# Given in table 1.
TUB_MASS, DRUM_MASS = 48.2, 12.5  # kg
ECCENTRICITY = 14.8e-3  # m
SPRING, SPRING_ANGLE = 6000.0, math.radians(75.0)  # N/m each of two; taken from the horizontal
DAMPER, DAMPER_ANGLE = 175.0, math.radians(70.0)  # N s/m each of two
FARTHEST = 0.09  # m, of the drum's centre of mass along the axis


@dataclass(frozen=True)
class Assumed:
    """What DG21 does not give, in SI units.

    Parameters
    ----------
    tub_inertia : of a shell of 230 mm radius and 300 mm length with a counterweight
    drum_polar_inertia, drum_transverse_inertia : of a shell of 185 mm radius and 190 mm length with laundry
    spring_place, damper_place : x across and z up, each mirrored in x, at y = 0
    lateral : stiffness of a spring across itself: its tension, 308 N, over its length, 250 mm
    bush : sideways stiffness of a damper's rubber bushes
    friction : damping of the bushes in all directions
    """

    tub_inertia: Vector = (1.3, 1.5, 1.3)
    drum_polar_inertia: float = 0.32
    drum_transverse_inertia: float = 0.20
    spring_place: tuple[float, float] = (0.2, 0.2)
    damper_place: tuple[float, float] = (0.12, -0.22)
    lateral: float = 1200.0
    bush: float = 500.0
    friction: float = 20.0


def suspended_tub(
    drum_y: float = 0.0, shift: float = 0.0, spring_turn: float = 0.0, damper_turn: float = 0.0
) -> Tub:
    """The machine of DG21.

    Parameters
    ----------
    drum_y : y_D, place of the drum's centre of mass and of the unbalance along the axis, m
    shift : l_c, by which the springs sit farther along the axis, m
    spring_turn, damper_turn : phi out of the plane across the axis, rad; one of the pair towards +y, the
        other towards -y, so that they stay in balance under the weight

    Returns
    -------
    Tub without liquid
    """
    known = Assumed()
    springs, dampers = [], []
    for side in (1.0, -1.0):
        place = (side * known.spring_place[0], shift, known.spring_place[1])
        springs.append(
            Mount(
                place,
                SPRING - known.lateral,
                direction(SPRING_ANGLE, spring_turn, side),
                along_axes=(known.lateral,) * 3,
            )
        )
        place = (side * known.damper_place[0], 0.0, known.damper_place[1])
        springs.append(Mount(place, along_axes=(known.bush, known.bush, 0.0)))
        way = direction(-DAMPER_ANGLE, damper_turn, side)
        dampers.append(Mount(place, DAMPER - known.friction, way, along_axes=(known.friction,) * 3))
    return Tub(
        tub_mass=TUB_MASS,
        drum_mass=DRUM_MASS,
        tub_inertia=known.tub_inertia,
        drum_polar_inertia=known.drum_polar_inertia,
        drum_transverse_inertia=known.drum_transverse_inertia,
        springs=tuple(springs),
        dampers=tuple(dampers),
        unbalance=DRUM_MASS * ECCENTRICITY,
        drum_position=(0.0, drum_y, 0.0),
    )


def direction(angle: float, turn: float, side: float) -> Vector:
    """Unit vector at an angle above the horizontal, turned by phi out of the plane across the axis.

    Parameters
    ----------
    angle, turn : rad
    side : 1 or -1, of the tub; on the other side everything is turned by half a turn about the vertical
    """
    flat = math.cos(turn)
    return side * math.cos(angle) * flat, side * math.sin(turn), math.sin(angle) * flat


def amplitude(machine: Tub, speed: Array, coordinate: str) -> Array:
    """Amplitude of one coordinate of the tub's centre of mass over speed.

    Parameters
    ----------
    machine : the tub
    speed : rad/s, shape (s,)
    coordinate : "x", "y", "z" (m) or "alpha", "beta", "gamma" (rad)

    Returns
    -------
    shape (s,)
    """
    system = machine.system()
    return np.asarray(np.abs(unbalance_response(system, speed)[:, system.coordinates.index(coordinate)]))
