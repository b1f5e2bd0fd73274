"""What a run-up asks of a liquid model: a rotor with its liquid at one moment, which can go on in time.

A backend is made by a function with the arguments of `solvers.runup.long_wave.couple`; `run_up` drives any.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from enum import IntEnum
from typing import Any, Protocol

from fluid.fill import Fill
from fluid.friction import Friction
from meshes.arrays import Array, Complex, Flags, Index
from solvers.rotor.system import RotorSystem


class Outcome(IntEnum):
    """How a stretch of time steps ended; compiled code knows it as well."""

    DONE = 0
    TOO_LONG = 1
    AT_AXIS = 2
    RAN_OUT = 3
    NOT_COUPLED = 4
    STOPPED = 5

    @property
    def message(self) -> str:
        """Why it went no further; empty where it came to its end."""
        return _MESSAGES[self]


_MESSAGES = {
    Outcome.DONE: "",
    Outcome.TOO_LONG: "a layer outran the shortest step",
    Outcome.AT_AXIS: "the surface of a layer came to the axis",
    Outcome.RAN_OUT: "the time steps ran out",
    Outcome.NOT_COUPLED: "rotor and layers did not agree in the shortest steps",
    Outcome.STOPPED: "the motor stands",
}


@dataclass(frozen=True)
class Reading:
    """A moment of a run-up with n coordinates and l layers, as `solvers.runup.runup.RunupHistory` keeps it.

    Parameters
    ----------
    time, speed, angle : s, rad/s, and rad by which the drum has turned
    coordinates : of the rotor, shape (n,)
    deflection : of each chamber's axis in the standing frame, complex, m, shape (l,); without a chamber, of
        the axis at position 0, shape (1,)
    offset : of each layer's centre of mass from its chamber's axis, standing frame, complex, m, shape (l,)
    captured : the layer rides with the drum, shape (l,)
    depth_min, depth_max : of each layer, m, shape (l,); nan while it is not captured
    mean_rotation : of each layer relative to its drum, rad/s, shape (l,)
    """

    time: float
    speed: float
    angle: float
    coordinates: Array
    deflection: Complex
    offset: Complex
    captured: Flags
    depth_min: Array
    depth_max: Array
    mean_rotation: Array


@dataclass(frozen=True)
class LayerSnapshots:
    """The layers cell by cell at f of a run-up's recorded times; l chambers, c cells.

    Parameters
    ----------
    sample : which of the history's times these are, ascending, shape (f,)
    theta : angle of the cells' middles from the drum's zero mark, rad, shape (c,)
    depth : of each layer, m, nan while the liquid is none, shape (f, l, c)
    """

    sample: Index
    theta: Array
    depth: Array


class RunupMachine(Protocol):
    """A rotor with its liquid at one moment."""

    @property
    def time(self) -> float:
        """Time, s."""

    @property
    def spin(self) -> float:
        """Spin speed, rad/s."""

    @property
    def masses(self) -> Array:
        """Mass of the liquid in each chamber, kg, shape (l,)."""

    @property
    def sums(self) -> Any:
        """Works, heats and counts so far, a record of `solvers.runup.state.SUMS`."""

    @property
    def theta(self) -> Array:
        """Angle of the cells' middles from the drum's zero mark, rad, shape (c,)."""

    def drive(self, curve: Array, inertia: float) -> None:
        """Set a motor's torque curve and moment of inertia; an empty curve leaves the spin to its ramp."""

    def advance(self, stop: float, rate: float, courant: float, most: int) -> Outcome:
        """Advance to a time while the spin changes at a rate, in at most so many steps."""

    def switch(self) -> float:
        """Catch liquid that can ride with the drum by now, let go what cannot; energy brought in, J."""

    def fall(self, outcome: Outcome) -> float | None:
        """Let liquid fall that gravity has thrown down; energy brought in, J, or None where none has been."""

    def energy(self) -> float:
        """Of rotor and liquid, J."""

    def mass_error(self) -> float:
        """Largest relative change of a layer's volume since the beginning."""

    def read(self) -> Reading:
        """The moment as the history keeps it."""

    def depth(self) -> Array:
        """Depth of the layers cell by cell, m, nan where the liquid is none, shape (l, c)."""


class RunupModel(Protocol):
    """A liquid model through time: makes a rotor without deflection with its liquid at rest in the drum."""

    def __call__(
        self,
        system: RotorSystem,
        fills: Sequence[Fill],
        spin: float,
        friction: Friction,
        gravity: float,
        cells: int,
        dispersion: bool,
    ) -> RunupMachine:
        """As `solvers.runup.long_wave.couple`."""
