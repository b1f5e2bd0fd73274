"""Liquid models of the synchronous response: the exact equilibrium, linear theory, the equilibrium on grids.

`Statics` and `Linear` also answer a prescribed whirl with its wave. Long-wave cells and finite elements
converge to the exact equilibrium, the cells where it is a cylinder of liquid.
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass
from functools import lru_cache
from typing import ClassVar

import numpy as np

from fluid import waves
from fluid.fill import Fill, Fills
from fluid.paraboloid import CYLINDER_STEEPNESS, steepness
from meshes.arrays import Array, Index
from meshes.errors import InputError
from meshes.section import Section, annulus
from solvers.liquid_model import (
    CAPTURED,
    LONG,
    ROUNDING,
    SMOOTH,
    THIN_LAYERS,
    FreeWave,
    LiquidAnswer,
    LiquidModel,
    LiquidWave,
    Range,
    WaveModel,
    Whirl,
    Whirls,
    added_mass_answer,
    angles,
    kept_limits,
    numbers_of,
    require_crest,
    smooth_whirl,
    wave_amplitude,
    whirl_answer,
)
from solvers.roots import bracketed_root
from solvers.statics.hydrostatics import equilibrium, volume_under
from solvers.statics.law_defect import defect_bound, upright_surfaces
from solvers.wave_error import linear_error

# The end of the straight line is taken so much too low, relatively, that the law is the line up to it.
_MARGIN = 1e-9


@dataclass(frozen=True)
class Statics(WaveModel):
    """Exact equilibrium of the liquid at any amplitude, under a synchronous whirl [theory: statics]."""

    name = "statics"
    # The liquid is at rest: any depth, any amplitude, dry walls.
    ranges: ClassVar[Mapping[str, Range]] = {}

    def answer(self, fills: Fills, whirls: Whirls) -> LiquidAnswer:
        """See `LiquidModel`; another whirl is answered as if it were synchronous, which is out of range."""
        state = equilibrium(fills.chamber, fills.volume, whirls.amplitude, whirls.spin, whirls.axial_gravity)
        moment, slope = state.unbalance()
        return LiquidAnswer.at_rest(
            fills,
            whirls,
            unbalance=fills.density * moment,
            slope=fills.density * slope,
            dry_patch=state.dry_patch,
            converged=state.converged,
            error=ROUNDING,
        )

    def pull(self, fills: Fills, whirls: Whirls) -> Array:
        """See `LiquidModel`."""
        state = equilibrium(fills.chamber, fills.volume, whirls.amplitude, whirls.spin, whirls.axial_gravity)
        return np.asarray(fills.density * state.first_moment())

    def wave(self, fill: Fill, whirl: Whirl) -> LiquidWave:
        """See `WaveModel`; no friction acts on liquid that is at rest in the drum."""
        amplitude = whirl.amplitude
        if whirl.slip != 0.0:
            allowed = f"the spin speed ({whirl.spin:g} rad/s) for the static model"
            raise InputError("whirl_speed", whirl.speed, allowed)
        if whirl.gravity != 0.0:
            allowed = "0 for the static model: across the axis it turns in the drum"
            raise InputError("gravity", whirl.gravity, allowed)
        chamber = fill.chamber
        state = equilibrium(chamber, fill.volume, amplitude, whirl.spin, gravity=0.0)
        moment = float(state.unbalance()[0])
        full = math.pi * chamber.radius**2 * chamber.height
        # Without a whirl the ratio is that of a vanishing one, which no depth of liquid runs dry.
        ratio = moment / (full * amplitude) if amplitude else 1.0
        theta = angles()
        # The surface is a circle about the rotation axis, at -A from the drum's axis.
        floor = float(state.wetted_height / state.steepness)
        squared = chamber.radius**2 * ((1.0 + amplitude / chamber.radius) ** 2 - floor)
        across = np.maximum(squared - np.square(amplitude * np.sin(theta)), 0.0)
        surface = np.maximum(np.sqrt(across) - amplitude * np.cos(theta), chamber.inner_radius)
        depth = np.clip(chamber.radius - surface, 0.0, chamber.radius)
        answer = whirl_answer(
            fill,
            whirl,
            force_ratio=complex(ratio),
            offset=complex(moment / fill.volume - amplitude),
            limits={"synchronous": True},
            dry_patch=bool(state.dry_patch),
            converged=bool(state.converged),
            small=True,
            error=ROUNDING,
        )
        return LiquidWave(
            answer=answer,
            theta=theta,
            depth=depth,
            numbers=numbers_of(fill, whirl, {"wave_amplitude": wave_amplitude(depth, fill.depth)}),
            ranges=self.ranges,
            mass_error=abs(float(state.volume) / fill.volume - 1.0),
        )

    def linear_limit(self, fills: Fills, speed: Array, gravity: Array) -> Array:
        """Deflection at which the surface reaches the near wall under the lid, m, shape (n,).

        Up to it the outer wall is wet, the inner dry, and the liquid adds the mass of a full chamber
        [theory: statics, eq. 9]; 0 where the upright surface does not even do that.
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
class Linear(WaveModel):
    """Exact linear theory of a clear ring without friction [theory: waves, eq. 5].

    A synchronous whirl finds an added mass, exact until the surface touches an end of the wall.
    """

    name = "linear"
    ranges: ClassVar[Mapping[str, Range]] = {
        "wave_amplitude": (0.0, 0.3), "centrifuge": CAPTURED, "wall_layer": THIN_LAYERS,
        "smooth_whirl": SMOOTH,
    }  # fmt: skip

    def at_rest(self, fills: Fills, whirls: Whirls) -> LiquidAnswer:
        """See `WaveModel`; the error is an analytical bound [theory: model_error, eq. 7]."""
        size = whirls.amplitude
        line = fills.added_mass * size
        missing = defect_bound(upright_surfaces(fills, whirls.spin, whirls.axial_gravity), size)
        error = np.divide(missing, line, out=np.zeros_like(line), where=line > 0.0) + ROUNDING
        return added_mass_answer(fills, whirls, error)

    def wave(self, fill: Fill, whirl: Whirl) -> LiquidWave:
        """See `WaveModel`; the error is that beside fully nonlinear waves [theory: model_error, eq. 34]."""
        chamber, surface, amplitude = fill.chamber, fill.surface_radius, whirl.amplitude
        if fill.depth >= chamber.radius * (1.0 - 1e-9) or surface <= chamber.inner_radius:
            allowed = "less than what fills the chamber, for a free surface"
            raise InputError("volume", fill.volume, allowed)
        kappa, ratio = (chamber.radius / surface) ** 2, whirl.speed / whirl.spin
        force = float(waves.force_ratio(kappa, ratio))
        offset = float(waves.offset_ratio(kappa, ratio)) * amplitude
        displacement = float(waves.displacement_ratio(kappa, ratio)) * amplitude
        converged = math.isfinite(force) and math.isfinite(displacement)
        # A synchronous whirl's linear surface is the exact circle to the square of its offset, while wet.
        ranges = dict(self.ranges) | ({} if whirl.slip else {"wave_amplitude": (0.0, 1.0)})
        found = {"wave_amplitude": abs(displacement) / fill.depth}
        numbers = numbers_of(fill, whirl, found | smooth_whirl(fill, whirl))
        inner_wall = surface - abs(displacement) >= chamber.inner_radius
        theta = angles()
        drawn = surface + displacement * np.cos(theta) if converged else np.full(theta.shape, math.nan)
        answer = whirl_answer(
            fill,
            whirl,
            force_ratio=complex(force),
            offset=complex(offset),
            limits=kept_limits(numbers, ranges) | {"inner_wall": inner_wall},
            dry_patch=abs(displacement) > fill.depth,
            converged=converged,
            small=True,
            error=self._error(fill, whirl),
        )
        return LiquidWave(
            answer=answer,
            theta=theta,
            depth=np.clip(chamber.radius - drawn, 0.0, chamber.radius),
            numbers=numbers,
            ranges=ranges,
            mass_error=0.5 * displacement**2 / (chamber.radius**2 - surface**2) if converged else math.nan,
            reason=""
            if converged
            else "the whirl meets a natural sloshing wave, the linear force is unbounded",
        )

    def free_wave(self, fill: Fill, spin: float, crest: float, crests: int = 1) -> FreeWave:
        """The natural wave of n crests, whose speed does not depend on its height [theory: waves, eq. 7]."""
        radius, surface = fill.chamber.radius, fill.surface_radius
        if fill.depth >= radius * (1.0 - 1e-9) or surface <= fill.chamber.inner_radius:
            raise InputError("volume", fill.volume, "less than what fills the chamber, for a free surface")
        require_crest(fill, crest, crests)
        height = (crest - 1.0) * fill.depth
        ahead, behind = waves.free_wave_speeds(crests, math.log(radius / surface), spin)
        theta = angles()
        depth = np.clip(fill.depth + height * np.cos(crests * theta), 0.0, radius)
        # Speed along the surface over that across it, of liquid between a wall and a small wave.
        ring = (surface / radius) ** (2 * crests)
        crest_number = crests * height / surface * (1.0 + ring) / (1.0 - ring)
        numbers = {"relative_depth": fill.depth / radius, "wave_amplitude": crest - 1.0}
        numbers |= {"crest": crest, "trough": 2.0 - crest, "crest_number": crest_number}
        return FreeWave(
            whirl_speed=(spin + float(behind), spin + float(ahead)),
            theta=theta,
            depth=depth,
            crest=crest,
            trough=2.0 - crest,
            crest_number=crest_number,
            numbers=numbers,
            ranges={"wave_amplitude": self.ranges["wave_amplitude"]},
            converged=True,
            mass_error=0.5 * height**2 / (radius**2 - surface**2),
        )

    def _error(self, fill: Fill, whirl: Whirl) -> float:
        """Error of one wave; none where gravity throws others."""
        if whirl.gravity != 0.0:
            return math.nan
        if whirl.slip == 0.0:
            return float(self.at_rest(Fills.of([fill]), Whirls.of(whirl)).error[0])
        return float(
            linear_error(fill.depth / fill.chamber.radius, whirl.detuning, whirl.amplitude / fill.depth)
        )

    def linear_limit(self, fills: Fills, speed: Array, gravity: Array) -> Array:
        """Infinite: the law is a straight line."""
        return np.full(speed.shape, np.inf)


