"""Motions of a response that are no steady circle: tilt, self-excited whirl, time-domain states."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Annotated

import numpy as np

from leblanc.studies.cycles.answer import LargeWhirl
from meshes.arrays import Array, Complex, Flags
from meshes.quantity import Q
from solvers.rotor.campbell import Campbell

Bands = tuple[tuple[float, float], ...]
_OVER, _EACH, _LAYERS, _REST = ("speed",), ("speed", "branch"), ("speed", "chamber"), ("rest_mode",)
_AXES, _RATE = ("along the unbalance", "90 deg ahead of it"), "rad s-1"
_AGAINST, _SENSE = (
    "turning against the spin",
    "each with the direction of its whirl, -1 against the spin to 1",
)


@dataclass(frozen=True)
class RestMode:
    """Free vibration of the rotor without liquid at rest."""

    frequency: float  #: damped, rad/s; 0 where overdamped
    damping_ratio: float  #: 1 where overdamped
    moves: str  #: by share of kinetic energy, in words


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
    modes: tuple[RestMode, ...]  #: of the rotor without liquid at rest, by rising frequency
    campbell: Annotated[
        Campbell, Q(part=True)
    ]  #: natural frequencies of the rotor without liquid over its speed
    critical_speeds_dry: Annotated[Bands, Q("rad s-1", text=f"undamped, {_SENSE}", data=False)]
    critical_speeds_wet: Annotated[Bands, Q("rad s-1", text=f"the same with liquid, {_SENSE}", data=False)]
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

    @property
    def natural_mode(
        self,
    ) -> Annotated[tuple[str, ...], Q(text="mode at rest, by share of kinetic energy", data=False)]:
        return tuple(mode.moves for mode in self.modes)


@dataclass(frozen=True)
class SelfExcited:
    """Self-excited whirl from the even layer, in linear theory."""

    #: nan where it was not found
    growth: Annotated[Array, Q("s-1", "growth rate", "of the fastest-growing whirl; above 0 unstable", _OVER)]
    whirl_speed: Annotated[Array, Q(_RATE, "whirl speed", "of the fastest-growing whirl, in space", _OVER)]
    #: the ends of the range of speeds count as edges
    bands: Annotated[
        Bands, Q("rad s-1", text="bands of speed in which some whirl grows", key="whirl_bands", data=False)
    ]
    friction: str  #: of the liquid, in words
    #: between the nearest speeds where they were
    not_known: Annotated[
        Bands,
        Q("rad s-1", text="bands in which the modes were not found", key="whirl_bands_not_known", data=False),
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
