"""Integrals over the liquid along the arc of the chamber's wall.

Lengths in units of the chamber's radius across the axis and of its height along it. A wall point at the angle
psi from the deflection, seen from the chamber's centre, lies at s = r^2 = 1 + eps^2 + 2 eps cos(psi) from the
rotation axis; the circle through it is inside the chamber for |angle| < phi. All integrands are positive, so
that nothing cancels at any speed, eccentricity or fill [theory: statics, eq. 11-15].
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from fluid.paraboloid import Moments
from meshes.arrays import Array, Index

# The wall is divided at v = pi - psi = pi/4. Far part: the nearest singularity (v = 0 when the rotation axis
# touches the wall) is pi/4 beyond the end of a panel of half-length 3/8 pi: the error falls as 3**(-2 n).
# Near part, in u: the square root of dv/du ends 0.96 beyond a panel of half-length up to 6.3: 1.7**(-2 n).
# The full circles are polynomials of degree 3.
_DIVIDE = 0.75 * np.pi
_DIVIDE_SINE = np.sin(np.pi / 8.0)
_FAR = np.polynomial.legendre.leggauss(18)
_NEAR = np.polynomial.legendre.leggauss(34)
_DISC = np.polynomial.legendre.leggauss(3)

# Smallest width of the near zone that the nodes are crowded into; what lies inside a narrower one weighs
# less than its square.
_NARROWEST = 3e-6


@dataclass(frozen=True)
class _Panel:
    """Nodes of a panel, last axis; `rise` is the change of depth over it, None outside the ramp."""

    rows: Index  # states that have this panel; the other fields are theirs
    half: Array  # half the panel's length in its own variable, shape (..., 1)
    density: Array  # ds over that half, with the quadrature's weights
    s: Array  # r^2
    phi: Array  # half the angle of the circle inside the chamber
    chord: Array  # r sin(phi)
    abscissa: Array  # r cos(phi)
    depth: Array  # eta, 0 to 1
    rise: Array | None  # shape (...,)

    @property
    def weight(self) -> Array:
        """ds at the nodes."""
        return self.half * self.density


def _clip(x: Array) -> Array:
    return np.minimum(np.maximum(x, 0.0), 1.0)


def _present(start: Array, stop: Array, rise: Array | None) -> Index:
    """States in which a panel is there; one of no length counts if the surface crosses it like a wall."""
    there = stop > start
    return np.flatnonzero(there if rise is None else there | (rise != 0.0))


def _half_angle_squared_sine(depth_drop: Array, span: Array) -> Array:
    """sin^2(psi/2) where the depth has dropped that much; span = 4 B eps; 1 where it never drops so far."""
    inside = (depth_drop < span) & (depth_drop > 0.0)
    out = np.where(depth_drop > 0.0, 1.0, 0.0)
    np.divide(depth_drop, span, out=out, where=inside)
    return out


def _far_panel(
    eps: Array, span: Array, zeta: Array, start: Array, stop: Array, rise: Array | None
) -> _Panel | None:
    """Wall from psi = start to stop, both in the far part."""
    rows = _present(start, stop, rise)
    if rows.size == 0:
        return None
    eps, span, zeta, start, stop = (x[rows] for x in (eps, span, zeta, start, stop))
    half = 0.5 * (stop - start)[..., None]
    psi = 0.5 * (stop + start)[..., None] + half * _FAR[0]
    e = eps[..., None]
    sin, cos = np.sin(psi), np.cos(psi)
    depth = _clip(zeta[..., None] - span[..., None] * np.square(np.sin(0.5 * psi)))
    return _Panel(
        rows=rows,
        half=half,
        density=_FAR[1] * 2.0 * e * sin,
        s=np.square(1.0 + e) - 4.0 * e * np.square(np.sin(0.5 * psi)),
        phi=np.arctan2(sin, e + cos),
        chord=sin,
        abscissa=e + cos,
        depth=depth,
        rise=None if rise is None else rise[rows],
    )


def _near_panel(
    eps: Array, span: Array, nearest: Array, start: Array, stop: Array, rise: Array | None
) -> _Panel | None:
    """Wall from sin(v/2) = start to stop, v = pi - psi; `nearest` is the depth at v = 0."""
    rows = _present(start, stop, rise)
    if rows.size == 0:
        return None
    eps, span, nearest, start, stop = (x[rows] for x in (eps, span, nearest, start, stop))
    safe = np.maximum(eps, np.finfo(float).tiny)
    width = np.maximum(np.abs(1.0 - eps) / (2.0 * np.sqrt(safe)), _NARROWEST)
    first, last = np.arcsinh(start / width), np.arcsinh(stop / width)
    half = 0.5 * (last - first)[..., None]
    u = 0.5 * (last + first)[..., None] + half * _NEAR[0]
    e, k = eps[..., None], width[..., None]
    sine = np.minimum(k * np.sinh(u), _DIVIDE_SINE)
    squared = np.square(sine)
    sin_v = 2.0 * sine * np.sqrt(1.0 - squared)
    abscissa = (e - 1.0) + 2.0 * squared
    return _Panel(
        rows=rows,
        half=half,
        density=_NEAR[1] * 8.0 * e * k * sine * np.cosh(u),
        s=np.square(1.0 - e) + 4.0 * e * squared,
        phi=np.arctan2(sin_v, abscissa),
        chord=sin_v,
        abscissa=abscissa,
        depth=_clip(nearest[..., None] + span[..., None] * squared),
        rise=None if rise is None else rise[rows],
    )


def _disc_panel(
    steep: Array, nearest: Array, inner: Array, start: Array, stop: Array, rise: Array | None
) -> _Panel | None:
    """Full circles from s = inner - start down to inner - stop; `nearest` is the depth at s = inner."""
    rows = _present(start, stop, rise)
    if rows.size == 0:
        return None
    steep, nearest, inner, start, stop = (x[rows] for x in (steep, nearest, inner, start, stop))
    half = 0.5 * (stop - start)[..., None]
    fall = 0.5 * (stop + start)[..., None] + half * _DISC[0]
    zero = np.zeros_like(fall)
    return _Panel(
        rows=rows,
        half=half,
        density=np.broadcast_to(_DISC[1], fall.shape),
        s=np.maximum(inner[..., None] - fall, 0.0),
        phi=np.full_like(fall, np.pi),
        chord=zero,
        abscissa=zero,
        depth=_clip(nearest[..., None] - steep[..., None] * fall),
        rise=None if rise is None else rise[rows],
    )


def _panels(eps: Array, steep: Array, zeta: Array) -> list[_Panel]:
    """The wall cut at both waterlines and where the variable changes, then the full circles inside it."""
    span = 4.0 * steep * eps
    divide = np.cos(np.pi / 8.0) ** 2  # sin^2(psi/2) there
    middle = zeta - divide * span
    nearest = zeta - span
    lid = _half_angle_squared_sine(zeta - 1.0, span)
    floor = _half_angle_squared_sine(zeta, span)
    lid_psi, floor_psi = 2.0 * np.arcsin(np.sqrt(lid)), 2.0 * np.arcsin(np.sqrt(floor))
    none = np.zeros_like(zeta)
    near_end = np.full_like(zeta, _DIVIDE_SINE)
    lid_near = np.sqrt(1.0 - np.maximum(lid, divide))
    floor_near = np.sqrt(1.0 - np.maximum(floor, divide))
    lid_far, floor_far = np.minimum(lid_psi, _DIVIDE), np.minimum(floor_psi, _DIVIDE)

    inner = np.where(eps < 1.0, np.square(1.0 - eps), 0.0)
    deepest = np.maximum(nearest, 0.0)
    lid_fall = _fall(deepest - 1.0, steep, inner)
    floor_fall = _fall(deepest, steep, inner)
    bottom = deepest - steep * inner
    panels = (
        _far_panel(eps, span, zeta, none, lid_far, None),
        _far_panel(eps, span, zeta, lid_far, floor_far, _clip(zeta) - _clip(middle)),
        _near_panel(eps, span, nearest, lid_near, near_end, None),
        _near_panel(eps, span, nearest, floor_near, lid_near, _clip(middle) - _clip(nearest)),
        _disc_panel(steep, deepest, inner, none, lid_fall, None),
        _disc_panel(steep, deepest, inner, lid_fall, floor_fall, _clip(deepest) - _clip(bottom)),
    )
    return [panel for panel in panels if panel is not None]


def _fall(depth: Array, steep: Array, inner: Array) -> Array:
    """Drop of s over which the surface falls by `depth`, between 0 and `inner`."""
    reached = (depth < steep * inner) & (depth > 0.0)
    out = np.where(depth > 0.0, inner, 0.0)
    np.divide(depth, steep, out=out, where=reached)
    return out


def _sine_excess(phi: Array) -> Array:
    """phi - sin(phi) cos(phi) without cancellation for thin slivers."""
    small = np.minimum(phi, 0.2)
    x2 = np.square(2.0 * small)
    series = 4.0 / 6.0 * small**3
    term = np.ones_like(series)
    total = np.ones_like(series)
    for n in range(2, 8):
        term = -term * x2 / ((2 * n) * (2 * n + 1))
        total = total + term
    return np.where(phi < 0.2, series * total, phi - np.sin(phi) * np.cos(phi))


def _mean(panel: _Panel, value: Array) -> Array:
    """Mean of a value over the panel; it keeps its digits when the panel shrinks to a point."""
    measure = panel.density.sum(axis=-1)
    weighted = (panel.density * value).sum(axis=-1)
    mean: Array = np.divide(weighted, measure, out=np.zeros_like(measure), where=measure > 0.0)
    return mean


def volume_and_plan(eps: Array, steep: Array, zeta: Array) -> tuple[Array, ...]:
    """Volume of the liquid and plan area of its free surface, in chamber units; see `integrate`."""
    volume, plan, area = np.zeros((3, *eps.shape))
    for panel in _panels(eps, steep, zeta):
        weighted, rows = panel.weight * panel.phi, panel.rows
        volume[rows] += (weighted * panel.depth).sum(-1)
        if panel.rise is not None:
            plan[rows] += panel.rise * _mean(panel, panel.phi)
            area[rows] += weighted.sum(-1)
    # The plan shrinks as 1/B: its area then comes from the rise, which keeps its digits.
    return volume, np.where(steep > 1.0, plan / np.maximum(steep, 1.0), area)


def unbalance(eps: Array, steep: Array, zeta: Array) -> tuple[Array, ...]:
    """First moment of the liquid about the rotation axis, and moments of its free surface's plan.

    Parameters
    ----------
    eps, steep, zeta : see `integrate`

    Returns
    -------
    x : first moment over R^3 h, shape (...,)
    plan, plan_x, plan_xx : B times the plan's area and its first and second moment along the deflection,
        in chamber units, shape (...,); they stay finite as the surface becomes a cylinder
    """
    x, plan, plan_x, plan_xx = np.zeros((4, *eps.shape))
    for panel in _panels(eps, steep, zeta):
        rows = panel.rows
        x[rows] += (panel.weight * panel.depth * panel.chord).sum(-1)
        if panel.rise is not None:
            plan[rows] += panel.rise * _mean(panel, panel.phi)
            plan_x[rows] += panel.rise * _mean(panel, panel.chord)
            plan_xx[rows] += panel.rise * _mean(panel, _second_moment(panel))
    return x, plan, plan_x, plan_xx


def _second_moment(panel: _Panel) -> Array:
    """Integral of x^2 over the circle of radius r inside the chamber, per ds."""
    return 0.5 * (panel.s * panel.phi + panel.chord * panel.abscissa)


def integrate(eps: Array, steep: Array, zeta: Array) -> Moments:
    """Moments of the liquid in a disc-shaped chamber, about the rotation axis and the floor.

    Parameters
    ----------
    eps : eccentricity over radius e/R, shape (n,), >= 0
    steep : B = beta R^2/h, shape (n,), >= 0
    zeta : height of the unclamped surface at the wall's farthest point over h, shape (n,), >= 0

    Returns
    -------
    Moments, lengths across the axis over R and along it over h [theory: statics, eq. 14-15]
    """
    v, x, z, xx, yy, zz, xz = np.zeros((7, *eps.shape))
    for panel in _panels(eps, steep, zeta):
        depth, rows = panel.depth, panel.rows
        liquid = panel.weight * depth
        v[rows] += (liquid * panel.phi).sum(-1)
        x[rows] += (liquid * panel.chord).sum(-1)
        xx[rows] += (liquid * _second_moment(panel)).sum(-1)
        yy[rows] += (0.5 * liquid * panel.s * _sine_excess(panel.phi)).sum(-1)
        z[rows] += (0.5 * liquid * depth * panel.phi).sum(-1)
        zz[rows] += (liquid * depth**2 * panel.phi).sum(-1) / 3.0
        xz[rows] += (0.5 * liquid * depth * panel.chord).sum(-1)
    none = np.zeros(eps.shape)
    return Moments(volume=v, x=x, y=none, z=z, xx=xx, yy=yy, zz=zz, xy=none, xz=xz, yz=none)
