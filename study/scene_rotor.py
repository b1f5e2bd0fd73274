"""The rotor of a scene, of one of four kinds, in SI units and frozen."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import TYPE_CHECKING, Literal

from study.rotor_table import (
    DamperTable,
    ExciterTable,
    JeffcottTable,
    SpringTable,
    TubTable,
    TwoPlaneTable,
)
from study.table import Table

if TYPE_CHECKING:
    from solvers.rotor.tub import Mount, Tub
    from solvers.rotor.two_plane import TwoPlane

Axis = Literal["horizontal", "vertical"]


@dataclass(frozen=True)
class Rotor:
    """A rotor on an isotropic support, moving in one plane.

    Parameters
    ----------
    kind : "jeffcott"
    mass : M without the liquid, kg
    stiffness : K, N/m
    damping : C of the support, external, N s/m
    unbalance : U0 = m e, kg m
    axis : "horizontal" if gravity lies across the axis, "vertical" if along it
    """

    kind: Literal["jeffcott"]
    mass: float
    stiffness: float
    damping: float
    unbalance: float
    axis: Axis


@dataclass(frozen=True)
class TwoPlaneRotor:
    """A rigid rotor in supports along its axis.

    Parameters
    ----------
    kind : "two_plane"
    machine : the rotor without liquid
    axis : as in `Rotor`
    """

    kind: Literal["two_plane"]
    machine: TwoPlane
    axis: Axis


@dataclass(frozen=True)
class TubRotor:
    """A suspended tub with its drum.

    Parameters
    ----------
    kind : "tub"
    machine : tub and drum without liquid
    axis : of the drum, as in `Rotor`
    """

    kind: Literal["tub"]
    machine: Tub
    axis: Axis


@dataclass(frozen=True)
class ExciterBalls:
    """The balls, rollers or pendulums of an exciter.

    Parameters
    ----------
    count : how many
    mass : of each, kg
    kind : "ball", "roller" or "pendulum"
    pendulum_inertia : of each pendulum about its own centre of mass, kg m^2; 0 for the others
    track_radius : of the circle of their centres, m
    damping : of the motion along the track, N s/m
    """

    count: int
    mass: float
    kind: Literal["ball", "roller", "pendulum"]
    pendulum_inertia: float
    track_radius: float
    damping: float


@dataclass(frozen=True)
class Exciter:
    """A platform that vibrates along one line, shaken by an unbalance and by balls in a rotating track.

    Parameters
    ----------
    kind : "exciter"
    platform_mass : of all that vibrates without the balls, kg
    stiffness : N/m
    damping : N s/m
    unbalance : of the shaft, kg m
    balls : in the track on the shaft
    """

    kind: Literal["exciter"]
    platform_mass: float
    stiffness: float
    damping: float
    unbalance: float
    balls: ExciterBalls

    @property
    def axis(self) -> Axis:
        """Its shaft lies across the vibration."""
        return "horizontal"


AnyRotor = Rotor | TwoPlaneRotor | TubRotor | Exciter


def rotor_from_table(table: Table) -> AnyRotor:
    """Rotor from the checked values of its table."""
    if isinstance(table, TwoPlaneTable):
        return _two_plane(table)
    if isinstance(table, TubTable):
        return _tub(table)
    if isinstance(table, ExciterTable):
        return _exciter(table)
    assert isinstance(table, JeffcottTable)
    return _jeffcott(table)


def _jeffcott(table: JeffcottTable) -> Rotor:
    """Stiffness and damping from a critical speed and a damping ratio, both of the rotor without liquid.

    K = M omega^2 and C = 2 zeta sqrt(K M).
    """
    stiffness, damping = table.stiffness, table.damping
    if table.critical_speed is not None:
        stiffness = table.mass * table.critical_speed**2
    assert stiffness is not None
    if table.damping_ratio is not None:
        damping = 2.0 * table.damping_ratio * math.sqrt(stiffness * table.mass)
    assert damping is not None
    return Rotor(table.kind, table.mass, stiffness, damping, table.unbalance, table.axis)


def _two_plane(table: TwoPlaneTable) -> TwoPlaneRotor:
    from solvers.rotor.two_plane import PlaneUnbalance, Support, TwoPlane

    machine = TwoPlane(
        mass=table.mass,
        transverse_inertia=table.transverse_inertia,
        polar_inertia=table.polar_inertia,
        supports=tuple(Support(**one.model_dump()) for one in table.supports),
        unbalances=tuple(PlaneUnbalance(**one.model_dump()) for one in table.unbalances),
    )
    return TwoPlaneRotor(table.kind, machine, table.axis)


def _tub(table: TubTable) -> TubRotor:
    from solvers.rotor.tub import Tub

    values = table.model_dump(exclude={"kind", "axis", "springs", "dampers"})
    machine = Tub(
        **values, springs=tuple(map(_mount, table.springs)), dampers=tuple(map(_mount, table.dampers))
    )
    return TubRotor(table.kind, machine, table.axis)


def _mount(table: SpringTable | DamperTable) -> Mount:
    """Along its direction if it has one, else along the axes."""
    from solvers.rotor.tub import Mount

    value = table.stiffness if isinstance(table, SpringTable) else table.damping
    if isinstance(value, tuple):
        return Mount(table.position, along_axes=value)
    assert table.direction is not None
    return Mount(table.position, coefficient=value, direction=table.direction)


def _exciter(table: ExciterTable) -> Exciter:
    values = table.model_dump(exclude={"balls"})
    balls = table.balls.model_dump(exclude={"kind", "pendulum_inertia"})
    inertia = table.balls.pendulum_inertia
    kind = table.balls.kind or "pendulum"
    return Exciter(**values, balls=ExciterBalls(**balls, kind=kind, pendulum_inertia=inertia or 0.0))
