"""Liquid models as objects: the liquid's unbalance under a deflection that is fixed in the drum.

Two of them stand on a grid, long-wave cells round the wall and finite elements. Both converge to the exact
equilibrium, the cells where it is a cylinder of liquid. Their unbalance less the liquid's mass times the
deflection never falls as that grows, which the search for branches rests on.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import lru_cache
from typing import Protocol

import numpy as np

from fluid.fill import Fills
from fluid.paraboloid import CYLINDER_STEEPNESS, steepness
from meshes.arrays import Array, Flags, Index
from meshes.errors import InputError
from meshes.section import Section, annulus
from solvers.roots import bracketed_root
from solvers.statics.hydrostatics import equilibrium, volume_under

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


_CELLS_AT_ONCE = 1 << 17  # of all states together, so that they stay in the processor's cache
_DEEPEST = 0.3  # mean depth over the radius up to which waves on the layer are long
_SHIFT = 1e-4  # relative change of a level across which the plan of the surface is measured


@dataclass(frozen=True)
class LongWave(LiquidModel):
    """The plane layer at rest on finite-volume cells, as the long-wave scheme holds it in synchronous whirl.

    In every cell the surface is that of one circle about the rotation axis [theory: long_wave, eq. 6]; cells
    beyond the circle are dry, and the volume is met by the cells' sum. Unbalance and volume are the sums of
    what the cells hold, so that even with every cell wet the law is the straight line to rounding only if
    there are many cells. Gravity along the axis is left out.

    Parameters
    ----------
    cells : round the wall, at least 8; the deflection points between two of them

    Raises
    ------
    InputError : fewer cells
    """

    cells: int

    def __post_init__(self) -> None:
        if not 8 <= self.cells <= 65536:
            raise InputError("cells", self.cells, "from 8 to 65536")

    @property
    def name(self) -> str:
        """Model and resolution."""
        return f"long_wave {self.cells}"

    def synchronous(self, fills: Fills, speed: Array, deflection: Array, gravity: Array) -> SynchronousAnswer:
        """See `LiquidModel`; in range while the layer is long, upright, and clear of axis and inner wall."""
        at_once = max(1, _CELLS_AT_ONCE // self.cells)
        parts = [np.arange(k, min(k + at_once, speed.size)) for k in range(0, speed.size, at_once)]
        found = [self._at_rest(fills.at(part), deflection[part]) for part in parts]
        moment, slope, dry, most, met = np.concatenate([np.zeros((5, 0)), *found], axis=1)
        chamber = fills.chamber
        steep = steepness(speed, gravity, chamber.radius, chamber.height)
        covered = fills.volume * steep >= 0.5 * math.pi * np.square(chamber.radius) * chamber.height
        clear = most < chamber.radius - chamber.inner_radius
        return SynchronousAnswer(
            unbalance=fills.density * moment,
            slope=fills.density * slope,
            dry_patch=(dry > 0.0) & (deflection > 0.0),
            in_range=covered & clear & (fills.depth <= _DEEPEST * chamber.radius),
            converged=met > 0.0,
        )

    def _at_rest(self, fills: Fills, deflection: Array) -> Array:
        """First moment about the rotation axis, slope; dry, greatest depth, volume met; shape (5, n)."""
        chamber = fills.chamber
        radius, height = chamber.radius, chamber.height
        e, film = deflection / radius, fills.volume / (math.pi * height * np.square(radius))
        mean = fills.depth / radius

        def excess(level: Array, which: Index) -> Array:
            depth = _circle(e[which], level, self.cells)[0]
            return np.asarray(np.mean(depth * (2.0 - depth), axis=1) - film[which])

        # As deep as mean depth and deflection together along that, a circle holds all there is, or more.
        most = np.minimum(1.5 * (mean + e), 1.0 + e)
        cosine, _, away = _middles(self.cells)
        level, _ = bracketed_root(excess, 0.5 * mean, most * (2.0 * (1.0 + e) - most) - e * away[0])
        depth, chord = _circle(e, level, self.cells)
        found = np.mean(depth * (2.0 - depth), axis=1)
        met = np.abs(found - film) <= 1e-12 * film
        drop = level + e * away[0]
        deepest = drop / (1.0 + e + np.sqrt(np.maximum(np.square(1.0 + e) - drop, 0.0)))
        surface, wet = 1.0 - depth, depth > 0.0
        lever = depth * (3.0 - depth * (3.0 - depth)) / 3.0  # (1 - r^3)/3
        own = 2.0 * math.pi * np.mean(lever * cosine, axis=1)
        # How much each cell's area changes with the head, and the mean lever arm of that.
        share = np.divide(surface, chord, out=np.zeros_like(surface), where=wet & (chord > 0.0))
        arm, whole = surface * cosine, np.sum(share, axis=1)
        middle = np.divide(np.sum(share * arm, axis=1), whole, out=np.zeros_like(whole), where=whole > 0.0)
        spread = 2.0 * math.pi * np.mean(share * np.square(arm - middle[:, None]), axis=1)
        size = np.square(radius) * height
        moment = fills.volume * deflection + size * radius * own
        dry = ~np.all(wet, axis=1)
        return np.stack([moment, fills.volume + size * spread, dry, deepest * radius, met])


def _middles(cells: int) -> tuple[Array, Array, Array]:
    """Cosine, sine and 4 sin^2(theta/2) of the cells' middles from the deflection."""
    theta = 2.0 * math.pi * (np.arange(cells) + 0.5) / cells
    return np.cos(theta), np.sin(theta), 4.0 * np.square(np.sin(0.5 * theta))


