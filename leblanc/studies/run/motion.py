"""What a response tells of motions that are no steady circle: tilt, self-excited whirl, held in time."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Annotated

import numpy as np
from numpy.typing import NDArray

from leblanc.results.motion.cycles import LargeWhirl
from meshes.arrays import Array, Complex, Flags
from meshes.quantity import Q
from solvers.held.state import COUPLED
from solvers.rotor.campbell import Campbell

MOTIONS = ("steady", "periodic", "limit_cycle", "not_settled")
# Liquid models of motions held in time, with what goes round each wall, in words.
HELD_MODELS = {"long_wave": ("long waves", "cells"), "potential": ("exact waves", "nodes")}

Bands = tuple[tuple[float, float], ...]
_OVER, _EACH, _LAYERS, _REST = ("speed",), ("speed", "branch"), ("speed", "chamber"), ("rest_mode",)
_AXES, _RATE = ("along the unbalance", "90 deg ahead of it"), "rad s-1"
_AGAINST, _SENSE = (
    "turning against the spin",
    "each with the direction of its whirl, -1 against the spin to 1",
)


@dataclass(frozen=True)
class RestMode:
    """Free vibration of the dry rotor at rest."""

    frequency: float  #: damped, rad/s; 0 where overdamped
    damping_ratio: float  #: 1 where overdamped
    moves: str  #: what moves most, in words


@dataclass(frozen=True)
class Motion:
    """What a rotor that tilts, or moves differently in two directions, adds to a planar one.

    The axis goes round as forward e^{i Omega t} + backward e^{-i Omega t}; the deflections of the response
    are the forward part. s speeds, b branches, c chambers.
    """

    position: Annotated[float, Q("m", "position", "of the plane reported, along the axis")]
    backward: Annotated[Complex, Q("m", f"part of the deflection {_AGAINST}", over=_OVER, axes=_AXES)]
    backward_dry: Annotated[
        Complex, Q("m", f"part {_AGAINST}, without liquid", over=_OVER, axes=_AXES, json=False)
    ]
    branch_backward: Annotated[
        Complex, Q("m", f"part of every branch {_AGAINST}", over=_EACH, axes=_AXES, json=False)
    ]
    chamber_forward: Annotated[
        Complex,
        Q(
            *("m", "deflection at each chamber", "", _LAYERS, _AXES),
            key="chamber_deflection",
            variable="chamber",
        ),
    ]
    modes: tuple[RestMode, ...]  #: of the dry rotor at rest, by rising frequency
    campbell: Annotated[Campbell, Q(part=True)]  #: natural frequencies of the dry rotor over its speed
    critical_speeds_dry: Annotated[Bands, Q(text=f"undamped, rad/s, {_SENSE}")]
    critical_speeds_wet: Annotated[Bands, Q(text=f"the same with liquid, rad/s, {_SENSE}")]
    zero: str  #: what angles count from, in words
    #: as chamber_forward, at the refined speeds; none if empty, shape (r, c)
    refined_forward: Complex = field(default_factory=lambda: np.zeros((0, 0), dtype=complex))

    @property
    def natural_frequency(
        self,
    ) -> Annotated[tuple[float, ...], Q(_RATE, "natural frequency", "at rest, dry", _REST)]:
        return tuple(mode.frequency for mode in self.modes)

    @property
    def natural_damping_ratio(
        self,
    ) -> Annotated[tuple[float, ...], Q("1", "damping ratio", "at rest, dry", _REST)]:
        return tuple(mode.damping_ratio for mode in self.modes)


@dataclass(frozen=True)
class SelfExcited:
    """Whirl that grows by itself from the even layer, in linear theory."""

    #: nan where it was not found
    growth: Annotated[Array, Q("s-1", "growth rate", "of the whirl that grows most; above 0 unstable", _OVER)]
    whirl_speed: Annotated[Array, Q(_RATE, "whirl speed", "of the whirl that grows most, in space", _OVER)]
    #: the ends of the range of speeds count as edges
    bands: Annotated[Bands, Q(text="bands of speed in which some whirl grows, rad/s", key="whirl_bands")]
    friction: str  #: of the liquid, in words
    #: between the nearest speeds where they were
    not_known: Annotated[
        Bands, Q(text="bands in which the modes were not found, rad/s", key="whirl_bands_not_known")
    ] = ()
    #: how large the whirl becomes; None where that was not asked for
    large: Annotated[LargeWhirl | None, Q(part=True)] = None

    def leaves_stable(self, stable: Flags) -> Flags:
        """Stable against slow disturbances, no whirl grows; what is not known is not stable; shape (n,)."""
        return np.asarray(stable & (self.growth <= 0.0))

    def inside(self, speed: Array) -> Flags:
        """Whether speeds lie inside a band in which a whirl grows, shape (n,)."""
        found = np.zeros(speed.shape, dtype=bool)
        for low, high in self.bands:
            found |= (speed >= low) & (speed <= high)
        return found


@dataclass(frozen=True)
class Held:
    """What rotor and waves do at the speeds at which they were held in time until they settled.

    n speeds, c chambers. At the other speeds numbers are nan and states are "steady".
    """

    at: Annotated[
        Flags,
        Q(
            *("", "held", "the motion was held in time until it settled", _OVER),
            flags="no yes",
            key="held_at",
        ),
    ]
    state: NDArray[np.str_]  #: one of `MOTIONS`, as met while the speed rises, shape (n,)
    least: Array  #: distance of the axis from where it rests, over time, m, shape (n,)
    largest: Array
    #: nan without one
    whirl_speed: Annotated[
        Array, Q(_RATE, "whirl speed", "beside the spin, in space", _OVER, key="held_whirl_speed")
    ]
    liquid: Annotated[
        Complex,
        Q(
            *("m", "mean of the layer's centre of mass", "from the chamber's axis, in the drum"),
            over=_LAYERS,
            axes=_AXES,
            key="liquid_mean",
        ),
    ]
    ripple: Annotated[
        Array, Q("m", "ripple of the layer's centre of mass", "largest", _LAYERS, key="liquid_ripple")
    ]
    error: Annotated[
        Array, Q("1", "estimated error", "of the held motion, by half the cells", _OVER, key="held_error")
    ]
    state_down: Annotated[
        NDArray[np.str_],
        Q(name="state of the motion", text="while the speed falls", over=_OVER, flags=" ".join(MOTIONS)),
    ]
    amplitude_down: Annotated[Array, Q("m", "amplitude", "while the speed falls", _OVER)]
    cells: int  #: round each wall
    reason: Annotated[
        NDArray[np.str_],
        Q(
            *("1", "why the motion has not settled", "empty where it has, or was not held", _OVER),
            key="held_reason",
        ),
    ]
    #: estimated from smooth waves; nan where there is no whirl or no estimate
    wave_error: Annotated[
        Array,
        Q(
            *("1", "estimated error of the waves"),
            "of long waves beside exact ones, under the whirl of a limit cycle",
            _OVER,
            key="held_wave_error",
        ),
    ]
    #: over the largest of the works of unbalance and drive and of the heats; nan where the solver does not
    #: tell it
    energy_error: Annotated[
        Array, Q("1", "energy error", "what the balance of energy of the last turns leaves", _OVER)
    ]
    solver: Annotated[
        str,
        Q("1", "solver", "that held the motions, of py-pde unless it is dop853", key="held_solver"),
    ] = COUPLED
    model: str = "long_wave"  #: of the liquid, one of `HELD_MODELS`

    @property
    def limit_cycle(self) -> Flags:
        """Where the motion, as met while the speed rises, is bounded but never repeats, shape (n,)."""
        return np.asarray(self.at & (self.state == "limit_cycle"))

    @property
    def waves_not_known(self) -> Flags:
        """Limit cycles of which there is no estimate how far long waves are off, shape (n,)."""
        if self.model == "potential":
            return np.zeros(self.at.shape, dtype=bool)
        return np.asarray(self.limit_cycle & np.isnan(self.wave_error))

    @property
    def not_settled(self) -> Flags:
        """Where the motion still changed when it was given up, shape (n,)."""
        return np.asarray(self.at & (self.state == "not_settled"))

    @property
    def hysteresis(self) -> Flags:
        """Where the motion depends on whether the speed rises or falls, shape (n,).

        What has not settled on either way is no motion of its own.
        """
        settled = (self.state != "not_settled") & (self.state_down != "not_settled")
        return np.asarray(self.at & settled & ~np.isnan(self.amplitude_down))
