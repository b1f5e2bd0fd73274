"""What a layer of annular long waves holds and does, read from its state in SI units.

A state is A and q as in `solvers.pypde.terms`; cells that a time step left below zero count as dry.
"""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from fluid import long_wave
from meshes.arrays import Array
from meshes.errors import InputError
from solvers.layer.loads import ring
from solvers.pypde.terms import LongWaveTerms, faded_velocity, radial_force, require_layer, scaled


def area_at(terms: LongWaveTerms, depth: Array) -> Array:
    """Liquid area per radian A = h (R - h/2), m^2, of depths h up to R, m; shape (n,)."""
    return np.asarray(depth * (terms.fill.chamber.radius - 0.5 * depth))


def surface_radius(terms: LongWaveTerms, area: Array) -> Array:
    """Free-surface radius r_s, m, of A, m^2, shape (n,); beyond the wall in cells below zero."""
    radius = terms.fill.chamber.radius
    return np.asarray(radius * long_wave.free_surface_radius(area / radius**2))


def depth(terms: LongWaveTerms, area: Array) -> Array:
    """Depth R - r_s, m, of A, m^2, shape (n,), without cancellation in thin films."""
    return 2.0 * area / (terms.fill.chamber.radius + surface_radius(terms, area))


def velocity(terms: LongWaveTerms, area: Array, momentum: Array, time: float) -> Array:
    """Velocity along the wall relative to the drum, u = (q + Omega A^2)/(R A); 0 in dry cells.

    Parameters
    ----------
    terms : chamber and spin
    area, momentum : A and q, shape (n,)
    time : s

    Returns
    -------
    u, m/s, shape (n,)
    """
    radius = terms.fill.chamber.radius
    a, q = scaled(terms, area, momentum)
    return radius * faded_velocity(a, q, terms.spin(time))


def momentum_at(terms: LongWaveTerms, area: Array, velocity: Array, time: float) -> Array:
    """Relative angular momentum q = R u A - Omega A^2, m^4/s, of A, m^2, and u, m/s; shape (n,)."""
    return np.asarray(terms.fill.chamber.radius * velocity * area - terms.spin(time) * np.square(area))


def angular_momentum(terms: LongWaveTerms, area: Array, momentum: Array, time: float) -> float:
    """Angular momentum of the liquid in space about the drum's axis, kg m^2/s: the sum of q + Omega R^2 A."""
    fill = terms.fill
    whole = float((momentum + terms.spin(time) * fill.chamber.radius**2 * area).mean()) * 2.0 * math.pi
    return fill.liquid.density * fill.chamber.height * whole


def pressure_force(terms: LongWaveTerms, area: Array, momentum: Array, time: float) -> complex:
    """Force of the liquid on the drum by the pressure on its wall [theory: long_wave, eq. 7].

    Parameters
    ----------
    terms : what acts
    area, momentum : A and q, shape (n,)
    time : s

    Returns
    -------
    F in the drum frame, N, real along theta = 0

    Raises
    ------
    InputError : a surface at the axis, a value that is not finite
    """
    require_layer(terms, area, momentum)
    a, q = scaled(terms, area, momentum)
    surface, spin = long_wave.free_surface_radius(a), terms.spin(time)
    u, pull = faded_velocity(a, q, spin), radial_force(terms, a.size, time)[0]
    pressure = long_wave.wall_pressure(u, long_wave.layer_log(a), a, surface, spin, pull)
    force = complex((pressure * _rays(a.size)).mean()) * 2.0 * math.pi
    return force * terms.fill.liquid.density * terms.fill.chamber.height * terms.fill.chamber.radius**3


def liquid_offset(terms: LongWaveTerms, area: Array) -> complex:
    """Liquid's centre of mass from the drum's axis, in the drum frame, m, of A, m^2, shape (n,).

    Raises
    ------
    InputError : no liquid, a surface at the axis, a value that is not finite
    """
    require_layer(terms, area, area)
    a = np.maximum(area, 0.0) / terms.fill.chamber.radius**2
    if not a.any():
        raise InputError("area", 0.0, "above 0 in some cell")
    r = long_wave.free_surface_radius(a)
    # (1 - r^3)/3, without cancellation in thin films.
    moment = 2.0 / 3.0 * a * (1.0 + r + r * r) / (1.0 + r)
    return complex((moment * _rays(a.size)).sum() / a.sum()) * terms.fill.chamber.radius


def _rays(cells: int) -> NDArray[np.complex128]:
    """e^{i theta} at the cells' middles."""
    return np.asarray(ring(cells)[0] + 1j * ring(cells)[1])
