"""Free surface of a rotating liquid in a chamber of any section, by finite elements.

Under the surface z = beta r^2 + C, r from the rotation axis and z from the floor, the liquid is H =
clamp(beta r^2 + C, 0, h) deep. Here it is described by squared radii, in which nothing cancels at any speed:
H rises from 0 at the floor's waterline to h at the lid's, which lie the ramp w = h/beta apart. Without
gravity the ramp shrinks to a step, without spin it flattens.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from scipy.optimize import brentq
from skfem import CellBasis, ElementTriP0, Functional, MeshTri1, MeshTri2

from fluid.paraboloid import Moments
from meshes.arrays import Array
from meshes.errors import InputError, require_not_negative, require_positive
from meshes.refine.waterline import Arcs, beyond, distance_range, monotone_arcs
from meshes.section import Section, annulus, section_area

Integrand = Callable[[Array, Array, Array], Array]

# Ramps outside these multiples of the largest squared radius are a step, or flat, to rounding.
_STEEPEST, _FLATTEST = 1e-15, 1e15

# Polynomial degree of the moments' integrands over a triangle: depth cubed for straight edges; for quadratic
# ones the same with coordinates of degree 2 and a Jacobian of degree 2.
_DEGREE = {1: 6, 2: 14}


@dataclass(frozen=True)
class SurfaceSolution:
    """The free surface of a given volume."""

    #: Z, height of the surface, not cut by the lid, where the section is farthest from the axis, m; infinite
    #: without gravity
    wetted_height: float
    surface_constant: float  #: C of z = beta r^2 + C, m; minus infinity without gravity
    #: distance from the axis at which the surface meets the floor, m; 0 if the floor is covered there
    dry_radius: float
    moments: Moments  #: integrals over the liquid about the rotation axis and the floor
    converged: bool  #: whether the search ended within its tolerance
    iterations: int  #: how many steps it took


@dataclass(frozen=True, eq=False)
class _Plan:
    """What does not depend on the surface: quadrature points, triangle edges, distances from the axis."""

    height: float
    ramp: float  # w, m^2
    axis: tuple[float, float]
    basis: CellBasis
    arcs: Arcs
    least: Array  # squared distances over each triangle, m^2, shape (M,)
    largest: Array

    @property
    def farthest(self) -> float:
        """Largest squared distance of the section from the axis, m^2."""
        return float(self.largest.max())

    @property
    def reach(self) -> float:
        """Depth of the floor's waterline below the farthest point when the chamber is full, m^2."""
        return self.farthest - float(self.least.min()) + self.ramp


def integrate_surface(
    section: Section,
    height: float,
    beta: float,
    wetted_height: float | None = None,
    *,
    dry_radius: float | None = None,
    axis: tuple[float, float] = (0.0, 0.0),
) -> Moments:
    """Moments about the rotation axis and the floor of the liquid under a surface [theory: statics, eq. 1].

    The surface is given by its height Z where the section is farthest from the axis, or by the distance from
    the axis at which it meets the floor, which serves every speed, even beta infinite. The axis crosses the
    section at `axis`, (-e, 0) for a deflection e. Exact on the mesh to about 1e-9.
    """
    plan = _plan(section, height, beta, axis)
    if (wetted_height is None) == (dry_radius is None):
        raise InputError("wetted_height", wetted_height, "given, or dry_radius, one of the two")
    if wetted_height is None:
        assert dry_radius is not None
        require_not_negative("dry_radius", dry_radius)
        return _moments(plan, plan.farthest - dry_radius**2)
    if not math.isfinite(wetted_height) or math.isinf(beta):
        raise InputError("wetted_height", wetted_height, "finite; without gravity give dry_radius")
    return _moments(plan, plan.ramp * (wetted_height / height))


def solve_surface(
    section: Section,
    height: float,
    beta: float,
    volume: float,
    axis: tuple[float, float] = (0.0, 0.0),
) -> SurfaceSolution:
    """Free surface that holds a given volume [theory: statics, eq. 1], bracketed by empty and full chamber.

    beta is infinite without gravity; the axis crosses the section at `axis`, (-e, 0) for a deflection e.
    """
    plan = _plan(section, height, beta, axis)
    require_not_negative("volume", volume)
    capacity = section_area(section) * height
    if volume > capacity * (1.0 + 1e-12):
        raise InputError("volume", volume, f"at most what the section holds ({capacity:.9g} m^3)")

    def excess(fill: float) -> float:
        return float(_integral(plan, fill * plan.reach, _volume)[0]) - volume

    fill, converged, iterations = 0.0, True, 0
    if volume > 0.0 and excess(1.0) <= 0.0:
        fill = 1.0
    elif volume > 0.0:
        # A thin film has a fill near zero: its own digits matter, hence no absolute tolerance to speak of.
        fill, search = brentq(excess, 0.0, 1.0, xtol=1e-30, rtol=1e-14, full_output=True, disp=False)
        converged, iterations = bool(search.converged), int(search.iterations)
    below = fill * plan.reach
    floor = plan.farthest - below
    weightless = math.isinf(beta)
    return SurfaceSolution(
        wetted_height=math.inf if weightless else height * (below / plan.ramp),
        surface_constant=-math.inf if weightless else -height * (floor / plan.ramp),
        dry_radius=math.sqrt(max(floor, 0.0)),
        moments=_moments(plan, below),
        converged=converged,
        iterations=iterations,
    )


