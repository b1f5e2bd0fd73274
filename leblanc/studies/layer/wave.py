"""The wave of a layer as figures show it, steady and over time."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from meshes.arrays import Array, Complex
from meshes.errors import InputError, require_not_negative, require_positive

FEWEST = 3  # angles of a wave


SLACK = 1e-9  # rounding of a depth, over the radius


@dataclass(frozen=True)
class Wave:
    """A layer under a prescribed whirl, in the frame of the deflection."""

    title: str  #: of the figure; of the liquid
    model: str
    radius: float  #: wall, inner wall (0 if none), layer undisturbed, m
    inner_radius: float
    mean_depth: float
    whirl_amplitude: float  #: m
    spin: float  #: rad/s; the spin positive, the whirl in space and negative against it
    whirl_speed: float
    theta: Array  #: angle from the deflection in any order, rad, and depth there, m, shape (n,), n > 2
    depth: Array
    #: on the drum over that of a full drum; along the deflection, 90 deg ahead; nan if none found
    force_ratio: complex
    offset: complex  #: centre of mass from the geometric axis, same axes, m; nan if none was found
    notes: tuple[str, ...] = ()  #: limits of validity and findings, in words
    #: what lies at angle 0: the "deflection", or a "crest" of a wave that no whirl holds
    towards: str = "deflection"

    def __post_init__(self) -> None:
        require_positive("radius", self.radius)
        require_not_negative("inner_radius", self.inner_radius)
        require_not_negative("mean_depth", self.mean_depth)
        if self.inner_radius + self.mean_depth > self.radius * (1.0 + SLACK):
            raise InputError("mean_depth", self.mean_depth, "at most the room between the walls")
        require_not_negative("whirl_amplitude", self.whirl_amplitude)
        require_positive("spin", self.spin)
        if not math.isfinite(self.whirl_speed):
            raise InputError("whirl_speed", self.whirl_speed, "a finite number")
        _require_angles(self.theta)
        _require_depth(self.depth, self.theta.shape, self.radius)

    @property
    def seen_from_the_drum(self) -> float:
        """Whirl speed less spin speed, rad/s."""
        return self.whirl_speed - self.spin

    def require_room(self, frames: WaveFrames) -> None:
        """Raise `InputError` unless the depths of some frames fit the wall."""
        _require_depth(frames.depth, frames.depth.shape, self.radius)


@dataclass(frozen=True)
class WaveFrames:
    """A layer over time, in the frame of the drum."""

    time: Array  #: rising, s, shape (k,)
    theta: Array  #: angle from a mark on the drum, rad, shape (n,), n > 2
    depth: Array  #: m, shape (k, n)
    deflection: (
        Complex  #: complex, the mark on the real axis, m, shape (k,); of a natural wave towards a crest
    )

    def __post_init__(self) -> None:
        count = self.time.size
        if self.time.ndim != 1 or not count or not np.isfinite(self.time).all():
            raise InputError("time", self.time.shape, "a list of at least one finite time")
        if np.any(np.diff(self.time) <= 0.0):
            raise InputError("time", "not rising", "rising")
        _require_angles(self.theta)
        _require_depth(self.depth, (count, self.theta.size), math.inf)
        if self.deflection.shape != (count,) or not np.isfinite(self.deflection).all():
            raise InputError("deflection", self.deflection.shape, f"finite and of shape {(count,)}")


def _require_angles(theta: Array) -> None:
    if theta.ndim != 1 or theta.size < FEWEST or not np.isfinite(theta).all():
        raise InputError("theta", theta.shape, f"a list of at least {FEWEST} finite angles")


def _require_depth(depth: Array, shape: tuple[int, ...], radius: float) -> None:
    if depth.shape != shape:
        raise InputError("depth", depth.shape, f"of shape {shape}")
    slack = SLACK * radius if math.isfinite(radius) else 0.0
    low, high = float(np.min(depth)), float(np.max(depth))
    if not (math.isfinite(low) and math.isfinite(high) and -slack <= low and high <= radius + slack):
        raise InputError("depth", (low, high), "finite, 0 or above, and at most the radius")
