"""Directions of a rotor in space, what holds it, and where its masses are. SI units."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from fluid.fill import Fill
from meshes.arrays import Array
from solvers.rotor.balls.balancers import BallRace
from solvers.rotor.jeffcott import Jeffcott
from solvers.rotor.tub import Mount, Tub, Vector, displacement
from solvers.rotor.two_plane import TwoPlane

AnyRotor = Jeffcott | TwoPlane | Tub


@dataclass(frozen=True)
class Frame:
    """Directions of a rotor with n coordinates."""

    body: Array  #: shift along and turn about x, y, z of the body for unit coordinates, shape (6, n)
    along: int  #: number of the direction along the spin axis, 0 for x
    #: numbers of the two directions across it; the spin turns the first into the second
    across: tuple[int, int]
    up: int  #: number of the direction against gravity
    axis: Vector  #: (x, y, z) of a point of the spin axis, m

    def moving(self, position: Vector) -> Array:
        """Displacement of a point of the body for unit coordinates [theory: loads, eq. 1].

        Along x, y, z, shape (3, n), of a point at (x, y, z) at rest, m.
        """
        return np.asarray(displacement(position) @ self.body)

    def on_axis(self, place: float) -> Vector:
        """The point of the spin axis at a place along it."""
        point = list(self.axis)
        point[self.along] = place
        return (point[0], point[1], point[2])


def frame_of(rotor: AnyRotor, vertical: bool = False) -> Frame:
    """Directions of a rotor; `vertical` where gravity acts along its axis."""
    if isinstance(rotor, Tub):
        x, _, z = rotor.drum_position
        return Frame(np.eye(6), 1, (2, 0), 1 if vertical else 2, (x, 0.0, z))
    # Only a rotor in two planes leans: about x and y.
    rows = [0, 1, 3, 4] if isinstance(rotor, TwoPlane) else [0, 1]
    return Frame(np.eye(6)[:, rows], 2, (0, 1), 2 if vertical else 0, (0.0, 0.0, 0.0))


@dataclass(frozen=True)
class Holder:
    """A spring, a damper or a support between the rotor and its cabinet."""

    name: str  #: for reports, such as "spring 1"
    position: Vector  #: where it holds the rotor, m
    stiffness: Array  #: force over displacement and over velocity, shape (3, 3), N/m and N s/m
    damping: Array


def holders_of(rotor: AnyRotor) -> tuple[Holder, ...]:
    """What holds a rotor: the springs and dampers of a tub, the supports of any other."""
    none, across = np.zeros((3, 3)), np.diag([1.0, 1.0, 0.0])
    if isinstance(rotor, Tub):
        springs = [
            Holder(f"spring {k + 1}", mount.position, tensor(mount), none)
            for k, mount in enumerate(rotor.springs)
        ]
        dampers = [
            Holder(f"damper {k + 1}", mount.position, none, tensor(mount))
            for k, mount in enumerate(rotor.dampers)
        ]
        return (*springs, *dampers)
    if isinstance(rotor, TwoPlane):
        return tuple(
            Holder(f"support {k + 1}", (0.0, 0.0, s.position), *(np.pad(each, (0, 1)) for each in s.across))
            for k, s in enumerate(rotor.supports)
        )
    return (Holder("support", (0.0, 0.0, 0.0), rotor.stiffness * across, rotor.damping * across),)


def tensor(mount: Mount) -> Array:
    """Force of a spring or damper over the displacement or velocity of its point [theory: rotor, eq. 21].

    N/m or N s/m, shape (3, 3).
    """
    unit = np.array(mount.direction) / math.hypot(*mount.direction)
    return np.asarray(mount.coefficient * np.outer(unit, unit) + np.diag(mount.along_axes))


@dataclass(frozen=True)
class Weight:
    """A mass at its place at rest."""

    mass: float  #: kg
    position: Vector  #: m
    turns: bool = True  #: it hangs on the drum, not on the tub


def weights_of(
    rotor: AnyRotor, fills: Sequence[Fill], frame: Frame, races: Sequence[BallRace] = ()
) -> tuple[Weight, ...]:
    """Masses of a rotor, of liquid and of balls, which count at the centre of their chamber or race."""
    rolling = [Weight(sum(race.masses), frame.on_axis(race.position)) for race in races]
    liquid = [Weight(fill.mass, frame.on_axis(fill.chamber.plane)) for fill in fills if fill.volume > 0.0]
    if isinstance(rotor, Tub):
        tub = Weight(rotor.tub_mass, (0.0, 0.0, 0.0), turns=False)
        return (tub, Weight(rotor.drum_mass, rotor.drum_position), *liquid, *rolling)
    return (Weight(rotor.mass, (0.0, 0.0, 0.0)), *liquid, *rolling)