def _circle(e: Array, level: Array, cells: int) -> tuple[Array, Array]:
    """Depth of each cell over R under a circle about the rotation axis, and r + e cos(theta), (n, cells).

    The surface is at r = chord - e cos(theta). `level` is how much the circle's squared radius falls short of
    the squared distance of the wall at the middle of the deepest cell: thin films keep their digits.
    """
    cosine, sine, away = _middles(cells)
    e, level = e[:, None], level[:, None]
    across = np.square(1.0 + e) - e * away[0] - level - np.square(e * sine)
    chord = np.sqrt(np.maximum(across, 0.0))
    below = level - e * (away - away[0])
    seen = 1.0 + e * cosine + chord
    depth = np.divide(below, seen, out=np.ones_like(below), where=(across > 0.0) & (seen > 0.0))
    # Beyond the circle's side the scheme takes the surface where the pull vanishes.
    depth = np.where(across > 0.0, depth, np.minimum(1.0 + e * cosine, 1.0))
    return np.clip(depth, 0.0, 1.0), chord


@dataclass(frozen=True)
class Fem(LiquidModel):
    """The exact free surface integrated over a finite-element mesh of the section [theory: statics, eq. 1].

    The section has the area of its mesh, a little less than the circle's.

    Parameters
    ----------
    segments : edges along the wall, 8 or more
    order : 1 for straight edges, 2 for quadratic ones

    Raises
    ------
    InputError : fewer segments, another order
    """

    segments: int
    order: int = 1

    def __post_init__(self) -> None:
        if self.segments < 8 or self.order not in (1, 2):
            raise InputError("segments, order", (self.segments, self.order), "8 or more; 1 or 2")

    @property
    def name(self) -> str:
        """Model and resolution."""
        return f"fem {self.segments} order {self.order}"

    def synchronous(self, fills: Fills, speed: Array, deflection: Array, gravity: Array) -> SynchronousAnswer:
        """See `LiquidModel`; holds at every deflection."""
        chamber = fills.chamber
        steep = steepness(speed, gravity, chamber.radius, chamber.height)
        count = speed.size
        moment, slope, nearest = np.zeros(count), np.zeros(count), np.zeros(count)
        met = np.zeros(count, dtype=bool)
        for k in range(count):
            radius, height = float(chamber.radius[k]), float(chamber.height[k])
            section = _section(radius, float(chamber.inner_radius[k]), self.segments, self.order)
            beta = float(steep[k]) * height / radius**2 if steep[k] < CYLINDER_STEEPNESS else math.inf
            found = _surface(section, height, beta, float(fills.volume[k]), float(deflection[k]), radius)
            moment[k], slope[k], nearest[k], met[k] = found
        return SynchronousAnswer(
            unbalance=fills.density * moment,
            slope=fills.density * slope,
            dry_patch=(nearest <= 0.0) & (deflection > 0.0),
            in_range=np.ones(count, dtype=bool),
            converged=met,
        )


@lru_cache(maxsize=32)
def _section(radius: float, inner_radius: float, segments: int, order: int) -> Section:
    return annulus(radius, inner_radius, segments, order=order)


def _surface(
    section: Section, height: float, beta: float, volume: float, e: float, radius: float
) -> tuple[float, float, float, bool]:
    """First moment, its slope, depth of the near wall below the surface, and whether the volume was met.

    The level of the surface is the drop from the far wall to its line on the floor in squared radii, m^2.
    """
    from solvers.statics.free_surface import integrate_surface, solve_surface

    axis, plane = (-e, 0.0), math.isinf(beta)
    far, near = (radius + e) ** 2, (radius - e) ** 2
    solved = solve_surface(section, height, beta, volume, axis)
    level = far - solved.dry_radius**2 if plane else solved.wetted_height / beta
    lower = level * (1.0 - _SHIFT)
    if plane:
        line = math.sqrt(max(far - lower, 0.0))
        other = integrate_surface(section, height, beta, dry_radius=line, axis=axis)
    else:
        other = integrate_surface(section, height, beta, beta * lower, axis=axis)
    # What lies between the two levels is the plan of the surface, weighted [theory: statics, eq. 16].
    here = solved.moments
    plan, arm, square = (float(getattr(here, n) - getattr(other, n)) for n in ("volume", "x", "xx"))
    spread = max(square - arm * arm / plan, 0.0) if plan > 0.0 else 0.0
    slope = float(here.volume) + 2.0 * spread / (level - lower)
    return float(here.x), slope, level - (far - near), solved.converged