STATICS, LINEAR = Statics(), Linear()

_CELLS_AT_ONCE = 1 << 17  # of all states together, so that they stay in the processor's cache
_SHIFT = 1e-4  # relative change of a level across which the plan of the surface is measured


@dataclass(frozen=True)
class CellsAtRest(LiquidModel):
    """The plane layer at rest on finite-volume cells, as the long-wave scheme holds it in synchronous whirl.

    In every cell the surface is that of one circle about the rotation axis [theory: long_wave, eq. 6]; cells
    beyond the circle are dry, and the volume is met by the cells' sum. Unbalance and volume are the sums of
    what the cells hold, so that even with every cell wet the law is the straight line to rounding only if
    there are many cells. Gravity along the axis is left out.

    Raises
    ------
    InputError : fewer cells
    """

    cells: int  #: round the wall, at least 8; the deflection points between two of them

    def __post_init__(self) -> None:
        if not 8 <= self.cells <= 65536:
            raise InputError("cells", self.cells, "from 8 to 65536")

    @property
    def name(self) -> str:
        """Model and resolution."""
        return f"long_wave {self.cells}"

    def answer(self, fills: Fills, whirls: Whirls) -> LiquidAnswer:
        """See `LiquidModel`; in range while the layer is long, upright, and clear of axis and inner wall."""
        speed, deflection = whirls.spin, whirls.amplitude
        at_once = max(1, _CELLS_AT_ONCE // self.cells)
        parts = [np.arange(k, min(k + at_once, speed.size)) for k in range(0, speed.size, at_once)]
        found = [self._at_rest(fills.at(part), deflection[part]) for part in parts]
        moment, slope, dry, most, met = np.concatenate([np.zeros((5, 0)), *found], axis=1)
        chamber = fills.chamber
        steep = steepness(speed, whirls.axial_gravity, chamber.radius, chamber.height)
        covered = fills.volume * steep >= 0.5 * math.pi * np.square(chamber.radius) * chamber.height
        clear = most < chamber.radius - chamber.inner_radius
        return LiquidAnswer.at_rest(
            fills,
            whirls,
            unbalance=fills.density * moment,
            slope=fills.density * slope,
            dry_patch=(dry > 0.0) & (deflection > 0.0),
            converged=met > 0.0,
            limits={
                "upright": covered,
                "inner_wall": clear,
                "relative_depth": fills.depth <= LONG[1] * chamber.radius,
            },
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

    The surface is at r = chord - e cos(theta). `level`: its squared radius is that much below the squared
    distance of the wall in the middle of the deepest cell: thin films keep their digits.
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
class ElementsAtRest(LiquidModel):
    """The exact free surface integrated over a finite-element mesh of the section [theory: statics, eq. 1].

    The section has the area of its mesh, a little less than the circle's.

    Raises
    ------
    InputError : fewer segments, another order
    """

    segments: int  #: edges along the wall, 8 or more
    order: int = 1  #: 1 for straight edges, 2 for quadratic ones

    def __post_init__(self) -> None:
        if self.segments < 8 or self.order not in (1, 2):
            raise InputError("segments, order", (self.segments, self.order), "8 or more; 1 or 2")

    @property
    def name(self) -> str:
        """Model and resolution."""
        return f"fem {self.segments} order {self.order}"

    def answer(self, fills: Fills, whirls: Whirls) -> LiquidAnswer:
        """See `LiquidModel`; holds at every deflection."""
        chamber, speed, deflection = fills.chamber, whirls.spin, whirls.amplitude
        steep = steepness(speed, whirls.axial_gravity, chamber.radius, chamber.height)
        count = speed.size
        moment, slope, nearest = np.zeros(count), np.zeros(count), np.zeros(count)
        met = np.zeros(count, dtype=bool)
        for k in range(count):
            radius, height = float(chamber.radius[k]), float(chamber.height[k])
            section = _section(radius, float(chamber.inner_radius[k]), self.segments, self.order)
            beta = float(steep[k]) * height / radius**2 if steep[k] < CYLINDER_STEEPNESS else math.inf
            found = _surface(section, height, beta, float(fills.volume[k]), float(deflection[k]), radius)
            moment[k], slope[k], nearest[k], met[k] = found
        return LiquidAnswer.at_rest(
            fills,
            whirls,
            unbalance=fills.density * moment,
            slope=fills.density * slope,
            dry_patch=(nearest <= 0.0) & (deflection > 0.0),
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
