"""What turns the rotor in a run-up (ramp or motor), and what a run-up asks of a liquid model.

A liquid model is a function that makes a rotor with its liquid at one moment, a `RunupMachine`.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass, field
from enum import StrEnum
from typing import Annotated, Any, Protocol

import numpy as np

from fluid.fill import Fill
from fluid.friction.laws import Friction
from meshes.arrays import Array, Complex, Flags, Index
from meshes.errors import InputError, require_positive
from meshes.quantity import Q
from solvers.layer.records import Outcome
from solvers.rotor.system import RotorSystem
from solvers.runup.programme import Programme, require_curve


@dataclass(frozen=True)
class Ramp:
    """Spin speed that rises at a rate, is held, and may fall again at the same rate."""

    start: float  #: rad/s
    stop: float
    rate: float  #: rad/s^2
    duration: float  #: of rise and hold together, s; a rise that takes longer is cut there
    back: bool = False  #: down to the start again afterwards

    def __post_init__(self) -> None:
        for name in ("start", "stop", "rate", "duration"):
            require_positive(name, getattr(self, name))
        if self.stop <= self.start:
            raise InputError("stop", self.stop, f"above the start, {self.start:g} rad/s")

    def corners(self) -> Array:
        """Times at which the rate changes, from 0 to the end, and the speeds there, shape (2, k)."""
        rise = min((self.stop - self.start) / self.rate, self.duration)
        top = min(self.stop, self.start + self.rate * rise)
        points = [(0.0, self.start), (rise, top)]
        if self.duration > rise:
            points.append((self.duration, top))
        if self.back:
            points.append((self.duration + rise, self.start))
        return np.array(points).T


@dataclass(frozen=True)
class Motor:
    """A motor on the rotor's axis: the spin speed answers."""

    start: float  #: spin speed at the beginning, rad/s
    inertia: float  #: of rotor and motor about the axis, kg m^2
    #: points of the torque curve, rad/s ascending and N m; straight lines between them
    speeds: tuple[float, ...]
    torques: tuple[float, ...]
    duration: float  #: s

    def __post_init__(self) -> None:
        for name in ("start", "inertia", "duration"):
            require_positive(name, getattr(self, name))
        require_curve(self.speeds, self.torques)

    def corners(self) -> Array:
        """Beginning and end with the starting speed, shape (2, 2)."""
        return np.array([[0.0, self.duration], [self.start, self.start]])


Drive = Ramp | Motor | Programme


class Handover(StrEnum):
    """How liquid at the bottom of a lying chamber becomes a layer round its wall [theory: pool]."""

    # By itself: walls and baffles draw it over the top until none of it lies at the bottom.
    CARRIED = "carried"
    # The same with twice their grip on the liquid: the earliest to be expected.
    DRUM = "drum"
    # As soon as the drum's centrifugal field beats gravity, however it would get there.
    RIDING = "riding"


@dataclass(frozen=True)
class Transfer:
    """Liquid that became a layer, or fell to the bottom; what was handed over."""

    chamber: Annotated[int, Q("1", text="its number, from 0", data=False)]
    captured: Annotated[bool, Q(text="it became a layer")]
    time: Annotated[float, Q("s", "time")]
    speed: Annotated[float, Q("rad s-1", "spin speed")]
    #: about its chamber's axis, N m s
    angular_momentum: Annotated[
        tuple[float, float], Q("kg m2 s-1", text="of the liquid before and after", data=False)
    ]
    #: kinetic and elastic, J
    energy: Annotated[tuple[float, float], Q("J", text="of rotor and liquid before and after", data=False)]
    lifted: Annotated[float, Q("J", "change of the liquid's potential energy")]

    @property
    def lost(self) -> Annotated[float, Q("J", "energy that becomes heat")]:
        """Energy that the sudden change turns into heat, J; below zero what the drum gives."""
        return self.energy[0] - self.energy[1] - self.lifted


@dataclass(frozen=True)
class Reading:
    """A moment of a run-up, n coordinates and l layers, as `solvers.runup.runup.RunupHistory` keeps it."""

    time: float  #: s, rad/s, and rad by which the drum has turned
    speed: float
    angle: float
    coordinates: Array  #: of the rotor, shape (n,)
    #: of each chamber's axis in the standing frame, complex, m, shape (l,); without a chamber, of the axis at
    #: position 0, shape (1,)
    deflection: Complex
    largest: float  #: largest modulus of the first deflection at any step since the reading before, m
    largest_speed: float  #: where that was, rad/s and s
    largest_time: float
    #: of each layer's centre of mass from its chamber's axis, standing frame, complex, m, shape (l,)
    offset: Complex
    captured: Flags  #: the layer rides with the drum, shape (l,)
    depth_min: Array  #: of each layer, m, shape (l,); nan while it is not captured
    depth_max: Array
    mean_rotation: Array  #: of each layer or pool relative to its drum, rad/s, shape (l,)
    #: share of the outer wall that liquid wets, and of the liquid that is above the axis, shape (l,)
    wet_share: Array
    lifted_share: Array
    #: of each ball in the drum, from its zero mark, whole turns counted, rad, shape (N,)
    ball_angle: Array = field(default_factory=lambda: np.zeros(0))
    #: of each ball in space, rad/s, shape (N,)
    ball_speed: Array = field(default_factory=lambda: np.zeros(0))


