"""The liquid between an outer and an inner wall, state by state: its integrals, and its surface for a volume.

Of every state, arrays of shape (n,): radius, inner and height of the chamber, m; e, eccentricity, m; steep,
beta R^2/h; zeta, wetted height over h [theory: statics, eq. 12].
"""

from __future__ import annotations

from typing import Any

import numpy as np

from meshes.arrays import Array, Flags
from solvers.machine_code import BARE, machine_code
from solvers.statics import wall

_jit: Any = machine_code(**wall.COMPILED)
_inner_jit: Any = machine_code(**(wall.COMPILED | BARE))

_ITERATIONS = 200
_STEEP, _GUESSES = 3.0, 60  # above which a surface is nearly a cylinder, and steps to find that
_ROUNDING = 8.0 * np.finfo(np.float64).eps
_TINY = np.finfo(np.float64).tiny


@_inner_jit
def _inside(ratio: float, eps: float, steep: float, zeta: float) -> tuple[float, float, float]:
    """The same surface seen from the inner wall, in that wall's units."""
    # How far the surface falls from the outer wall's farthest point to the inner one's.
    fall = steep * (1.0 - ratio) * (1.0 + ratio + 2.0 * eps)
    return eps / ratio, steep * ratio**2, max(zeta - fall, 0.0)


@_inner_jit
def _volume_and_plan(
    radius: float, inner: float, height: float, eps: float, steep: float, zeta: float
) -> tuple[float, float]:
    size = radius**2 * height
    held, plan = wall.volume_and_plan(eps, steep, zeta)
    held, plan = size * held, size * plan
    if inner > 0.0:
        size = inner**2 * height
        less, narrower = wall.volume_and_plan(*_inside(inner / radius, eps, steep, zeta))
        held, plan = held - size * less, plan - size * narrower
    return held, plan


@_jit
def volumes(
    radius: Array, inner: Array, height: Array, e: Array, steep: Array, zeta: Array, found: Array
) -> None:
    """Volume under the surface, m^3, and its derivative with respect to zeta; into `found`, shape (2, n)."""
    for k in range(e.size):
        eps = e[k] / radius[k]
        found[0, k], found[1, k] = _volume_and_plan(radius[k], inner[k], height[k], eps, steep[k], zeta[k])


@_jit
def first_moments(
    radius: Array, inner: Array, height: Array, e: Array, steep: Array, zeta: Array, found: Array
) -> None:
    """First moment of the liquid about the rotation axis, m^4; into `found`, shape (1, n)."""
    for k in range(e.size):
        eps = e[k] / radius[k]
        found[0, k] = radius[k] ** 3 * height[k] * wall.first_moment(eps, steep[k], zeta[k])
        if inner[k] > 0.0:
            own = wall.first_moment(*_inside(inner[k] / radius[k], eps, steep[k], zeta[k]))
            found[0, k] -= inner[k] ** 3 * height[k] * own


@_jit
def plan_moments(
    radius: Array, inner: Array, height: Array, e: Array, steep: Array, zeta: Array, found: Array
) -> None:
    """First moment of the liquid, m^4, then the plan's moments; into `found`, shape (4, n)."""
    for k in range(e.size):
        eps, h = e[k] / radius[k], height[k]
        own = wall.unbalance(eps, steep[k], zeta[k])
        for i in range(4):
            found[i, k] = own[i] * radius[k] ** _power(i) * h
        if inner[k] > 0.0:
            own = wall.unbalance(*_inside(inner[k] / radius[k], eps, steep[k], zeta[k]))
            for i in range(4):
                found[i, k] -= own[i] * inner[k] ** _power(i) * h


@_inner_jit
def _power(i: int) -> int:
    """Of the radius in the scale of a first moment and of the plan's three moments."""
    return 3 if i == 0 else i - 1


@_jit
def moments(
    radius: Array, inner: Array, height: Array, e: Array, steep: Array, zeta: Array, found: Array
) -> None:
    """Volume, x, z, xx, yy, zz, xz, heights over h; added to `found`, shape (7, n)."""
    for k in range(e.size):
        eps, h = e[k] / radius[k], height[k]
        _add_moments(found[:, k], wall.moments(eps, steep[k], zeta[k]), radius[k], h)
        if inner[k] > 0.0:
            own = wall.moments(*_inside(inner[k] / radius[k], eps, steep[k], zeta[k]))
            _add_moments(found[:, k], own, inner[k], -h)


@_inner_jit
def _add_moments(found: Array, own: tuple[float, ...], radius: float, height: float) -> None:
    """In the units of the wall, of the radius to the powers 2, 3, 2, 4, 4, 2, 3."""
    area = radius**2 * height
    found[0] += area * own[0]
    found[1] += area * radius * own[1]
    found[2] += area * own[2]
    found[3] += area * radius**2 * own[3]
    found[4] += area * radius**2 * own[4]
    found[5] += area * own[5]
    found[6] += area * radius * own[6]


