"""Vibration of a rotor besides its planar response: modes, critical speeds, whirl that grows by itself."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from meshes.arrays import Array, Flags
from solvers.rotor.campbell import Campbell


@dataclass(frozen=True)
class RestMode:
    """Free vibration of the dry rotor at rest.

    Parameters
    ----------
    frequency : damped, rad/s; 0 where overdamped
    damping_ratio : 1 where overdamped
    moves : what moves most, in words
    """

    frequency: float
    damping_ratio: float
    moves: str


@dataclass(frozen=True)
class Motion:
    """What a rotor that tilts, or moves differently in two directions, adds to a planar one.

    The axis goes round as forward e^{i Omega t} + backward e^{-i Omega t}; the deflections of the response
    are the forward part. s speeds, b branches, c chambers.

    Parameters
    ----------
    position : along the axis of the plane reported, m
    backward, backward_dry : m, shape (s,)
    branch_backward : m, shape (s, b)
    chamber_forward : at each chamber, m, shape (s, c)
    modes : of the dry rotor at rest, by rising frequency
    campbell : natural frequencies of the dry rotor over its speed
    critical_speeds_dry, critical_speeds_wet : undamped, each with the direction of its whirl, -1 to 1
    zero : what angles count from, in words
    """

    position: float
    backward: NDArray[np.complex128]
    backward_dry: NDArray[np.complex128]
    branch_backward: NDArray[np.complex128]
    chamber_forward: NDArray[np.complex128]
    modes: tuple[RestMode, ...]
    campbell: Campbell
    critical_speeds_dry: tuple[tuple[float, float], ...]
    critical_speeds_wet: tuple[tuple[float, float], ...]
    zero: str


@dataclass(frozen=True)
class SelfExcited:
    """Whirl that grows by itself from the even layer, in linear theory.

    Parameters
    ----------
    growth : of the whirl that grows most, 1/s, nan where it was not found, shape (n,)
    whirl_speed : of that whirl in the standing frame, rad/s, shape (n,)
    bands : of speed in which some whirl grows, rad/s; the ends of the range of speeds count as edges
    friction : of the liquid, in words
    """

    growth: Array
    whirl_speed: Array
    bands: tuple[tuple[float, float], ...]
    friction: str

    def leaves_stable(self, stable: Flags) -> Flags:
        """Stability against slow disturbances and against whirls that grow by themselves, shape (n,).

        Parameters
        ----------
        stable : against slow disturbances, shape (n,)
        """
        return np.asarray(stable & ~(self.growth > 0.0))
