"""Liquid models behind one small interface: the liquid's unbalance under a deflection fixed in the drum."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Protocol

import numpy as np
from numpy.typing import NDArray

from fluid.fill import Fills
from fluid.paraboloid import CYLINDER_STEEPNESS, steepness
from meshes.arrays import Array
from meshes.errors import InputError
from solvers.roots import bracketed_root
from solvers.statics.hydrostatics import equilibrium
from solvers.statics.integrals import volume_under

# The limit of the straight line is taken a hair low, so that the law is the line up to it and with it.
_HAIR = 1e-9


@dataclass(frozen=True)
class SynchronousAnswer:
    """The liquid of chambers under synchronous whirl; all shapes (n,).

    Parameters
    ----------
    unbalance : first moment of the liquid about the rotation axis, kg m
    slope : its derivative with respect to the deflection at fixed volume, kg
    dry_patch : the wall is dry over its whole height somewhere
    in_range : the model holds there
    converged : the surface holds the volume asked for
    """

    unbalance: Array
    slope: Array
    dry_patch: NDArray[np.bool_]
    in_range: NDArray[np.bool_]
    converged: NDArray[np.bool_]


class LiquidModel(Protocol):
    """What a model of the liquid must answer for the synchronous response."""

    name: str

    def synchronous(self, fills: Fills, speed: Array, deflection: Array, gravity: Array) -> SynchronousAnswer:
        """Answer of fills at spin speeds and deflections, all shape (n,).

        Parameters
        ----------
        fills : one for each state, none of them empty
        speed : spin speed Omega, rad/s
        deflection : e, m
        gravity : along the axis, m/s^2
        """
        ...

    def linear_limit(self, fills: Fills, speed: Array, gravity: Array) -> Array:
        """Deflection up to which the unbalance is exactly the full mass times the deflection, m, (n,)."""
        ...


class Statics:
    """Exact equilibrium of the liquid at any amplitude [theory: statics]."""

    name = "statics"

    def synchronous(self, fills: Fills, speed: Array, deflection: Array, gravity: Array) -> SynchronousAnswer:
        """See `LiquidModel`; holds at every deflection."""
        state = equilibrium(fills.chamber, fills.volume, deflection, speed, gravity)
        moment, slope = state.unbalance()
        return SynchronousAnswer(
            unbalance=fills.density * moment,
            slope=fills.density * slope,
            dry_patch=state.dry_patch,
            in_range=np.ones(speed.shape, dtype=bool),
            converged=state.converged,
        )

    def linear_limit(self, fills: Fills, speed: Array, gravity: Array) -> Array:
        """Deflection at which the surface reaches the near wall under the lid, m, shape (n,).

        Up to it the wall is wet all over, the inner wall is dry, and the liquid adds the mass of a full
        chamber [theory: statics, eq. 9]; 0 where the upright surface does not even do that.
        """
        chamber = fills.chamber
        steep = steepness(speed, gravity, chamber.radius, chamber.height)
        # A cylinder about the rotation axis touches the wall where the deflection is the mean depth.
        limit = fills.depth * (1.0 - _HAIR)
        bowl = np.flatnonzero(steep < CYLINDER_STEEPNESS)
        if bowl.size:
            limit[bowl] = _touching(fills.at(bowl), steep[bowl])
        # With the wall wet all over the surface rises under the inner wall as the deflection grows.
        ratio, eps = chamber.inner_radius / chamber.radius, limit / chamber.radius
        inner = 1.0 + 4.0 * steep * eps - steep * (1.0 - ratio) * (1.0 + ratio + 2.0 * eps)
        return np.where((ratio == 0.0) | (inner <= 0.0), limit, 0.0)


def _touching(fills: Fills, steep: Array) -> Array:
    """Deflection at which a bowl touches the near wall under the lid, m; 0 if it always does, R if never."""
    chamber = fills.chamber

    def excess(deflection: Array, which: NDArray[np.intp]) -> Array:
        here = chamber.at(which)
        touching = 1.0 + 4.0 * steep[which] * deflection / here.radius
        return volume_under(here, deflection, steep[which], touching) - fills.volume[which]

    everyone = np.arange(steep.size)
    limit = np.where(excess(chamber.radius, everyone) <= 0.0, chamber.radius, 0.0)
    between = np.flatnonzero((excess(np.zeros_like(steep), everyone) < 0.0) & (limit == 0.0))
    if between.size:

        def missing(deflection: Array, which: NDArray[np.intp]) -> Array:
            return excess(deflection, between[which])

        ends = np.zeros(between.size), chamber.radius[between]
        root, _ = bracketed_root(missing, *ends, relative=1e-10)
        limit[between] = root * (1.0 - _HAIR)
    return limit


class Linear:
    """The layer's added mass, exact for small synchronous deflections [theory: waves, eq. 8]."""

    name = "linear"

    def synchronous(self, fills: Fills, speed: Array, deflection: Array, gravity: Array) -> SynchronousAnswer:
        """See `LiquidModel`; holds while the deflection is below the mean depth of the layer."""
        dry = deflection >= fills.depth
        return SynchronousAnswer(
            unbalance=fills.added_mass * deflection,
            slope=fills.added_mass,
            dry_patch=dry & (deflection > 0.0),
            in_range=~dry,
            converged=np.ones(deflection.shape, dtype=bool),
        )

    def linear_limit(self, fills: Fills, speed: Array, gravity: Array) -> Array:
        """Infinite: the law is a straight line."""
        return np.full(speed.shape, np.inf)


class Elements(Linear):
    """The same with baffles, whose waves are found by finite elements [theory: sections, eq. 8].

    The deflection stays below the mean depth: in no compartment does the surface come nearer to the wall.
    """

    name = "fem"


SYNCHRONOUS_MODELS: dict[str, LiquidModel] = {
    model.name: model for model in (Statics(), Linear(), Elements())
}


def synchronous_model(name: str) -> LiquidModel:
    """Model by name; `auto` is the cheapest that is exact for synchronous whirl.

    Raises
    ------
    InputError : no such model answers a synchronous whirl
    """
    if name == "auto":
        return SYNCHRONOUS_MODELS["statics"]
    if name not in SYNCHRONOUS_MODELS:
        raise InputError("model.liquid", name, "one of auto, " + ", ".join(SYNCHRONOUS_MODELS))
    return SYNCHRONOUS_MODELS[name]