@_jit
def wetted_heights(
    radius: Array,
    inner: Array,
    height: Array,
    capacity: Array,
    volume: Array,
    e: Array,
    steep: Array,
    zeta: Array,
    reached: Array,
    converged: Flags,
) -> None:
    """Wetted height for a volume, the volume reached, and whether it is the one asked for; the last three."""
    for k in range(e.size):
        zeta[k], reached[k], converged[k] = _wetted_height(
            radius[k], inner[k], height[k], capacity[k], volume[k], e[k], steep[k]
        )


@_inner_jit
def _wetted_height(
    radius: float, inner: float, height: float, capacity: float, volume: float, e: float, steep: float
) -> tuple[float, float, bool]:
    """Newton steps on the logarithm of wet over dry volume, in a bracket that every step shrinks."""
    eps = e / radius
    nearest = 0.0 if eps < 1.0 else eps - 1.0
    full = 1.0 + steep * (1.0 + eps - nearest) * (1.0 + eps + nearest)
    fill = volume / capacity
    if fill <= 0.0:
        return 0.0, 0.0, True
    if fill >= 1.0:
        return full, capacity, True
    # The depth nowhere exceeds the wetted height, so the fill is a lower bound of it.
    low, high = min(fill, full), full
    # A surface clear of the walls is known [theory: statics, eq. 3]; a nearly flat one is near the bound.
    disc = np.pi * radius**2 * height
    clear = 0.5 + steep * (volume / disc + eps * (2.0 + eps))
    guess = low if full < 2.0 else np.sqrt(low * high)
    if low < clear < high:
        guess = clear
    if steep > _STEEP and clear < 4.0 * steep * eps + 0.5:
        guess = min(max(_of_cylinder(eps, volume / (radius**2 * height), steep), low), high)
    zeta = wet = 0.0
    for _ in range(_ITERATIONS):
        zeta = guess
        wet, plan = _volume_and_plan(radius, inner, height, eps, steep, zeta)
        off = wet - volume
        if off <= 0.0:
            low = zeta
        if off >= 0.0:
            high = zeta
        # Rounding of zeta alone moves the volume by plan * zeta units in the last place.
        if abs(off) <= _ROUNDING * max(volume, plan * zeta) or high - low <= _ROUNDING * high:
            return zeta, wet, True
        step = _logit_step(zeta, full, wet, volume, capacity, plan)
        if abs(step - zeta) <= _ROUNDING * zeta and abs(off) <= 1e-12 * volume:
            return zeta, wet, True
        middle = np.sqrt(low * high) if high > 4.0 * low else 0.5 * (low + high)
        guess = step if low < step < high else middle
    return zeta, wet, False


@_inner_jit
def _of_cylinder(eps: float, area: float, steep: float) -> float:
    """Wetted height of a surface so steep that it is a cylinder, with a dry wall on the near side.

    Newton steps on the area between wall and cylinder; its slope is half the angle of the part inside.
    """
    low, high = (1.0 - eps) ** 2, (1.0 + eps) ** 2
    squared = 0.5 * (low + high)
    for _ in range(_GUESSES):
        # Half angles of the wall's and the cylinder's part beyond their common chord.
        wall_cosine = min(max((squared - 1.0 - eps**2) / (2.0 * eps), -1.0), 1.0)
        cosine = min(max((squared + eps**2 - 1.0) / (2.0 * eps * np.sqrt(squared)), -1.0), 1.0)
        chord = np.sqrt(1.0 - wall_cosine**2)
        beyond, angle = np.arccos(wall_cosine), np.arccos(cosine)
        off = beyond - squared * angle + eps * chord - area
        if off >= 0.0:
            low = squared
        else:
            high = squared
        step = squared + off / angle if angle > 0.0 else low
        last, squared = squared, step if low < step < high else 0.5 * (low + high)
        if abs(squared - last) <= 1e-13 * high:
            break
    return steep * ((1.0 + eps) ** 2 - squared) + 0.5


@_inner_jit
def _logit_step(
    zeta: float, full: float, reached: float, volume: float, capacity: float, plan: float
) -> float:
    """Newton step on log(wet/dry) as a function of log(zeta/(full - zeta)); may be outside."""
    wet, dry = max(reached, _TINY), max(capacity - reached, _ROUNDING * capacity)
    left = max(full - zeta, _ROUNDING * full)
    target = np.log(max(volume, _TINY)) - np.log(max(capacity - volume, _ROUNDING * capacity))
    off = np.log(wet) - np.log(dry) - target
    slope = plan * (capacity / (wet * dry)) * (zeta * left / full)
    shift = min(max(off / slope, -50.0), 50.0) if slope > 0.0 else 0.0
    odds: float = zeta / left * np.exp(-shift)
    return full * odds / (1.0 + odds)
