"""Liquid models behind one small interface: the liquid's unbalance under a deflection fixed in the drum."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Protocol

import numpy as np
from numpy.typing import NDArray

from fluid.fill import Fill
from fluid.paraboloid import steepness
from meshes.border import InputError
from solvers import hydrostatics
from solvers.bracket import bracketed_root

Array = NDArray[np.float64]


@dataclass(frozen=True)
class SynchronousAnswer:
    """The liquid of one chamber under synchronous whirl; all shapes (n,).

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

    def synchronous(self, fill: Fill, speed: Array, deflection: Array, gravity: float) -> SynchronousAnswer:
        """Answer at spin speeds and deflections, shape (n,); `gravity` is along the axis, m/s^2."""
        ...

    def linear_limit(self, fill: Fill, speed: Array, gravity: float) -> Array:
        """Deflection up to which the unbalance is exactly the full mass times the deflection, m, (n,)."""
        ...


class Statics:
    """Exact equilibrium of the liquid at any amplitude [theory: statics]."""

    name = "statics"

    def synchronous(self, fill: Fill, speed: Array, deflection: Array, gravity: float) -> SynchronousAnswer:
        """See `LiquidModel`; holds at every deflection."""
        state = hydrostatics.equilibrium(fill.chamber, fill.volume, deflection, speed, gravity)
        moment, slope = state.unbalance()
        density = fill.liquid.density
        return SynchronousAnswer(
            unbalance=density * moment,
            slope=density * slope,
            dry_patch=state.dry_patch,
            in_range=np.ones(speed.shape, dtype=bool),
            converged=state.converged,
        )

    def linear_limit(self, fill: Fill, speed: Array, gravity: float) -> Array:
        """Deflection at which the surface reaches the near wall under the lid, m, shape (n,).

        Up to it the wall is wet all over, the inner wall is dry, and the liquid adds the mass of a full
        chamber [theory: statics, eq. 9]; 0 where the upright surface does not even do that.
        """
        chamber = fill.chamber
        # Without gravity along the axis the surface has one shape at all speeds.
        steep, back = np.unique(
            steepness(speed, gravity, chamber.radius, chamber.height), return_inverse=True
        )

        def excess(deflection: Array, which: NDArray[np.intp]) -> Array:
            touching = 1.0 + 4.0 * steep[which] * deflection / chamber.radius
            return hydrostatics.volume_under(chamber, deflection, steep[which], touching) - fill.volume

        everyone = np.arange(steep.size)
        farthest = np.full(steep.shape, chamber.radius)
        limit = np.where(excess(farthest, everyone) <= 0.0, chamber.radius, 0.0)
        between = np.flatnonzero((excess(np.zeros_like(steep), everyone) < 0.0) & (limit == 0.0))
        if between.size:

            def missing(deflection: Array, which: NDArray[np.intp]) -> Array:
                return excess(deflection, between[which])

            root, _ = bracketed_root(missing, np.zeros(between.size), farthest[between], relative=1e-10)
            # A hair below the root, so that the law is the straight line up to the limit and with it.
            limit[between] = root * (1.0 - 1e-9)
        # With the wall wet all over the surface rises under the inner wall as the deflection grows.
        ratio, eps = chamber.inner_radius / chamber.radius, limit / chamber.radius
        inner = 1.0 + 4.0 * steep * eps - steep * (1.0 - ratio) * (1.0 + ratio + 2.0 * eps)
        return np.where(inner <= 0.0, limit, 0.0)[back]


class Linear:
    """The layer's added mass, exact for small synchronous deflections [theory: waves, eq. 8]."""

    name = "linear"

    def synchronous(self, fill: Fill, speed: Array, deflection: Array, gravity: float) -> SynchronousAnswer:
        """See `LiquidModel`; holds while the deflection is below the mean depth of the layer."""
        dry = deflection >= fill.depth
        full_mass = fill.full_mass if fill.volume > 0.0 else 0.0
        return SynchronousAnswer(
            unbalance=full_mass * deflection,
            slope=np.full(deflection.shape, full_mass),
            dry_patch=dry & (deflection > 0.0),
            in_range=~dry,
            converged=np.ones(deflection.shape, dtype=bool),
        )

    def linear_limit(self, fill: Fill, speed: Array, gravity: float) -> Array:
        """Infinite: the law is a straight line."""
        return np.full(speed.shape, np.inf)


SYNCHRONOUS_MODELS: dict[str, LiquidModel] = {model.name: model for model in (Statics(), Linear())}


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
