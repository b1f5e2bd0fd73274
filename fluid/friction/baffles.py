"""What radial baffles take from a layer that flows past them: head, and by it torque [theory: baffles].

Lengths in any one unit; in the long waves over the wall radius. The functions of numbers are compiled by the
finite volumes as they stand; those of arrays serve linear layers and estimates.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Any

import numpy as np

from fluid.fill import Fill
from meshes.arrays import Array

Real = Any  # an array or, compiled, a number

# Contraction of the jet behind a baffle, fitted to computed flow [theory: baffles, eq. 2].
_LEAST, _POWER = 0.55, 1.8
# Of the depths before and behind a baffle, the share of the first in the depth at it.
BEFORE = 0.55
# A share of the depth that counts as closed.
CLOSED = 1e-6
# Above this Froude number the layer shoots over its baffles and their torque falls.
SUPERCRITICAL = 1.1


def open_share(depth: Real, tip: float, gap: float) -> Real:
    """Share of the depth that baffles leave open [theory: baffles, eq. 1]."""
    held = np.maximum(depth, 1e-300)
    return np.minimum((np.maximum(held - tip, 0.0) + np.minimum(held, gap)) / held, 1.0)


def contraction(share: Real) -> Real:
    """Width of the jet over that of its opening [theory: baffles, eq. 2]."""
    return _LEAST + (1.0 - _LEAST) * share**_POWER


def loss_coefficient(share: Real) -> Real:
    """Head lost at a baffle over that of the flow before it, u^2/2 [theory: baffles, eq. 2]."""
    jet = contraction(share) * share
    lost = 1.0 / jet - 1.0
    return lost * lost


def pile_up(depth: Array, tip: float, gap: float, head: Array) -> tuple[Array, Array]:
    """Loss coefficient of the mean flow, and the depth that piles up before the baffles, m.

    A fixed point: the deeper the layer stands, the less it loses [theory: baffles, eq. 3]. `head` is u^2/(4
    g), m, u the mean flow and g what holds it to the wall; the coefficient is inf where nothing flows past.
    """
    depth, head = np.broadcast_arrays(np.asarray(depth, dtype=float), np.asarray(head, dtype=float))
    # The depth before the baffles is the root of a function that falls: bisection.
    low, high = depth.copy(), depth + np.where(head > 0.0, 1.0, 0.0)
    for _ in range(60):
        high = np.where(_missing(high, depth, tip, gap, head) > 0.0, 2.0 * high, high)
    for _ in range(80):
        middle = 0.5 * (low + high)
        short = _missing(middle, depth, tip, gap, head) > 0.0
        low, high = np.where(short, middle, low), np.where(short, high, middle)
    return _mean_loss(high, depth, tip, gap), high


def _mean_loss(before: Array, depth: Array, tip: float, gap: float) -> Array:
    """Loss coefficient of the mean flow, given the depth before the baffles, shape (n,)."""
    share = open_share(before, tip, gap)
    wide = np.maximum(share, CLOSED)
    return np.where(share > CLOSED, loss_coefficient(wide) * depth / before, np.inf)


def _missing(before: Array, depth: Array, tip: float, gap: float, head: Array) -> Array:
    """By how much the depth must grow to be the fixed point, shape (n,)."""
    loss = _mean_loss(before, depth, tip, gap)
    rise = np.where(head > 0.0, np.where(np.isfinite(loss), loss, 1e300) * head, 0.0)
    return np.asarray(depth + np.minimum(rise, 1e30) - before)


@dataclass(frozen=True)
class BaffleTorque:
    """What baffles can do for a layer at a lag; n lags."""

    lag: Array  #: of the liquid's rotation behind the drum's, over the drum's, shape (n,)
    loss: Array  #: zeta, shape (n,)
    before: Array  #: depth before the baffles, m, shape (n,)
    froude: Array  #: of the flow past them, shape (n,)
    torque: Array  #: on the liquid, N m, shape (n,)


def baffle_torque(fill: Fill, spin: float, lag: Array) -> BaffleTorque:
    """Torque of baffles on a layer that lags by 0 to 1 of the spin, shape (n,) [theory: baffles, eq. 4]."""
    baffles, radius = fill.chamber.baffles, fill.chamber.radius
    depth, inner = fill.depth, fill.surface_radius
    assert baffles is not None
    middle = math.sqrt(0.5 * (radius**2 + inner**2))
    flow = np.asarray(lag, dtype=float) * spin * middle
    weight = (spin * (1.0 - np.asarray(lag, dtype=float))) ** 2 * middle
    head = flow**2 / (4.0 * np.maximum(weight, 1e-300))
    tip, gap = radius - baffles.tip_radius, baffles.wall_gap
    if baffles.loss is None:
        loss, before = pile_up(np.full(flow.shape, depth), tip, gap, head)
    else:
        loss, before = np.full(flow.shape, baffles.loss), depth + baffles.loss * head
    moved = fill.mass * middle * flow**2 * baffles.count / (4.0 * math.pi * radius)
    torque = np.where(flow > 0.0, np.where(np.isfinite(loss), loss, np.inf) * moved, 0.0)
    froude = flow / np.sqrt(np.maximum(weight * depth, 1e-300))
    return BaffleTorque(np.asarray(lag, dtype=float), loss, before, froude, torque)


def most_torque(fill: Fill, spin: float) -> float:
    """Largest torque that baffles exert before the layer shoots over them, N m; inf if they are closed."""
    found = baffle_torque(fill, spin, np.linspace(0.0, 0.6, 241))
    below = found.torque[found.froude <= SUPERCRITICAL]
    return float(below.max())