@dataclass(frozen=True)
class LayerSnapshots:
    """The layers cell by cell at f of a run-up's recorded times; l chambers, c cells."""

    sample: Index  #: which of the history's times these are, ascending, shape (f,)
    theta: Array  #: angle of the cells' middles from the drum's zero mark, rad, shape (c,)
    depth: Array  #: of each layer, m, nan while the liquid is none, shape (f, l, c)


class RunupMachine(Protocol):
    """A rotor with its liquid at one moment."""

    @property
    def time(self) -> float:
        """Time, s."""

    @property
    def spin(self) -> float:
        """Spin speed, rad/s."""

    @property
    def angle(self) -> float:
        """Angle by which the drum has turned, rad."""

    @property
    def velocity(self) -> Array:
        """Rates of change of the rotor's coordinates, shape (n,)."""

    @property
    def lost_inertia(self) -> float:
        """Moment of inertia about the axis that has left the drum by now, kg m^2."""

    @property
    def masses(self) -> Array:
        """Mass of the liquid in each chamber, kg, shape (l,)."""

    @property
    def sums(self) -> Any:
        """Works, heats and counts so far, a record of `solvers.runup.state.SUMS`."""

    @property
    def transfers(self) -> Sequence[Transfer]:
        """Liquid that has become a layer or fallen so far, in their order."""

    @property
    def theta(self) -> Array:
        """Angle of the cells' middles from the drum's zero mark, rad, shape (c,)."""

    def drive(self, curve: Array, inertia: float) -> None:
        """Set a motor's torque curve and moment of inertia; an empty curve leaves the spin to its ramp."""

    def load(self, unbalance: Complex) -> None:
        """Set the unbalance from here on, kg m and kg m^2, shape (n,)."""

    def lighten(self, mass: Array, inertia: float) -> float:
        """Set mass matrix and spin inertia of what has left the drum; the energy brought in, J, below 0.

        What leaves keeps its velocity, so that no speed changes [theory: coupling, eq. 17].
        """

    def advance(self, stop: float, rate: float, courant: float, most: int) -> Outcome:
        """Advance to a time while the spin changes at a rate, in at most so many steps."""

    def through(
        self,
        stops: Array,
        rates: Array,
        courant: float,
        most: int,
        progress: Callable[[float], object],
    ) -> tuple[Outcome, dict[str, Array], Array] | None:
        """Go through k times, to each at a rate of the spin, in at most so many steps.

        Returns fields of `Reading` and depths of the layers at the times that were reached, shapes (k, ...);
        None of a machine that changes on the way, whose legs are gone one by one.
        """

    def switch(self) -> float:
        """Catch liquid that can ride with the drum by now, let go what cannot; energy brought in, J."""

    def fall(self, outcome: Outcome) -> float | None:
        """Let liquid fall that gravity has thrown down; energy brought in, J, or None where none has been."""

    def energy(self) -> float:
        """Energy of rotor and liquid, J."""

    def mass_error(self) -> float:
        """Largest relative change of a layer's volume since the beginning."""

    def watch(self) -> None:
        """Look for the largest amplitude anew from here on."""

    def read(self) -> Reading:
        """The moment as the history keeps it."""

    def depth(self) -> Array:
        """Depth of the layers cell by cell, m, nan where the liquid is none, shape (l, c)."""

    def follow(self, rows: int) -> None:
        """Write the steps down from here on, so many between two looks; 0 writes none."""

    def followed(self) -> Array:
        """Time, angle and coordinates of the steps since this was asked last, shape (k, 2 + n or more)."""


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
        enstrophy: bool = False,
        handover: Handover = Handover.RIDING,
    ) -> RunupMachine:
        """As `solvers.runup.long_wave.couple`."""


# Of the error of linear layers, found from random run-ups with both models: see the theory page.
FLOOR, WAVE, MOST_WAVE = 0.006, 2.0, 0.5


def largest_wave(tolerance: float) -> float:
    """Rise of a surface over its depth at which a run without lag reaches a tolerance; 0 where none does."""
    return min(math.sqrt(max(tolerance - FLOOR, 0.0) / WAVE), MOST_WAVE)
