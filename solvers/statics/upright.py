"""Whether a body with liquid in chambers about its axis stands upright while it spins about a fixed point."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from fluid.fill import Fill
from fluid.upright import cylinder_terms, free_surface_term, frozen_liquid
from meshes.arrays import Array
from meshes.errors import InputError, require_not_negative, require_positive
from solvers.roots import bracketed_root
from solvers.statics.hydrostatics import equilibrium


@dataclass(frozen=True)
class Top:
    """A rigid body without liquid, with one fixed point on its axis."""

    mass: float  #: kg
    transverse_inertia: float  #: across and along its axis, about its centre of mass, kg m^2
    polar_inertia: float
    centre: float  #: height of the centre of mass above the fixed point, m
    stiffness: float = 0.0  #: of springs against a tilt about the fixed point, N m; 0 without any

    def __post_init__(self) -> None:
        require_positive("mass", self.mass)
        require_positive("transverse_inertia", self.transverse_inertia)
        require_not_negative("polar_inertia", self.polar_inertia)
        require_not_negative("stiffness", self.stiffness)
        if not np.isfinite(self.centre):
            raise InputError("centre", self.centre, "a finite number")


@dataclass(frozen=True)
class Margin:
    """What keeps a body upright, second derivatives of its energy by the tilt; shapes (...,)."""

    frozen: Array  #: with the liquid frozen, springs included, N m
    surface: Array  #: what the free surfaces take from it, a of the source, N m

    @property
    def left(self) -> Array:
        """Above 0 where the upright rotation is stable, N m."""
        return self.frozen - self.surface


def upright_margin(
    top: Top, fills: Sequence[Fill], share: ArrayLike, speed: ArrayLike, gravity: float
) -> Margin:
    """Second variation of the energy of upright rotation [DR18, eq. 21-22; theory: statics, eq. 18-21].

    Circular chambers without baffles, their planes heights above the body's centre of mass; `share` is the
    part of each fill's volume that is there, shape (...,).
    """
    require_not_negative("gravity", gravity)
    part, omega = np.broadcast_arrays(np.asarray(share, dtype=float), np.asarray(speed, dtype=float))
    if not np.all(np.isfinite(omega) & (omega > 0.0)):
        raise InputError("speed", speed, "finite numbers above 0")
    spread = top.polar_inertia - top.transverse_inertia - top.mass * top.centre**2
    frozen = spread * np.square(omega) - top.mass * top.centre * gravity + top.stiffness
    surface = np.zeros(omega.shape)
    for fill in fills:
        chamber = fill.chamber
        if chamber.section is not None or chamber.baffles is not None:
            raise InputError("chambers", chamber, "circular and without baffles for this")
        floor = top.centre + chamber.plane - 0.5 * chamber.height
        volume, density = part * fill.volume, fill.liquid.density
        if gravity > 0.0:
            constant = equilibrium(chamber, volume, 0.0, omega, gravity).surface_constant
            at = chamber, floor, constant, omega, gravity, density
            liquid, taken = frozen_liquid(*at), free_surface_term(*at)
        else:
            liquid, taken = cylinder_terms(chamber, floor, volume, omega, density)
        frozen = frozen + (liquid.polar - liquid.transverse) * np.square(omega) - liquid.static * gravity
        surface = surface + taken
    return Margin(np.asarray(frozen), surface)


def sign_changes(function: Callable[[Array], Array], grid: Array) -> tuple[float, ...]:
    """Where a function of points (m,) changes sign between neighbours of a rising grid, once at most."""
    at = np.sign(function(grid))
    (changes,) = np.nonzero(at[1:] * at[:-1] < 0.0)
    root, _ = bracketed_root(lambda x, _: function(x), grid[changes], grid[changes + 1])
    through = (at[1:-1] == 0.0) & (at[2:] * at[:-2] < 0.0)
    return tuple(sorted([*root.tolist(), *grid[1:-1][through].tolist()]))
