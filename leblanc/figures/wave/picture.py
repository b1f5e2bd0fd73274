"""The wave of a liquid layer under a prescribed whirl: what is drawn of it, and how.

Angles run with the spin. In the frame of the deflection they start there, in the frame of the drum at a mark
on it; in both the origin is the geometric axis.
"""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from leblanc.results.drawn.scale import FILLED, LARGEST_FACTOR, rounded_down
from leblanc.results.layer import Wave, WaveFrames
from meshes.arrays import Array

RAYS = 721  # half a degree apart, closed
DRY = 1e-4  # a film thinner than this, over the mean depth, is drawn as a dry wall
SHOWN = 0.2  # mean depth as drawn, over the wall's radius
MOST_FRAMES = 120  # of a film
TURN = 0.25 * math.pi  # of the deflection from frame to frame: more of it and the eye sees it run backwards
FRAME_RATE = 20  # 1/s; a GIF counts in hundredths of a second


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


def depth_factor(record: Wave, deepest: float) -> float:
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


def frames(record: Wave, history: WaveFrames) -> NDArray[np.intp]:
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
