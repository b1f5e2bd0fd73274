"""The wave of a liquid layer under a prescribed whirl: what is drawn of it, and how.

Angles run with the spin. In the frame of the deflection they start there, in the frame of the drum at a mark
on it; in both the origin is the geometric axis.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from leblanc.figures.section import rounded_down
from meshes.arrays import Array, Complex
from meshes.errors import InputError, require_not_negative, require_positive

RAYS = 721  # half a degree apart, closed
DRY = 1e-4  # a film thinner than this, over the mean depth, is drawn as a dry wall
SHOWN, FILLED = 0.2, 0.55  # drawn: mean depth over the wall's radius; deepest place over the room there is
LARGEST_FACTOR = 1e6
FEWEST, MOST_FRAMES = 3, 120  # angles; frames of a film
TURN = 0.25 * math.pi  # of the deflection from frame to frame: more of it and the eye sees it run backwards
FRAME_RATE = 20  # 1/s; a GIF counts in hundredths of a second
SLACK = 1e-9  # rounding of a depth, over the radius


@dataclass(frozen=True)
class WaveRecord:
    """A layer under a prescribed whirl, in the frame of the deflection.

    Parameters
    ----------
    title, model : of the figure; of the liquid
    radius, inner_radius, mean_depth : wall, inner wall (0 if none), layer undisturbed, m
    whirl_amplitude : m
    spin, whirl_speed : rad/s; the spin positive, the whirl in space and negative against it
    theta, depth : angle from the deflection in any order, rad, and depth there, m, shape (n,), n > 2
    force_ratio : on the drum over that of a full drum; along the deflection, 90 deg ahead; nan if none found
    offset : centre of mass from the geometric axis, same axes, m; nan if none was found
    notes : limits of validity and findings, in words

    Raises
    ------
    InputError : a value out of its range, arrays that do not fit together
    """

    title: str
    model: str
    radius: float
    inner_radius: float
    mean_depth: float
    whirl_amplitude: float
    spin: float
    whirl_speed: float
    theta: Array
    depth: Array
    force_ratio: complex
    offset: complex
    notes: tuple[str, ...] = ()

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


@dataclass(frozen=True)
class WaveHistory:
    """A layer over time, in the frame of the drum.

    Parameters
    ----------
    time : rising, s, shape (k,)
    theta : angle from a mark on the drum, rad, shape (n,), n > 2
    depth : m, shape (k, n)
    deflection : complex, the mark on the real axis, m, shape (k,)
    force_ratio, period_time, mean_rotation : means over periods of the whirl seen from the drum: force as in
        `WaveRecord`, middle of the period, s, and the liquid's rotation in the drum, rad/s; shape (p,)

    Raises
    ------
    InputError : values out of their range, arrays that do not fit together
    """

    time: Array
    theta: Array
    depth: Array
    deflection: Complex
    force_ratio: Complex | None = None
    period_time: Array | None = None
    mean_rotation: Array | None = None

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
        means = (self.force_ratio, self.period_time, self.mean_rotation)
        shapes = {None if mean is None else mean.shape for mean in means}
        if len(shapes) > 1:
            raise InputError("force_ratio", str(shapes), "of the shape of period_time and mean_rotation")


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


def require_room(record: WaveRecord, history: WaveHistory) -> None:
    """Raise `InputError` unless the depths of a history fit the record's wall."""
    _require_depth(history.depth, history.depth.shape, record.radius)


def unrolled(theta: Array, depth: Array) -> tuple[Array, Array]:
    """Depth around the wall from -180 to 180 degrees, closed.

    Parameters
    ----------
    theta : angles in any order, rad, shape (n,)
    depth : there, m, shape (n,)

    Returns
    -------
    Angles that rise from -pi to pi, and depth, linear between the angles given, equal at both ends; n + 2 of
    them, less those that are there twice.
    """
    angle = np.mod(theta + math.pi, 2.0 * math.pi) - math.pi
    order = np.argsort(angle, kind="stable")
    angle, depth = angle[order], np.maximum(depth[order], 0.0)
    first, last = angle[0] + 2.0 * math.pi, angle[-1]
    share = (math.pi - last) / (first - last)
    edge = [(1.0 - share) * depth[-1] + share * depth[0]]
    angle, depth = np.concatenate([[-math.pi], angle, [math.pi]]), np.concatenate([edge, depth, edge])
    new = np.concatenate([[True], np.diff(angle) > 0.0])
    return angle[new], depth[new]


def free_surface(radius: float, theta: Array, depth: Array, factor: float) -> tuple[Array, Array]:
    """Free surface as drawn: the wall is to scale, depths grow by a factor.

    Parameters
    ----------
    radius : of the wall, m
    theta, depth : angles, rad, and depth there, m, shape (n,)
    factor : of the depth

    Returns
    -------
    Angles that rise from -pi to pi, at most half a degree apart, rad, and the surface's radius there, m.
    """
    angle, layer = unrolled(theta, depth)
    fine = np.union1d(angle, np.linspace(-math.pi, math.pi, RAYS))
    return fine, np.maximum(radius - factor * np.interp(fine, angle, layer), 0.0)


def outline(radius: float, angle: Array, surface: Array) -> tuple[Array, Array]:
    """Closed outline of the liquid: along the wall with the spin and back along the free surface.

    Parameters
    ----------
    radius : of the wall, m
    angle, surface : from `free_surface`, shape (m,)

    Returns
    -------
    x along angle 0 and y, m, shape (2 m,).
    """
    wall, inner = radius * np.exp(1j * angle), surface * np.exp(1j * angle)
    edge = np.concatenate([wall, inner[::-1]])
    return edge.real, edge.imag


def is_dry(depth: Array, mean_depth: float) -> NDArray[np.bool_]:
    """Stretches where nothing covers the wall; a point that the surface merely touches is none.

    Parameters
    ----------
    depth, mean_depth : m, along rising angles, shape (..., n), n > 1; of the layer undisturbed
    """
    dry: NDArray[np.bool_] = depth <= DRY * mean_depth
    beside = np.zeros_like(dry)
    beside[..., 1:] |= dry[..., :-1]
    beside[..., :-1] |= dry[..., 1:]
    return dry & beside


def depth_factor(record: WaveRecord, deepest: float) -> float:
    """Factor that makes a thin layer visible and keeps a deep one between the walls.

    Parameters
    ----------
    record : walls and mean depth
    deepest : of all that is drawn on one scale, m
    """
    if not (deepest > 0.0 and record.mean_depth > 0.0):
        return 1.0
    # In this order no quotient of a depth near zero overflows.
    fits = FILLED * (record.radius - record.inner_radius) / max(deepest, record.radius / LARGEST_FACTOR)
    shows = SHOWN * record.radius / max(record.mean_depth, record.radius / LARGEST_FACTOR)
    return rounded_down(max(1.0, min(fits, shows)))


def frames(record: WaveRecord, history: WaveHistory) -> NDArray[np.intp]:
    """Indices over time of a film's frames: all of the history, or as much of its end as the eye can follow.

    Parameters
    ----------
    record, history : speeds, times

    Returns
    -------
    Rising, evenly spaced in time as far as the history is, at most 120.
    """
    time, turning = history.time, abs(record.seen_from_the_drum)
    span = float(time[-1] - time[0])
    if turning * span > TURN * (MOST_FRAMES - 1):
        span = TURN * (MOST_FRAMES - 1) / turning
    wanted = np.linspace(time[-1] - span, time[-1], MOST_FRAMES)
    middle = 0.5 * (time[1:] + time[:-1])
    return np.unique(np.searchsorted(middle, wanted, side="left"))