def optimal_volume_fem(
    radius: float, height: float, eccentricity: float, beta: float, *, inner_radius: float = 0.0
) -> float:
    """Volume whose surface just touches the near wall at the floor [DR18, eq. 19] [theory: statics, eq. 8].

    m^3, on the mesh of `default_disc`; beta is infinite without gravity.
    """
    require_positive("radius", radius)
    require_not_negative("eccentricity", eccentricity)
    section = default_disc(radius, 2.0 * min(eccentricity, radius), inner_radius=inner_radius)
    axis = (-eccentricity, 0.0)
    if math.isinf(beta):
        moments = integrate_surface(section, height, beta, dry_radius=abs(radius - eccentricity), axis=axis)
    else:
        # At slow spin the radii of the farthest and the nearest wall point would lose the thin film's digits.
        rise = 4.0 * beta * radius * eccentricity
        moments = integrate_surface(section, height, beta, rise, axis=axis)
    return float(moments.volume)


def default_disc(radius: float, layer: float, *, inner_radius: float = 0.0) -> Section:
    """Quadratic mesh that serves a liquid layer of that thickness to about 1e-7 of its volume.

    The only error is the wall's: with 2 b the angle of an edge, its parabola runs inside the circle by d =
    b^4 R/60 on the average. Of the optimal volume (`layer`, the largest thickness, is 2 e) that is 2 d/layer
    at fast spin and 8 d/(3 layer) at slow spin, of an even layer less. 64 to 1024 wall edges: layers below
    4e-5 R get fewer digits.
    """
    require_positive("radius", radius)
    require_not_negative("layer", layer)
    half_angle = (20.0 * 1e-7 * layer / radius) ** 0.25
    segments = 1024 if half_angle < np.pi / 1024 else max(64, 2 * math.ceil(0.5 * np.pi / half_angle))
    return annulus(radius, inner_radius, segments, order=2)


def _plan(section: Section, height: float, beta: float, axis: tuple[float, float]) -> _Plan:
    require_positive("height", height)
    if not beta >= 0.0:
        raise InputError("beta", beta, "0 or above; infinite without gravity")
    if len(axis) != 2 or not all(math.isfinite(value) for value in axis):
        raise InputError("axis", axis, "two finite coordinates in metres")
    mesh = (MeshTri1, MeshTri2)[section.order - 1](
        np.ascontiguousarray(section.points.T), np.ascontiguousarray(section.triangles.T)
    )
    basis = CellBasis(mesh, ElementTriP0(), intorder=_DEGREE[section.order], disable_doflocs=True)
    arcs = monotone_arcs(section, axis)
    least, largest = distance_range(arcs, len(section.triangles))
    scale = float(largest.max())
    gentlest, steepest = height / (_FLATTEST * scale), height / (_STEEPEST * scale)
    ramp = height / min(max(beta, gentlest), steepest)
    return _Plan(height, ramp, axis, basis, arcs, least, largest)


def _integral(plan: _Plan, below: float, integrand: Integrand) -> Array:
    """Integrals over the section when the floor's waterline lies `below` the farthest point, m^2.

    By quadrature where the depth is smooth; triangles cut by a waterline between their edges and it.
    """
    floor = plan.farthest - below
    lid = floor + plan.ramp

    def values(x: Array, y: Array) -> Array:
        depth = plan.height * np.clip((x * x + y * y - floor) / plan.ramp, 0.0, 1.0)
        return integrand(x, y, depth)

    def form(w: dict[str, Array]) -> Array:
        return values(w["x"][0] - plan.axis[0], w["x"][1] - plan.axis[1])

    cut = np.zeros(len(plan.least), dtype=bool)
    for level in (floor, lid):
        cut |= (plan.least < level) & (level < plan.largest)
    total = np.sum(Functional(form).elemental(plan.basis), axis=-1, where=~cut)
    if np.any(cut):
        arcs = plan.arcs.take(cut[plan.arcs.triangle])
        x, y, weight = beyond(arcs, plan.least[arcs.triangle], plan.largest[arcs.triangle], floor, lid)
        total = total + values(x, y) @ weight
    return np.asarray(total)


def _volume(x: Array, y: Array, depth: Array) -> Array:
    """Integrand of the volume alone."""
    return depth[None]


def _all_moments(x: Array, y: Array, depth: Array) -> Array:
    """Integrands of the ten moments, in the order of `Moments`: integrals over z from 0 to the depth."""
    middle, third = 0.5 * depth * depth, depth * depth * depth / 3.0
    products = [x * x * depth, y * y * depth, third, x * y * depth, x * middle, y * middle]
    return np.stack([depth, x * depth, y * depth, middle, *products])


def _moments(plan: _Plan, below: float) -> Moments:
    return Moments(*_integral(plan, below, _all_moments))
