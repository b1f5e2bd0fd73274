"""What is held, how it is resolved, and what comes of it."""

from __future__ import annotations

import math
from dataclasses import dataclass, field, replace
from enum import StrEnum

import numpy as np

from fluid.fill import Fill
from fluid.friction.laws import NO_FRICTION, Friction
from meshes.arrays import Array, Complex, Flags
from meshes.errors import InputError
from solvers.rotor.system import RotorSystem

# Turns a motion is looked at over before it may be called periodic, where nothing is known of it.
SHORT = 8
COUPLED = "coupled"  # the compiled steps, by their name in py-pde


class HeldKind(StrEnum):
    """What a motion settles to."""

    STEADY = "steady"
    PERIODIC = "periodic"
    LIMIT_CYCLE = "limit_cycle"
    NOT_SETTLED = "not_settled"


@dataclass(frozen=True)
class HoldNumerics:
    """How a state is held."""

    #: finite volumes round each wall, from 8; nodes of the surface of a fully nonlinear wave, even, from 16
    cells: int = 128
    dispersion: bool = False  #: add the finite depth's dispersion to the layers
    courant: float = 0.8  #: Courant number of the layers, above 0, at most 0.9
    tolerance: float = 2e-4  #: change of the amplitude over its size at which it has settled
    turns: int = 1024  #: of the drum, at most
    #: its name in py-pde; another than the compiled steps is slow, and an independent check
    solver: str = COUPLED

    def __post_init__(self) -> None:
        if not 8 <= self.cells <= 65536:
            raise InputError("cells", self.cells, "from 8 to 65536")
        if not 0.0 < self.courant <= 0.9:
            raise InputError("courant", self.courant, "above 0, at most 0.9")
        if not 0.0 < self.tolerance <= 0.1:
            raise InputError("tolerance", self.tolerance, "above 0, at most 0.1")
        if self.turns < 2 * SHORT:
            raise InputError("turns", self.turns, f"{2 * SHORT} or more")


@dataclass(frozen=True)
class Moment:
    """Rotor and layers when the drum's zero mark lies along the first direction; n coordinates, l layers."""

    spin: float  #: Omega, rad/s
    coordinates: Array  #: of the rotor, m or rad, and per second, shape (n,)
    rate: Array
    area: Array  #: A, m^2, and q, m^4/s, of the layers' cells, shape (l, c)
    momentum: Array
    layers: Flags  #: which chambers hold a layer
    #: of which area and momentum are seen, lengths over R and times in 1/Omega: y and phi of nonlinear waves,
    #: shape (l, 2m), modes and lag of KdV-Burgers, shape (l, 2m + 3); none of long waves
    wave: Array = field(default_factory=lambda: np.zeros((0, 0)))

    def at(self, spin: float) -> Moment:
        """The same motion turn by turn at another spin: velocities go with it."""
        share = spin / self.spin
        return replace(self, spin=spin, rate=self.rate * share, momentum=self.momentum * share)


@dataclass(frozen=True)
class HeldState:
    """Motion of rotor and liquid at one speed; n coordinates, l chambers.

    Deflections are those of the first chamber's axis, or of the axis at position 0 without one, from where it
    rests without motion.
    """

    spin: float  #: Omega, rad/s
    kind: HeldKind  #: what it settles to
    amplitude: float  #: mean over time of the axis' distance from where it rests, m
    crest: float  #: mean over the turns of each turn's largest distance, m
    least: float  #: over time, m
    largest: float
    #: of the part that turns with the drum, q = Re(coordinates e^{i Omega t}), complex, shape (n,)
    coordinates: Complex
    rest: Array  #: mean of the coordinates, shape (n,)
    #: mean of each layer's centre of mass from its chamber's axis, in the drum, complex, m, shape (l,)
    liquid: Complex
    ripple: Array  #: largest distance of the centre of mass from that mean, m, shape (l,)
    #: strongest of the axis' frequencies that is not the spin's, standing frame, positive with the spin,
    #: rad/s; nan where the motion repeats every turn
    whirl_speed: float
    dry: Flags  #: the wall is dry somewhere, shape (l,)
    captured: Flags  #: the liquid rides with the drum as a layer, shape (l,)
    mean_rotation: Array  #: of each layer relative to the drum at the end, rad/s, shape (l,)
    mass_error: float  #: largest relative change of a layer's volume
    change: float  #: of the amplitude that may still come, over its size
    turns: int  #: what it took
    steps: int
    moment: Moment  #: where it ends, from which other speeds can go on
    reason: str = ""  #: why it did not settle, or empty
    #: estimated, of mean and largest amplitude, over the latter, by another run with half the cells; nan
    #: without that run
    error: float = math.nan
    #: time, s, and coordinates at moments of the last turns, shape (m, 1 + n); m = 0 where not known
    path: Array = field(default_factory=lambda: np.zeros((0, 1)))
    #: mean power that supports, friction, baffles and bores turn into heat, W; nan where the solver does not
    #: tell it
    heat: float = math.nan
    #: what the balance of energy of the last turns leaves, over the largest of the works of unbalance and
    #: drive and of the heats; nan where the solver does not tell it
    energy_error: float = math.nan
    #: Floquet multipliers of a motion that Newton's method has found, the largest first; none of one that was
    #: marched
    multipliers: Complex = field(default_factory=lambda: np.zeros(0, dtype=complex))

    @property
    def settled(self) -> bool:
        """Whether it came to an answer."""
        return self.kind is not HeldKind.NOT_SETTLED


@dataclass(frozen=True)
class PeriodicMotion:
    """A stable motion that repeats with the turn, found without marching."""

    moment: Moment  #: at its beginning
    half: Moment | None  #: the same with half the cells; None where these would be too few
    multipliers: Complex  #: by which a turn takes small changes on, the largest first
    turns: int  #: what it took on this mesh

    @property
    def multiplier(self) -> float:
        """Size of the largest multiplier."""
        return float(abs(self.multipliers[0]))


@dataclass(frozen=True)
class HeldMachine:
    """Machine that is held."""

    system: RotorSystem  #: the dry rotor
    fills: tuple[Fill, ...]  #: its chambers with their liquid
    #: on the walls; the laminar law at the slower natural wave's frequency; nonlinear waves take a force on
    #: all the liquid that damps that wave as much
    friction: Friction = NO_FRICTION
    gravity: float = 0.0  #: across the axis, m/s^2
    #: what the layers are: long_wave; potential, fully nonlinear waves; kdv, those of KdV-Burgers
    liquid: str = "long_wave"

    @property
    def exact(self) -> bool:
        """The layers are fully nonlinear waves."""
        return self.liquid == "potential"

    @property
    def family(self) -> bool:
        """The layers are waves of KdV-Burgers."""
        return self.liquid == "kdv"
