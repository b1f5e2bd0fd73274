"""Liquid models as objects: the liquid's unbalance under a deflection that is fixed in the drum."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Protocol

import numpy as np

from fluid.fill import Fills
from fluid.paraboloid import CYLINDER_STEEPNESS, steepness
from meshes.arrays import Array, Flags, Index
from meshes.errors import InputError
from solvers.roots import bracketed_root
from solvers.statics.hydrostatics import equilibrium
from solvers.statics.integrals import volume_under

# The end of the straight line is taken so much too low, relatively, that the law is the line up to it.
_MARGIN = 1e-9


@dataclass(frozen=True)
class SynchronousAnswer:
    """The liquid of chambers under synchronous whirl; all shapes (n,).

    Parameters
    ----------
    unbalance : first moment of the liquid about the rotation axis, along the deflection, kg m
    slope : its derivative with respect to the deflection at fixed volume, kg
    dry_patch : the wall is dry over its whole height somewhere
    in_range : the model holds there
    converged : the surface holds the volume asked for
    """

    unbalance: Array
    slope: Array
    dry_patch: Flags
    in_range: Flags
    converged: Flags

    @classmethod
    def everywhere(cls, unbalance: Array, slope: Array) -> SynchronousAnswer:
        """Answer of a law that holds at every deflection and leaves the wall wet."""
        yes = np.ones(unbalance.shape, dtype=bool)
        return cls(unbalance, slope, ~yes, yes, yes)


class LiquidModel(Protocol):
    """Model of the liquid in chambers that whirl with their spin.

    Solvers take it as an object. A class that inherits from it needs a name and `synchronous`; the branches
    are found only if its unbalance less the liquid's mass times the deflection never falls as that grows.
    """

    @property
    def name(self) -> str:
        """By which results tell it, with its resolution if it has one."""
        ...

    def synchronous(self, fills: Fills, speed: Array, deflection: Array, gravity: Array) -> SynchronousAnswer:
        """Answer of fills at spin speeds and deflections, all shape (n,).

        Parameters
        ----------
        fills : one for each state, none of them empty
        speed : spin speed Omega, rad/s
        deflection : size of the chamber's deflection e, m, 0 or above
        gravity : along the axis, m/s^2
        """
        ...

    def linear_limit(self, fills: Fills, speed: Array, gravity: Array) -> Array:
        """Deflection up to which the unbalance is exactly the full mass times the deflection, m, (n,).

        0, as here, is right for every model; a larger one saves time.
        """
        return np.zeros(speed.shape)


@dataclass(frozen=True)
class Statics(LiquidModel):
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
        limit = fills.depth * (1.0 - _MARGIN)
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

    def excess(deflection: Array, which: Index) -> Array:
        here = chamber.at(which)
        touching = 1.0 + 4.0 * steep[which] * deflection / here.radius
        return volume_under(here, deflection, steep[which], touching) - fills.volume[which]

    everyone = np.arange(steep.size)
    limit = np.where(excess(chamber.radius, everyone) <= 0.0, chamber.radius, 0.0)
    between = np.flatnonzero((excess(np.zeros_like(steep), everyone) < 0.0) & (limit == 0.0))
    if between.size:

        def missing(deflection: Array, which: Index) -> Array:
            return excess(deflection, between[which])

        ends = np.zeros(between.size), chamber.radius[between]
        root, _ = bracketed_root(missing, *ends, relative=1e-10)
        limit[between] = root * (1.0 - _MARGIN)
    return limit


@dataclass(frozen=True)
class Linear(LiquidModel):
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


@dataclass(frozen=True)
class Elements(Linear):
    """The same with baffles, whose waves are found by finite elements [theory: sections, eq. 8].

    The deflection stays below the mean depth: in no compartment does the surface come nearer to the wall.
    """

    name = "fem"


STATICS, LINEAR, ELEMENTS = Statics(), Linear(), Elements()
MODEL_NAMES = tuple(model.name for model in (STATICS, LINEAR, ELEMENTS))


def model_named(name: str) -> LiquidModel:
    """The model that a scene names; `auto` is the cheapest that is exact for synchronous whirl.

    Raises
    ------
    InputError : no model of that name answers a synchronous whirl
    """
    known = {model.name: model for model in (STATICS, LINEAR, ELEMENTS)} | {"auto": STATICS}
    if name not in known:
        raise InputError("model.liquid", name, "one of auto, " + ", ".join(MODEL_NAMES))
    return known[name]
