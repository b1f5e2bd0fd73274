"""The fully nonlinear wave as a liquid model: steady waves of one whirl, and natural sloshing waves.

In SI units; the solvers below count lengths in radii and times in 1/Omega.
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass, field
from enum import StrEnum
from typing import ClassVar

import numpy as np

from fluid import waves
from fluid.fill import FULL, Fill, Fills
from fluid.paraboloid import steepness
from meshes.arrays import Array
from meshes.errors import InputError
from solvers.liquid_model import (
    CAPTURED,
    ROUNDING,
    THIN_LAYERS,
    FreeWave,
    LiquidAnswer,
    LiquidWave,
    Range,
    WaveModel,
    Whirl,
    Whirls,
    added_mass_answer,
    angles,
    kept_limits,
    no_free_wave,
    numbers_of,
    require_crest,
    wave_amplitude,
    whirl_answer,
)
from solvers.potential import unsteady
from solvers.potential.histories import PotentialHistory, Progress
from solvers.potential.in_time import Steps
from solvers.potential.steady import (
    MOST,
    RESOLVED,
    Branch,
    SteadyWave,
    follow,
    forced,
    free,
    linear_detuning,
    on_more_nodes,
    on_nodes,
)
from solvers.potential.strip import FEWEST, nodes

# Error of an answer that counts as found.
_FOUND = 1e-4
_MOST_CELLS, _MOST_STEPS = 8192, 2048
# Nodes from crest to trough that are drawn, at least.
_DRAWN = 180
# Digits that a whirl loses as it gets smaller than the drum.
_EPSILON = 1e-15


@dataclass(frozen=True)
class PotentialWave(LiquidWave):
    """A fully nonlinear wave; nan and empty where none was found."""

    branch: str = ""  #: "one_crest", or "lee_waves" where shorter waves ride on it
    nodes: int = 0  #: steps from crest to trough that it was solved on; 0 where it has a closed form
    #: whirl at which waves of this speed end, or up to which they were found, m; nan where the wave that was
    #: asked for was found
    largest: float = math.nan


@dataclass(frozen=True)
class Potential(WaveModel):
    """Fully nonlinear wave of a layer without friction, at any height and depth [theory: potential, eq. 7].

    Parameters
    ----------
    cells : steps from crest to trough that nodes may have, of which the spectrum decides how many are taken;
        in time the nodes round the wall that there may be, from 128 on doubled; None for 432 and 2048
    progress : called with the share of the time that is done, where a wave goes through time

    Raises
    ------
    InputError : too few or too many of them

    Examples
    --------
    >>> from fluid.liquid import known_liquid
    >>> from meshes.chamber import Chamber
    >>> fill = Fill(Chamber(radius=0.1, height=0.02), known_liquid("water"), volume=0.19e-3 * 0.62831853)
    >>> wave = Potential().wave(fill, Whirl(spin=40.0, speed=52.0, amplitude=0.2e-3))
    >>> ratio = wave.answer.unbalance[0].real / (fill.full_mass * 0.2e-3)
    >>> f"{ratio:.6f} {wave.branch}"
    '2.042546 one_crest'
    """

    cells: int | None = None
    progress: Progress = field(default=None, compare=False, repr=False)

    name = "potential"
    ranges: ClassVar[Mapping[str, Range]] = {
        "relative_depth": (0.01, 0.9), "centrifuge": CAPTURED, "wall_layer": THIN_LAYERS,
    }  # fmt: skip

    def __post_init__(self) -> None:
        if not FEWEST <= self.most <= _MOST_CELLS:
            raise InputError(
                "cells", self.most, f"from {FEWEST} to {_MOST_CELLS} for the fully nonlinear wave"
            )

    @property
    def most(self) -> int:
        """Steps from crest to trough that nodes of a steady wave may have."""
        return MOST if self.cells is None else min(self.cells, _MOST_STEPS)

    @property
    def steps(self) -> Steps:
        """How a wave is taken through time."""
        if self.cells is None:
            return Steps()
        if self.cells < unsteady.FEWEST or self.cells % 2:
            raise InputError("cells", self.cells, f"an even number from {unsteady.FEWEST} in time")
        return Steps(nodes=min(self.cells, Steps.nodes), most=self.cells)

    def at_rest(self, fills: Fills, whirls: Whirls) -> LiquidAnswer:
        """See `WaveModel`: a circle about the axis of spin, exact while the wall is wet.

        A paraboloid keeps the law until it touches an end of the wall, which is outside.
        """
        chamber = fills.chamber
        steep = steepness(whirls.spin, whirls.axial_gravity, chamber.radius, chamber.height)
        covered = fills.volume * steep >= 0.5 * math.pi * np.square(chamber.radius) * chamber.height
        answer = added_mass_answer(fills, whirls, ROUNDING)
        return LiquidAnswer.at_rest(
            fills,
            whirls,
            unbalance=answer.unbalance.real,
            slope=answer.slope.real,
            dry_patch=answer.dry_patch,
            limits={**answer.limits, "upright": covered},
            error=np.where(answer.dry_patch, math.nan, ROUNDING),
        )

    def wave(self, fill: Fill, whirl: Whirl) -> PotentialWave:
        """See `WaveModel`; the error is the distance from the same wave on half as many nodes again."""
        if whirl.gravity != 0.0:
            allowed = (
                "0 for the steady fully nonlinear wave: transverse gravity turns in the frame of the whirl"
            )
            raise InputError("gravity", whirl.gravity, allowed)
        _require_surface(fill)
        radius, layer = fill.chamber.radius, fill.depth / fill.chamber.radius
        if whirl.slip == 0.0 or whirl.amplitude == 0.0:
            return self._closed_form(fill, whirl)
        size, detuning = whirl.amplitude / radius, (whirl.slip / whirl.speed) ** 2
        found = forced(layer, detuning, size, self.most)
        if not found.converged:
            return self._without(fill, whirl, *_told(end(found, self.most), fill))
        finer = on_more_nodes(found, {"detuning": detuning, "whirl": found.whirl})
        change = abs(finer.force_ratio - found.force_ratio)
        if not finer.converged or change > _FOUND * max(abs(found.force_ratio), layer):
            last = End(EndKind.NODES, size, math.nan, 0)
            return self._without(fill, whirl, _told(last, fill)[0], math.nan)
        theta, depth, drawn = _profile(finer)
        force = complex(finer.force_ratio)
        return self._found(
            fill,
            whirl,
            force=force,
            offset=math.copysign(1.0, finer.whirl) * finer.centre * radius,
            theta=theta,
            depth=depth * radius,
            crest_number=_crest_number(drawn),
            error=(change + _EPSILON / size) / max(abs(force), _EPSILON) + ROUNDING,
            mass_error=_mass_error(drawn),
            rotation=finer.rotation * whirl.slip,
            branch=finer.branch,
            nodes=found.surface.size - 1,
        )

    def wave_at_end(self, fill: Fill, whirl: Whirl, history: PotentialHistory) -> PotentialWave:
        """The wave as a history leaves it, with the last means as its answer."""
        periods, answered = history.periods, history.periods.force_ratio.size > 0
        none = complex(math.nan, math.nan)
        force, offset = (periods.force_ratio[-1], periods.offset[-1]) if answered else (none, none)
        found = {
            "wave_amplitude": max(history.crest - 1.0, 1.0 - history.trough), "crest": history.crest,
            "trough": history.trough, "crest_number": history.crest_number,
        }  # fmt: skip
        numbers = numbers_of(fill, whirl, found)
        chamber = fill.chamber
        clear = history.crest * fill.depth <= chamber.radius - chamber.inner_radius
        answer = whirl_answer(
            fill,
            whirl,
            force_ratio=complex(force),
            offset=complex(offset),
            limits=kept_limits(numbers, self.ranges) | {"inner_wall": clear},
            converged=periods.converged,
            error=history.force_gap,
        )
        return PotentialWave(
            answer=answer,
            theta=periods.theta,
            depth=periods.depth,
            numbers=numbers,
            ranges=self.ranges,
            mass_error=periods.mass_error,
            mean_rotation=float(periods.mean_rotation[-1]) if answered else math.nan,
            reason=periods.reason,
            nodes=history.nodes,
        )

    def free_wave(self, fill: Fill, spin: float, crest: float, crests: int = 1) -> FreeWave:
        """Natural wave of so many crests, `crest` being the depth there over the mean depth, above 1.

        Its error is the distance from the same one on half as many nodes again.
        """
        _require_surface(fill)
        radius, layer = fill.chamber.radius, fill.depth / fill.chamber.radius
        require_crest(fill, crest, crests)
        found, reason, error = free(layer, crest, crests, self.most), "", math.nan
        if found.converged:
            finer = on_more_nodes(found, {"whirl": 0.0, "crest": crest})
            pair = [math.sqrt(wave.detuning) for wave in (found, finer)]
            error = abs(pair[1] / pair[0] - 1.0) + ROUNDING
            if not finer.converged or not finer.single or error > _FOUND:
                reason = f"{self.most} nodes from crest to trough do not carry a wave as sharp as this"
            found = finer
        else:
            reason = f"no natural sloshing wave as high was found: the last crest is {found.crest:.4g} depths"
        if reason:
            return no_free_wave(fill, self.ranges, reason)
        theta, depth, drawn = _profile(found)
        numbers = numbers_of(fill, Whirl(spin, spin, 0.0), {})
        names = ("relative_depth", "reynolds")
        high = wave_amplitude(depth, layer)
        crest_number = _crest_number(drawn)
        numbers = {name: numbers[name] for name in names} | {"wave_amplitude": high}
        numbers |= {"crest": drawn.crest, "trough": drawn.trough, "crest_number": crest_number}
        ahead, behind = found.slip_speeds()
        return FreeWave(
            whirl_speed=(spin * (1.0 + behind), spin * (1.0 + ahead)),
            theta=theta,
            depth=depth * radius,
            crest=drawn.crest,
            trough=drawn.trough,
            crest_number=crest_number,
            numbers=numbers,
            ranges=self.ranges,
            converged=True,
            mass_error=_mass_error(drawn),
            error=error,
            branch=found.branch,
        )

    def _closed_form(self, fill: Fill, whirl: Whirl) -> PotentialWave:
        """A circle about the axis of spin, or the layer that no whirl stirs."""
        radius, surface, size = fill.chamber.radius, fill.surface_radius, whirl.amplitude
        if size >= fill.depth:
            reason = "the wall runs dry, which no fully nonlinear wave here does; the statics do"
            return self._without(fill, whirl, reason, fill.depth)
        theta = angles()
        drawn = np.sqrt(surface**2 - np.square(size * np.sin(theta))) - size * np.cos(theta)
        still = complex(float(waves.force_ratio((radius / surface) ** 2, whirl.speed / whirl.spin)))
        if not math.isfinite(still.real):
            return self._without(
                fill, whirl, "the whirl meets a natural sloshing wave, whose force is unbounded", 0.0
            )
        return self._found(
            fill,
            whirl,
            force=still if size == 0.0 else complex(1.0),
            offset=size * surface**2 / (radius**2 - surface**2),
            theta=theta,
            depth=radius - drawn,
            crest_number=math.nan,
            error=ROUNDING,
            mass_error=0.0,
            rotation=0.0,
            branch=Branch.ONE_CREST if size else "",
            nodes=0,
        )

    def _found(
        self,
        fill: Fill,
        whirl: Whirl,
        force: complex,
        offset: float,
        theta: Array,
        depth: Array,
        crest_number: float,
        error: float,
        mass_error: float,
        rotation: float,
        branch: str,
        nodes: int,
    ) -> PotentialWave:
        """The answer of a wave in the frame of its deflection."""
        crest, trough = float(depth.max()), float(depth.min())
        numbers = numbers_of(fill, whirl, {"wave_amplitude": wave_amplitude(depth, fill.depth)})
        numbers |= {"crest": crest / fill.depth, "trough": trough / fill.depth, "crest_number": crest_number}
        clear = crest <= fill.chamber.radius - fill.chamber.inner_radius
        answer = whirl_answer(
            fill,
            whirl,
            force_ratio=force,
            offset=complex(offset),
            limits=kept_limits(numbers, self.ranges) | {"inner_wall": clear},
            small=whirl.amplitude == 0.0,
            error=error,
        )
        return PotentialWave(
            answer=answer,
            theta=theta,
            depth=depth,
            numbers=numbers,
            ranges=self.ranges,
            mass_error=mass_error,
            mean_rotation=rotation,
            branch=branch,
            nodes=nodes,
        )

    def _without(self, fill: Fill, whirl: Whirl, reason: str, largest: float) -> PotentialWave:
        """No wave, and why."""
        none = complex(math.nan, math.nan)
        numbers = numbers_of(fill, whirl, {})
        answer = whirl_answer(
            fill,
            whirl,
            force_ratio=none,
            offset=none,
            limits=kept_limits(numbers, self.ranges),
            dry_patch=whirl.slip == 0.0 and whirl.amplitude >= fill.depth,
            converged=False,
        )
        theta = angles()
        return PotentialWave(
            answer=answer,
            theta=theta,
            depth=np.full(theta.shape, math.nan),
            numbers=numbers,
            ranges=self.ranges,
            mass_error=math.nan,
            mean_rotation=math.nan,
            reason=reason,
            largest=largest,
        )


def _require_surface(fill: Fill) -> None:
    """Refuse a chamber without a free surface."""
    chamber, surface = fill.chamber, fill.surface_radius
    if fill.volume >= chamber.capacity * FULL or surface <= chamber.inner_radius:
        allowed = "less than what fills the chamber, for a free surface"
        raise InputError("volume", fill.volume, allowed)


def _profile(wave: SteadyWave) -> tuple[Array, Array, SteadyWave]:
    """Angles from the deflection or from a crest, ascending, depth there over R, and the wave as drawn."""
    count, crests = max(wave.surface.size - 1, _DRAWN), wave.at.crests
    drawn = on_nodes(wave, nodes(count, crests, wave.at.cluster))
    half, depth = drawn.angle, drawn.depth
    whole = np.concatenate((-half[:0:-1], half[:-1]))
    deep = np.concatenate((depth[:0:-1], depth[:-1]))
    # A negative whirl has its crest opposite to the deflection.
    first = math.pi if wave.whirl < 0.0 else 0.0
    around = (first + whole[None, :] + 2.0 * math.pi / crests * np.arange(crests)[:, None]).ravel()
    around = np.mod(around + math.pi, 2.0 * math.pi) - math.pi
    order = np.argsort(around)
    return around[order], np.tile(deep, crests)[order], drawn


def _crest_number(wave: SteadyWave) -> float:
    """Speed of the liquid at the highest place over that of the wave there, both seen from the drum."""
    highest = int(np.argmax(wave.surface))
    return float(1.0 - wave.speeds[highest] * math.exp(float(wave.surface[highest])))


def _mass_error(wave: SteadyWave) -> float:
    """Relative error of the mass under the surface as it is drawn, on nodes of its own."""
    return abs(wave.volume / (wave.layer * (2.0 - wave.layer)) - 1.0)


def _told(last: End, fill: Fill) -> tuple[str, float]:
    """Why there is no wave, and the whirl at which they end, m."""
    share = last.whirl * fill.chamber.radius / fill.depth
    upto = f"the last smooth steady wave was found at a whirl of {share:.3g} of the depth"
    froude = math.sqrt(last.froude) if last.froude > 0.0 else math.nan
    why = {
        EndKind.FOLD: f"waves of this speed end in a fold at a whirl of {share:.3g} of the depth",
        EndKind.CHOKING: f"the flow chokes at the trough, Froude number {froude:.2f}; {upto}",
        EndKind.RESONANCE: f"the whirl meets the natural sloshing wave of {last.crests} crests; {upto}",
        EndKind.NODES: f"the nodes do not carry the short waves that come with it; {upto}",
    }
    return why[last.kind], last.whirl * fill.chamber.radius


# Growth of the wave's height from step to step round a fold, and how many steps there may be.
_RISE, _STEPS = 1.04, 60
# Fall of the whirl, of its largest, that is a fold and no rounding.
_FALL = 1e-3
# Square of the local Froude number that dispersion leaves of a flow that chokes.
_CHOKED = 0.84
_MOST_CRESTS = 64


class EndKind(StrEnum):
    """Why there is no smooth steady wave beyond some whirl."""

    FOLD = "fold"
    CHOKING = "choking"
    RESONANCE = "resonance"
    NODES = "nodes"


@dataclass(frozen=True)
class End:
    """End of a branch of waves."""

    kind: EndKind  #: what it comes of
    whirl: float  #: largest |w_0|/R of a wave that was found on it
    froude: float  #: square of the largest local Froude number of that wave
    crests: int  #: of the natural wave that the whirl's speed is nearest to, but for that of one crest


def froude(wave: SteadyWave) -> Array:
    """Square of the local Froude number of the flow seen from the wave [theory: potential, eq. 33].

    At the nodes: 1 where long waves stand still on the flow.
    """
    y, speed = wave.surface, wave.speeds
    radius = np.exp(-y)
    return np.asarray(wave.detuning * speed * (speed / y + 2.0 * radius - speed) / np.square(radius))


def end(wave: SteadyWave, most: int = MOST) -> End:
    """Why a branch did not go on."""
    ratios = [abs(wave.detuning / linear_detuning(wave.layer, n) - 1.0) for n in range(2, _MOST_CRESTS)]
    crests, local = 2 + int(np.argmin(ratios)), float(froude(wave).max())
    reached = abs(wave.whirl)
    if wave.detuning > linear_detuning(wave.layer):
        largest = _fold(wave, most)
        if not math.isnan(largest):
            return End(EndKind.FOLD, largest, local, crests)
    if wave.tail > RESOLVED:
        return End(EndKind.NODES, reached, local, crests)
    kind = EndKind.CHOKING if local > _CHOKED else EndKind.RESONANCE
    return End(kind, reached, local, crests)


def _fold(wave: SteadyWave, most: int) -> float:
    """Largest whirl of a branch, which goes on with the height of its waves; nan where it has none."""
    heights, whirls = [wave.crest - wave.trough], [abs(wave.whirl)]
    if not heights[0] > 0.0:
        return math.nan
    for _ in range(_STEPS):
        height = _RISE * heights[-1]
        wave = follow(wave, {"detuning": wave.detuning, "height": height}, 1, most, 0.1)
        if not wave.converged or not wave.single:
            return math.nan
        heights.append(height)
        whirls.append(abs(wave.whirl))
        top = int(np.argmax(whirls))
        if top < len(whirls) - 1 and whirls[-1] < (1.0 - _FALL) * whirls[top]:
            break
    else:
        return math.nan
    if top == 0:
        return whirls[0]
    # The top of a parabola through three heights.
    near = slice(top - 1, top + 2)
    bend, slope, level = np.polyfit(heights[near], whirls[near], 2)
    return float(level - slope**2 / (4.0 * bend))
